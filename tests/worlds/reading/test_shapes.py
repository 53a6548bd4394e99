"""What may stand somewhere, in plain words, for every sort of field a plug-in may have."""

from datetime import date
from pathlib import Path
from typing import Annotated, Any, Literal

import pytest
from pydantic import Field

from fogbench.worlds.reading.shapes import shape
from fogbench.worlds.settings import Count, MapFile, Positive, PositiveRange, Probability, Range, Settings


class Part(Settings):
    """A block in a block."""

    size: Positive


class Block(Settings):
    """One field of each sort."""

    whole: int
    count: Count
    part: Probability
    above: Annotated[float, Field(gt=0)]
    below: Annotated[int, Field(lt=9, ge=2)]
    most: Annotated[int, Field(le=9)]
    flag: bool
    text: str
    choice: Literal["a", "b"]
    numbers: Literal[1, 3]
    single: Literal["only"]
    bounds: Range
    ends: PositiveRange | None
    several: list[int]
    some: Annotated[list[str], Field(min_length=2)]
    mixed: tuple[int, str]
    table: dict[str, float]
    inner: Part
    either: int | Part
    file: MapFile
    path: Path | None
    anything: Any
    day: date


@pytest.mark.parametrize(
    ("field", "words"),
    [
        ("whole", "a whole number"),
        ("count", "a whole number from 0 to 1,000,000,000"),
        ("part", "a number from 0 to 1"),
        ("above", "a number above 0"),
        ("below", "a whole number of at least 2 and below 9"),
        ("most", "a whole number of at most 9"),
        ("flag", "true or false"),
        ("text", "text"),
        ("choice", "one of a, b"),
        ("numbers", "one of 1, 3"),
        ("single", "only"),
        ("bounds", "two whole numbers from 0 to 1,000,000,000"),
        ("ends", "two whole numbers from 1 to 1,000,000,000 or nothing"),
        ("several", "a list"),
        ("some", "a list of at least 2"),
        ("mixed", "a list of 2"),
        ("table", "a mapping"),
        ("inner", "a mapping"),
        ("either", "a whole number or a mapping"),
        ("file", "a path"),
        ("path", "a path or nothing"),
        ("anything", ""),
        ("day", "text"),
    ],
)
def test_words(field: str, words: str) -> None:
    """Bounds and choices are said; of a field that takes anything, nothing is."""
    assert shape(Block).at(field).words() == words


def test_a_shape_is_walked_by_keys_and_numbers() -> None:
    """Through references and alternatives, to nothing where nothing is said."""
    block = shape(Block)
    assert block.at("bounds").at(1).words() == "a whole number from 0 to 1,000,000,000"
    assert block.at("several").at(7).words() == "a whole number"
    assert block.at("table").at("any").words() == "a number"
    assert block.at("either").at("size").words() == "a whole number from 1 to 1,000,000,000"
    assert block.at("ends").at(2).words() == block.at("inner").at("sise").words() == ""


def test_keys_and_choices() -> None:
    """A mapping has keys, a choice has values by their text."""
    assert shape(Block).at("inner").keys() == shape(Block).at("either").keys() == ["size"]
    assert shape(Block).at("numbers").choices() == {"1": 1, "3": 3}
    assert shape(Block).at("flag").choices() == {"true": True, "false": False}
    assert shape(Block).at("text").choices() == {}


def test_what_alone_may_stand_somewhere() -> None:
    """Nothing at all may stand beside it."""
    block = shape(Block)
    assert block.at("path").is_a("path")
    assert block.at("file").is_a("path")
    assert not block.at("text").is_a("path")
    assert not block.at("either").is_a("integer")
    assert not block.at("anything").is_a("boolean")
