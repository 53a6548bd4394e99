"""Episodes side by side: each in a world of its own, with one network for all of them.

Worlds, teachers and what a network sees are those of single episodes. A rollout keeps the way back to the weights,
unless PyTorch is told not to, so that what was played is learned from as it is.

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

from fogbench.learned.encoding.encoding import Viewpoint
from fogbench.learned.networks.network import Network, rows
from fogbench.learned.policy import Policy
from fogbench.planners.judging import Teacher
from fogbench.worlds.mistake import Mistake
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


class Run:
    """One world, and who teaches there."""

    def __init__(self, world: World, luck: np.random.Generator, teacher: Teacher | None) -> None:
        """Before the first step; `luck` is for the sensor and the slip. Without a teacher nothing is right."""
        self.world = world
        self.luck = luck
        self.teacher = teacher
        self.state = world.reset()
        self.steps = 0
        self.reached = False

    def look(self, viewpoint: Viewpoint, outputs: int) -> Array:
        """Sense, and let the viewpoint and the teacher see: which of the outputs are right, [A] bool.

        Raises:
            Mistake: the teacher says something else.
        """
        observation = self.world.sense(self.state, self.luck)
        viewpoint.see(observation)
        if self.teacher is None:
            return np.zeros(outputs, np.bool_)
        self.teacher.see(observation)
        targets: Array = np.asarray(self.teacher.targets())
        if targets.dtype != np.bool_ or targets.shape != (outputs,):
            told = f"got targets of {targets.dtype} {list(targets.shape)}; expected bool [{outputs}]"
            raise Mistake(f"{type(self.teacher).__name__}: {told}, one for each output.")
        return targets

    def step(self, viewpoint: Viewpoint, output: int) -> bool:
        """Do what an output means; whether the episode goes on."""
        step = self.world.step(self.state, viewpoint.act(output), self.luck)
        self.state, self.reached, self.steps = step.state, step.reached, self.steps + 1
        return not (step.reached or step.collided or self.steps >= self.world.task.budget.steps)


def roll_out(settings: Policy, network: Network, episodes: Sequence[Run], choose: Chooser) -> Rollout:
    """Play episodes to their ends.

    Raises:
        Mistake: the network is not for such worlds.
    """
    encoding = settings.encoding()
    playing = [(episode, encoding.start(episode.world.task)) for episode in episodes]
    live, state = np.arange(len(episodes)), network.blank((len(episodes),))
    decisions: list[tuple[Tensor, Tensor, Tensor]] = []
    while playing:
        targets = np.stack([run.look(viewpoint, len(encoding.outputs)) for run, viewpoint in playing])  # [b, A]
        inputs = encoding.encode([viewpoint for _, viewpoint in playing])
        scores, state = network(inputs.to(settings.device), state)
        turn = Turn(len(decisions), live, scores.detach().cpu().numpy(), targets, encoding.open(inputs))
        outputs = choose(turn)
        decisions.append((scores, torch.from_numpy(targets), torch.from_numpy(outputs)))
        steps = zip(playing, outputs.tolist(), strict=True)
        goes_on = np.array([episode.step(viewpoint, output) for (episode, viewpoint), output in steps])
        if not goes_on.all():
            live, state = live[goes_on], rows(state, torch.from_numpy(goes_on))
            playing = [pair for pair, stays in zip(playing, goes_on.tolist(), strict=True) if stays]
    scores, right, done = (torch.cat(parts) for parts in zip(*decisions, strict=True))  # [n, A], [n, A], [n]
    reached = np.array([episode.reached for episode in episodes])
    return Rollout(scores, right.to(scores.device), done.to(scores.device), reached)


def greedy(turn: Turn) -> Array:
    """The outputs of the highest scores; of equals, the first: as a policy decides in an episode."""
    best: Array = turn.scores.argmax(1)
    return best
