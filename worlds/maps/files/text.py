"""Lines and words of a text file, as other projects write them."""

import re

WHOLE = re.compile("[0-9]{1,9}")
"""A whole number."""

SHOWN = 40
"""Characters of a text that a mistake shows at most."""


def lines_of(contents: bytes) -> list[str]:
    """The lines of a file with any line ends; those at its end that are blank are left out."""
    text = contents.decode("utf-8-sig", "replace").replace("\r\n", "\n").replace("\r", "\n")
    return text.rstrip().split("\n")


def quoted(text: str) -> str:
    """A text in an error; empty where there is none."""
    text = text.strip()
    return repr(text[:SHOWN]) + ("..." if len(text) > SHOWN else "") if text else ""
