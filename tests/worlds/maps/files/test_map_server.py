"""The files of ROS's map_server."""

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fogbench.worlds.maps.files.map_server import Header, occupancy, read_header, read_image
from fogbench.worlds.types import MapError

YAML = b"""image: map.pgm
resolution: 0.1
origin: [-19.0, -19.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""
P5 = b"P5\n3 2\n255\n\0\xcd\xfe\xff\1\2"
KEYS = "image, resolution, origin, negate, occupied_thresh, free_thresh, mode"


def header(**fields: Any) -> Header:
    """A header that differs from the usual one in some fields."""
    return read_header(Path("x.yaml"), YAML).model_copy(update=fields)


def test_a_header_by_hand() -> None:
    """All keys are read, `mode` is trinary where it is not said, and other keys are let be."""
    expected = Header(
        image=Path("map.pgm"),
        resolution=0.1,
        origin=(-19.0, -19.0, 0.0),
        negate=False,
        occupied_thresh=0.65,
        free_thresh=0.196,
        mode="trinary",
    )
    assert read_header(Path("x.yaml"), YAML) == expected
    assert read_header(Path("x.yaml"), YAML + b"mode: trinary\nauthor: me\n") == expected


@pytest.mark.parametrize(
    ("old", "new", "text"),
    [
        (b"negate: 0\n", b"", f"x.yaml: got no 'negate'; expected {KEYS}"),
        (b"image: map.pgm\n", b"", f"x.yaml: got no 'image'; expected {KEYS}"),
        (b", 0.0]", b"]", f"x.yaml: got no 'origin.2'; expected {KEYS}"),
        (b"negate: 0", b"negate: 7", "x.yaml: negate: got '7'; expected a valid boolean, unable to interpret input"),
        (b"0.65", b"1.5", "x.yaml: occupied_thresh: got '1.5'; expected less than or equal to 1"),
        (b"0.196", b"0.65", "x.yaml: free_thresh: got '0.65'; expected less than occupied_thresh"),
        (b"0.1\n", b"0\n", "x.yaml: resolution: got '0'; expected greater than 0"),
        (b"0.1\n", b".inf\n", "x.yaml: resolution: got 'inf'; expected a finite number"),
        (
            b"negate: 0",
            b"negate: " + b"[" * 3000,
            "x.yaml:1: got text that is no YAML; expected lines such as 'negate: 0'",
        ),
        (b"negate: 0", b"negate: 0\nmode: scale", "x.yaml: mode: got 'scale'; expected 'trinary'"),
        (b"negate: 0", b"negate: [0", "x.yaml:5: got text that is no YAML; expected lines such as 'negate: 0'"),
        (b"negate", b"\x00", "x.yaml:1: got text that is no YAML; expected lines such as 'negate: 0'"),
        (b"0.65", b"2026-99-99", "x.yaml:1: got text that is no YAML; expected lines such as 'negate: 0'"),
        (YAML, b"a map", "x.yaml: all: got 'a map'; expected a valid dictionary or instance of Header"),
    ],
)
def test_a_broken_header_is_one_line(old: bytes, new: bytes, text: str) -> None:
    """The line says the file, the key, what was got and what was expected."""
    with pytest.raises(MapError) as error:
        read_header(Path("x.yaml"), YAML.replace(old, new))
    assert str(error.value) == text


@pytest.mark.parametrize(
    "image", [b"P2\n# by hand\n3 2\n255\n0 205 254\n255 1 2\n", b"P5\n3 2\n255\n\0\xcd\xfe\xff\1\2"]
)
def test_an_image_by_hand(image: bytes) -> None:
    """P2 and P5 files give the same grey values, rows from the top."""
    assert read_image(Path("x.pgm"), image).tolist() == [[0, 205, 254], [255, 1, 2]]


@pytest.mark.parametrize(
    ("image", "text"),
    [
        (b"", "got no PGM image; expected P2 or P5"),
        (b"hello", "got no PGM image; expected P2 or P5"),
        (b"P6\n1 1\n255\nabc", "got an image of mode RGB; expected 8-bit grey, P2 or P5"),
        (b"P5\n1 1\n65535\nab", "got an image of mode I; expected 8-bit grey, P2 or P5"),
    ],
)
def test_what_is_no_grey_image_is_one_line(image: bytes, text: str) -> None:
    """The line says the file, what was got and what was expected."""
    with pytest.raises(MapError) as error:
        read_image(Path("x.pgm"), image)
    assert str(error.value) == f"x.pgm: {text}"


@pytest.mark.parametrize(
    "image",
    [
        b"P5\n4 4\n255\nabc",
        b"P5\n4\n",
        b"P5\na 4\n255\n",
        b"P5\n1 1\n0\na",
        b"P2\n4 4\n255\n1 2 3",
        b"P2\n2 1\n255\n1 x",
        b"P2\n2 1\n255\n1 300",
        b"P5\n100000 100000\n255\n",
    ],
)
def test_a_broken_image_is_one_line(image: bytes) -> None:
    """A truncated, senseless or monstrous image names its file, and Pillow's reason stands in brackets."""
    with pytest.raises(MapError, match=r"^x\.pgm: got a broken PGM image \([^\n]+\); expected P2 or P5$"):
        read_image(Path("x.pgm"), image)


def complaint(read: Callable[[Path, bytes], Any], contents: bytes) -> str:
    """What a reader says of a broken file; nothing of a good one."""
    try:
        read(Path("x"), contents)
    except MapError as error:
        return str(error)
    return ""


@given(place=st.integers(0, 200), cut=st.integers(0, 3), put=st.binary(max_size=3))
def test_no_damage_ends_in_another_error(place: int, cut: int, put: bytes) -> None:
    """A few bytes cut out of, or put into, a file leave it readable or raise a MapError of one line."""
    for read, contents in ((read_header, YAML), (read_image, b"P2\n3 2\n255\n0 205 254\n255 1 2\n"), (read_image, P5)):
        text = complaint(read, contents[:place] + put + contents[place + cut :])
        assert re.fullmatch("(x[^\n]*: got [^\n]+; expected [^\n]+)?", text)


def test_occupancy_by_hand() -> None:
    """White is free, black is occupied, and map_server's own grey of 205 is unknown, just not below 0.196."""
    grey = np.array([[0, 89, 90, 205, 206, 254, 255]], np.uint8)
    free, occupied = occupancy(grey, header())
    assert free.tolist() == [[False, False, False, False, True, True, True]]
    assert occupied.tolist() == [[True, True, False, False, False, False, False]]


def test_negate_exchanges_black_and_white() -> None:
    """A negated image reads as its negative."""
    grey = np.arange(256, dtype=np.uint8)[None]
    for plain, negated in zip(occupancy(grey, header()), occupancy(255 - grey, header(negate=True)), strict=True):
        assert np.array_equal(plain, negated)
