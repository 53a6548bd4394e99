"""Episodes side by side: each in a world of its own, with one network for all of them.

Worlds, teachers and what a network sees are those of single episodes, in one call for all where their kind allows it. A
rollout keeps the way back to the weights, unless PyTorch is told not to, so that what was played is learned from as it
is. An episode that is over leaves the network's state when a few others are over too, for that copies the whole state.

Words used here
    B   episodes;  b  those of them that go on;  h  those that the state holds
    n   decisions of all episodes, step by step
    A   outputs of the network
"""

from collections.abc import Sequence
from typing import Any, NamedTuple, Protocol

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.encoding.viewpoints import viewpoints_of
from fogbench.learned.networks.network import Network, rows
from fogbench.learned.policy import Policy
from fogbench.planners.teachers import Teachers
from fogbench.worlds.batch import Luck, batch_of
from fogbench.worlds.types import Array, World

SPARE = 0.1
"""Share of a state's episodes that are over, from which they leave it."""


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
    encoding, live, held = settings.encoding(), np.arange(len(drawn)), np.arange(len(drawn))
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
        scores, state = _step(network, inputs.to(settings.device), state, np.searchsorted(held, live), len(held))
        turn = Turn(len(decisions), live, scores.detach().cpu().numpy(), targets, encoding.open(inputs))
        outputs = choose(turn)
        decisions.append((scores, torch.from_numpy(targets), torch.from_numpy(outputs)))
        steps = batch.step(live, viewpoints.act(live, outputs))
        reached[live] = steps.reached
        live = live[~steps.over]
        if len(live) <= (1 - SPARE) * len(held):
            held, state = live, rows(state, torch.from_numpy(np.searchsorted(held, live)))
    scores, right, done = (torch.cat(parts) for parts in zip(*decisions, strict=True))  # [n, A], [n, A], [n]
    return Rollout(scores, right.to(scores.device), done.to(scores.device), reached)


def _step(network: Network, inputs: Any, state: Any, places: Array, held: int) -> tuple[Tensor, Any]:
    """The scores [b, A] of episodes that are in such places of a state [h, ...], and the state after."""
    if len(places) == held:
        scores, state = network(inputs, state)
        return scores, state
    told = np.zeros(held, np.int64)  # those that are over are told what the first is told
    told[places] = np.arange(len(places))
    scores, state = network(rows(inputs, torch.from_numpy(told)), state)
    return scores[torch.from_numpy(places)], state


def greedy(turn: Turn) -> Array:
    """The outputs of the highest scores; of equals, the first: as a policy decides in an episode."""
    best: Array = turn.scores.argmax(1)
    return best
