"""The one kind of error that is shown to a user as text alone."""


class Mistake(ValueError):
    """Something a user can put right; its text is ready to be printed: the place, what was got, what was expected."""


class Unavailable(Exception):
    """Something an agent needs is not there, so it is skipped; the text is the reason."""
