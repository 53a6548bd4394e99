"""The JSON Schema of scenario files, as an editor uses it."""

from pathlib import Path
from typing import Any

import pytest
import yaml

from fogbench.bench.reading.schema import schema
from fogbench.bench.shipped import find
from fogbench.learned import LEARNED
from fogbench.planners import PLANNERS
from fogbench.worlds import FAMILIES

SCHEMA = schema()

TYPES = {
    "object": (dict,),
    "array": (list,),
    "string": (str,),
    "boolean": (bool,),
    "integer": (int,),
    "number": (int, float),
    "null": (type(None),),
}


def accepts(value: Any, shape: dict[str, Any]) -> bool:
    """Whether a value fits a schema: the few words of JSON Schema that are used here, and no others."""
    if "$ref" in shape:
        return accepts(value, SCHEMA["$defs"][shape["$ref"].removeprefix("#/$defs/")])
    options = shape.get("anyOf") or shape.get("oneOf")
    if options:
        return any(accepts(value, option) for option in options)
    types = [name for name, kind in TYPES.items() if type(value) in kind]
    return (
        ("type" not in shape or any(name in shape["type"] for name in types))
        and ("enum" not in shape or value in shape["enum"])
        and (not isinstance(value, str) or shape.get("pattern", "") in value)
        and (not isinstance(value, int | float) or shape.get("minimum", value) <= value <= shape.get("maximum", value))
        and (not isinstance(value, list) or accepts_list(value, shape))
        and (not isinstance(value, dict) or accepts_mapping(value, shape))
    )


def accepts_list(value: list[Any], shape: dict[str, Any]) -> bool:
    """Whether the items of a list fit."""
    prefix = shape.get("prefixItems", [])
    items = [*prefix, *[shape.get("items", {})] * (len(value) - len(prefix))]
    return len(value) >= shape.get("minItems", 0) and all(map(accepts, value, items))


def accepts_mapping(value: dict[str, Any], shape: dict[str, Any]) -> bool:
    """Whether the keys and values of a mapping fit."""
    known, rest = shape.get("properties", {}), shape.get("additionalProperties", True)
    if len(value) > shape.get("maxProperties", len(value)) or not set(shape.get("required", ())) <= set(value):
        return False
    others = [child for key, child in value.items() if key not in known]
    fit = rest is True or not others or (rest is not False and all(accepts(child, rest) for child in others))
    return fit and all(accepts(value[key], known[key]) for key in value.keys() & known.keys())


@pytest.mark.parametrize("path", find(None), ids=lambda path: path.stem)
def test_the_shipped_scenarios_fit(path: Path) -> None:
    """An editor underlines nothing in them."""
    page = yaml.safe_load(path.read_text("utf-8"))
    page["variants"] = {str(name): variant for name, variant in page.get("variants", {}).items()}
    assert accepts(page, SCHEMA)


@pytest.mark.parametrize(
    "text",
    [
        "{}",
        "{name: a, sensr: {radius: 3}}",
        "{name: a, sensor: {radius: 0}}",
        "{name: a, sensor: {radios: 3}}",
        "{name: a, maps: {blobs: {size: 16}, maze: {size: 9}}}",
        "{name: a, maps: {blobs: {size: big}}}",
        "{name: a, agents: [aster]}",
        "{name: a, agents: [astar: {replan: never}]}",
        "{name: a, variants: {b: {name: c}}}",
        "{name: a, variants: {b: {rules: {slip: 2}}}}",
    ],
)
def test_what_is_wrong_does_not_fit(text: str) -> None:
    """Unknown keys, two map families, values out of bounds, in the rest and in a variant."""
    assert not accepts(yaml.safe_load(text), SCHEMA)


@pytest.mark.parametrize(
    "text",
    [
        "{name: a}",
        "{name: a, maps: {'./mine.py:Mine': {any: thing}}}",
        "{name: a, agents: ['./mine.py:Mine', {'./mine.py:Mine': {any: thing}}, {astar: {label: b}}, {astar: null}]}",
        "{name: a, budget: {steps: {per_distance: 2}}, variants: {b: null, c: {budget: {memory_bytes: 9}}}}",
    ],
)
def test_parts_and_plug_ins_of_users_fit(text: str) -> None:
    """What is missing may be in a variant; what a class of a user reads is not known."""
    assert accepts(yaml.safe_load(text), SCHEMA)


def test_every_plug_in_has_its_settings_with_defaults_and_words() -> None:
    """As its class says them; the label is one key more."""
    assert set(SCHEMA["$defs"]["Maps"]["properties"]) == set(FAMILIES)
    assert set(SCHEMA["$defs"]["Agent"]["properties"]) <= {*PLANNERS, *LEARNED}
    replan = SCHEMA["$defs"]["AStar"]["properties"]["replan"]
    assert (replan["default"], replan["enum"]) == ("cut", ["cut", "change"])
    assert replan["description"].startswith("Plan again when the path is cut")
    assert SCHEMA["$defs"]["AStar"]["description"].startswith("Plans on the known map")
    assert "label" in SCHEMA["$defs"]["AStar"]["properties"]
    assert SCHEMA["properties"]["episodes"]["minimum"] == 1


def test_it_names_its_draft_and_every_reference_leads_somewhere() -> None:
    """Otherwise an editor would refuse it."""

    def references(shape: Any) -> list[str]:
        children = shape.values() if isinstance(shape, dict) else shape if isinstance(shape, list) else ()
        own = [shape["$ref"]] if isinstance(shape, dict) and "$ref" in shape else []
        return own + [found for child in children for found in references(child)]

    assert SCHEMA["$schema"] == "https://json-schema.org/draft/2020-12/schema"
    assert {name.removeprefix("#/$defs/") for name in references(SCHEMA)} == set(SCHEMA["$defs"])
