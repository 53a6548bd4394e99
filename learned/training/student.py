"""Imitation of the planner that has seen the same: a network learns which moves are right on its own known map.

It learns where its own decisions lead it (Ross, Gordon & Bagnell 2011, "DAgger"), from fresh maps in every batch. All
luck of a batch comes from streams of its number, so a training goes on from its weights and that number alone.
"""

from collections.abc import Mapping
from functools import partial
from typing import Any, cast

import torch
from torch import Tensor
from torch.optim.swa_utils import AveragedModel

from fogbench.learned.agent import load
from fogbench.learned.networks.network import Network
from fogbench.learned.training.curriculum import eased, farther
from fogbench.learned.training.exploring import Explorer, Noisy
from fogbench.learned.training.imitation import Imitation
from fogbench.learned.training.recipe import Recipe, Worlds
from fogbench.learned.training.rollout import Drawn, Rollout, roll_out
from fogbench.learned.training.trials import draw_world, teacher_in, teachers_in
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.streams import digest, stream

OPTIMISERS = {"adam": torch.optim.Adam, "rmsprop": torch.optim.RMSprop}


class Imitator:
    """A network that learns batch by batch."""

    def __init__(self, recipe: Recipe, learning: Imitation) -> None:
        """Before the first batch, with fresh weights or those of the recipe's checkpoint.

        Raises:
            Mistake: nobody can teach in its worlds as the recipe says.
        """
        self.recipe, self.learning = recipe, learning
        for worlds, easy in recipe.lessons:
            try:
                first = draw_world(self._grown(worlds, 0.0), easy, "training", 0, 0).world
                teacher_in(first, hindsight=learning.teacher.hindsight)
            except Mistake as error:
                raise Mistake(f"{recipe.name}: {error}.") from None
        self.learner = load(recipe.network)
        """What learns, and plays in training."""
        self.optimiser = OPTIMISERS[learning.optimiser](self.learner.parameters())
        self.parts: dict[str, Any] = {"network": self.learner, "optimiser": self.optimiser}
        """What has a state, by its name there; the mean of what has learned only where it is asked for."""
        if learning.average > 1:
            self.parts["mean"] = AveragedModel(self.learner, avg_fn=partial(drawn_nearer, learning.average))
        self.batches = 0
        """Learned from so far."""

    @property
    def network(self) -> Network:
        """What is tried and kept: the mean of what has learned, or that itself."""
        return cast(Network, self.parts["mean"].module) if "mean" in self.parts else self.learner

    def learn(self) -> float:
        """Play one more batch and learn from it; the loss before.

        Raises:
            Mistake: the weights would be numbers no longer; they stay as they were.
        """
        done = self.batches / self.learning.batches
        rollout = self._play(done)
        loss = imitation_loss(rollout)
        (loss + self.learning.access_decay * access_weight(self.learner)).backward()  # type: ignore[no-untyped-call]
        norm = torch.nn.utils.clip_grad_norm_(self.learner.parameters(), self.learning.clip)
        if not norm.isfinite():
            place = f"{self.recipe.name}, batch {self.batches + 1}"
            raise Mistake(f"{place}: got a gradient of {norm.item()}; expected a smaller rate.")
        for group in self.optimiser.param_groups:
            group["lr"] = rate(self.learning, done)
        self.optimiser.step()
        self.optimiser.zero_grad()
        if "mean" in self.parts:
            self.parts["mean"].update_parameters(self.learner)
        self.batches += 1
        return loss.item()

    def state(self) -> dict[str, Any]:
        """All of it that changes."""
        return {**{name: part.state_dict() for name, part in self.parts.items()}, "batches": self.batches}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Become as it was."""
        for name, part in self.parts.items():
            part.load_state_dict(state[name])
        self.batches = state["batches"]

    def _play(self, done: float) -> Rollout:
        recipe, learning = self.recipe, self.learning
        drawn = self._drawn(done)
        teachers = teachers_in(drawn, len(recipe.network.encoding().outputs), hindsight=learning.teacher.hindsight)
        luck = stream(recipe.seed, recipe.lessons[0].worlds.family.words(), "training moves", self.batches)
        network = self.learner
        if learning.noise:
            network = Noisy(network, learning.noise, int(digest(recipe.seed, "noise", self.batches)[:8], 16))
        first_share, last_share = learning.teacher.share
        share = first_share + part(done, learning.teacher.until) * (last_share - first_share)
        return roll_out(recipe.network, network, drawn, teachers, Explorer(luck, learning.batch, share))

    def _drawn(self, done: float) -> list[Drawn]:
        """The worlds of the batch, of all lessons in turn."""
        learning, first = self.learning, self.batches * self.learning.batch
        grown = part(done, learning.curriculum.until if learning.curriculum else 0.0)
        turns = [
            (self._grown(worlds, grown), eased(easy, worlds.family, grown)) for worlds, easy in self.recipe.lessons
        ]
        return [
            draw_world(*turns[number % len(turns)], "training", self.recipe.seed, number)
            for number in range(first, first + learning.batch)
        ]

    def _grown(self, worlds: Worlds, grown: float) -> Worlds:
        """Worlds whose goals are as far away as they are by now."""
        near = self.learning.curriculum.distance if self.learning.curriculum else None
        return worlds._replace(conditions=farther(near, worlds.conditions, grown)) if near else worlds


def drawn_nearer(batches: int, mean: Tensor, latest: Tensor, count: Tensor) -> Tensor:
    """A running mean over so many batches, of fewer at first, after `count` of them."""
    return mean + (latest - mean) / torch.clamp(count + 1, max=batches)


def imitation_loss(rollout: Rollout) -> Tensor:
    """-log of the probability of all right outputs together; mean over the decisions that have any."""
    scores, targets = rollout.scores[rollout.judged], rollout.targets[rollout.judged]
    right = scores.masked_fill(~targets, -torch.inf).logsumexp(1)
    return (scores.logsumexp(1) - right).sum() / max(1, len(scores))


def access_weight(network: Network) -> Tensor:
    """Sum of the squared weights between a DNC's controller and its memory; 0 without one."""
    weights = [tensor for name, tensor in network.named_parameters() if name.endswith("interface.weight")]
    return torch.stack([weight.square().sum() for weight in weights]).sum() if weights else torch.zeros(())


def part(done: float, until: float) -> float:
    """How much of a change that lasts until `until` is made, from 0 to 1."""
    return min(1.0, done / until) if until else 1.0


def rate(learning: Imitation, done: float) -> float:
    """The learning rate: constant over the first half, then falling by the same factor with every batch."""
    first, last = learning.rate
    return float(first * (last / first) ** max(0.0, 2 * done - 1))
