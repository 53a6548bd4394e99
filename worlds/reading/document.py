"""From the text of a YAML file to its values: composed by PyYAML, resolved by nobody."""

import os
import re
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import yaml

from fogbench.worlds.mistake import SHOWN, shown
from fogbench.worlds.reading.positions import Fault, Spot, Value, join

VARIABLE = re.compile(r"\$\{(\w+)\}")
"""`${NAME}`: the environment variable of that name."""

PRINTABLE = "text without control characters and lone surrogates"

DEEPEST, MOST = 100, 100_000
"""Levels of a file, and values in it with those that its aliases repeat."""

UNWRITABLE = re.compile("[\x00-\x08\x0b-\x1f\x7f\ud800-\udfff]")
"""Characters that no name, path or table can have: control characters, and halves of pairs."""

PLAIN = "null", "bool", "int", "float", "str", "seq", "map", "timestamp", "merge", "value"

TAGS = {f"tag:yaml.org,2002:{name}" for name in PLAIN}
"""What PyYAML makes of values without a tag, or with a plain one."""

TOO_DEEP, TOO_MANY = f"nested more than {DEEPEST} deep", f"more than {MOST:,} values, aliases counted"


def parse(text: str, faults: list[Fault]) -> Value | None:
    """The mapping that a file is; None where it is none. What is wrong with it is added to `faults`."""
    page = _read(text, faults)
    if page is None or isinstance(page.content, dict):
        return page
    faults.append(page.wrong("a mapping"))
    return None


def _read(text: str, faults: list[Fault]) -> Value | None:
    try:
        node = yaml.compose(text, _Loader)
        if node is not None:
            return _Document(text, faults).value(node, "", None, ())
        faults.append(Fault(1, 1, "", "an empty file", "a mapping"))
    except yaml.MarkedYAMLError as error:
        problem = (error.problem or "").removeprefix("but ")
        faults.append(_broken(_spot(error.problem_mark), problem))
    except yaml.reader.ReaderError as error:
        before = text[: error.position].split("\n")
        faults.append(_broken(Spot(len(before), len(before[-1]) + 1), f"{error.reason}: {chr(error.character)!r}"))
    except (ValueError, OverflowError) as error:  # a number in an escape or a directive is out of range
        faults.append(_broken(Spot(1, 1), str(error)))
    return None


def _broken(spot: Spot, problem: str) -> Fault:
    return Fault(*spot, "", f"broken YAML ({shown(problem, 3 * SHOWN)})", "one YAML document")


def _spot(mark: yaml.Mark | None) -> Spot:
    return Spot(mark.line + 1, mark.column + 1) if mark else Spot(1, 1)


class _Loader(yaml.SafeLoader):
    """Stops where a file is nested too deep, before Python does."""

    depth = 0

    def compose_node(self, parent: yaml.Node | None, index: Any) -> yaml.Node | None:
        """The next node with all below it."""
        if self.depth > DEEPEST:
            event = self.peek_event()  # type: ignore[no-untyped-call]  # PyYAML's
            raise yaml.MarkedYAMLError(problem=TOO_DEEP, problem_mark=event.start_mark)
        self.depth += 1
        node = super().compose_node(parent, index)
        self.depth -= 1
        return node


class _Document:
    """The text of a file, and what is wrong with it."""

    def __init__(self, text: str, faults: list[Fault]) -> None:
        self.text = text
        self.faults = faults
        self.values = 0

    def value(self, node: yaml.Node, path: str, key: Spot | None, above: tuple[yaml.Node, ...]) -> Value:
        """A node with all below it; an aliased node is a value of its own wherever it is used."""
        self.values += 1
        if len(above) > DEEPEST or self.values > MOST:
            problem = TOO_DEEP if len(above) > DEEPEST else TOO_MANY
            raise yaml.MarkedYAMLError(problem=problem, problem_mark=node.start_mark)
        spot = _spot(node.start_mark)
        value = Value(None, path, spot, key or spot, self._written(node))
        if node in above:
            self.faults.append(value.wrong("an alias of something that does not hold the alias"))
            return value
        if node.tag not in TAGS:
            self.faults.append(value.wrong("a value without a tag"))
        if isinstance(node, yaml.ScalarNode):
            return self._scalar(node, value)
        above = (*above, node)
        if isinstance(node, yaml.MappingNode):
            return replace(value, content=dict(self._items(node, value, above)))
        items = [self.value(item, f"{path}[{number}]", None, above) for number, item in enumerate(node.value)]
        return replace(value, content=items)

    def _items(
        self, node: yaml.MappingNode, mapping: Value, above: tuple[yaml.Node, ...]
    ) -> Iterator[tuple[str, Value]]:
        lines: dict[str, int] = {}
        for key_node, node_ in node.value:
            spot, key = _spot(key_node.start_mark), self._written(key_node)
            if not isinstance(key_node, yaml.ScalarNode):
                self.faults.append(Fault(*spot, mapping.path, key, "a key that is text"))
            elif UNWRITABLE.search(key_node.value):
                self.faults.append(Fault(*spot, mapping.path, key, PRINTABLE))
            elif key == "<<":
                self.faults.append(Fault(*spot, mapping.path, "<<", "keys written out; merge keys are not read"))
            elif key_node.value in lines:
                first = f"each key once (it is first on line {lines[key_node.value]})"
                self.faults.append(Fault(*spot, mapping.path, f"{key} again", first))
            else:
                lines[key_node.value] = spot.line
                yield key_node.value, self.value(node_, join(mapping.path, key_node.value), spot, above)

    def _written(self, node: yaml.Node) -> str:
        start = node.start_mark.index
        text = self.text[start : min(node.end_mark.index, start + 10 * SHOWN)].strip()
        if "\n" in text and not isinstance(node, yaml.ScalarNode):
            return "a mapping" if isinstance(node, yaml.MappingNode) else "a list"
        return shown(text)

    def _scalar(self, node: yaml.ScalarNode, value: Value) -> Value:
        """The text of a node, in which an empty variable is none; a plain `null`, `~` or nothing at all is None."""
        if node.style is None and node.tag == "tag:yaml.org,2002:null":
            return value
        variables = tuple(VARIABLE.findall(node.value))
        text = VARIABLE.sub(lambda found: os.environ.get(found[1]) or found[0], node.value)
        unset = next((name for name in variables if not os.environ.get(name)), "")
        if UNWRITABLE.search(text):
            self.faults.append(value.wrong(PRINTABLE))
            text = UNWRITABLE.sub("?", text)
        return replace(value, content=text, variables=variables, unset=unset)
