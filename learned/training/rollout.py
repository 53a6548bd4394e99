"""Episodes side by side: each in a world of its own, with one network for all of them.

Worlds, teachers and what a network sees are those of single episodes, in one call for all where their kind allows it. A
rollout keeps the way back to the weights, unless PyTorch is told not to, so that what was played is learned from as it
is.

Words used here
    B   episodes;  b  those of them that go on
    n   decisions of all episodes, step by step
    A   outputs of the network
"""

from collections.abc import Sequence
from typing import NamedTuple, Protocol

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.encoding.viewpoints import viewpoints_of
from fogbench.learned.networks.network import Network, rows
from fogbench.learned.policy import Policy
from fogbench.planners.teachers import Teachers
from fogbench.worlds.batch import Luck, batch_of
from fogbench.worlds.types import Array, World


class Turn(NamedTuple):
    """One step of the episodes that go on."""

    step: int
    episodes: Array
    """[b] int64, which they are."""
    scores: Array
    """[b, A] float32, what the network says of its outputs."""
    targets: Array
    """[b, A] bool, the outputs that each teacher says are right; none where that is undefined."""
    open: Array
    """[b, A] bool, the outputs that are not seen to run into an obstacle."""


class Chooser(Protocol):
    """**Protocol:** what decides by the scores of a network."""

    def __call__(self, turn: Turn) -> Array:
        """The outputs [b] int64."""


class Rollout(NamedTuple):
    """All decisions of some episodes."""

    scores: Tensor
    """[n, A]"""
    targets: Tensor
    """[n, A] bool, the outputs that each teacher said were right; none where that is undefined."""
    outputs: Tensor
    """[n] int64, what was done."""
    reached: Array
    """[B] bool, whether the episode ended at the goal."""

    @property
    def judged(self) -> Tensor:
        """[n] bool, the decisions of which some were right."""
        return self.targets.any(1)

    def wrong(self) -> Tensor:
        """[n] bool, the decisions that are judged, and are not right."""
        right: Tensor = self.targets.gather(1, self.outputs[:, None])[:, 0]
        return self.judged & ~right


class Drawn(NamedTuple):
    """A world to play in."""

    world: World
    luck: Luck
    """That of its sensor and of slips."""


def roll_out(
    settings: Policy, network: Network, drawn: Sequence[Drawn], teachers: Teachers | None, choose: Chooser
) -> Rollout:
    """Play episodes to their ends, side by side.

    Args:
        settings: of the network.
        network: as it is now.
        drawn: a world for each episode.
        teachers: who says what is right, with a slot for each episode; None: nothing is.
        choose: who decides.

    Raises:
        Mistake: the network is not for such worlds, or a teacher says what none can.
    """
    worlds, lucks = zip(*drawn, strict=True)
    encoding, live = settings.encoding(), np.arange(len(drawn))
    batch, viewpoints = batch_of(worlds), viewpoints_of(encoding, worlds)
    batch.reset(live, worlds, lucks)
    viewpoints.reset(live, [world.task for world in worlds])
    if teachers:
        teachers.reset(live, worlds)
    reached, state = np.zeros(len(drawn), np.bool_), network.blank((len(drawn),))
    decisions: list[tuple[Tensor, Tensor, Tensor]] = []
    while len(live):
        observations = batch.sense(live)
        viewpoints.see(live, observations)
        targets = np.zeros((len(live), len(encoding.outputs)), np.bool_)
        if teachers:
            teachers.see(live, observations)
            told = teachers.targets(live)
            targets[:, : told.shape[1]] = told  # a smaller world has fewer actions than the network has outputs
        inputs = viewpoints.encode(live)
        scores, state = network(inputs.to(settings.device), state)
        turn = Turn(len(decisions), live, scores.detach().cpu().numpy(), targets, encoding.open(inputs))
        outputs = choose(turn)
        decisions.append((scores, torch.from_numpy(targets), torch.from_numpy(outputs)))
        steps = batch.step(live, viewpoints.act(live, outputs))
        reached[live] = steps.reached
        if steps.over.any():
            live, state = live[~steps.over], rows(state, torch.from_numpy(~steps.over))
    scores, right, done = (torch.cat(parts) for parts in zip(*decisions, strict=True))  # [n, A], [n, A], [n]
    return Rollout(scores, right.to(scores.device), done.to(scores.device), reached)


def greedy(turn: Turn) -> Array:
    """The outputs of the highest scores; of equals, the first: as a policy decides in an episode."""
    best: Array = turn.scores.argmax(1)
    return best
