"""A whole training: batches, trials on held-out maps, and a state on disk from which it goes on when it was stopped.

In its folder
    state.pt          all that changes: weights, optimiser, number of batches, what was reached
    log.jsonl         one line for each trial
    NAME.safetensors  the best weights so far, with their card beside them
"""

import io
import json
import math
from collections.abc import Iterator, Mapping
from pathlib import Path
from time import perf_counter
from typing import Any, NamedTuple

import torch

from fogbench.learned import checkpoint
from fogbench.learned.training.recipe import Recipe, differences
from fogbench.learned.training.trials import refuse_unplayable, validate
from fogbench.worlds.files import write
from fogbench.worlds.mistake import Mistake, counted
from fogbench.worlds.streams import digest

SAVED_EVERY = 120.0
"""Seconds between two savings, at most; it changes nothing but what a stop can cost."""

KEPT = ("trials", "losses", "best", "seconds")
"""What a course remembers beside its student."""

Trial = dict[str, Any]
"""A line of the log: `batch`, `loss` since the trial before, `seconds`, and `variants` with what each reached."""


class News(NamedTuple):
    """What is told after every batch."""

    batches: int
    loss: float
    trial: Trial | None


class Course:
    """A training, from where it was left."""

    def __init__(self, recipe: Recipe, folder: Path, origin: Mapping[str, Any]) -> None:
        """Start, or go on from the state in `folder`.

        Args:
            recipe: what is trained, and how.
            folder: for all that is written; it is made if it is not there.
            origin: where the weights come from, for their card: commit, machine, versions.

        Raises:
            Mistake: a world of the recipe cannot be played, or the folder holds the state of another training.
        """
        refuse_unplayable(recipe)
        folder.mkdir(parents=True, exist_ok=True)
        self.recipe, self.folder, self.origin = recipe, folder, origin
        self.student = recipe.learning.student(recipe)
        self.trials: list[Trial] = []
        self.losses: list[float] = []  # since the last trial
        self.best: list[float] = []
        self.seconds = 0.0
        if self._state.exists():
            self._load()

    def go_on(self) -> Iterator[News]:
        """Train to the end; stopped at any moment, a new course goes on from the last saved state to the same end."""
        began, saved = perf_counter() - self.seconds, perf_counter()
        while self.student.batches < self.recipe.learning.batches:
            self.losses.append(self.student.learn())
            loss, tried = self.losses[-1], self._is_due()
            self.seconds = perf_counter() - began
            if tried:
                self._try()
            if tried or perf_counter() - saved > SAVED_EVERY:
                self._save()
                saved = perf_counter()
            yield News(self.student.batches, loss, self.trials[-1] if tried else None)

    def _is_due(self) -> bool:
        batches, recipe = self.student.batches, self.recipe
        return batches % recipe.validation.every == 0 or batches == recipe.learning.batches

    def _try(self) -> None:
        """Try the network; keep its weights if they are the best so far."""
        variants = validate(self.recipe, self.student.network)
        loss = sum(self.losses) / len(self.losses)
        self.losses = []
        self.trials.append(
            {"batch": self.student.batches, "loss": loss, "seconds": round(self.seconds, 1), "variants": variants}
        )
        reached = [_mean(variants, "success"), -_mean(variants, "test_error")]
        if reached >= self.best:  # of equals, the later has learned more
            self.best = reached
            self._keep()

    def _keep(self) -> None:
        training = {
            "recipe": self.recipe.text,
            "seed": self.recipe.seed,
            "batches": self.student.batches,
            "of": self.recipe.learning.batches,
            "variants": self.trials[-1]["variants"],
            "minutes": round(self.seconds / 60, 1),
            "device": self.recipe.network.device,
            "threads": torch.get_num_threads(),
            **self.origin,
        }
        settings, state = self.recipe.network, self.student.network.state_dict()
        weights = {name: tensor.cpu() for name, tensor in state.items()}
        checkpoint.write(self.weights, type(settings).__name__, settings.trained(), weights, training)

    @property
    def weights(self) -> Path:
        """The file of the best weights."""
        return self.folder / f"{self.recipe.name}{checkpoint.SUFFIX}"

    @property
    def _state(self) -> Path:
        return self.folder / "state.pt"

    def _save(self) -> None:
        state = {
            "recipe": digest(self.recipe.words()),
            "settings": self.recipe.settings(),
            "threads": torch.get_num_threads(),
            **self.student.state(),
            **{name: getattr(self, name) for name in KEPT},
        }
        lines = "".join(json.dumps(trial) + "\n" for trial in self.trials)
        write(self.folder / "log.jsonl", lines.encode())  # first: what the state has, the log has too
        contents = io.BytesIO()
        torch.save(state, contents)
        write(self._state, contents.getvalue())

    def _load(self) -> None:
        try:
            state = torch.load(self._state, map_location=self.recipe.network.device, weights_only=True)
            self._recognise(state)
            self.student.restore(state)
            vars(self).update({name: state[name] for name in KEPT})
        except Mistake:
            raise
        except Exception:  # noqa: BLE001  whatever a broken file does to its reader
            raise Mistake(f"{self._state}: got a broken file; choose another folder with --out.") from None

    def _recognise(self, state: Mapping[str, Any]) -> None:
        """Hold a state against this course, which must come to the same end as the one that left it."""
        other = "choose another with --out"
        if "settings" not in state:
            raise Mistake(f"{self.folder}: This folder holds a training of another version of fogbench; {other}.")
        threads, before = torch.get_num_threads(), state["threads"]
        if state["recipe"] != digest(self.recipe.words()):
            told = differences(state["settings"], self.recipe.settings()) or "a file that it names has other contents"
            weights = next(self.folder.glob(f"*{checkpoint.SUFFIX}"), self.weights)  # another seed has another name
            start = f"To start from its weights, name {weights} as the `checkpoint` of the recipe's network."
            raise Mistake(f"{self.folder}: This folder holds a training with other settings ({told}); {other}. {start}")
        if threads != before:
            way = f"set OMP_NUM_THREADS={before}, or {other}"
            raise Mistake(
                f"{self.folder}: This folder holds a training on {counted(before, 'thread')}, now {threads}; {way}."
            )
        if state["best"] and not self.weights.exists():
            raise Mistake(f"{self.weights}: missing; this file has the best weights so far. Restore it, or {other}.")


def _mean(variants: Mapping[str, Mapping[str, float]], metric: str) -> float:
    """Over the variants that have it; 0 where none does, so that what nobody judges counts for nothing."""
    known = [variant[metric] for variant in variants.values() if not math.isnan(variant[metric])]
    return sum(known) / max(1, len(known))
