"""What a run would play, and whether it could."""

from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path

from rich.console import Console

from fogbench.bench.playing.loop import episode_world
from fogbench.bench.reading.scenario import Scenario, ScenarioError, Variant
from fogbench.bench.several import each, read_each, say
from fogbench.planners import judge_of, reference_settings
from fogbench.worlds.mistake import Mistake


def check_all(paths: Sequence[Path]) -> None:
    """Say what a run would play.

    Raises:
        ScenarioError: all the mistakes that are in the way of it.
        Mistake: no agent of a scenario can play here.
    """
    console = Console()

    def check(scenario: Scenario) -> None:
        for line in chain.from_iterable(_outlook(variant) for variant in scenario.variants):
            say(line, console)
        for name, reason in scenario.left_out.items():
            say(f"  {name} is skipped: {reason}", console)
        refuse_idle(scenario)

    each(read_sound(paths, None), console, check)


def read_sound(paths: Sequence[Path], episodes: int | None) -> list[Scenario]:
    """Read scenario files, and draw a world of every variant.

    Args:
        paths: of the files.
        episodes: per variant and agent, in place of what the files say; None: what they say.

    Raises:
        ScenarioError: all the mistakes in all the files, and in the maps that they name.
    """
    scenarios, errors = read_each(paths, episodes)
    lines = [line for error in errors for line in (*error.lines, *_mistakes(error.rest))]
    lines += [line for scenario in scenarios for line in _mistakes(scenario)]
    if lines:
        raise ScenarioError(lines)
    return scenarios


def refuse_idle(scenario: Scenario) -> None:
    """Hold it against a scenario that nobody plays it.

    Raises:
        Mistake: all its agents are skipped.
    """
    skipped = {entry.label: entry.skipped for variant in scenario.variants for entry in variant.agents}
    if all(skipped.values()):
        reasons = "; ".join(f"{label} {reason}" for label, reason in skipped.items())
        raise Mistake(f"{scenario.path}: got no agent that can play here ({reasons}).")


def _mistakes(scenario: Scenario | None) -> Iterator[str]:
    """What is wrong with the variants of a scenario, in lines."""
    for variant in scenario.variants if scenario else ():
        try:
            _try(variant)
        except Mistake as mistake:
            yield from (f"{variant.place}: {line.rstrip('.')}." for line in str(mistake).splitlines())
        except Exception as error:  # noqa: BLE001  a user's class may raise anything
            yield f"{variant.place}: got {type(error).__name__}: {' '.join(str(error).split())}; expected worlds."


def _try(variant: Variant) -> None:
    """Draw its first world, and do all else that a run begins with.

    Raises:
        Mistake: it cannot be played.
    """
    judge_of(variant.kind)  # what cannot be imported is told now
    reference_settings(variant.kind)
    episode_world(variant, 0).shortest()
    most = variant.family.tasks(variant.conditions)
    if most is not None and variant.episodes > most:
        usable = f"only {most} {'task is' if most == 1 else 'tasks are'} usable"
        raise Mistake(f"got {variant.episodes} episodes; {usable}, by the conditions")


def _outlook(variant: Variant) -> Iterator[str]:
    """What a run would play of a variant that was tried."""
    world = episode_world(variant, 0)
    playing = sum(not entry.skipped for entry in variant.agents)
    yield (
        f"  {variant.name}: {variant.episodes} episodes of {playing} agents; "
        f"the first has an optimum of {world.shortest():g} and a budget of {world.task.budget.steps} steps"
    )
    for entry in variant.agents:
        if entry.skipped:
            yield f"    {entry.label} is skipped: {entry.skipped}"
