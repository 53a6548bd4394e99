"""Texts of a user as they are: nothing in them steers a terminal or a page, and none takes the file of another."""

import re
from collections.abc import Iterable
from textwrap import wrap

JOINERS = "\u200c\u200d"
"""They join letters and emoji, and are seen by that alone."""

MARKUP = re.compile(
    r"[\\`|#]"
    r"|[*~$](?=\S)"
    r"|(?<![^\W_])_(?=\S)"  # within a word it is a letter
    r"|<(?=[a-zA-Z/!?])"
    r"|&(?=#?\w+;)"
    r"|\](?=[(:\[])"
    r"|\A(?:>|[-+](?=[-\s]))"
)
"""What Markdown could read as more than a character."""

LONGEST = 50
"""Characters of a label in the name of a file; of four bytes each, a file system takes twice as many."""


def plain(text: str) -> str:
    """The text in one line, with escapes in place of characters that are not seen but do something."""
    line = re.sub(r"\s", " ", text)
    return "".join(c if c.isprintable() or c in JOINERS else c.encode("unicode_escape").decode() for c in line)


def printable(text: str) -> str:
    """The same for lines of text."""
    return "\n".join(map(plain, text.split("\n")))


def escaped(text: str) -> str:
    """The text in one line of Markdown."""
    return re.sub(r"\A(\d+)([.)]\s)", r"\1\\\2", MARKUP.sub(r"\\\g<0>", plain(text)))


def folded(text: str, width: int, lines: int = 4) -> str:
    """The text in a few lines of some width, for a plot; `…` stands for the rest."""
    found = wrap(plain(text), width)
    cut = [f"{found[lines - 1][: width - 1]}…"] if len(found) > lines else []
    return "\n".join([*found[: lines - len(cut)], *cut])


def stems(labels: Iterable[str]) -> dict[str, str]:
    """By label, its words for the name of a file: no two alike, none empty, none too long."""
    found: dict[str, str] = {}
    for label in dict.fromkeys(labels):
        stem = words = "-".join(re.findall(r"\w+", label))[:LONGEST] or "unnamed"
        taken, number = set(found.values()), 1
        while stem in taken:
            number += 1
            stem = f"{words}-{number}"
        found[label] = stem
    return found
