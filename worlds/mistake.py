"""The one kind of error that is shown to a user as text alone."""


class Mistake(ValueError):
    """Something a user can put right; its text is ready to be printed: the place, what was got, what was expected."""

    def __init__(self, text: str, near: str = "") -> None:
        """With the valid name that is most like what was got, where there is one and the text does not say it."""
        super().__init__(text)
        self.near = near


class Unavailable(Exception):
    """A package that an agent needs is not installed, so it is skipped; the text says how to get it."""
