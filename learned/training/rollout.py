"""Episodes side by side: each in a world of its own, with one network for all of them.

Worlds, known maps and what a network sees are those of single episodes. A rollout keeps the way back to the weights,
unless PyTorch is told not to, so that what was played is learned from as it is.

Words used here
    B   episodes;  b  those of them that go on
    n   decisions of all episodes, step by step
"""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.encoding.grid import STILL, Known, encode, gather
from fogbench.learned.encoding.grid_sizes import SIGHT
from fogbench.learned.grid_policy import GridPolicy
from fogbench.learned.networks.network import Network, rows
from fogbench.planners.optimal import OptimalMoves, nearer
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import KnownMap
from fogbench.worlds.maps.distances import distances
from fogbench.worlds.types import BLOCKED, DELTAS, FREE, Array, Move, Observation

BESIDE = SIGHT + np.array(DELTAS)  # [4, 2] where a sight shows the cells that the four moves lead to


class Moment(NamedTuple):
    """One step of the episodes that go on."""

    step: int
    episodes: Array
    """[b] int64, which they are."""
    scores: Array
    """[b, 4] float32, what the network says of the moves."""
    optimal: Array
    """[b, 4] bool, the moves that each episode says are optimal; none where that is undefined."""
    open: Array
    """[b, 4] bool, the moves that are not seen to run into an obstacle."""


class Chooser(Protocol):
    """**Protocol:** what decides by the scores of a network."""

    def __call__(self, moment: Moment) -> Array:
        """The moves [b] int64."""


class Rollout(NamedTuple):
    """All decisions of some episodes."""

    scores: Tensor
    """[n, 4]"""
    optimal: Tensor
    """[n, 4] bool, the moves that each episode said were optimal; none where that is undefined."""
    moves: Tensor
    """[n] int64, what was done."""
    reached: Array
    """[B] bool, whether the episode ended at the goal."""

    @property
    def judged(self) -> Tensor:
        """[n] bool, the decisions that have an optimal move."""
        return self.optimal.any(1)

    def wrong(self) -> Tensor:
        """[n] bool, the decisions that are judged, and are none of the optimal moves."""
        right: Tensor = self.optimal.gather(1, self.moves[:, None])[:, 0]
        return self.judged & ~right


def roll(settings: GridPolicy, network: Network, episodes: Sequence["Episode"], choose: Chooser) -> Rollout:
    """Play episodes to their ends.

    Raises:
        Mistake: a network that was made for maps of one size meets another.
    """
    (frame,) = {settings.shown(episode.world.task) for episode in episodes}
    live, state = np.arange(len(episodes)), network.blank((len(episodes),))
    decisions: list[tuple[Tensor, Tensor, Tensor]] = []
    while len(live):
        playing = [episodes[b] for b in live.tolist()]
        optimal = np.stack([episode.look() for episode in playing])  # [b, 4]
        inputs = encode(_known(playing, settings.stitched), frame)
        beside = inputs.sight[:, BLOCKED - FREE, BESIDE[:, 0], BESIDE[:, 1]].numpy()  # [b, 4]
        scores, state = network(inputs.to(settings.device), state)
        moves = choose(Moment(len(decisions), live, scores.detach().cpu().numpy(), optimal, beside == 0))
        decisions.append((scores, torch.from_numpy(optimal), torch.from_numpy(moves)))
        goes_on = np.array([episode.step(move) for episode, move in zip(playing, moves.tolist(), strict=True)])
        if not goes_on.all():
            live, state = live[goes_on], rows(state, torch.from_numpy(goes_on))
    scores, right, done = (torch.cat(parts) for parts in zip(*decisions, strict=True))  # [n, 4], [n, 4], [n]
    reached = np.array([episode.reached for episode in episodes])
    return Rollout(scores, right.to(scores.device), done.to(scores.device), reached)


def _known(episodes: Sequence["Episode"], stitched: bool) -> Known:
    return gather(
        [episode.observation for episode in episodes],
        [episode.world.task.goal for episode in episodes],
        [episode.move for episode in episodes],
        [episode.known.cells for episode in episodes] if stitched else None,
    )


def greedy(moment: Moment) -> Array:
    """The moves of the highest scores; of equals, the first: as a policy decides in an episode."""
    best: Array = moment.scores.argmax(1)
    return best


class Episode:
    """One world, and what is known of it."""

    observation: Observation
    """Of the last look."""

    def __init__(self, world: GridWorld, luck: np.random.Generator) -> None:
        """Before the first step; `luck` is for the sensor and the slip."""
        self.world = world
        self.luck = luck
        self.state = world.reset()
        self.known = KnownMap(world.task.extent)
        self.optimal = OptimalMoves(world.task)
        self.move = STILL
        self.reached = False

    def look(self) -> Array:
        """Sense, and write what is seen into the known map: which moves are optimal there, [4] bool."""
        self.observation = self.world.sense(self.state, self.luck)
        self.known.update(self.observation)
        reach = len(self.observation.view) // 2
        optimal: Array = self.optimal.update(self.known.cells, self.observation.place, reach)
        return optimal

    def step(self, move: int) -> bool:
        """Do a move; whether the episode goes on."""
        step = self.world.step(self.state, Move(move), self.luck)
        self.state, self.move, self.reached = step.state, move, step.reached
        return not (step.reached or step.collided or self.state.step >= self.world.task.budget.steps)


class Hindsight(Episode):
    """One world, where of the moves that are optimal by what is known those count that turn out to be, if any does.

    Which of equals turns out better depends on what lies out of sight; over many maps it tells where walls are likely.
    """

    def __init__(self, world: GridWorld, luck: np.random.Generator) -> None:
        """Before the first step."""
        super().__init__(world, luck)
        self.distance = distances(world.blocked, world.task.goal, (-1, -1))  # [H, W], on the full map

    def look(self) -> Array:
        """Sense, and write what is seen into the known map: which moves count, [4] bool."""
        optimal = super().look()
        task, place = self.world.task, self.observation.place
        best: Array = optimal & nearer(self.world.blocked, self.distance, place, task.goal)
        return best if best.any() else optimal
