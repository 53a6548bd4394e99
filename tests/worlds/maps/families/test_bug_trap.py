"""Bug traps."""

from typing import Any

import numpy as np
import pytest
from pydantic import ValidationError
from scipy.ndimage import label

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.bug_trap import BugTrap
from fogbench.worlds.maps.layout import Layout
from fogbench.worlds.types import Array

CONDITIONS = GridConditions.model_validate({"budget": {"steps": 100}})
LIPS = """
.......
.#####.
.#...#.
.#...#.
.#...#.
.##.##.
.......
"""
NO_LIPS = LIPS.replace(".##.##.", ".......")


def parse(drawing: str) -> Array:
    """A drawing as a map."""
    return np.array([[letter == "#" for letter in row] for row in drawing.split()])


def draws(count: int, **fields: Any) -> list[Layout]:
    """Traps, one after the other from one generator."""
    rng = np.random.default_rng(0)
    return [BugTrap.model_validate(fields).draw(rng, CONDITIONS) for _ in range(count)]


@pytest.mark.parametrize(("drawing", "lip"), [(LIPS, 1), (NO_LIPS, 0)])
def test_the_trap_looks_as_drawn_by_hand_in_every_orientation(drawing: str, lip: int) -> None:
    """In the smallest square, the trap is one of the four rotations of a drawing by hand, each of them drawn."""
    layouts = draws(100, size=7, depth=(3, 3), width=(3, 3), lip=(lip, lip))
    rotations = {np.rot90(parse(drawing), k).tobytes() for k in range(4)}
    assert len(rotations) == 4
    assert {layout.blocked.tobytes() for layout in layouts} == rotations


def test_start_and_goal_lie_on_either_side_of_the_closed_end() -> None:
    """With the closed end up, all nine cells inside are starts, and all three cells above the trap are goals."""
    layouts = draws(800, size=7, depth=(3, 3), width=(3, 3), lip=(1, 1))
    upright = [layout for layout in layouts if np.array_equal(layout.blocked, parse(LIPS))]
    assert {layout.start for layout in upright} == {(r, c) for r in (2, 3, 4) for c in (2, 3, 4)}
    assert {layout.goal for layout in upright} == {(0, c) for c in (2, 3, 4)}


def test_sizes_and_places_are_drawn_from_their_whole_ranges() -> None:
    """Every depth, width and lip is drawn, the trap reaches each side but one cell, and the outside stays connected."""
    found, reached = set(), set()
    for layout in draws(600, size=12, depth=(2, 3), width=(5, 6), lip=(1, 2)):
        assert layout.start is not None
        rows, columns = np.nonzero(layout.blocked)
        reached |= {("top", rows.min()), ("left", columns.min()), ("bottom", rows.max()), ("right", columns.max())}
        hull = np.zeros_like(layout.blocked)
        hull[rows.min() : rows.max() + 1, columns.min() : columns.max() + 1] = True
        mouth = hull & ~layout.blocked
        mouth[rows.min() + 1 : rows.max(), columns.min() + 1 : columns.max()] = False
        inside = label(~layout.blocked & ~mouth)[0]
        cells = np.argwhere(inside == inside[layout.start])
        sides = np.sort(np.ptp(cells, axis=0) + 1)
        found.add((*sides.tolist(), int(mouth.sum())))
        assert label(~layout.blocked & ~hull)[1] == label(~layout.blocked)[1] == 1
    assert found == {(d, w, w - 2 * lip) for d in (2, 3) for w in (5, 6) for lip in (1, 2)}
    assert {side for side, at in reached if at == (1 if side in ("top", "left") else 10)} == {
        "top",
        "left",
        "bottom",
        "right",
    }
    assert all(1 <= at <= 10 for _, at in reached)


@pytest.mark.parametrize(
    ("fields", "text"),
    [
        ({"size": 10, "depth": (3, 7), "width": (3, 4)}, "a size from 11, for depth 7 and width 4"),
        ({"size": 10, "depth": (3, 4), "width": (4, 6), "lip": (0, 2)}, "a width from 5, for lips of 2"),
    ],
)
def test_a_trap_that_does_not_fit_is_refused(fields: dict[str, Any], text: str) -> None:
    """The error says the least that would do."""
    with pytest.raises(ValidationError) as error:
        BugTrap.model_validate(fields)
    assert [mistake["msg"] for mistake in error.value.errors()] == [f"Value error, {text}"]
