"""A worker process: it reads the scenario itself and plays one episode per task."""

import os
from contextlib import suppress
from contextvars import ContextVar
from functools import cache
from pathlib import Path

from threadpoolctl import threadpool_limits

from fogbench.bench.playing import play as playing
from fogbench.bench.playing.episode import Episode
from fogbench.bench.playing.keys import keys
from fogbench.bench.playing.loop import ClerkError
from fogbench.bench.playing.sources import edited
from fogbench.bench.reading.scenario import Scenario, Variant, read_scenario
from fogbench.bench.reading.variant import Entry
from fogbench.worlds.types import Outcome

EDITED = "{file} was edited while it was played; what was played before is kept, run the same command again"

_TOLD: ContextVar[tuple[str, Path, int]] = ContextVar("_TOLD")
"""What `begin` was told."""


def begin(text: str, path: Path, workers: int) -> None:
    """Prepare this process.

    Args:
        text: the scenario's YAML.
        path: where it came from.
        workers: how many processes run side by side.
    """
    end = os._exit  # pebble overlooks a worker that ends with 0
    os._exit = lambda status: end(status or 1)
    _TOLD.set((text, path, workers))
    threadpool_limits(1)
    with suppress(Exception):  # the first task meets the error again, and can report it
        playing.prepare(_scenario(text, path))


def play(variant: str, agent: str, episode: int) -> Episode:
    """Play an episode of an agent, both by name; see `fogbench.bench.playing.play.play`.

    Raises:
        ClerkError: a file that counts in its keys was edited since this process read it.
    """
    row = playing.play(*_find(variant, agent), episode, _TOLD.get()[2])
    if found := edited():
        raise ClerkError(EDITED.format(file=found[0]))
    return row


def lose(variant: str, agent: str, episode: int, outcome: Outcome, detail: str) -> Episode:
    """The record of an episode that took its process with it; see `fogbench.bench.playing.play.lost`."""
    return playing.lost(*_find(variant, agent), episode, _TOLD.get()[2], outcome, detail)


def _find(variant_name: str, label: str) -> tuple[Scenario, Variant, Entry]:
    text, path, _ = _TOLD.get()
    scenario = _scenario(text, path)
    variant = next(variant for variant in scenario.variants if variant.name == variant_name)
    return scenario, variant, next(entry for entry in variant.agents if entry.label == label)


@cache
def _scenario(text: str, path: Path) -> Scenario:
    scenario = read_scenario(text, path)
    keys(scenario)  # of the sources as they were loaded just now
    return scenario
