"""Imitation of the planner that has seen the same: a network learns which moves are optimal on its own known map.

It learns where its own decisions lead it (Ross, Gordon & Bagnell 2011, "DAgger"), from fresh maps in every batch. All
luck of a batch comes from streams of its number, so a training goes on from its weights and that number alone.
"""

from collections.abc import Mapping
from typing import Any, cast

import numpy as np
import torch
from torch import Tensor

from fogbench.learned.agent import load
from fogbench.learned.networks.network import Network
from fogbench.learned.training.curriculum import eased
from fogbench.learned.training.exploring import Explorer, Noisy
from fogbench.learned.training.recipe import Recipe, Training, Worlds
from fogbench.learned.training.rollout import Episode, Hindsight, Rollout, greedy, roll
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.streams import digest, stream
from fogbench.worlds.types import MapFamily

OPTIMISERS = {"adam": torch.optim.Adam, "rmsprop": torch.optim.RMSprop}


class Student:
    """A network that learns batch by batch."""

    def __init__(self, recipe: Recipe) -> None:
        """Before the first batch, with fresh weights or those of the recipe's checkpoint."""
        self.recipe = recipe
        self.network = load(recipe.network)
        self.optimiser = OPTIMISERS[recipe.training.optimiser](self.network.parameters())
        self.batches = 0
        """Learned from so far."""

    def learn(self) -> float:
        """Play one more batch and learn from it; the loss before.

        Raises:
            Mistake: the weights would be numbers no longer; they stay as they were.
        """
        training, done = self.recipe.training, self.batches / self.recipe.training.batches
        rollout = self._play(done)
        loss = imitation_loss(rollout)
        (loss + training.access_decay * access_weight(self.network)).backward()  # type: ignore[no-untyped-call]
        norm = torch.nn.utils.clip_grad_norm_(self.network.parameters(), training.clip)
        if not norm.isfinite():
            place = f"{self.recipe.name}, batch {self.batches + 1}"
            raise Mistake(f"{place}: got a gradient of {norm.item()}; expected a smaller rate.")
        for group in self.optimiser.param_groups:
            group["lr"] = rate(training, done)
        self.optimiser.step()
        self.optimiser.zero_grad()
        self.batches += 1
        return loss.item()

    def state(self) -> dict[str, Any]:
        """All of it that changes."""
        weights, optimiser = self.network.state_dict(), self.optimiser.state_dict()
        return {"network": weights, "optimiser": optimiser, "batches": self.batches}

    def restore(self, state: Mapping[str, Any]) -> None:
        """Become as it was."""
        self.network.load_state_dict(state["network"])
        self.optimiser.load_state_dict(state["optimiser"])
        self.batches = state["batches"]

    def _play(self, done: float) -> Rollout:
        recipe, training = self.recipe, self.recipe.training
        episodes = self._episodes(done)
        luck = stream(training.seed, recipe.lessons[0].worlds.family.words(), "training moves", self.batches)
        network = self.network
        if training.noise:
            network = Noisy(network, training.noise, int(digest(training.seed, "noise", self.batches)[:8], 16))
        first_share, last_share = training.teacher.share
        share = first_share + part(done, training.teacher.until) * (last_share - first_share)
        return roll(recipe.network, network, episodes, Explorer(luck, training.batch, share))

    def _episodes(self, done: float) -> list[Episode]:
        """Those of the batch, of all lessons in turn."""
        training, first = self.recipe.training, self.batches * self.recipe.training.batch
        grown = part(done, training.curriculum.until if training.curriculum else 0.0)
        turns = [(worlds, eased(easy, worlds.family, grown)) for worlds, easy in self.recipe.lessons]
        kind = Hindsight if training.teacher.hindsight else Episode
        return [
            kind(*draw_world(*turns[number % len(turns)], "training", training.seed, number))
            for number in range(first, first + training.batch)
        ]


def imitation_loss(rollout: Rollout) -> Tensor:
    """-log of the probability of all optimal moves together; mean over the decisions that have any."""
    scores, optimal = rollout.scores[rollout.judged], rollout.optimal[rollout.judged]
    right = scores.masked_fill(~optimal, -torch.inf).logsumexp(1)
    return (scores.logsumexp(1) - right).sum() / max(1, len(scores))


def access_weight(network: Network) -> Tensor:
    """Sum of the squared weights between a DNC's controller and its memory; 0 without one."""
    weights = [tensor for name, tensor in network.named_parameters() if name.endswith("interface.weight")]
    return torch.stack([weight.square().sum() for weight in weights]).sum() if weights else torch.zeros(())


def validate(recipe: Recipe, network: Network) -> dict[str, dict[str, float]]:
    """How a network does in the held-out episodes of each variant: success and test error [%]."""
    scores = {}
    for name, worlds in recipe.held_out.items():
        episodes = [
            Episode(*draw_world(worlds, worlds.family, "validation", 0, number))  # the same for every seed
            for number in range(recipe.training.validation.episodes)
        ]
        with torch.no_grad():
            rollout = roll(recipe.network, network, episodes, greedy)
        wrong = int(rollout.wrong().sum()) / max(1, int(rollout.judged.sum()))
        scores[name] = {"success": 100 * float(rollout.reached.mean()), "test_error": 100 * wrong}
    return scores


def rehearse(recipe: Recipe) -> None:
    """Draw a world of each lesson and variant, so that what cannot be played is told before the first batch.

    Raises:
        Mistake: there is no such world, the network does not fit it, or its tasks are a list, of which those to learn
            on, those to be tried on, and those that a scenario tests on are the same.
    """
    for place, worlds, family in recipe.places():
        try:
            listed = family.tasks(worlds.conditions)
            world, _ = draw_world(worlds, family, "training", 0, 0)
            recipe.network.shown(world.task)
        except Mistake as error:
            raise Mistake(f"{recipe.name}: {place}: {error}.") from None
        if listed is not None:
            told = f"got a list of {listed} tasks; expected maps or tasks that are drawn afresh"
            raise Mistake(f"{recipe.name}: {place}: {told}.")


def draw_world(
    worlds: Worlds, family: MapFamily, purpose: str, seed: int, number: int
) -> tuple[GridWorld, np.random.Generator]:
    """The world of a number on a map of `family`, and the luck in it; another purpose shares nothing with them."""
    map_luck, luck = (stream(seed, worlds.family.words(), f"{purpose} {what}", number) for what in ("map", "luck"))
    return cast(GridWorld, family.sample(map_luck, number, worlds.conditions)), luck


def part(done: float, until: float) -> float:
    """How much of a change that lasts until `until` is made, from 0 to 1."""
    return min(1.0, done / until) if until else 1.0


def rate(training: Training, done: float) -> float:
    """The learning rate: constant over the first half, then falling by the same factor with every batch."""
    first, last = training.rate
    return float(first * (last / first) ** max(0.0, 2 * done - 1))
