"""What a network sees of a grid: what is kept of an episode, how it becomes tensors, and what its outputs mean."""

from collections.abc import Sequence
from pkgutil import resolve_name
from typing import TYPE_CHECKING, Protocol

import numpy as np

from fogbench.learned.encoding.grid_inputs import STILL, Inputs, Known, encode
from fogbench.learned.encoding.grid_sizes import OUTPUTS, SIGHT, Frame
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.types import BLOCKED, DELTAS, FREE, UNKNOWN, Array, Cell, Move, Observation, Task

if TYPE_CHECKING:
    from fogbench.learned.encoding.viewpoints import Viewpoints

BESIDE = SIGHT + np.array(DELTAS)  # [4, 2] where a sight shows the cells that the four moves lead to


class Shown(Protocol):
    """What the settings of a policy say of what it is shown; see `fogbench.learned.grid_policy.GridPolicy`."""

    @property
    def frame(self) -> Frame:
        """What the image shows of the world."""

    @property
    def stitched(self) -> bool:
        """Whether the map known so far is shown; else, the current view alone."""


class GridViewpoint:
    """What is kept of an episode: the last move and, if it is shown, the map known so far; a look until the move."""

    observation: Observation
    """Of the look that no move has followed yet."""

    def __init__(self, task: Task, stitched: bool) -> None:
        """Nothing is seen yet."""
        self.goal: Cell = task.goal
        self.known = KnownMap(task.extent) if stitched else None
        self.move = STILL

    def see(self, observation: Observation) -> None:
        """Look."""
        self.observation = observation
        if self.known:
            self.known.update(observation)

    def act(self, output: int) -> Move:
        """Remember a move, and no more of the look than is on the map."""
        del self.observation  # or it would be carried to the next decision
        self.move = output
        return Move(output)

    @property
    def bytes(self) -> int:
        """The known map."""
        return self.known.cells.nbytes if self.known else 0


class GridEncoding:
    """The image that is planned on, the cells around the agent, and its compass; the outputs are the four moves."""

    outputs = OUTPUTS

    def __init__(self, settings: Shown) -> None:
        """Show what the settings say."""
        self.frame = settings.frame
        self.stitched = settings.stitched

    def start(self, task: Task) -> GridViewpoint:
        """A viewpoint from which nothing was seen.

        Raises:
            Mistake: a network that was made for maps of one size meets another.
        """
        self.frame.check(task.extent)
        return GridViewpoint(task, self.stitched)

    def side_by_side(self, slots: int) -> "Viewpoints":
        """Viewpoints of so many episodes; they are named by a string, for no single episode depends on them."""
        kind = resolve_name("fogbench.learned.encoding.grid_batch:GridViewpoints")
        made: Viewpoints = kind(slots, self.frame, stitched=self.stitched)
        return made

    def encode(self, viewpoints: Sequence[GridViewpoint]) -> Inputs:
        """What a network sees from some viewpoints."""
        return encode(gather(viewpoints), self.frame)

    def open(self, inputs: Inputs) -> Array:
        """[B, 4] bool, the moves that are not seen to run into an obstacle."""
        beside = inputs.sight[:, BLOCKED - FREE, BESIDE[:, 0], BESIDE[:, 1]]
        is_open: Array = (beside == 0).numpy()
        return is_open


def gather(viewpoints: Sequence[GridViewpoint]) -> Known:
    """What is known from some viewpoints of one encoding, on maps of any sizes, with views of any sizes."""
    observations = [viewpoint.observation for viewpoint in viewpoints]
    places = np.array([observation.place for observation in observations], np.int64)  # [B, 2]
    maps = [viewpoint.known.cells for viewpoint in viewpoints if viewpoint.known]
    cells, corners = _maps(maps) if maps else _views([observation.view for observation in observations], places)
    goals = np.array([viewpoint.goal for viewpoint in viewpoints], np.int64)
    moves = np.array([viewpoint.move for viewpoint in viewpoints], np.int64)
    blocked = np.array([observation.blocked for observation in observations])
    return Known(cells, corners, places, goals, moves, blocked)


def _views(views: Sequence[Array], places: Array) -> tuple[Array, Array]:
    """Cells [B, K, K], K of the widest view, and corners [B, 2] of views around `places` [B, 2]."""
    side = max(map(len, views))
    cells = np.full((len(views), side, side), UNKNOWN, np.uint8)
    for b, view in enumerate(views):
        rim = (side - len(view)) // 2
        cells[b, rim : side - rim, rim : side - rim] = view
    return cells, places - side // 2


def _maps(maps: Sequence[Array]) -> tuple[Array, Array]:
    """Cells [B, H + 2, W + 2], of the highest and the widest map, and corners [B, 2] of known maps [h, w]."""
    height, width = np.max([known.shape for known in maps], 0)
    cells = np.full((len(maps), height + 2, width + 2), UNKNOWN, np.uint8)
    for b, known in enumerate(maps):
        rows, columns = known.shape
        cells[b, : rows + 2, : columns + 2] = BLOCKED  # beyond the map, as in a view
        cells[b, 1 : rows + 1, 1 : columns + 1] = known
    return cells, np.full((len(maps), 2), -1, np.int64)
