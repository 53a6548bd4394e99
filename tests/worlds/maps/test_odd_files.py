"""Odd map files, one line each: what is said of them, or that they are read.

To add one, add a line to the table of its format: its contents, and the lines that are said of it; none where it is
read. Each is a file called `x` in an otherwise empty folder, which is called DIR in what is said.
"""

from collections.abc import Callable
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from PIL import Image

from fogbench.worlds.maps.files.image import read_image
from fogbench.worlds.maps.files.map_server import read_header
from fogbench.worlds.maps.files.octile import read_map
from fogbench.worlds.maps.files.scen import read_scen
from fogbench.worlds.types import MapError

HEAD = b"type octile\nheight 2\nwidth 3\nmap\n"
MAP = HEAD + b"..@\nGST\n"
LETTERS = "expected one of . G S @ O T W."
NO_MAP = "got no line 'map'; expected it between the sizes and the rows."

MAPS = {
    "plain": (MAP,),
    "CRLF": (MAP.replace(b"\n", b"\r\n"),),
    "old Mac": (MAP.replace(b"\n", b"\r"),),
    "mixed line ends": (MAP.replace(b"2\n", b"2\r\n"),),
    "byte-order mark": (b"\xef\xbb\xbf" + MAP,),
    "blank lines at the end": (MAP + b"\n \n\n",),
    "no line end at the end": (MAP.rstrip(),),
    "width before height": (MAP.replace(b"height 2\nwidth 3", b"width 3\nheight 2"),),
    "tab in the header": (MAP.replace(b"height 2", b"height\t2"),),
    "empty": (b"", "x:1:1  missing; give 'type' or 'height' or 'width' or 'map'.", f"x:2:1  {NO_MAP}"),
    "other type": (
        MAP.replace(b"octile", b"tile"),
        "x:1:6  type: got 'tile'; expected octile, the only type that is read.",
    ),
    "a separator behind a width": (MAP.replace(b"width 3", b"width 3\x1e"),),
    "no type": (MAP.replace(b"type octile\n", b""), "x:3:1  type: missing; give it above 'map'."),
    "float height": (
        MAP.replace(b"height 2", b"height 2.0"),
        "x:2:8  height: got '2.0'; expected a whole number from 1.",
    ),
    "word for a height": (
        MAP.replace(b"height 2", b"height two"),
        "x:2:8  height: got 'two'; expected a whole number from 1.",
    ),
    "no width": (MAP.replace(b"width 3\n", b""), "x:3:1  width: missing; give it above 'map'."),
    "width of nothing": (
        MAP.replace(b"width 3", b"width"),
        "x:3:6  width: missing; give a whole number from 1.",
    ),
    "negative width": (MAP.replace(b"width 3", b"width -3"), "x:3:7  width: got '-3'; expected a whole number from 1."),
    "zero width": (MAP.replace(b"width 3", b"width 0"), "x:3:7  width: got '0'; expected a whole number from 1."),
    "endless width": (
        MAP.replace(b"width 3", b"width 99999999999"),
        "x:3:7  width: got '99999999999'; expected a whole number from 1.",
    ),
    "huge": (
        MAP.replace(b"t 2", b"t 90000").replace(b"h 3", b"h 90000"),
        "x:1:1  got 8,100,000,000 cells; expected at most 67,108,864.",
    ),
    "twice a width": (
        MAP.replace(b"height 2", b"width 2"),
        "x:3:1  got 'width 3'; expected 'height' or 'map'.",
        "x:4:1  height: missing; give it above 'map'.",
    ),
    "foreign key": (
        MAP.replace(b"height", b"depth"),
        "x:2:1  got 'depth 2'; expected 'height' or 'width' or 'map'.",
        "x:4:1  height: missing; give it above 'map'.",
    ),
    "no map line": (MAP.replace(b"map\n", b""), "x:4:1  got '..@'; expected 'map'.", f"x:6:1  {NO_MAP}"),
    "short row": (MAP.replace(b"GST", b"GS"), "x:6:3  got 2 letters; expected 3, the width."),
    "long row": (MAP.replace(b"..@", b"..@@"), "x:5:4  got 4 letters; expected 3, the width."),
    "blank row": (HEAD + b"\n...\n", "x:5:1  got 0 letters; expected 3, the width."),
    "missing row": (HEAD + b"...\n", "x:6:1  got 1 rows; expected 2, the height."),
    "row too many": (MAP + b"...\n", "x:7:1  got 3 rows; expected 2, the height."),
    "unknown letters": (
        MAP.replace(b"..@", b".EE").replace(b"GST", b"x.E"),
        f"x:5:2  got 'E'; {LETTERS}",
        f"x:6:1  got 'x'; {LETTERS}",
        f"x:6:3  got 'E'; {LETTERS}",
    ),
    "a letter beyond ASCII": (MAP.replace(b"..@", "..é".encode()), f"x:5:3  got 'é'; {LETTERS}"),
    "Latin-1": (MAP.replace(b"..@", b"..\xe9"), f"x:5:3  got '\ufffd'; {LETTERS}"),
    "space in a row": (MAP.replace(b"..@", b". @"), f"x:5:2  got ' '; {LETTERS}"),
    "all at once": (
        b"type tile\nheight -2\nwidth 3\nmap\n.?\n",
        "x:1:6  type: got 'tile'; expected octile, the only type that is read.",
        "x:2:8  height: got '-2'; expected a whole number from 1.",
        f"x:5:2  got '?'; {LETTERS}",
    ),
    "more than anybody reads": (
        b"type octile\nheight 30\nwidth 3\nmap\n" + b"..\n" * 30,
        *(f"x:{line}:3  got 2 letters; expected 3, the width." for line in range(5, 25)),
        "x: 10 more mistakes.",
    ),
}

TASK = b"version 1\n0\tm.map\t3\t2\t0\t1\t2\t0\t3.5\n"

SCENS = {
    "plain": (TASK,),
    "CRLF": (TASK.replace(b"\n", b"\r\n"),),
    "old Mac": (TASK.replace(b"\n", b"\r"),),
    "byte-order mark": (b"\xef\xbb\xbf" + TASK,),
    "spaces": (TASK.replace(b"\t", b"  "),),
    "version 1.0": (TASK.replace(b"n 1", b"n 1.0"),),
    "a separator behind a number": (TASK.replace(b"\t3\t", b"\t3\x1e\t"),),
    "no tasks": (b"version 1\n",),
    "blank lines at the end": (TASK + b"\n\n",),
    "empty": (b"", "x:1:1  missing; give 'version 1'."),
    "no version": (TASK[10:], "x:1:1  got '0\\tm.map\\t3\\t2\\t0\\t1\\t2\\t0\\t3.5'; expected 'version 1'."),
    "a column less": (
        TASK.replace(b"\t3.5", b""),
        "x:2:1  got 8 fields; expected 9: bucket, map, width, height, x, y, x, y, length.",
    ),
    "a blank line": (
        TASK.replace(b"1\n0", b"1\n\n0"),
        "x:2:1  got 0 fields; expected 9: bucket, map, width, height, x, y, x, y, length.",
    ),
    "float coordinates": (
        TASK.replace(b"\t0\t1\t2\t0\t", b"\t0.0\t1\t2.0\t0\t"),
        "x:2:13  got '0.0'; expected a whole number from 0.",
        "x:2:19  got '2.0'; expected a whole number from 0.",
    ),
    "a negative coordinate": (
        TASK.replace(b"\t0\t1\t", b"\t-1\t1\t"),
        "x:2:13  got '-1'; expected a whole number from 0.",
    ),
    "outside": (
        TASK.replace(b"\t0\t1\t2\t0\t", b"\t3\t1\t2\t2\t"),
        "x:2:13  got x 3; expected x below 3.",
        "x:2:19  got y 2; expected y below 2.",
    ),
    "another map's size": (
        TASK.replace(b"\t3\t2\t", b"\t8\t6\t"),
        "x:2:9  got a map of 8 x 6; expected 3 x 2, as the map file has.",
    ),
    "a length that is none": (TASK.replace(b"3.5", b"nan"), "x:2:21  got 'nan'; expected a length from 0."),
    "a negative length": (TASK.replace(b"3.5", b"-1"), "x:2:21  got '-1'; expected a length from 0."),
    "all at once": (
        TASK.replace(b"version 1", b"2")
        + b"0\tm.map\n"
        + TASK[10:].replace(b"\t0\t1\t", b"\ta\t1\t").replace(b"3.5", b"far"),
        "x:1:1  got '2'; expected 'version 1'.",
        "x:3:1  got 2 fields; expected 9: bucket, map, width, height, x, y, x, y, length.",
        "x:4:13  got 'a'; expected a whole number from 0.",
        "x:4:21  got 'far'; expected a length from 0.",
    ),
}

YAML = b"image: x\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"

YAMLS = {
    "plain": (YAML,),
    "CRLF": (YAML.replace(b"\n", b"\r\n"),),
    "byte-order mark": (b"\xef\xbb\xbf" + YAML,),
    "a document mark": (b"---\n" + YAML,),
    "other keys": (YAML + b"author: me\n",),
    "mode scale": (YAML + b"mode: scale\n",),
    "mode RAW": (YAML + b"mode: RAW\n",),
    "negate true": (YAML.replace(b"negate: 0", b"negate: true"),),
    "negate False": (YAML.replace(b"negate: 0", b"negate: False"),),
    "a folder with a backslash": (YAML.replace(b": x", b": .\\x"),),
    "numbers in texts": (YAML.replace(b"0.65", b"'0.65'"),),
    "1e-1": (YAML.replace(b"0.1\n", b"1e-1\n"),),
    "a yaw": (YAML.replace(b", 0]", b", 1.57]"),),
    "empty": (b"", "x:1:1  got an empty file; expected a mapping."),
    "a list": (b"- image: x\n", "x:1:1  got - image: x; expected a mapping."),
    "a text": (b"a map", "x:1:1  got a map; expected a mapping."),
    "a tab": (
        YAML.replace(b"negate: 0", b"\tnegate: 0"),
        r"x:4:1  got broken YAML (found character '\t' that cannot start any token); expected one YAML document.",
    ),
    "an open bracket": (
        YAML.replace(b"negate: 0", b"negate: [0"),
        "x:5:16  got broken YAML (expected ',' or ']', but got ':'); expected one YAML document.",
    ),
    "a key twice": (YAML + b"negate: 1\n", "x:7:1  got negate again; expected each key once (it is first on line 4)."),
    "two documents": (
        YAML + b"---\n" + YAML,
        "x:7:1  got broken YAML (found another document); expected one YAML document.",
    ),
    "Latin-1": (YAML + b"author: J\xfcrgen\n", "x:7:10  got the byte 0xfc; expected UTF-8 text."),
    "NUL": (
        YAML.replace(b"negate", b"\x00"),
        r"x:4:1  got broken YAML (special characters are not allowed: '\x00'); expected one YAML document.",
    ),
    "a deep one": (
        YAML + b"x: " + b"[" * 300 + b"]" * 300 + b"\n",
        "x:7:104  got broken YAML (nested more than 100 deep); expected one YAML document.",
    ),
    "no image": (YAML.replace(b"image: x\n", b""), "x:1:1  image: missing; give a path."),
    "an image that is not there": (
        YAML.replace(b"image: x", b"image: nosuch.pgm"),
        "x:1:8  image: got nosuch.pgm; expected an existing file (looked for DIR/nosuch.pgm).",
    ),
    "a Windows path": (
        YAML.replace(b"image: x", b"image: C:\\maps\\x.pgm"),
        r"x:1:8  image: got C:\maps\x.pgm; expected an existing file (looked for DIR/C:/maps/x.pgm).",
    ),
    "image of nothing": (YAML.replace(b"image: x", b"image:"), "x:1:7  image: missing; give a path."),
    "a resolution of 0": (YAML.replace(b"0.1\n", b"0\n"), "x:2:13  resolution: got 0; expected a number above 0."),
    "a resolution without end": (
        YAML.replace(b"0.1\n", b".inf\n"),
        "x:2:13  resolution: got .inf; expected a number above 0.",
    ),
    "an origin of two": (YAML.replace(b", 0]", b"]"), "x:3:9  origin: got [0, 0]; expected three numbers."),
    "an origin of four": (
        YAML.replace(b", 0]", b", 0, 0]"),
        "x:3:9  origin: got [0, 0, 0, 0]; expected three numbers.",
    ),
    "negate maybe": (YAML.replace(b"negate: 0", b"negate: maybe"), "x:4:9  negate: got maybe; expected one of 0, 1."),
    "negate 7": (YAML.replace(b"negate: 0", b"negate: 7"), "x:4:9  negate: got 7; expected one of 0, 1."),
    "percent": (YAML.replace(b"0.65", b"65"), "x:5:18  occupied_thresh: got 65; expected a number from 0 to 1."),
    "thresholds the other way round": (
        YAML.replace(b"0.65", b"0.1"),
        "x:6:14  free_thresh: got 0.196; expected less than occupied_thresh.",
    ),
    "equal thresholds": (
        YAML.replace(b"0.65", b"0.196"),
        "x:6:14  free_thresh: got 0.196; expected less than occupied_thresh.",
    ),
    "a mode of its own": (
        YAML + b"mode: trinry\n",
        "x:7:7  mode: got trinry; expected one of trinary, scale, raw. Did you mean trinary?",
    ),
    "negate in mode raw": (
        YAML.replace(b"negate: 0", b"negate: 1") + b"mode: raw\n",
        "x:4:9  negate: got 1; expected 0 in mode raw, where map_server of ROS 1 and that of ROS 2 read 1 differently.",
    ),
    "a variable that is not set": (
        YAML.replace(b"0.1\n", b'"${NOBODY_SETS_THIS}"\n'),
        'x:2:13  resolution: got "${NOBODY_SETS_THIS}"; expected the variable NOBODY_SETS_THIS to be set.',
    ),
    "all at once": (
        b"image: no.pgm\nresolution: -1\norigin: [0,0]\nnegate: maybe\noccupied_thresh: 2\nfree_thresh: 3\nmode: rw\n",
        "x:1:8  image: got no.pgm; expected an existing file (looked for DIR/no.pgm).",
        "x:2:13  resolution: got -1; expected a number above 0.",
        "x:3:9  origin: got [0,0]; expected three numbers.",
        "x:4:9  negate: got maybe; expected one of 0, 1.",
        "x:5:18  occupied_thresh: got 2; expected a number from 0 to 1.",
        "x:6:14  free_thresh: got 3; expected a number from 0 to 1.",
        "x:7:7  mode: got rw; expected one of trinary, scale, raw. Did you mean raw?",
    ),
}


def saved(form: str, mode: str = "L", **fields: Any) -> bytes:
    """An image file of 2 x 2 pixels."""
    contents = BytesIO()
    grey = np.array([[0, 205], [254, 255]], np.uint8)
    Image.fromarray(grey).convert(mode).save(contents, form, **fields)
    return contents.getvalue()


FORMATS = "expected a PGM, PNG or BMP image"
PIXELS = "expected 1 to 67,108,864 of them"

IMAGES = {
    "P2": (b"P2\n2 2\n255\n0 205 254 255\n",),
    "P2 with comments": (b"P2 # by hand\n# me\n2 2\n255\n0 205\n# so\n254 255",),
    "P5": (b"P5\n2 2\n255\n\0\xcd\xfe\xff",),
    "P5 of 16 bits": (b"P5\n1 2\n65535\n\0\0\xff\xff",),
    "P5 of 100 shades": (b"P5\n1 2\n100\n\0\x64",),
    "PBM": (b"P1\n2 2\n0 1 1 0\n",),
    "PPM": (b"P6\n1 1\n255\nabc",),
    "PNG": (saved("PNG"),),
    "PNG with a palette": (saved("PNG", "P"),),
    "PNG with a clear colour": (saved("PNG", "P", transparency=0),),
    "PNG with opacity": (saved("PNG", "LA"),),
    "BMP": (saved("BMP"),),
    "empty": (b"", f"x: got an empty file; {FORMATS}"),
    "text": (b"hello", f"x: got no image, or a broken one; {FORMATS}"),
    "GIF": (saved("GIF"), f"x: got no image, or a broken one; {FORMATS}"),
    "JPEG": (saved("JPEG"), f"x: got no image, or a broken one; {FORMATS}"),
    "floats": (b"Pf\n1 1\n-1.0\nabcd", "x: got an image of floating-point shades; expected whole ones, 8 or 16 bits"),
    "no pixels": (b"P5\n0 4\n255\n", f"x: got no image, or a broken one; {FORMATS}"),
    "P5 cut short": (
        b"P5\n4 4\n255\nabc",
        f"x: got a broken image (image file is truncated (3 bytes not processed)); {FORMATS}",
    ),
    "P5 without a size": (
        b"P5\n4\n",
        f"x: got a broken image (Reached EOF while reading header); {FORMATS}",
    ),
    "P5 of no shades": (
        b"P5\n1 1\n0\na",
        f"x: got a broken image (maxval must be greater than 0 and less than 65536); {FORMATS}",
    ),
    "P2 cut short": (
        b"P2\n4 4\n255\n1 2 3",
        f"x: got a broken image (not enough image data); {FORMATS}",
    ),
    "P2 with a word": (
        b"P2\n2 1\n255\n1 x",
        f"x: got a broken image (invalid literal for int() with base 10: b'x'); {FORMATS}",
    ),
    "P2 with too light a shade": (
        b"P2\n2 1\n255\n1 300",
        f"x: got a broken image (Channel value too large for this mode: 300); {FORMATS}",
    ),
    "PNG cut short": (
        saved("PNG")[:-30],
        f"x: got a broken image (image file is truncated (0 bytes not processed)); {FORMATS}",
    ),
    "PNG with a flipped bit": (
        saved("PNG").replace(b"IDAT", b"IDAU"),
        f"x: got no image, or a broken one; {FORMATS}",
    ),
    "BMP cut short": (
        saved("BMP")[:60],
        f"x: got a broken image (image file is truncated (0 bytes not processed)); {FORMATS}",
    ),
    "animated": (
        saved("PNG", save_all=True, append_images=[Image.new("L", (2, 2))]),
        "x: got an animated image of 2 frames; expected one",
    ),
    "large": (b"P5\n9000 9000\n255\n", f"x: got an image of 9000 x 9000 pixels; {PIXELS}"),
    "a bomb": (b"P5\n12000 12000\n255\n", f"x: got far more pixels than are read; {PIXELS}"),
    "a greater bomb": (b"P5\n100000 100000\n255\n", f"x: got far more pixels than are read; {PIXELS}"),
}


def said(read: Callable[[Path, bytes], Any], contents: bytes, folder: Path) -> list[str]:
    """What is said of a file."""
    (folder / "x").write_bytes(contents)
    try:
        read(Path("x"), contents)
    except MapError as error:
        return str(error).replace(str(folder), "DIR").splitlines()
    return []


def read_list(path: Path, contents: bytes) -> Any:
    """Read tasks on a map of two rows and three columns."""
    return read_scen(path, contents, (2, 3))


@pytest.mark.parametrize(
    ("read", "contents", "lines"),
    [
        pytest.param(read, contents, lines, id=f"{name} {what}")
        for name, read, table in (
            (".map", read_map, MAPS),
            (".scen", read_list, SCENS),
            (".yaml", read_header, YAMLS),
            ("image", read_image, IMAGES),
        )
        for what, (contents, *lines) in table.items()
    ],
)
def test_an_odd_file_is_read_or_told(
    read: Callable[[Path, bytes], Any],
    contents: bytes,
    lines: list[str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """What is said of a file is said in lines, one for each mistake, with its place; otherwise it is read."""
    monkeypatch.chdir(tmp_path)
    assert said(read, contents, tmp_path) == lines
