"""What a run would play, and whether it could."""

from collections.abc import Iterator, Sequence
from itertools import chain
from pathlib import Path

from rich.console import Console

from fogbench.bench.playing.enough import mistakes
from fogbench.bench.playing.guests import drawn, guests
from fogbench.bench.reading.scenario import Scenario, ScenarioError, Variant
from fogbench.bench.several import each, read_each, say
from fogbench.worlds.mistake import Mistake, counted
from fogbench.worlds.types import Noted


def check_all(paths: Sequence[Path]) -> None:
    """Say what a run would play, after drawing one world of every variant, and one decision of each user's agent.

    Raises:
        ScenarioError: all the mistakes in all the files, in the maps that they name, and of users' agents.
    """
    console = Console()

    def check(scenario: Scenario) -> None:
        for line in chain.from_iterable(_outlook(variant) for variant in scenario.variants):
            say(line, console)
        for name, reason in scenario.left_out.items():
            say(f"  {name} is skipped: {reason}", console)
        refuse_idle(scenario)

    with console.status("Drawing the first worlds, counting tasks, and the first time compiling"):
        scenarios = _read_sound(paths)
    each(scenarios, console, check)


def _read_sound(paths: Sequence[Path]) -> list[Scenario]:
    """Read scenario files, draw a world of every variant, and let users' agents decide."""
    scenarios, errors = read_each(paths, None)
    lines = [line for error in errors for line in error.lines]
    for scenario in [*(error.rest for error in errors if error.rest), *scenarios]:
        found = [*mistakes(scenario.path, scenario.variants)]
        lines += found + _rehearsed(scenario, blamed=bool(found) or scenario not in scenarios)
    if lines:
        raise ScenarioError(lines)
    return scenarios


def _rehearsed(scenario: Scenario, *, blamed: bool) -> list[str]:
    """What is wrong with the decision of each user's agent, in lines; why none could be taken, unless that is known."""
    if not guests(scenario):
        return []
    from fogbench.bench.playing.rehearsal import rehearsed  # noqa: PLC0415  it starts processes, and is slow

    try:
        return rehearsed(scenario)
    except Mistake as mistake:
        return [] if blamed else str(mistake).splitlines()


def notes(variant: Variant) -> Sequence[str]:
    """What a user should know of how the files of its maps were read, in lines."""
    return variant.family.notes() if isinstance(variant.family, Noted) else ()


def refuse_idle(scenario: Scenario) -> None:
    """Hold it against a scenario that nobody plays it.

    Raises:
        Mistake: all its agents are skipped.
    """
    skipped = {entry.label: entry.skipped for variant in scenario.variants for entry in variant.agents}
    if all(skipped.values()):
        reasons = "; ".join(f"{label} {reason}" for label, reason in skipped.items())
        raise Mistake(f"{scenario.path}: no agent can play here ({reasons}).")


def _outlook(variant: Variant) -> Iterator[str]:
    """What a run would play of a variant that was tried."""
    world = drawn(variant, 0)
    playing = sum(not entry.skipped for entry in variant.agents)
    yield (
        f"  {variant.name}: {counted(variant.episodes, 'episode')} of {counted(playing, 'agent')}; "
        f"the first has an optimum of {world.shortest():g} and a budget of {counted(world.task.budget.steps, 'step')}"
    )
    yield from (f"    {note}" for note in notes(variant))
    for entry in variant.agents:
        if entry.skipped:
            yield f"    {entry.label} is skipped: {entry.skipped}"
