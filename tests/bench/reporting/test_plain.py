"""Texts of a user, as they are written to terminals, pages and files."""

import re

import pytest

from fogbench.bench.reporting.plain import escaped, folded, plain, printable, stems


@pytest.mark.parametrize(
    ("text", "seen"),
    [
        ("A* ([red]µ — :smile:[/])", "A* ([red]µ — :smile:[/])"),
        ("a\nb\tc\u2028d", "a b c d"),
        ("\x1b[31mred\x00\x07", "\\x1b[31mred\\x00\\x07"),
        ("\u202eevil\ud800", "\\u202eevil\\ud800"),
        ("e\u0301 \U0001f469\u200d\U0001f680", "e\u0301 \U0001f469\u200d\U0001f680"),
    ],
)
def test_what_steers_a_terminal_is_seen(text: str, seen: str) -> None:
    """Controls and marks of direction are escapes, white space is a blank; all else stays."""
    assert plain(text) == seen
    assert plain(text).encode()


def test_lines_stay_lines() -> None:
    """Each of them is plain."""
    assert printable("a\tb\n\x1b\n") == "a b\n\\x1b\n"


@pytest.mark.parametrize(
    ("text", "page"),
    [
        ("random_walk, A* [94.9, 97.3], <0.001, -0.3, a & b", "random_walk, A* [94.9, 97.3], <0.001, -0.3, a & b"),
        ("*a* _b_ __init__ `c` ~d~ $e$ f|g", "\\*a* \\_b_ \\_\\_init__ \\`c\\` \\~d~ \\$e$ f\\|g"),
        ("<b>x</b> <!-- &amp; [a](b) [a]: b", "\\<b>x\\</b> \\<!-- \\&amp; [a\\](b) [a\\]: b"),
        ("# a", "\\# a"), ("- a", "\\- a"), ("> a", "\\> a"), ("1. a", "1\\. a"), ("a\\b", "a\\\\b"), ("---", "\\---"),
    ],
)  # fmt: skip
def test_a_page_shows_the_text(text: str, page: str) -> None:
    """A backslash stands where Markdown would begin to read more than characters, and nowhere else."""
    assert escaped(text) == page
    assert re.sub(r"\\([^a-zA-Z0-9\s])", r"\1", page) == text


def test_a_plot_gets_few_short_lines() -> None:
    """However long a text is, and whether or not it has blanks."""
    assert folded("16x16 dense", 20) == "16x16 dense"
    assert folded("x" * 200, 40, 2) == "x" * 40 + "\n" + "x" * 39 + "…"


def test_no_two_labels_have_one_file() -> None:
    """Words of a label name its file; where two have the same, the later has a number."""
    labels = ["no memory", "no-memory", "MACN (LSTM)", "???", "", "x" * 300]
    names = ["no-memory", "no-memory-2", "MACN-LSTM", "unnamed", "unnamed-2", "x" * 50]
    assert stems(labels) == dict(zip(labels, names, strict=True))
