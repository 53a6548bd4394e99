"""What is told to a user as text alone: the one kind of error, its nearest valid name, and what is not installed."""

from collections.abc import Iterable
from difflib import get_close_matches


class Mistake(ValueError):
    """Something a user can put right; its text is ready to be printed: the place, what was got, what was expected."""

    def __init__(self, text: str, near: str = "") -> None:
        """With the valid name that is most like what was got, where there is one and the text does not say it."""
        super().__init__(text)
        self.near = near

    def within(self, place: str) -> str:
        """Its text with the place where it was met before each line, and a full stop behind it."""
        lines = str(self).splitlines()
        return "\n".join(f"{place}: {line}{'' if line.endswith(('.', '?')) else '.'}" for line in lines)


class Unavailable(Exception):
    """A package that an agent needs is not installed, so it is skipped; the text says how to get it."""


def encodable(name: str) -> str:
    """The same name.

    Raises:
        Mistake: UTF-8 has no bytes for it: it came from bytes that are no UTF-8.
    """
    try:
        name.encode()
    except UnicodeEncodeError:
        raise Mistake(f"{name!a}: got a name that is not UTF-8; expected one that can be printed.") from None
    return name


SHOWN = 60
"""Letters of a value or a name that an error shows at most."""


def shown(text: str, most: int = SHOWN) -> str:
    """A value or a name as an error shows it: in one line, and cut."""
    text = " ".join(text[: 10 * most].split())
    return text if len(text) <= most else f"{text[:most]}..."


def counted(count: int, noun: str) -> str:
    """So many of something, in words: `1 task`, `2 tasks`."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


def near(name: str, names: Iterable[str]) -> str:
    """The name that is most like the given one, in upper or lower case; empty if none is."""
    folded = {each.casefold(): each for each in names}
    return next((folded[each] for each in get_close_matches(name.casefold(), folded, n=1)), "")


def one_of(names: Iterable[str]) -> str:
    """What is expected where one of some names is."""
    return f"one of {', '.join(map(shown, names))}"


def meant(name: str) -> str:
    """The end of a text that proposes a name; empty without one."""
    return f" Did you mean {shown(name)}?" if name else ""


def unknown(place: str, got: str, names: Iterable[str], also: Iterable[str] = ()) -> Mistake:
    """Something got none of the names that it could have; it may have meant one of those `also`."""
    names = list(names)
    return Mistake(f"{place}: got {got}; expected {one_of(names)}.{meant(near(got, [*names, *also]))}")
