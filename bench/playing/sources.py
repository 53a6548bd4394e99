"""What one file counts by: its contents, of a source without comments and docstrings; and its import statements."""

import ast
import re
import warnings
from collections.abc import Iterable, Iterator
from functools import cache
from hashlib import sha256
from importlib.util import decode_source
from pathlib import Path
from typing import NamedTuple

from fogbench.worlds import files

PARTS = re.compile(
    r"""
    ((?: [^"'\#\s]+ | [ \t\f]+(?=[^\#\s])
       | \"{3}(?:\\.|[^\\])*?\"{3} | '{3}(?:\\.|[^\\])*?'{3} | "(?:\\.|[^\\"\n])*" | '(?:\\.|[^\\'\n])*'
    )+)
    | [ \t\f]*(?:\#[^\n]*)? (?:\n[ \t\f]*(?:\#[^\n]*)?)* (?=\n|\Z)
    """,
    re.DOTALL | re.VERBOSE,
)
"""Code with the texts in it, which is the only group; or comments, blank lines and blanks at the end of a line."""


class Import(NamedTuple):
    """One import statement of one module."""

    module: str
    """As the statement names it; empty in `from . import name`."""
    level: int
    """How many dots stand before it."""
    names: dict[str, str]
    """What is taken from it, by the name it then has; none where the module itself is imported."""


class Source(NamedTuple):
    """One file."""

    digest: str
    """Of its contents, as 64 hexadecimal digits; the same under every version of Python that can read it."""
    imports: tuple[Import, ...]


_STAMPS: dict[Path, tuple[int, ...]] = {}
"""Of each file that was read: what tells that it may have been written since."""


@cache
def read_source(path: Path) -> Source:
    """Read a file, once in a process; one that is no Python, or not for this version, counts by its bytes.

    Raises:
        OSError: it cannot be read.
    """
    _STAMPS[path] = _stamp(path)
    return _read(path)


def edited() -> list[Path]:
    """The files that this process has read, and that count as others now."""
    return [path for path, stamp in _STAMPS.items() if _stamp(path) != stamp and not _counts_as_before(path)]


def _stamp(path: Path) -> tuple[int, ...]:
    try:
        found = path.stat()
    except OSError:
        return ()
    return found.st_mtime_ns, found.st_size, found.st_ino


def _counts_as_before(path: Path) -> bool:
    try:
        return _read(path).digest == read_source(path).digest
    except OSError:
        return False


def _read(path: Path) -> Source:
    contents = files.contents(path)
    try:
        if path.suffix not in (".py", ".pyi"):
            return Source(sha256(contents).hexdigest(), ())
        code = PARTS.sub(r"\1", decode_source(contents)).strip("\n")
        tree = _parsed(code)
    except (SyntaxError, ValueError):
        return Source(sha256(contents).hexdigest(), ())
    return Source(sha256(_without_docstrings(code, tree)).hexdigest(), tuple(_imports(tree.body)))


def _parsed(code: str) -> ast.Module:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # whoever runs the file is warned
        return ast.parse(code)


def _without_docstrings(code: str, tree: ast.Module) -> bytes:
    """The code without statements that are text alone: docstrings of modules, classes, functions and attributes."""
    lines = code.encode().split(b"\n")
    texts = [node for node in _statements(tree.body) if isinstance(node, ast.Expr) and _is_text(node.value)]
    for node in reversed(texts):
        first, last = node.lineno - 1, (node.end_lineno or node.lineno) - 1
        rest = lines[first][: node.col_offset] + lines[last][node.end_col_offset :]
        lines[first : last + 1] = [rest] if rest.strip() else []
    return b"\n".join(lines)


def _is_text(node: ast.expr) -> bool:
    return isinstance(node, ast.Constant) and isinstance(node.value, str)


def _statements(nodes: Iterable[ast.AST]) -> Iterator[ast.AST]:
    """Statements and all that are inside of them, in the order of the file."""
    for node in nodes:
        yield node
        yield from _statements(_inside(node))


def _inside(node: ast.AST) -> list[ast.AST]:
    """The statements of a compound statement; of an `except` or a `case` too."""
    return [inner for part in ("body", "handlers", "orelse", "finalbody", "cases") for inner in getattr(node, part, ())]


def _imports(nodes: Iterable[ast.AST]) -> Iterator[Import]:
    """The imports among statements, those in functions too; not those that only a type checker sees."""
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (Import(alias.name, 0, {}) for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            names = {alias.asname or alias.name: alias.name for alias in node.names}
            yield Import(node.module or "", node.level, names)
        elif isinstance(node, ast.If) and _never(node.test):
            yield from _imports(node.orelse)
        else:
            yield from _imports(_inside(node))


def _never(test: ast.expr) -> bool:
    """Whether a condition is `TYPE_CHECKING`, or that of a module."""
    return "TYPE_CHECKING" in (getattr(test, "id", ""), getattr(test, "attr", ""))
