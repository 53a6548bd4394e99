"""What a source file counts by, and what it imports."""

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from fogbench.bench.playing.sources import Import, edited, read_source

Digest = Callable[..., str]

PLAIN = '''\
import math
from typing import TYPE_CHECKING


class Wall:
    height: int = 2

    def see(self, x):
        if x > 1:
            return f"{x} # no comment {'a'}"
        return """text  
# no comment

""" + 'it''s'
'''  # noqa: W291  a blank at the end of a line of a text

TOLD = '''\
#!/usr/bin/env python
# -*- coding: utf-8 -*-
"""A module's own words: "quoted", it's # no code."""

import math  # for the floor
from typing import TYPE_CHECKING

# A comment "with a quote.


class Wall:
    """A class's."""

    height: int = 2
    """An attribute's,
    on two lines."""

    def see(self, x):
        """A function's."""  # and a comment
        # another

        if x > 1:   
            return f"{x} # no comment {'a'}"
        return """text  
# no comment

""" + 'it''s'  # it's

# the end
'''  # noqa: W291


@pytest.fixture
def digest(tmp_path: Path) -> Digest:
    """Gives the digest of a text in a file of its own."""

    def digest(text: str | bytes, name: str = "a.py") -> str:
        folder = tmp_path / str(len(list(tmp_path.iterdir())))
        folder.mkdir()
        (folder / name).write_bytes(text.encode() if isinstance(text, str) else text)
        return read_source(folder / name).digest

    return digest


def test_comments_and_docstrings_do_not_count(digest: Digest) -> None:
    """Nor do blank lines, blanks at the end of a line, and how lines end; a moved file is the same."""
    assert digest(PLAIN) == digest(TOLD) == digest(PLAIN.replace("\n", "\r\n"), "b.py")


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("height: int = 2", "height: int = 3"),
        ("# no comment {", "# a comment {"),
        ("text  \n", "text\n"),
        ("# no comment\n", "# a comment\n"),
        ('\n\n""" +', '\n""" +'),
        ("'it''s'", "'it' 's'"),
        ("x > 1", "x > 2"),
        ("            return", "          return"),
        ("import math", "import maths"),
    ],
)
def test_whatever_runs_counts(digest: Digest, old: str, new: str) -> None:
    """Each character of the code, and of a text that is used, whatever it looks like."""
    assert PLAIN.count(old)
    assert digest(PLAIN) != digest(PLAIN.replace(old, new, 1))


def test_what_is_no_python_counts_by_its_bytes(digest: Digest) -> None:
    """A compiled module, a file that cannot be parsed, one that cannot be decoded."""
    for text, other in ((b"\x7fELF\0# a", b"\x7fELF\0# b"), (b"x = = # a", b"x = = # b"), (b"\xff # a", b"\xff # b")):
        for name in ("a.py", "a.so"):
            assert digest(text, name) == digest(text, name) != digest(other, name)
    assert digest("x = 1 # a", "a.so") != digest("x = 1 # b", "a.so")


def test_imports_are_found_wherever_they_stand(tmp_path: Path) -> None:
    """In functions, classes, branches and handlers; not where only a type checker looks."""
    (tmp_path / "a.py").write_text(
        "import a.b as c, d\n"
        "from typing import TYPE_CHECKING\n"
        "import typing as t\n"
        "if TYPE_CHECKING:\n    import never\nelse:\n    import otherwise\n"
        "if t.TYPE_CHECKING:\n    from . import never\n"
        "try:\n    from . import e\nexcept ImportError:\n    from ..f import g as h\nelse:\n    import i\n"
        "class A:\n    def b(self):\n        with x:\n            from j import *\n"
        "match x:\n    case 1:\n        import k\n"
    )
    assert read_source(tmp_path / "a.py").imports == (
        Import("a.b", 0, {}),
        Import("d", 0, {}),
        Import("typing", 0, {"TYPE_CHECKING": "TYPE_CHECKING"}),
        Import("typing", 0, {}),
        Import("otherwise", 0, {}),
        Import("", 1, {"e": "e"}),
        Import("f", 2, {"h": "g"}),
        Import("i", 0, {}),
        Import("j", 0, {"*": "*"}),
        Import("k", 0, {}),
    )


def test_a_file_of_a_careless_author_is_read_in_silence(tmp_path: Path) -> None:
    """What Python warns of in a source is told to whoever runs it."""
    (tmp_path / "a.py").write_text("x = '\\d'\nassert (x, 'always')\n")
    assert read_source(tmp_path / "a.py").imports == ()


def test_an_edit_is_found(tmp_path: Path) -> None:
    """Of a file that was read: other code, other bytes, or no file any more; not a touch, nor a comment."""
    code, data, kept = (tmp_path / name for name in ("code.py", "data.bin", "kept.py"))
    for file in (code, data, kept):
        file.write_text("1\n")
        read_source(file)
    mine = {code, data, kept}
    assert not mine & {*edited()}
    kept.write_text("1  # more\n")
    os.utime(data, (0, 0))
    assert not mine & {*edited()}
    code.write_text("2\n")
    assert mine & {*edited()} == {code}
    data.unlink()
    assert mine & {*edited()} == {code, data}
