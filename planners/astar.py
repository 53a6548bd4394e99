"""A* on the map seen so far: the same-information reference (Hart, Nilsson & Raphael 1968).

Words used here
    g   cost of the best path found to a cell;  h  Manhattan distance to the goal;  f = g + h
"""

from typing import ClassVar, Literal

import numpy as np

from fogbench.planners.graph.astar import GraphAStarAgent
from fogbench.planners.robot.agent import RobotAgent
from fogbench.planners.robot.guides import AStarGuide
from fogbench.planners.route import Route
from fogbench.worlds.kernel import kernel
from fogbench.worlds.maps.cells import KnownMap, fuse
from fogbench.worlds.maps.distances import FAR
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import BLOCKED, DELTAS, Agent, Array, Cell, Move, Observation, Task

STEPS = np.array(DELTAS, np.int64)  # [4, 2]


class AStar(Settings):
    """Plans on the known map, unknown counts as free, and follows its path until a blocked cell cuts it."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid", "graph", "robot"})

    replan: Literal["cut", "change"] = "cut"
    """Plan again when the path is cut (the reference), or whenever any reading of the known map has changed; on a graph
    it plans at each node."""

    def start(self, task: Task, rng: np.random.Generator) -> Agent:
        """A fresh agent; it needs no luck."""
        del rng
        if task.kind == "graph":
            return GraphAStarAgent(task)
        eager = self.replan == "change"
        if task.kind == "robot":
            return RobotAgent(task, AStarGuide(task, eager=eager))
        return AStarAgent(task, eager=eager)

    def parameter_bytes(self) -> int:
        """Nothing is learned."""
        return 0


class AStarAgent:
    """One episode of A*."""

    def __init__(self, task: Task, *, eager: bool, known: KnownMap | None = None) -> None:
        """Plan towards the task's goal, on a known map of its own if none is given; `eager` plans at every change."""
        self.goal: Cell = task.goal
        self.eager = eager
        self.known = known or KnownMap(task.extent)
        self.route = Route(np.empty(0, np.int32), self.known.cells.shape[1])
        self.expanded = 0

    def act(self, observation: Observation) -> Move | None:
        """The next move of the path; on a map that false readings have closed, of a path on the current view alone."""
        touched = self.known.update(observation)
        return self.follow(observation, replan=self.eager and len(touched) > 0)

    def follow(self, observation: Observation, *, replan: bool = False) -> Move | None:
        """The same, where the known map has the observation already; `replan` leaves the old path."""
        place, cells = observation.place, self.known.cells
        move = None if replan else self.route.move(place, cells)
        if move is not None:
            return move
        path, expanded = search(cells, place, self.goal)
        self.expanded += expanded
        self.route = Route(path, cells.shape[1])
        move = self.route.move(place, cells)
        if move is None:  # `Move.DOWN` is 0, and false
            move, expanded = glance(self.goal, cells.shape, observation)
            self.expanded += expanded
        return move

    def memory_bytes(self) -> int:
        """The known map and the path."""
        return self.known.cells.nbytes + self.route.cells.nbytes

    def search_nodes(self) -> int:
        """Cells expanded so far."""
        return self.expanded


def glance(goal: Cell, extent: tuple[int, ...], observation: Observation) -> tuple[Move | None, int]:
    """The first move of a shortest path on the current view alone, everything else unknown, and the cells expanded."""
    cells = np.zeros(extent, np.uint8)  # [H, W]
    fuse(cells, observation.view, *observation.place)
    path, expanded = search(cells, observation.place, goal)
    return Route(path, extent[1]).move(observation.place, cells), expanded


@kernel
def search(known: Array, start: Cell, goal: Cell) -> tuple[Array, int]:
    """A shortest 4-connected path over cells that are not known to be blocked; ties by larger g, then first generated.

    On a unit-cost grid `f` grows by 0 or 2 with each move, so the open list is a stack of cells with the current `f`,
    deepest on top, and a list of those with the next. Sorting each new list once by `g` makes the order exactly that of
    a heap of `(f, -g, order of generation)`, without its logarithm.

    Args:
        known: [H, W] uint8 of UNKNOWN, FREE, BLOCKED.
        start: a cell.
        goal: a cell; a blocked one is out of reach.

    Returns:
        [n] int32, flat indices of the path with both ends, empty if there is none; and the number of expanded cells.
    """
    height, width = known.shape
    g = np.full(height * width, FAR, np.int32)
    parent = np.empty(height * width, np.int32)
    closed = np.zeros(height * width, np.bool_)
    stack = np.empty(4 * height * width + 1, np.int32)  # a cell is generated at most once by each neighbour
    layer = np.empty_like(stack)  # cells of the next f, in the order of their generation
    same_f = np.empty(2, np.int32)
    begin, end = start[0] * width + start[1], goal[0] * width + goal[1]
    g[begin] = 0
    stack[0] = begin
    depth, waiting, expanded = 1, 0, 0
    while depth:
        while depth:
            depth -= 1
            cell = stack[depth]
            if closed[cell]:
                continue
            closed[cell] = True
            expanded += 1
            if cell == end:
                return _path(parent, begin, end, g[end]), expanded
            r, c = cell // width, cell % width
            nearer = 0
            for move in range(4):
                i, j = r + STEPS[move, 0], c + STEPS[move, 1]
                if not (0 <= i < height and 0 <= j < width) or known[i, j] == BLOCKED:
                    continue
                neighbour = i * width + j
                if g[cell] + 1 >= g[neighbour]:
                    continue
                g[neighbour] = g[cell] + 1
                parent[neighbour] = cell
                if abs(goal[0] - i) + abs(goal[1] - j) < abs(goal[0] - r) + abs(goal[1] - c):
                    same_f[nearer] = neighbour
                    nearer += 1
                else:
                    layer[waiting] = neighbour
                    waiting += 1
            while nearer:  # the first move ends on top
                nearer -= 1
                stack[depth] = same_f[nearer]
                depth += 1
        _stack_by_g(g, layer[:waiting], stack)
        depth, waiting = waiting, 0
    return np.empty(0, np.int32), expanded


@kernel
def _stack_by_g(g: Array, layer: Array, stack: Array) -> None:
    """Lay `layer` on the empty stack so that the largest g is on top and, among equals, the first generated."""
    if len(layer) == 0:
        return
    least = FAR
    most = 0
    for cell in layer:
        least, most = min(least, g[cell]), max(most, g[cell])
    top = np.zeros(most - least + 2, np.int64)  # top[k + 1]: cells with g <= least + k
    for cell in layer:
        top[g[cell] - least + 1] += 1
    for k in range(len(top) - 1):
        top[k + 1] += top[k]
    for cell in layer:
        k = g[cell] - least + 1
        top[k] -= 1
        stack[top[k]] = cell


@kernel
def _path(parent: Array, begin: int, end: int, length: int) -> Array:
    path = np.empty(length + 1, np.int32)
    cell = end
    for k in range(length, 0, -1):
        path[k] = cell
        cell = parent[cell]
    path[0] = begin
    return path
