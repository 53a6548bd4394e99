"""Whether the variants of a scenario can be played: what a run begins with is tried, and nothing is recorded."""

from collections.abc import Callable, Iterable, Iterator
from functools import partial
from pathlib import Path

from fogbench.bench.playing.guests import drawn
from fogbench.bench.playing.keys import agent_key
from fogbench.bench.reading.scenario import ScenarioError, Variant
from fogbench.bench.reading.variant import Entry
from fogbench.planners import judge_of, reference_settings
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.reading.blocks import raised


def refuse_unplayable(path: Path, variants: Iterable[Variant]) -> None:
    """Try variants of a scenario.

    Raises:
        ScenarioError: some cannot be played; all that is wrong with all of them.
    """
    if lines := list(mistakes(path, variants)):
        raise ScenarioError(lines)


def mistakes(path: Path, variants: Iterable[Variant]) -> Iterator[str]:
    """What is wrong with variants of a scenario, in lines, each once."""
    told = dict[str, None]()
    for variant in variants:
        told |= dict.fromkeys(_blamed(variant.place, partial(_try, variant)))
        for entry in variant.agents:
            told |= dict.fromkeys(_unknown(path, entry))
    yield from told


def _blamed(place: str, attempt: Callable[[], object]) -> Iterator[str]:
    try:
        attempt()
    except Mistake as mistake:
        yield from mistake.within(place).splitlines()
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001  a user's class may raise anything
        yield f"{place}: got {' '.join(raised(error).split())}; expected worlds."


def _try(variant: Variant) -> None:
    """Draw the first world, and count the tasks of a list as far as they are needed.

    Raises:
        Mistake: it cannot be played.
    """
    judge_of(variant.kind)  # what cannot be imported is told now
    reference_settings(variant.kind)
    drawn(variant, 0).shortest()
    variant.family.words()
    count = variant.family.tasks(variant.conditions, variant.episodes)
    if count is not None and count < variant.episodes:
        drawn(variant, variant.episodes - 1)  # it raises, and says why


def _unknown(path: Path, entry: Entry) -> Iterator[str]:
    """That an agent has no key, if it has none."""
    try:
        if not entry.skipped:
            agent_key(entry)
    except Exception as error:  # noqa: BLE001  a user's class may raise anything
        expected = f"an agent that can say what it is made of; it raises {raised(error)}"
        yield entry.named._replace(expected=expected).text(str(path))
