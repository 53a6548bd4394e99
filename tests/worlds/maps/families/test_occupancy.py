"""Recorded floor maps."""

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.occupancy import Occupancy
from fogbench.worlds.maps.fixed import ONE_TASK
from fogbench.worlds.types import Array, MapError

YAML = "image: x.pgm\nresolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"
GREY = {".": "254", "#": "0", "?": "205"}
FLOOR = """
???????
?.....?
?.#..??
?.....?
?.....?
???????
"""


def family(folder: Path, floor: str = FLOOR, **fields: Any) -> Occupancy:
    """A drawn floor as files: `.` free, `#` occupied, `?` unknown."""
    folder.mkdir(parents=True, exist_ok=True)
    rows = floor.split()
    pixels = " ".join(GREY[letter] for row in rows for letter in row)
    (folder / "x.yaml").write_text(YAML)
    (folder / "x.pgm").write_text(f"P2\n{len(rows[0])} {len(rows)}\n255\n{pixels}\n")
    return Occupancy(map=folder / "x.yaml", **fields)


def sample(maps: Occupancy, seed: int = 0, **blocks: Any) -> Any:
    """A world."""
    under = GridConditions.model_validate({"budget": {"steps": 400}, **blocks})
    return maps.sample(np.random.default_rng(seed), 0, under)


@pytest.mark.parametrize(("downsample", "expected"), [(1, [".....", ".#..#", ".....", "....."]), (2, ["#.#", "..#"])])
def test_maps_are_cropped_and_coarsened_by_hand(tmp_path: Path, downsample: int, expected: list[str]) -> None:
    """The unknown border goes; a coarse cell is blocked if any of its cells is, or sticks out over the border."""
    blocked = sample(family(tmp_path, downsample=downsample)).blocked
    assert ["".join(row) for row in np.where(blocked, "#", ".").tolist()] == expected


def test_tasks_are_drawn_over_all_free_cells(tmp_path: Path) -> None:
    """Every free cell is a start and a goal; equal generators give equal tasks; any number can be drawn."""
    maps = family(tmp_path)
    drawn = [sample(maps, seed) for seed in range(300)]
    free = set(map(tuple, np.argwhere(~drawn[0].blocked).tolist()))
    assert {found.start for found in drawn} == {found.task.goal for found in drawn} == free
    assert sample(maps, 5).start == drawn[5].start
    assert maps.tasks(GridConditions.model_validate({"budget": {"steps": 9}}), 1) is None


def test_episodes_share_one_read_only_map(tmp_path: Path) -> None:
    """The image is read once, and nobody can change the map."""
    maps = family(tmp_path)
    assert sample(maps, 0).blocked is sample(maps, 1).blocked
    assert not sample(maps).blocked.flags.writeable


def test_words_hold_the_contents_and_not_the_place(tmp_path: Path) -> None:
    """The words are equal for equal files anywhere, and differ with the YAML, the image and the downsampling."""
    here, there = family(tmp_path / "here"), family(tmp_path / "there")
    words = here.words()
    assert words == there.words()
    assert family(tmp_path / "coarse", downsample=2).words() != words
    assert family(tmp_path / "other", FLOOR.replace("#", ".")).words() != words
    (tmp_path / "here/x.yaml").write_text(YAML.replace("0.65", "0.66"))
    assert here.words() != words


def test_broken_floors_are_one_line(tmp_path: Path) -> None:
    """A missing image, a missing YAML, an unknown floor and impossible bounds name the file."""

    def text(maps: Occupancy, **blocks: Any) -> str:
        with pytest.raises(MapError) as error:
            sample(maps, **blocks)
        return str(error.value)

    maps = family(tmp_path)
    far = text(maps, tasks={"distance": [50, 60]})
    bounds = "an optimum of 50 to 60 cells (set by `tasks: {distance: ...}`)"
    assert far == f"{tmp_path}/x.yaml: no task with {bounds} was found"
    unknown = text(family(tmp_path, "??\n??"))
    assert unknown == f"{tmp_path}/x.pgm: got only unknown cells; expected some that are free"
    (tmp_path / "x.pgm").unlink()
    assert text(maps) == f"{tmp_path}/x.pgm: no such file or directory; give a file that can be read"
    assert text(Occupancy(map=tmp_path / "y.yaml")).startswith(f"{tmp_path}/y.yaml: no such file")
    (tmp_path / "y.png").write_bytes(b"\x89PNG\r\n\x1a\n")
    pictured = f"{tmp_path}/y.png:1:1  got an image; expected the YAML file that names it by `image: ...`."
    assert text(Occupancy(map=tmp_path / "y.png")) == pictured


def plain(path: Path) -> Array:
    """A real floor, read byte by byte: the known part of a P5 image with one comment, free where 206 or lighter."""
    _, _, size, _, pixels = path.read_bytes().split(b"\n", 4)
    width, height = map(int, size.split())
    grey = np.frombuffer(pixels, np.uint8, count=height * width).reshape(height, width)
    known = (grey > 205) | (grey < 90)
    rows, columns = np.flatnonzero(known.any(1)), np.flatnonzero(known.any(0))
    return (grey <= 205)[rows[0] : rows[-1] + 1, columns[0] : columns[-1] + 1]


@pytest.mark.maps
@pytest.mark.parametrize("name", ["maze", "office02", "office02_partially_unknown", "room02"])
@pytest.mark.parametrize("downsample", [1, 3])
def test_real_floors_equal_a_plain_reading(name: str, downsample: int) -> None:
    """The map of a real floor is what its bytes say, and a coarse cell is blocked where any cell of its square is."""
    folder = Path(os.environ["FOGBENCH_MAPS"], "ros", name)
    blocked, fine = sample(Occupancy(map=folder / "map.yaml", downsample=downsample)).blocked, plain(folder / "map.pgm")
    height, width = fine.shape
    assert blocked.shape == (-(-height // downsample), -(-width // downsample))
    for (r, c), value in np.ndenumerate(blocked):
        top, left = r * downsample, c * downsample
        square = fine[top : top + downsample, left : left + downsample]
        assert value == (square.any() or square.shape != (downsample, downsample))


ROS_2 = YAML.replace("0.196", "0.25")


def test_unknown_cells_of_ros_2_are_blocked_and_counted(tmp_path: Path) -> None:
    """A free_thresh of 0.25 beside grey 205 gives the map that 0.196 gives, and says what it did."""
    expected = sample(family(tmp_path / "here")).blocked
    maps = family(tmp_path)
    (tmp_path / "x.yaml").write_text(ROS_2)
    assert np.array_equal(sample(maps).blocked, expected)
    why = "which map_saver writes for unknown, though free_thresh 0.25 calls them free"
    assert maps.notes() == [f"{tmp_path}/x.pgm: 23 cells of grey 205 are blocked, {why}"]
    assert family(tmp_path / "here").notes() == []


def test_cells_between_the_thresholds_are_counted(tmp_path: Path) -> None:
    """In mode scale, grey 205 is a probability of 0.196, neither free nor occupied."""
    maps = family(tmp_path, "???\n?.#")
    (tmp_path / "x.yaml").write_text(YAML + "mode: scale\n")
    assert maps.notes() == [f"{tmp_path}/x.pgm: 4 cells between free_thresh and occupied_thresh are blocked"]


def test_a_fixed_task_in_cells(tmp_path: Path) -> None:
    """Cells count in the cropped and coarsened map; every episode plays the task, whose words are its own."""
    maps = family(tmp_path, downsample=2, start=(0, 1), goal=(1, 0))
    assert maps.notes()[-1].endswith(ONE_TASK)
    maps = maps.model_copy(update={"goal": (1, 1)})
    for seed in (0, 1):
        world = sample(maps, seed)
        assert (world.start, world.task.goal, world.shortest()) == ((0, 1), (1, 1), 1.0)
    assert maps.words() == family(tmp_path, downsample=2).words() + " start=(0, 1) goal=(1, 1)"


@pytest.mark.parametrize(
    ("origin", "start", "goal"),
    [
        ("[0, 0, 0]", (0.15, 0.15), (0.55, 0.45)),
        ("[0, 0, 0]", (0.1, 0.1), (0.5, 0.4)),
        ("[-19.0, 2, 0]", (-18.85, 2.15), (-18.45, 2.45)),
        ("[0, 0, 1.5707963267948966]", (-0.15, 0.15), (-0.45, 0.55)),
    ],
)
def test_a_fixed_task_in_metres(
    tmp_path: Path, origin: str, start: tuple[float, float], goal: tuple[float, float]
) -> None:
    """Metres count from the lower left corner, turned by its yaw; the ends are the lower left and upper right cells."""
    ends = {name: {"x": x, "y": y} for name, (x, y) in (("start", start), ("goal", goal))}
    maps = family(tmp_path, **ends)
    (tmp_path / "x.yaml").write_text(YAML.replace("[0, 0, 0]", origin))
    world = sample(maps)
    assert (world.start, world.task.goal) == ((3, 0), (0, 4))


@pytest.mark.parametrize(
    ("start", "goal", "text"),
    [
        ((1, 1), (0, 0), "start [1, 1]: got an obstacle; expected a free cell"),
        (
            (0, 0),
            (0, 5),
            "goal [0, 5]: got a cell outside of the map; expected a row from 0 to 3 and a column from 0 to 4",
        ),
        (
            (0, 0),
            {"x": 1e6, "y": -1e6},
            (
                "goal {x: 1e+06, y: -1e+06}, cell [10000004, 9999999]: got a cell outside of the map; "
                "expected a row from 0 to 3 and a column from 0 to 4"
            ),
        ),
        (
            (0, 0),
            (0, 1),
            (
                "goal [0, 1]: got a shortest path of 1 cell from the start [0, 0]; expected an optimum of 2 to 9 cells "
                "(set by `tasks: {distance: ...}`)"
            ),
        ),
    ],
)
def test_a_fixed_task_that_cannot_be_is_one_line(tmp_path: Path, start: Any, goal: Any, text: str) -> None:
    """The line says which end is wrong, and why."""
    with pytest.raises(MapError) as error:
        sample(family(tmp_path, start=start, goal=goal), tasks={"distance": [2, 9]})
    assert str(error.value) == f"{tmp_path}/x.yaml: {text}"


def test_half_a_task_is_refused(tmp_path: Path) -> None:
    """A task has two ends."""
    with pytest.raises(ValidationError, match="start and goal, or neither"):
        family(tmp_path, start=(0, 0))
