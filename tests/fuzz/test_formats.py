"""Damaged files of every format that is read: a run, or exit code 2 and lines with a place; never anything else.

A format is one entry of `FORMATS`; a file that did harm once is one line of `FOUND`.
"""

import io
import json
import os
import subprocess
import sys
import time
from collections.abc import Callable
from pathlib import Path
from random import Random
from typing import Any, NamedTuple

import numpy as np
import pytest
import yaml
from PIL import Image

import fogbench
from fogbench.bench import several
from fogbench.bench.reading.recipe import read_recipe
from fogbench.bench.reading.scenario import text_of
from fogbench.learned.checkpoint import SHIPPED
from fogbench.worlds.files import sha256
from fogbench.worlds.mistake import Mistake

GRID = b"""name: grid
about: "Some [obstacles]."
maps: {blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}}
sensor: {radius: 2, occlusion: true, false_readings: 0.1}
rules: {collision: blocked, slip: 0.1, slip_to: sideways}
tasks: {distance: [1, 12]}
budget: {steps: 20, hard_seconds: 30, memory_bytes: 100000}
agents: [astar, memoryless, {astar: {replan: change, label: eager}}]
reference: eager
episodes: 2
seed: 3
"""

MIXED = b"""name: mixed
budget: {steps: {per_distance: 4, plus: 20}}
variants:
  rooms: {maps: {rooms: {size: 9, rooms: [2, 2], doors: [1, 2]}}}
  tunnel: {maps: {tunnel: {length: [4, 8]}}, sensor: {radius: 1}}
  maze: {maps: {maze: {size: 9}}, episodes: 1}
agents:
  - dstar_lite
  - random_walk
  - vin: {checkpoint: none, iterations: 3}
episodes: 2
published:
  source: a table
  success: {dstar_lite: {rooms: 96.3}}
  path_ratio: {dstar_lite: {maze: .inf}}
"""

RECIPE = b"""name: small
about: A recipe.
network: {vin: {iterations: 4, discount: 0.99}}
maps: {blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}}
sensor: {radius: 3}
budget: {steps: 20}
learning:
  imitation:
    curriculum: {easy: {obstacles: [0, 0]}, until: 0.3}
    batches: 2
    batch: 2
    rate: [2e-2, 5e-4]
validation: {every: 1, episodes: 2}
variants:
  small: {}
  dense: {maps: {blobs: {obstacles: [3, 9]}}, budget: {steps: 30}}
lessons: [small, dense]
seed: 1
"""

OCTILE = b"""type octile
height 4
width 6
map
......
.@@T..
.S..WO
......
"""

SCEN = b"""version 1
0\t%.map\t6\t4\t0\t0\t5\t0\t5
0\t%.map\t6\t4\t0\t3\t4\t0\t7.24264069
"""

FLOOR = b"""image: %.pgm
mode: trinary
resolution: 0.05
origin: [-1.0, -2.5, 0.0]
negate: 0
occupied_thresh: 0.65
free_thresh: 0.196
"""

GREY = np.full((6, 9), 254, np.uint8)
GREY[0], GREY[2, 3:6], GREY[5] = 205, 0, 205

PLAIN = b"P2\n# by hand\n9 6\n255\n" + b"\n".join(b" ".join(b"%d" % value for value in row) for row in GREY)

PAGE = """name: page
maps: {}
budget: {{steps: 40}}
agents: [{}]
episodes: 1
"""

WEIGHTS = (SHIPPED / "vin-grid.safetensors").read_bytes()

CARD = json.dumps({k: v for k, v in json.loads((SHIPPED / "vin-grid.json").read_text()).items() if k != "training"})

MOVINGAI = PAGE.format("{movingai: {map: %.map, scen: %.scen}}", "astar").encode()
OCCUPANCY = PAGE.format("{occupancy: {map: %.yaml}}", "astar").encode()
NETWORK = PAGE.format(
    "{blobs: {size: 8, obstacles: [0, 1], obstacle_size: [1, 1]}}", "vin: {checkpoint: ./%.safetensors}"
).encode()


def image(form: str, mode: str = "L") -> bytes:
    """The grey values as an image of some format."""
    file = io.BytesIO()
    Image.fromarray(GREY).convert(mode).save(file, form)
    return file.getvalue()


def pictured(suffix: str, contents: bytes) -> dict[str, bytes]:
    """An image with its YAML and a scenario that plays on it."""
    return {suffix: contents, ".yaml": FLOOR.replace(b".pgm", suffix.encode()), ".s.yaml": OCCUPANCY}


def carded(contents: bytes) -> dict[str, bytes]:
    """Weights, and a card that is theirs, so that they are looked into."""
    card = json.dumps({**json.loads(CARD), "sha256": sha256(contents)}).encode()
    return {".safetensors": contents, ".json": card, ".s.yaml": NETWORK}


class Format(NamedTuple):
    """One format of files."""

    seeds: tuple[bytes, ...]
    """Good files."""
    files: Callable[[bytes], dict[str, bytes]]
    """What lies in the folder: contents by suffix; `%` in them stands for the stem that all have."""


FORMATS = {
    "scenario": Format((GRID, MIXED), lambda text: {".s.yaml": text}),
    "recipe": Format((RECIPE,), lambda text: {".recipe.yaml": text}),
    "map": Format((OCTILE,), lambda text: {".map": text, ".scen": SCEN, ".s.yaml": MOVINGAI}),
    "scen": Format((SCEN,), lambda text: {".map": OCTILE, ".scen": text, ".s.yaml": MOVINGAI}),
    "map_server": Format((FLOOR,), lambda text: {".yaml": text, ".pgm": PLAIN, ".s.yaml": OCCUPANCY}),
    "pgm": Format((PLAIN, image("PPM")), lambda text: pictured(".pgm", text)),
    "png": Format((image("PNG"), image("PNG", "1"), image("PNG", "LA")), lambda text: pictured(".png", text)),
    "bmp": Format((image("BMP"), image("BMP", "RGB")), lambda text: pictured(".bmp", text)),
    "card": Format((CARD.encode(),), lambda text: {".safetensors": WEIGHTS, ".json": text, ".s.yaml": NETWORK}),
    "weights": Format((WEIGHTS,), carded),
}
"""By name; one entry makes a new one part of all tests here."""

FOUND = [
    ("map_server", FLOOR.replace(b"%.pgm", b"9" * 5000)),
    ("map_server", FLOOR.replace(b"%.pgm", b"/dev/zero")),
    ("scenario", MOVINGAI.replace(b"%.map", b"/dev/zero")),
    ("scenario", MOVINGAI.replace(b"%.scen", b"/dev/zero")),
    ("scenario", OCCUPANCY.replace(b"%.yaml", b"/dev/zero")),
    ("scenario", NETWORK.replace(b"./%.safetensors", b"/dev/zero")),
    ("scenario", b"[" * 60_000),
    ("scenario", b"*a" + b"9" * 5000),
    ("scenario", GRID.replace(b"[0, 3]", b"[0, 1000000]")),
    ("recipe", RECIPE.replace(b"blobs: {size", b"blobs" + b":bs" * 300 + b": {size")),
    ("scenario", GRID.replace(b"astar,", b'"json:' + b"x" * 3000 + b'",')),
    ("card", CARD.replace('"Vin"', f'"{"V" * 3000}"').encode()),
    ("card", CARD.replace('"settings": {', f'"settings": {{"{"x" * 3000}": 1, ').encode()),
    ("card", CARD.replace('"settings": {', f'"settings": {{"iterations": "{"x" * 3000}", ').encode()),
]
"""Files that did harm once."""

PLANTED = {
    "KeyError": KeyError("episodes"),
    "ZeroDivisionError": ZeroDivisionError("division by zero"),
    "exit code 1": SystemExit(1),
    "got exit code 2 with 0 lines": SystemExit(2),
    "a line without the file": Mistake("all: got nothing; expected something."),
    "a word of Python": Mistake("%.s.yaml: got KeyError: 'x'; expected a world."),
    "MemoryError": MemoryError(),
}
"""Faults of a reader, by a word of what the hunt says of them."""


def lay(form: Format, contents: bytes) -> Path:
    """Write a file with those beside it into the folder; the path of the one to name to the command."""
    stem = f"f{sha256(contents)[:10]}"
    for suffix, text in form.files(contents).items():
        place = Path(stem + suffix)
        place.write_bytes(text.replace(b"%", stem.encode()) if suffix.endswith(("yaml", ".scen")) else text)
    return place


def attempt(form: Format, watched: Any, contents: bytes) -> None:
    """Have one file read; what was good is cleared away."""
    told, judge, _ = watched
    place = lay(form, contents)
    stem = place.name.partition(".")[0]
    if place.name.endswith(".recipe.yaml"):
        judge(*read(place, watched), stem)
    else:
        judge(*told(["check", str(place)]), stem)
    for file in Path().glob(f"{stem}.*"):
        file.unlink()


def read(recipe: Path, watched: Any) -> tuple[int, list[str]]:
    """A recipe is read and not trained by."""
    try:
        read_recipe(text_of(recipe), recipe)
    except Mistake as mistake:
        return 2, str(mistake).splitlines()
    return 0, []


@pytest.mark.parametrize("name", FORMATS)
def test_good_files_are_read(name: str, watched: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """What the fuzzer damages is good before."""
    monkeypatch.chdir(tmp_path)
    told, _, _ = watched
    for contents in FORMATS[name].seeds:
        place = lay(FORMATS[name], contents)
        answer = read(place, watched) if name == "recipe" else told(["check", str(place)])
        assert answer == (0, [])


@pytest.mark.parametrize("name", FORMATS)
def test_damage_ends_in_lines_with_a_place(name: str, hunt: Any, watched: Any) -> None:
    """Whatever is cut, doubled, swapped, flipped or put in, each mistake is a line that names the file."""
    form = FORMATS[name]
    hunt(name, form.seeds, lambda contents: attempt(form, watched, contents), 1 / len(FORMATS))


@pytest.mark.parametrize(("name", "contents"), FOUND)
def test_what_was_found_stays_mended(
    name: str, contents: bytes, watched: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Files that did harm once do none."""
    monkeypatch.chdir(tmp_path)
    attempt(FORMATS[name], watched, contents)


@pytest.mark.parametrize("fault", PLANTED)
def test_the_hunt_finds_a_planted_fault(fault: str, hunt: Any, watched: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """A reader that fails where `episodes` is missing is found, whatever way it fails."""
    reads = several.read_scenario

    def broken(text: str, path: Path) -> Any:
        if "episodes" in text:
            return reads(text, path)
        error = PLANTED[fault]
        raise type(error)(
            *(word.replace("%.s.yaml", sys.argv[-1]) if isinstance(word, str) else word for word in error.args)
        )

    monkeypatch.setattr(several, "read_scenario", broken)
    form = Format((GRID,), FORMATS["scenario"].files)
    with pytest.raises((Exception, SystemExit)) as caught:
        hunt("planted", form.seeds, lambda contents: attempt(form, watched, contents))
    assert fault in f"{type(caught.value).__name__}: {caught.value}"
    assert any("contents=" in note for note in caught.value.__notes__)


@pytest.mark.parametrize(
    ("fault", "text"),
    [(lambda *_: time.sleep(60), "got no answer after 0.3 s"), (lambda *_: bytearray(2**50), None)],
    ids=["time", "memory"],
)
def test_a_bomb_is_found(fault: Any, text: str, watched: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A reader that takes all the time or all the memory is stopped, and found."""
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(yaml, "compose", fault)
    told, _, _ = watched
    with pytest.raises((AssertionError, MemoryError), match=text):
        told(["check", str(lay(FORMATS["scenario"], GRID))], 0.3)


def command(*words: object) -> tuple[int, list[str]]:
    """The exit code of the real command, and the lines of its error output."""
    environment = {**os.environ, "PYTHONPATH": str(Path(fogbench.__file__).parents[1]), "COLUMNS": "200"}
    line = ["sh", "-c", 'ulimit -v 16000000; exec "$@"', "sh", sys.executable, "-m", "fogbench", *map(str, words)]
    done = subprocess.run(line, env=environment, capture_output=True, text=True, check=False, timeout=300)
    return done.returncode, done.stderr.splitlines()


@pytest.mark.parametrize(
    "names", [("scenario",), tuple(FORMATS.keys() - {"scenario", "recipe"})], ids=["pages", "files"]
)
def test_damage_through_the_command(
    names: tuple[str, ...],
    watched: Any,
    request: pytest.FixtureRequest,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    """The real command tells of many damaged files at once, and plays those with which it is content."""
    monkeypatch.chdir(tmp_path)
    told, judge, damage = watched
    long = bool(request.config.getoption("fuzz_minutes", 0))
    luck, forms = Random(1), [FORMATS[name] for name in sorted(names)]
    places = [lay(form, damage(luck, form.seeds)) for form in forms for _ in range(200 if long else 60 // len(forms))]
    code, lines = command("check", *places)
    stems = [place.name.partition(".")[0] for place in places]
    assert code == 2
    for line in lines:
        judge(2, [line], next((stem for stem in stems if stem in line), "one of the files"))
    content = [place for place in places if told(["check", str(place)]) == (0, [])]
    assert content
    for place in content[: 20 if long else 2]:
        assert command("run", place, "--episodes", 1, "--workers", 1) == (0, [])


def test_a_damaged_recipe_trains_nothing(watched: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The real command tells of a recipe what reading it tells, and leaves nothing behind."""
    monkeypatch.chdir(tmp_path)
    _, _, damage = watched
    luck = Random(2)
    recipes = (lay(FORMATS["recipe"], damage(luck, (RECIPE,))) for _ in range(100))
    broken = next(recipe for recipe in recipes if read(recipe, watched)[0])
    assert command("train", broken) == read(broken, watched)
    assert not Path("results").exists()
