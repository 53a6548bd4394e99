"""What is kept of an episode on a grid, which moves are open, and how several viewpoints are gathered."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fogbench.learned.encoding.grid import GridEncoding, gather
from fogbench.learned.encoding.grid_inputs import STILL
from fogbench.learned.vin import Vin
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import BLOCKED, UNKNOWN, Move


def seen_from(encoding: GridEncoding, world: GridWorld) -> Any:
    """A viewpoint after the first look in a world."""
    viewpoint = encoding.start(world.task)
    viewpoint.see(world.sense(world.reset(), np.random.default_rng()))
    return viewpoint


def test_the_outputs_are_the_moves() -> None:
    """By name, in the order of `Move`."""
    assert GridEncoding(Vin(checkpoint="none")).outputs == tuple(move.name.lower() for move in Move)


def test_a_move_is_remembered(draw: Callable[..., GridWorld]) -> None:
    """Before the first there is none."""
    world = draw("S..\n..G")
    for move in Move:
        viewpoint = seen_from(GridEncoding(Vin(checkpoint="none")), world)
        assert viewpoint.move == STILL
        assert viewpoint.act(int(move)) is move
        assert viewpoint.move == move


@pytest.mark.parametrize(("stitched", "carried"), [(True, 6), (False, 0)])
def test_only_a_stitched_map_is_carried(stitched: bool, carried: int, draw: Callable[..., GridWorld]) -> None:
    """A byte for each of its cells; it knows what was seen."""
    viewpoint = seen_from(GridEncoding(Vin(checkpoint="none", stitched=stitched)), draw("S..\n..G", radius=1))
    assert viewpoint.bytes == carried
    if stitched:
        assert (viewpoint.known.cells != UNKNOWN).sum() == 4


def test_moves_into_an_obstacle_in_view_are_not_open(draw: Callable[..., GridWorld]) -> None:
    """Nor are those off the map; what is not seen counts as open."""
    encoding = GridEncoding(Vin(checkpoint="none"))
    viewpoints = [seen_from(encoding, draw(text, radius=1)) for text in ("S#G\n...", "...\n.S.\n.#G")]
    opened = encoding.open(encoding.encode(viewpoints))
    assert opened.tolist() == [[True, False, False, False], [False, True, True, True]]


def test_views_and_maps_of_several_sizes_lie_side_by_side(draw: Callable[..., GridWorld]) -> None:
    """A smaller view lies in the middle of unknown cells; around a smaller map is a wall, and nothing beyond."""
    worlds = [draw("S.G", radius=1), draw("S...\n...G", radius=2)]
    views = gather([seen_from(GridEncoding(Vin(checkpoint="none")), world) for world in worlds])
    assert (views.cells.shape, views.corners.tolist()) == ((2, 5, 5), [[-2, -2], [-2, -2]])
    assert (views.cells[0, [0, -1]] == UNKNOWN).all()
    maps = gather([seen_from(GridEncoding(Vin(checkpoint="none", stitched=True)), world) for world in worlds])
    assert (maps.cells.shape, maps.corners.tolist()) == ((2, 4, 6), [[-1, -1], [-1, -1]])
    assert (maps.cells[0, 2, :5] == BLOCKED).all()
    assert (maps.cells[0, 3] == UNKNOWN).all()


def test_a_network_for_maps_of_one_size_meets_no_other(draw: Callable[..., GridWorld]) -> None:
    """Nothing is kept of such an episode."""
    with pytest.raises(Mistake, match=r"^got a map of 2x3; expected 4x4, the size$"):
        GridEncoding(Vin(checkpoint="none", reading="map", size=(4, 4))).start(draw("S..\n..G").task)
