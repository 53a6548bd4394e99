"""A block of a file becomes an object of its settings class, or a fault for each thing that is wrong with it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any, TypeVar

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from fogbench.worlds.mistake import near, one_of
from fogbench.worlds.reading.positions import Fault, Value
from fogbench.worlds.reading.shapes import Shape, shape
from fogbench.worlds.settings import Settings

Block = TypeVar("Block", bound=Settings)


def read_block(settings: type[Block], value: Value, around: Mapping[str, Any], faults: list[Fault]) -> Block | None:
    """The settings that a value says; None where something is wrong, which is added to `faults`.

    Args:
        settings: the class.
        value: its block.
        around: pydantic's context: relative paths start at `folder`, all maps have the `extent`, if they have one.
        faults: a value that waits for an environment variable adds none.
    """
    try:
        filled = {Path(each.content) for each in value.below() if each.variables and isinstance(each.content, str)}
        return settings.model_validate(_typed(value, shape(settings)), context={**around, "filled": filled})
    except ValidationError as error:
        details = error.errors(include_url=False)
        faults.extend(fault for detail in details for fault in _fault(detail, value, shape(settings)))
        return None
    except Exception as error:  # noqa: BLE001  a user's class may raise anything
        if not any(inner.unset for inner in value.below()):
            faults.append(value.wrong(f"settings that its class can read; it raises {raised(error)}"))
        return None


def raised(error: BaseException) -> str:
    """What the code of a user raised, in one line."""
    return f"{type(error).__name__}: {str(error).strip().partition(chr(10))[0]}"


def _typed(value: Value, shape: Shape) -> Any:
    """Plain Python values; text becomes what pydantic would not make of it, or make too easily."""
    if isinstance(value.content, list):
        return [_typed(child, shape.at(number)) for number, child in enumerate(value.content)]
    if isinstance(value.content, dict):
        return {key: _typed(child, shape.at(key)) for key, child in value.content.items()}
    if value.content is None:
        return None
    other = (
        ... if shape.is_a("boolean") else value.content
    )  # pydantic alone reads `yes` and `1` as true, and refuses `...`
    return shape.choices().get(value.content, other)


def _fault(detail: ErrorDetails, value: Value, shape: Shape) -> list[Fault]:
    """One error of pydantic at the place it is about; none if an unset variable may be the reason."""
    kind, parts = detail["type"], detail["loc"]
    if kind in ("missing", "extra_forbidden") and isinstance(parts[-1], str):
        holder, around = _walk(parts[:-1], value, shape)
        return [_lacking(holder, around, parts[-1]) if kind == "missing" else _unknown(holder, around, parts[-1])]
    found, around = _walk(parts, value, shape)
    if found.unset:
        return []
    told = detail.get("ctx", {}).get("error")
    expected = " ".join(str(told).split()) if told is not None else around.words() or detail["msg"]
    text, choices = found.content if isinstance(found.content, str) else "", around.choices()
    meant = getattr(told, "near", "") or ("" if text in choices else near(text, choices))
    return [found.wrong(expected.rstrip("."), meant)]


def _lacking(holder: Value, shape: Shape, key: str) -> Fault:
    return holder.lacks(key, shape.at(key).words() or "a value")


def _unknown(holder: Value, shape: Shape, key: str) -> Fault:
    keys = shape.keys()
    return holder.wrong_key(key, one_of(keys) if keys else "no settings", near(key, keys))


def _walk(parts: tuple[str | int, ...], value: Value, shape: Shape) -> tuple[Value, Shape]:
    """As far as the parts lead; pydantic's names of alternatives are stepped over."""
    for part in parts:
        child = value.child(part)
        if child is not None:
            value, shape = child, shape.at(part)
    return value, shape
