"""The values of a YAML file as text, each with the place where it is written.

Nothing is read into a number or a truth value here: `1e-3`, `no` and `010` stay the text they are, until the type of
the field that they are for reads them.
"""

from collections.abc import Iterable, Iterator
from dataclasses import dataclass, replace
from typing import NamedTuple

from fogbench.worlds.mistake import meant, shown


class Fault(NamedTuple):
    """One mistake of a file; faults sort by their place."""

    line: int
    """From 1, as `column`."""
    column: int
    path: str
    """What it is about, for example `maps.blobs.size`; empty for the whole file."""
    got: str
    """As it is written; empty: nothing stands there."""
    expected: str
    near: str = ""
    """The valid name that is most like what was got."""
    base: "Fault | None" = None
    """The same about the mapping that a variant was merged over; what all variants lack is told there, once."""

    def text(self, file: str) -> str:
        """`file:line:column  path: got X; expected Y. Did you mean Z?`, or `missing; give Y`, in one line."""
        path = f"{self.path}: " if self.path else ""
        told = f"got {self.got}; expected" if self.got else "missing; give"
        return f"{file}:{self.line}:{self.column}  {path}{told} {self.expected}.{meant(self.near)}"


def told(faults: Iterable[Fault], file: str) -> list[str]:
    """All that is wrong with a file, in order and once."""
    ordered = sorted(faults, key=lambda fault: (fault.line, fault.column))
    return list(dict.fromkeys(fault.text(file) for fault in ordered))


class Spot(NamedTuple):
    """A place in a file, from 1."""

    line: int
    column: int


@dataclass(frozen=True, slots=True)
class Value:
    """A value of a file."""

    content: "str | list[Value] | dict[str, Value] | None"
    """Text has its environment variables filled in, as far as they are set."""
    path: str
    spot: Spot
    key: Spot
    """Where the key stands that it is the value of; elsewhere its own spot."""
    written: str
    """As in the file, in one line."""
    variables: tuple[str, ...] = ()
    """Environment variables in the text."""
    unset: str = ""
    """One of them that is not set."""
    base: "Value | None" = None
    """The mapping that this one was merged over."""

    def child(self, part: str | int) -> "Value | None":
        """The value of a key, or the item of that number; None where there is none."""
        if isinstance(self.content, dict) and isinstance(part, str):
            return self.content.get(part)
        if isinstance(self.content, list) and isinstance(part, int) and part < len(self.content):
            return self.content[part]
        return None

    def fields(self) -> dict[str, "Value"]:
        """The content of a mapping; of anything else, nothing."""
        return self.content if isinstance(self.content, dict) else {}

    def below(self) -> Iterator["Value"]:
        """The value itself and every value in it."""
        yield self
        for child in self.content if isinstance(self.content, list) else self.fields().values():
            yield from child.below()

    def wrong(self, expected: str, near: str = "") -> Fault:
        """It should be something else."""
        return Fault(*self.spot, self.path, self.written, expected, near)

    def wrong_key(self, key: str, expected: str, near: str = "") -> Fault:
        """One of its keys should be something else; it may stand in the mapping that this one was merged over."""
        child, own = self.fields()[key], shown(key)
        return Fault(*child.key, child.path.removesuffix(own).removesuffix("."), own, expected, near)

    def lacks(self, key: str, expected: str) -> Fault:
        """A key is missing."""
        base = self.base.lacks(key, expected) if self.base else None
        return Fault(*self.spot, join(self.path, key), "", expected, base=base)


def join(path: str, key: str) -> str:
    """The path of a key of the mapping at `path`."""
    return f"{path}.{shown(key)}" if path else shown(key)


def merge(base: Value, over: Value) -> Value:
    """`over` laid over `base`: mappings merge key by key, everything else replaces."""
    if not (isinstance(base.content, dict) and isinstance(over.content, dict)):
        return over
    merged = {
        key: merge(base.content[key], child) if key in base.content else child for key, child in over.fields().items()
    }
    return replace(over, content=base.content | merged, base=base.base or base)
