"""The YAML and the grey image of ROS's map_server (mode trinary).

Every mistake in a file is a `MapError` that reads `FILE: got X; expected Y`.
"""

from io import BytesIO
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
import yaml
from PIL import Image, UnidentifiedImageError
from pydantic import AfterValidator, BaseModel, Field, ValidationError, ValidationInfo
from pydantic_core import PydanticCustomError

from fogbench.worlds.settings import Probability
from fogbench.worlds.types import Array, MapError


def _below_occupied(free: float, info: ValidationInfo) -> float:
    if free >= info.data.get("occupied_thresh", 1):
        raise PydanticCustomError("order", "less than occupied_thresh")
    return free


class Header(BaseModel, frozen=True):
    """The YAML; keys that map_server does not know are let be."""

    image: Path
    """A file, relative to the YAML's folder."""
    resolution: Annotated[float, Field(gt=0, allow_inf_nan=False)]
    """Side of a cell [m]."""
    origin: tuple[float, float, float]
    """Pose of the lower left corner ([m], [m], [rad])."""
    negate: bool
    """Whether white is occupied."""
    occupied_thresh: Probability
    """Cells above are occupied."""
    free_thresh: Annotated[Probability, AfterValidator(_below_occupied)]
    """Cells below are free; what is neither is unknown."""
    mode: Literal["trinary"] = "trinary"


def read_header(path: Path, contents: bytes) -> Header:
    """The contents of a `.yaml` file."""
    try:
        return Header.model_validate(yaml.safe_load(contents))
    except ValidationError as errors:
        first = errors.errors()[0]
        place = ".".join(map(str, first["loc"]))
        if first["type"] == "missing":
            raise MapError(f"{path}: got no {place!r}; expected {', '.join(Header.model_fields)}") from None
        wanted = first["msg"].removeprefix("Input should be ")
        raise MapError(f"{path}: {place or 'all'}: got {str(first['input'])[:40]!r}; expected {wanted}") from None
    except (yaml.YAMLError, ValueError, RecursionError) as error:  # a date that is none, endless brackets
        mark = error.problem_mark if isinstance(error, yaml.MarkedYAMLError) else None
        line = mark.line + 1 if mark else 1
        raise MapError(f"{path}:{line}: got text that is no YAML; expected lines such as 'negate: 0'") from None


def read_image(path: Path, contents: bytes) -> Array:
    """The grey values of a `.pgm` file, P2 or P5: [H, W] uint8."""
    try:
        with Image.open(BytesIO(contents), formats=["PPM"]) as image:
            mode, grey = image.mode, np.asarray(image)  # [H, W]
    except UnidentifiedImageError:
        raise MapError(f"{path}: got no PGM image; expected P2 or P5") from None
    except (OSError, ValueError, Image.DecompressionBombError) as error:
        raise MapError(f"{path}: got a broken PGM image ({error}); expected P2 or P5") from None
    if mode != "L":
        raise MapError(f"{path}: got an image of mode {mode}; expected 8-bit grey, P2 or P5")
    return grey


def occupancy(grey: Array, header: Header) -> tuple[Array, Array]:
    """Which cells of an image are free, and which are occupied, both [H, W] bool; the others are unknown."""
    probability = (grey if header.negate else 255 - grey) / 255  # [H, W]
    return probability < header.free_thresh, probability > header.occupied_thresh
