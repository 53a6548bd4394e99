"""What a run would play, and whether it could."""

from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path

from rich.console import Console

from fogbench.bench.playing.loop import episode_world
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.several import each, read_all, say
from fogbench.planners import judge_of, reference_settings
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import MapError


def check_all(paths: Sequence[Path]) -> None:
    """Say what a run would play, after drawing one world of every variant."""
    console = Console()

    def check(scenario: Scenario) -> None:
        refuse_too_many(scenario)
        for line in chain.from_iterable(_outlook(scenario, variant) for variant in scenario.variants):
            say(line, console)
        for name, reason in scenario.left_out.items():
            say(f"  {name} is skipped: {reason}", console)

    each(read_all(paths, None), console, check)


def refuse_too_many(scenario: Scenario) -> None:
    """Hold the episodes that are wanted against the tasks that there are.

    Raises:
        Mistake: more are wanted.
    """
    for variant in scenario.variants:
        most = variant.family.tasks(variant.conditions)
        if most is not None and variant.episodes > most:
            raise Mistake(
                f"{scenario.path}: {variant.name}: got {variant.episodes} episodes; "
                f"expected at most {most}, the tasks that fit the conditions."
            )


def _outlook(scenario: Scenario, variant: Variant) -> Iterator[str]:
    judge_of(variant.kind)  # what cannot be imported is told now
    reference_settings(variant.kind)
    try:
        world = episode_world(variant, 0)
        optimum = world.shortest()
    except MapError as error:
        raise Mistake(f"{scenario.path}: {variant.name}: {error}.") from None
    except Exception as error:
        told = f"got {type(error).__name__}: {error}; expected a world of its map family"
        raise Mistake(f"{scenario.path}: {variant.name}: {told}.") from error
    playing = sum(not entry.skipped for entry in variant.agents)
    yield (
        f"  {variant.name}: {variant.episodes} episodes of {playing} agents; "
        f"the first has an optimum of {optimum:g} and a budget of {world.task.budget.steps} steps"
    )
    for entry in variant.agents:
        if entry.skipped:
            yield f"    {entry.label} is skipped: {entry.skipped}"
