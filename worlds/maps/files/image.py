"""A picture of a map, read by Pillow."""

import warnings
from io import BytesIO
from pathlib import Path
from typing import NamedTuple

import numpy as np
from PIL import Image, UnidentifiedImageError

from fogbench.worlds.types import Array, MapError

FORMATS = ["PPM", "PNG", "BMP"]
"""Names that Pillow has for formats; PPM is that of PGM, too."""

MOST_PIXELS = 2**26
"""Of the largest image that is read."""


class Pixels(NamedTuple):
    """An image in shades."""

    shade: Array
    """[H, W] uint8 or float, from black 0 to white 255: the mean of the colours."""
    opacity: Array | None
    """[H, W] uint8, from transparent 0 to opaque 255; None: the image tells none."""


def read_image(path: Path, contents: bytes) -> Pixels:
    """The shades of a PGM, PPM, PNG or BMP file, of 8 or 16 bits; those of 16 are brought down to 255.

    Raises:
        MapError: it is none of these, broken, animated, or too large.
    """
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(BytesIO(contents), formats=FORMATS) as image:
                _refuse_odd(path, image)
                return _pixels(image)
    except MapError:
        raise
    except (Image.DecompressionBombError, Image.DecompressionBombWarning):
        raise MapError(f"{path}: got far more pixels than are read; expected 1 to {MOST_PIXELS:,} of them") from None
    except UnidentifiedImageError:
        got = "an empty file" if not contents else "no image, or a broken one"
        raise MapError(f"{path}: got {got}; expected a PGM, PNG or BMP image") from None
    except Exception as error:  # noqa: BLE001  Pillow raises whatever its decoders meet
        told = " ".join(str(error).split()) or type(error).__name__
        raise MapError(f"{path}: got a broken image ({told}); expected a PGM, PNG or BMP image") from None


def _refuse_odd(path: Path, image: Image.Image) -> None:
    width, height = image.size
    frames = getattr(image, "n_frames", 1)
    if not 0 < width * height <= MOST_PIXELS:
        raise MapError(f"{path}: got an image of {width} x {height} pixels; expected 1 to {MOST_PIXELS:,} of them")
    if frames > 1:
        raise MapError(f"{path}: got an animated image of {frames} frames; expected one")
    if image.mode == "F":
        raise MapError(f"{path}: got an image of floating-point shades; expected whole ones, 8 or 16 bits")


def _pixels(image: Image.Image) -> Pixels:
    if image.mode.startswith("I"):  # 16 bits, in which white is 65535
        return Pixels(np.asarray(image) / 257, None)
    if image.mode in ("1", "L") and "transparency" not in image.info:
        return Pixels(np.asarray(image.convert("L")), None)
    clear = image.mode.endswith("A") or "transparency" in image.info
    bands = np.asarray(image.convert("RGBA" if clear else "RGB"))  # [H, W, 3 or 4]
    return Pixels(bands[..., :3].mean(2), bands[..., 3] if clear else None)
