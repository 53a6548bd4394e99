"""The files of ROS's map_server."""

import re
from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from PIL import Image

from fogbench.worlds.maps.files.image import Pixels, read_image
from fogbench.worlds.maps.files.map_server import Header, Readings, occupancy, read_header
from fogbench.worlds.types import Array, MapError

YAML = """image: map.pgm
resolution: 0.1
origin: [-19.0, -19.0, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""
P5 = b"P5\n3 2\n255\n\0\xcd\xfe\xff\1\2"


@pytest.fixture(autouse=True)
def _image(tmp_path: Path) -> None:
    """The image that the YAML names."""
    (tmp_path / "map.pgm").write_bytes(P5)


def header(folder: Path, text: str = "") -> Header:
    """The usual header, with other lines in place of those for the same keys."""
    keys = dict(line.split(": ", 1) for line in f"{YAML}{text}".splitlines())
    return read_header(folder / "x.yaml", "\n".join(f"{key}: {value}" for key, value in keys.items()).encode())


def read(folder: Path, shade: Any, text: str = "", opacity: Any = None) -> Readings:
    """What the pixels of a row mean."""
    return occupancy(Pixels(np.array([shade]), None if opacity is None else np.array([opacity])), header(folder, text))


def letters(told: Readings) -> str:
    """A row as text: `.` free, `#` occupied, `?` neither."""
    assert not (told.free & told.occupied).any()
    return "".join(np.where(told.free, ".", np.where(told.occupied, "#", "?"))[0])


def test_a_header_by_hand(tmp_path: Path) -> None:
    """All keys are read, `mode` is trinary where it is not said, and other keys are let be."""
    expected = Header(
        image=tmp_path / "map.pgm",
        resolution=0.1,
        origin=(-19.0, -19.0, 0.0),
        negate=0,
        occupied_thresh=0.65,
        free_thresh=0.196,
        mode="trinary",
    )
    assert header(tmp_path) == expected
    assert header(tmp_path, "author: me\nmode: Trinary\nnegate: false\n") == expected
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps/a.png").touch()
    for image in ("maps/a.png", r"maps\a.png", tmp_path / "maps/a.png"):
        assert header(tmp_path, f"image: {image}").image == tmp_path / "maps/a.png"


@pytest.mark.parametrize(
    ("form", "mode", "shade"),
    [
        ("PPM", "L", [0, 100, 205, 255]),
        ("PNG", "L", [0, 100, 205, 255]),
        ("BMP", "L", [0, 100, 205, 255]),
        ("PNG", "1", [0, 0, 255, 255]),
        ("BMP", "1", [0, 0, 255, 255]),
        ("PNG", "P", [0, 100, 205, 255]),
        ("PNG", "RGB", [0, 100, 205, 255]),
        ("BMP", "RGB", [0, 100, 205, 255]),
        ("PPM", "RGB", [0, 100, 205, 255]),
    ],
)
def test_an_image_means_the_same_in_all_formats(form: str, mode: str, shade: list[int]) -> None:
    """Grey as it is, colours as their mean, a palette as the colours that it stands for."""
    colours = np.repeat(np.array([shade], np.uint8)[..., None], 3, 2)  # [1, W, 3]
    colours[0, 1] = (0, 100, 200) if mode in ("P", "RGB") else 100
    image = Image.fromarray(colours)
    contents = BytesIO()
    (image.quantize(4) if mode == "P" else image.convert(mode)).save(contents, form)
    pixels = read_image(Path("x"), contents.getvalue())
    assert pixels.opacity is None
    assert pixels.shade.tolist() == [shade]


@pytest.mark.parametrize("mode", ["LA", "RGBA"])
def test_opacity_is_read_beside_the_shade(mode: str) -> None:
    """A transparent pixel keeps its colours."""
    image = Image.fromarray(np.array([[[10, 10, 10, 0], [205, 205, 205, 255]]], np.uint8), "RGBA").convert(mode)
    contents = BytesIO()
    image.save(contents, "PNG")
    pixels = read_image(Path("x.png"), contents.getvalue())
    assert pixels.shade.tolist() == [[10, 205]]
    assert pixels.opacity is not None
    assert pixels.opacity.tolist() == [[0, 255]]


def test_sixteen_bits_are_brought_down_to_255() -> None:
    """White is 65535 in a PGM and in a PNG, and 205 stays 205."""
    deep = np.array([[0, 205 * 257, 65535]], np.uint16)
    contents = BytesIO()
    Image.fromarray(deep).save(contents, "PNG")
    for image in (contents.getvalue(), b"P5\n3 1\n65535\n" + deep.astype(">u2").tobytes()):
        assert read_image(Path("x"), image).shade.tolist() == [[0, 205, 255]]


def test_trinary_by_hand(tmp_path: Path) -> None:
    """White is free, black is occupied, and map_saver's own grey of 205 is unknown, just not below 0.196."""
    assert letters(read(tmp_path, [0, 89, 90, 205, 206, 254, 255])) == "##??..."


def test_the_grey_of_unknown_cells_is_unknown_whatever_free_thresh_says(tmp_path: Path) -> None:
    """With the 0.25 of ROS 2, 205 is unknown and counted, its neighbours are free; opaque grey is no other."""
    for opacity in (None, [255] * 4):
        told = read(tmp_path, [204, 205, 205, 206], "free_thresh: 0.25", opacity)
        assert (letters(told), told.saved) == (".??.", 2)
    assert read(tmp_path, [205], "free_thresh: 0.196").saved == 0
    assert letters(read(tmp_path, [205], "free_thresh: 0.25\nmode: scale")) == "."
    assert letters(read(tmp_path, [205], "negate: 1")) == "#"


def test_negate_exchanges_black_and_white(tmp_path: Path) -> None:
    """A negated image reads as its negative."""
    shade = np.arange(256)
    assert letters(read(tmp_path, shade)) == letters(read(tmp_path, 255 - shade, "negate: 1"))


def test_opacity_is_a_fourth_colour_in_mode_trinary(tmp_path: Path) -> None:
    """(0 + 0 + 0 + 255) / 4 is 64, still occupied; a transparent white is 191, and unknown."""
    assert letters(read(tmp_path, [0, 255, 255, 0], opacity=[255, 255, 0, 0])) == "#.?#"


def test_scale_by_hand(tmp_path: Path) -> None:
    """As trinary, but what is not opaque is unknown, and what lies between the thresholds is counted."""
    told = read(tmp_path, [0, 128, 200, 255, 255], "mode: scale", [255, 255, 255, 255, 254])
    assert (letters(told), told.between) == ("#??.?", 2)


def test_raw_by_hand(tmp_path: Path) -> None:
    """A shade up to 100 is a percentage, held against the same thresholds; one above is unknown."""
    told = read(tmp_path, [0, 19, 20, 65, 66, 100, 101, 255], "mode: raw")
    assert (letters(told), told.between) == ("..??##??", 2)


def complaint(read: Callable[[Path, bytes], Any], contents: bytes) -> str:
    """What a reader says of a broken file; nothing of a good one."""
    try:
        read(Path("x"), contents)
    except MapError as error:
        return str(error)
    return ""


def picture(form: str) -> bytes:
    """An image file."""
    contents = BytesIO()
    grey: Array = np.arange(60, dtype=np.uint8).reshape(6, 10)
    Image.fromarray(grey).save(contents, form)
    return contents.getvalue()


PICTURES = [b"P2\n3 2\n255\n0 205 254\n255 1 2\n", P5, picture("PNG"), picture("BMP")]


@given(place=st.integers(0, 200), cut=st.integers(0, 3), put=st.binary(max_size=3))
def test_no_damage_ends_in_another_error(place: int, cut: int, put: bytes) -> None:
    """A few bytes cut out of, or put into, a file leave it readable or raise a MapError of lines."""
    for read, contents in ((read_header, YAML.encode()), *((read_image, each) for each in PICTURES)):
        text = complaint(read, contents[:place] + put + contents[place + cut :])
        for line in text.splitlines():
            assert re.fullmatch(r"x:.*(got .+; expected|missing; give) .+", line)
