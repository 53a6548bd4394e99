"""The JSON Schema of scenario files, with which editors complete and check them."""

from collections.abc import Mapping
from functools import reduce
from operator import or_
from types import GenericAlias
from typing import Annotated, Any, Literal, cast

from pydantic import BaseModel, ConfigDict, Field, create_model

from fogbench.bench.reading.page import VARIED, Page, blocks
from fogbench.bench.reading.plugins import PluginError, load, load_conditions, load_kind
from fogbench.bench.reading.tables import AGENT, FAMILY, KIND, Table
from fogbench.worlds.mistake import Unavailable
from fogbench.worlds.reading.shapes import Lenient, Schema
from fogbench.worlds.settings import Settings

DRAFT = "https://json-schema.org/draft/2020-12/schema"

LABEL = Field(default="", description="The agent's name in tables; by default the name it is listed with.")


def schema() -> Schema:
    """The schema of a file, with the settings of all plug-ins that are installed here.

    Only `name` is required: what else a file needs may be spread over its variants.
    """
    known, read = Page.model_fields, _blocks()
    fields: dict[str, Any] = {key: (field.annotation, field) for key, field in known.items()} | read
    kinds: Any = Literal.__getitem__(tuple(KIND.targets()))
    fields["kind"] = (kinds | None, known["kind"])
    fields["maps"] = (_one_of_many("Maps", _classes(FAMILY)), known["maps"])
    fields["agents"] = (_agents(), known["agents"])
    varied = (*VARIED, *read)
    variant = _model("Variant", {key: field for key, field in fields.items() if key in varied}, Settings)
    fields["variants"] = (GenericAlias(dict, (str, variant | None)), known["variants"])
    page = _model("Scenario", fields, Page).model_json_schema(schema_generator=Lenient)
    return {"$schema": DRAFT, **_relax(page), "required": ["name"]}


def _agents() -> Any:
    """A list of names, of classes by their place, and of names with settings."""
    found = _classes(AGENT)
    labelled = {name: _model(agent.__name__, {"label": (str, LABEL)}, agent) for name, agent in found.items()}
    names: Any = Literal.__getitem__(tuple(AGENT.targets()))
    return GenericAlias(list, (names | Annotated[str, Field(pattern=":")] | _one_of_many("Agent", labelled),))


def _blocks() -> dict[str, Any]:
    """Each block as any kind of world reads it."""
    kinds = list(_classes(KIND).values())
    names = dict.fromkeys(block for kind in kinds for block in blocks(kind))
    fields = [kind.model_fields for kind in kinds]
    return {
        name: (reduce(or_, [cast(Any, each[name].annotation) for each in fields if name in each]), ...)
        for name in names
    }


def _one_of_many(title: str, classes: Mapping[str, type[BaseModel]]) -> Any:
    """A mapping with one key: a name, or a class by its place."""
    config = ConfigDict(extra="allow", json_schema_extra={"minProperties": 1, "maxProperties": 1})
    fields: Any = {name: (settings | None, None) for name, settings in classes.items()}
    return create_model(title, __config__=config, **fields)


def _classes(table: Table) -> dict[str, type[Settings]]:
    """The classes that can be imported here."""
    found: dict[str, type[Settings]] = {}
    for name, target in table.targets().items():
        try:
            found[name] = load_conditions(name, load_kind(name)) if table is KIND else load(table, name, target)
        except (PluginError, Unavailable):
            continue
    return found


def _model(title: str, fields: dict[str, Any], parent: type[BaseModel]) -> Any:
    return create_model(title, __base__=parent, __doc__=parent.__doc__, **fields)


def _relax(schema: Any) -> Any:
    """The schema without its lists of required keys."""
    if isinstance(schema, list):
        return [_relax(item) for item in schema]
    if not isinstance(schema, dict):
        return schema
    return {key: _relax(value) for key, value in schema.items() if not (key == "required" and isinstance(value, list))}
