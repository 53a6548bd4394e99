"""The YAML of ROS's map_server, and what the pixels of its image mean.

Words used here
    shade        of a pixel, from black 0 to white 255: the mean of its colours
    probability  that a cell is occupied, from 0 to 1; nan where it is unknown
"""

from pathlib import Path
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from pydantic import AfterValidator, BeforeValidator, ConfigDict, Field, ValidationInfo

from fogbench.worlds.maps.files.image import Pixels
from fogbench.worlds.maps.files.mistakes import refuse
from fogbench.worlds.reading.blocks import read_block
from fogbench.worlds.reading.document import parse
from fogbench.worlds.reading.positions import Fault
from fogbench.worlds.settings import MapFile, Probability, Settings
from fogbench.worlds.types import Array

SAVED_UNKNOWN = 205
"""The shade that map_saver writes for unknown cells."""

IMAGES = (b"\x89PNG", b"BM", b"P5", b"P6")
"""What images begin with."""

TRUTHS = {"true": 1, "yes": 1, "on": 1, "false": 0, "no": 0, "off": 0}


def _number(negate: Any) -> Any:
    return TRUTHS.get(str(negate).casefold(), negate)


def _lower(mode: Any) -> Any:
    return mode.lower() if isinstance(mode, str) else mode


def _slashes(image: Any) -> Any:
    return image.replace("\\", "/") if isinstance(image, str) else image


def _below_occupied(free: float, info: ValidationInfo) -> float:
    if free >= info.data.get("occupied_thresh", 2):
        raise ValueError("less than occupied_thresh")
    return free


def _not_raw(negate: int, info: ValidationInfo) -> int:
    if negate and info.data.get("mode") == "raw":
        raise ValueError("0 in mode raw, where map_server of ROS 1 and that of ROS 2 read 1 differently")
    return negate


class Header(Settings):
    """The YAML; keys that map_server does not know are let be."""

    model_config = ConfigDict(extra="ignore")

    image: Annotated[MapFile, BeforeValidator(_slashes)]
    """A file, relative to the YAML's folder."""
    resolution: Annotated[float, Field(gt=0)]
    """Side of a pixel [m]."""
    origin: tuple[float, float, float]
    """Pose of the lower left corner of the image ([m], [m], [rad])."""
    mode: Annotated[Literal["trinary", "scale", "raw"], BeforeValidator(_lower)] = "trinary"
    """What a shade means."""
    negate: Annotated[Literal[0, 1], BeforeValidator(_number), AfterValidator(_not_raw)]
    """Whether white is occupied."""
    occupied_thresh: Probability
    """Cells of a higher probability are occupied."""
    free_thresh: Annotated[Probability, AfterValidator(_below_occupied)]
    """Cells of a lower probability are free."""


class Readings(NamedTuple):
    """What is known of the cells of an image."""

    free: Array
    """[H, W] bool; what is neither free nor occupied is unknown, or lies between the thresholds."""
    occupied: Array
    """[H, W] bool."""
    saved: int
    """Cells of the shade of unknown cells that free_thresh would call free."""
    between: int
    """Cells between the thresholds, in a mode in which these are not unknown."""


def read_header(path: Path, contents: bytes) -> Header:
    """The contents of a `.yaml` file.

    Raises:
        MapError: it is broken, or its image is not there; a line for each mistake.
    """
    faults: list[Fault] = []
    try:
        page = parse(contents.decode("utf-8-sig"), faults)
    except UnicodeDecodeError as error:
        before = contents[: error.start].replace(b"\r\n", b"\n").split(b"\n")
        got, expected = f"the byte 0x{contents[error.start]:02x}", "UTF-8 text"
        if contents.startswith(IMAGES):
            got, expected = "an image", "the YAML file that names it by `image: ...`"
        page = None
        faults.append(Fault(len(before), len(before[-1].decode("utf-8", "replace")) + 1, "", got, expected))
    header = read_block(Header, page, {"folder": path.parent}, faults) if page else None
    faults += (
        [each.wrong(f"the variable {each.unset} to be set") for each in page.below() if each.unset] if page else []
    )
    refuse(path, faults)
    assert header is not None
    return header


def occupancy(pixels: Pixels, header: Header) -> Readings:
    """Which cells of an image are free and which are occupied, by the rules of map_server, but for one.

    In mode trinary the shade that map_saver writes for unknown cells is unknown, whatever free_thresh says.
    """
    probability = _probability(pixels, header)  # [H, W]
    saved = np.zeros(probability.shape, np.bool_)  # [H, W]
    if header.mode == "trinary" and not header.negate:
        saved = (pixels.shade == SAVED_UNKNOWN) & (probability < header.free_thresh)
        probability[saved] = np.nan
    free, occupied = probability < header.free_thresh, probability > header.occupied_thresh
    known = 0 if header.mode == "trinary" else int(np.isfinite(probability).sum())
    between = max(0, known - int(free.sum()) - int(occupied.sum()))
    return Readings(free, occupied, int(saved.sum()), between)


def _probability(pixels: Pixels, header: Header) -> Array:
    """[H, W] float; in mode raw a shade up to 100 is a percentage, and one above is unknown."""
    shade, opacity = pixels
    if header.mode == "raw":
        shade = np.rint(shade)
        return np.where(shade <= 100, shade / 100, np.nan)
    if header.mode == "trinary" and opacity is not None:
        shade = (3 * shade + opacity) / 4  # to map_server it is a fourth colour
    probability: Array = (shade if header.negate else 255 - shade) / 255
    if header.mode == "scale" and opacity is not None:
        probability[opacity < 255] = np.nan
    return probability
