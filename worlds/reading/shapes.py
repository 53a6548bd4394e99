"""What may stand at a place in a file, in plain words: the JSON Schema of a settings class, walked key by key."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cache
from typing import Any

from pydantic.json_schema import GenerateJsonSchema, JsonSchemaValue
from pydantic_core.core_schema import CoreSchema

from fogbench.worlds.settings import Settings

Schema = dict[str, Any]
"""A JSON Schema."""

NOUNS = {
    "boolean": ("true or false", "truth values"),
    "integer": ("a whole number", "whole numbers"),
    "number": ("a number", "numbers"),
    "string": ("text", "texts"),
    "array": ("a list", "lists"),
    "object": ("a mapping", "mappings"),
    "null": ("nothing", "nothings"),
}
"""A type of JSON: one of them, several of them."""

COUNTS = ("no", "one", "two", "three", "four", "five", "six")


@dataclass(frozen=True, slots=True)
class Shape:
    """The alternatives for one place; none where anything may stand."""

    options: tuple[Schema, ...]
    definitions: Schema

    def at(self, part: str | int) -> "Shape":
        """What may stand at a key, or at the item of that number."""
        return _shape([child for option in self.options if (child := _child(option, part))], self.definitions)

    def keys(self) -> list[str]:
        """The keys that a mapping may have here."""
        return [key for option in self.options for key in option.get("properties", {})]

    def choices(self) -> dict[str, Any]:
        """What may be chosen from here, by the text it has in a file; a truth value is a choice of two."""
        found = [choice for option in self.options for choice in _choices(option)]
        return {str(choice).lower() if isinstance(choice, bool) else str(choice): choice for choice in found}

    def is_a(self, name: str) -> bool:
        """Whether only that type or format of JSON may stand here, or nothing."""
        kinds = [option.get("format", option.get("type")) for option in self.options]
        return name in kinds and set(kinds) <= {name, "null"}

    def words(self) -> str:
        """All that may stand here; empty where that cannot be said."""
        return " or ".join(dict.fromkeys(words for option in self.options if (words := _words(option))))


@cache
def shape(settings: type[Settings]) -> Shape:
    """The shape of a settings class."""
    schema = settings.model_json_schema(schema_generator=Lenient)
    return _shape([schema], schema.get("$defs", {}))


class Lenient(GenerateJsonSchema):
    """JSON Schema in which a type that JSON does not know may be anything."""

    def handle_invalid_for_json_schema(self, schema: CoreSchema, error_info: str) -> JsonSchemaValue:
        """Anything."""
        del schema, error_info
        return {}


def _shape(schemas: list[Schema], definitions: Schema) -> Shape:
    return Shape(tuple(option for schema in schemas for option in _options(schema, definitions)), definitions)


def _options(schema: Schema, definitions: Schema) -> Iterator[Schema]:
    inner = [schema[word] for word in ("anyOf", "oneOf", "allOf") if word in schema]
    if "$ref" in schema:
        yield from _options(definitions[schema["$ref"].rpartition("/")[2]], definitions)
    elif inner:
        for option in inner[0]:
            yield from _options(option, definitions)
    else:
        yield schema


def _child(schema: Schema, part: str | int) -> Schema | None:
    prefix = schema.get("prefixItems", [])
    if isinstance(part, str):
        child = schema.get("properties", {}).get(part, schema.get("additionalProperties"))
    else:
        child = prefix[part] if part < len(prefix) else schema.get("items")
    return child if isinstance(child, dict) else None


def _choices(schema: Schema) -> list[Any]:
    if schema.get("type") == "boolean":
        return [True, False]
    return [schema["const"]] if "const" in schema else list(schema.get("enum", ()))


def _words(schema: Schema) -> str:
    choices = _choices(schema)
    if choices and schema.get("type") != "boolean":
        return f"one of {', '.join(map(str, choices))}" if len(choices) > 1 else str(choices[0])
    if "prefixItems" in schema:
        return _row(schema["prefixItems"])
    if str(schema.get("format", "")).endswith("path"):
        return "a path"
    examples = f" like {', '.join(map(str, schema['examples']))}" if "examples" in schema else ""
    return _noun(schema, 0) + _bounds(schema) + examples


def _noun(schema: Schema, form: int) -> str:
    kind = schema.get("type")
    return NOUNS[kind][form] if kind in NOUNS else ""


def _row(items: list[Schema]) -> str:
    """A list of fixed length."""
    if len(items) < len(COUNTS) and all(item == items[0] for item in items) and _noun(items[0], 1):
        return f"{COUNTS[len(items)]} {_noun(items[0], 1)}{_bounds(items[0])}"
    return f"a list of {len(items)}"


def _bounds(schema: Schema) -> str:
    """Of a number, or of the length of a list."""
    if "minimum" in schema and "maximum" in schema:
        return f" from {_written(schema['minimum'])} to {_written(schema['maximum'])}"
    words = {
        "minimum": "of at least",
        "exclusiveMinimum": "above",
        "exclusiveMaximum": "below",
        "maximum": "up to" if "exclusiveMinimum" in schema else "of at most",
        "minItems": "of at least",
    }
    told = [f" {word} {_written(schema[key])}" for key, word in words.items() if key in schema]
    return " and".join(told)


def _written(number: float) -> str:
    """A number, the digits of a whole one in groups of three."""
    return f"{int(number) if number == int(number) else number:,}"
