"""A worker process: it reads the scenario itself and answers one task after the other."""

import faulthandler
import os
import signal
from collections.abc import Callable
from contextlib import suppress
from contextvars import ContextVar
from functools import cache
from multiprocessing import set_start_method
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any

from threadpoolctl import threadpool_limits

from fogbench.bench.playing import play as playing
from fogbench.bench.playing.episode import Played
from fogbench.bench.playing.keys import keys
from fogbench.bench.playing.loop import ClerkError
from fogbench.bench.playing.relay import Prints, print_there
from fogbench.bench.playing.sources import edited
from fogbench.bench.reading.scenario import Scenario, ScenarioError, Variant, read_scenario
from fogbench.bench.reading.variant import Entry
from fogbench.worlds.types import MapError, Outcome

EDITED = "{file} was edited while it was played; what was played before is kept, run the same command again"

_TOLD: ContextVar[tuple[str, Path, int]] = ContextVar("_TOLD")
"""What `serve` was told."""


def serve(
    pipe: "Connection[Any, Any]",
    last_words: "Connection[Any, Any]",
    prints: Prints,
    text: str,
    path: Path,
    workers: int,
) -> None:
    """Answer tasks, each a function of this file and its arguments, until this process is ended.

    Args:
        pipe: where tasks come from and answers go to; the first answer says that this process is ready.
        last_words: where it is told what a fault of native code was in the middle of.
        prints: where everything is printed.
        text: the scenario's YAML.
        path: where it came from.
        workers: how many processes run side by side.
    """
    _stand_alone()
    print_there(prints)
    faulthandler.enable(last_words.fileno(), all_threads=False)
    _TOLD.set((text, path, workers))
    threadpool_limits(1)
    with suppress(Exception):  # the first task meets the error again, and can report it
        playing.prepare(_scenario(text, path))
    own = os.getpid()
    with suppress(EOFError, BrokenPipeError, ConnectionResetError):  # the run is gone
        pipe.send(None)
        while True:
            call, arguments = pipe.recv()
            answer = _answer(call, arguments)
            if os.getpid() != own:  # a planner has split the process, and its twin comes along
                os._exit(0)
            pipe.send(answer)


def _stand_alone() -> None:
    """Lead a group of processes, which no terminal sends its Ctrl-C or Ctrl-Z to."""
    os.setpgid(0, 0)
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})  # one that came before is gone
    signal.signal(signal.SIGINT, signal.default_int_handler)
    set_start_method(None, force=True)  # a planner may choose one, once


def _answer(call: Callable[..., Any], arguments: tuple[Any, ...]) -> Any:
    """The answer to a task; an error that is no agent's is one line of text."""
    place = f"{arguments[0]}, episode {arguments[2]}"
    try:
        return call(*arguments)
    except MapError as error:
        return error.within(place)
    except ClerkError as error:
        return f"{place}: {error}."
    except BaseException as error:  # noqa: BLE001  it is told where somebody can read it
        told = f"got {type(error).__name__}: {error}; expected no error but an agent's"
        return f"{place}, {arguments[1]}: {told}."


def play(variant: str, agent: str, episode: int) -> Played:
    """Play an episode of an agent, both by name; see `fogbench.bench.playing.play.play`.

    Raises:
        ClerkError: a file that counts in its keys was edited since this process read it.
    """
    told = list[str]()
    row = playing.play(*_find(variant, agent), episode, _TOLD.get()[2], told.append)
    if found := edited():
        raise ClerkError(EDITED.format(file=found[0]))
    return Played(row, "".join(told))


def lose(variant: str, agent: str, episode: int, outcome: Outcome, detail: str, traceback: str) -> Played:
    """The record of an episode that took its process with it; see `fogbench.bench.playing.play.lost`."""
    return Played(playing.lost(*_find(variant, agent), episode, _TOLD.get()[2], outcome, detail), traceback)


def rehearse(variant: str, agent: str, _episode: int) -> playing.Rehearsed:
    """Take one decision on a throw-away task, by what is right in the scenario."""
    return playing.rehearse(*_chosen(_readable(*_TOLD.get()[:2]), variant, agent)[1:])


def _find(variant: str, label: str) -> tuple[Scenario, Variant, Entry]:
    return _chosen(_scenario(*_TOLD.get()[:2]), variant, label)


def _chosen(scenario: Scenario, variant_name: str, label: str) -> tuple[Scenario, Variant, Entry]:
    variant = next(variant for variant in scenario.variants if variant.name == variant_name)
    return scenario, variant, next(entry for entry in variant.agents if entry.label == label)


@cache
def _scenario(text: str, path: Path) -> Scenario:
    scenario = read_scenario(text, path)
    keys(scenario)  # of the sources as they were loaded just now
    return scenario


@cache
def _readable(text: str, path: Path) -> Scenario:
    try:
        return read_scenario(text, path)
    except ScenarioError as error:
        if error.rest is None:
            raise
        return error.rest
