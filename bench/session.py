"""What the commands do with scenario files: run them, check them, report on them."""

import json
import sys
from collections.abc import Iterator, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path

from rich.console import Console

from bench.playing import store
from bench.playing.pool import cpus
from bench.playing.runner import Summary, run
from bench.progress import Bars
from bench.reading.scenario import Scenario, ScenarioError, Variant, read_scenario
from bench.reporting.report import READS, print_tables, write_report
from worlds.mistake import Mistake
from worlds.types import Outcome


def run_all(paths: Sequence[Path], episodes: int | None, workers: int | None, results: Path) -> bool:
    """Run scenarios one after the other, and report on each as it ends.

    Returns:
        Whether an agent crashed or hung.
    """
    console, crashed = Console(), False
    for scenario in read_all(paths, episodes):
        if _introduce(scenario, console):
            _refuse_too_many(scenario)
            with Bars(scenario.name, console) as bars:
                summary = run(scenario, results / scenario.name, workers or cpus(), bars.watch)
            crashed |= bool(summary.outcomes[Outcome.CRASHED] or summary.outcomes[Outcome.HUNG])
            console.print(_counts(summary), highlight=False)
            _report(scenario, results / scenario.name, console)
    return crashed


def report_all(paths: Sequence[Path], results: Path) -> None:
    """Report on all that is recorded of some scenarios, however many episodes their files ask for."""
    console = Console()
    for scenario in read_all(paths, sys.maxsize):
        if _introduce(scenario, console):
            _report(scenario, results / scenario.name, console)


def check_all(paths: Sequence[Path]) -> None:
    """Say what a run would play, after drawing one world of every variant."""
    console = Console()
    for scenario in read_all(paths, None):
        if _introduce(scenario, console):
            _refuse_too_many(scenario)
            for line in chain.from_iterable(map(_outlook, scenario.variants)):
                console.print(line, highlight=False)


def read_all(paths: Sequence[Path], episodes: int | None) -> list[Scenario]:
    """Read scenario files.

    Args:
        paths: of the files.
        episodes: a cell, in place of what the files say; None: what they say.

    Raises:
        ScenarioError: all the mistakes in all the files, or two files with one name.
    """
    scenarios, lines = dict[str, Scenario](), list[str]()
    for path in paths:
        try:
            scenario = read_scenario(_text(path), path)
        except ScenarioError as error:
            lines += error.lines
            continue
        twin = scenarios.setdefault(scenario.name, scenario)
        if twin is not scenario:
            lines.append(f"{path}: got the name {scenario.name}, as in {twin.path}; expected a name of its own.")
    if lines:
        raise ScenarioError(lines)
    return [_with_episodes(scenario, episodes) if episodes else scenario for scenario in scenarios.values()]


def _text(path: Path) -> str:
    try:
        return path.read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        raise Mistake(f"{path}: got a file that cannot be read ({error}); expected UTF-8 text.") from None


def _with_episodes(scenario: Scenario, episodes: int) -> Scenario:
    return replace(scenario, variants=tuple(replace(each, episodes=episodes) for each in scenario.variants))


def _introduce(scenario: Scenario, console: Console) -> bool:
    """Print what comes; False if it is skipped."""
    console.rule(scenario.name, align="left")
    console.print(scenario.about, style="dim", highlight=False)
    if scenario.skipped:
        console.print(f"Skipped: {scenario.skipped}.", style="yellow", highlight=False)
    return not scenario.skipped


def _refuse_too_many(scenario: Scenario) -> None:
    for variant in scenario.variants:
        most = variant.family.tasks(variant.conditions)
        if most is not None and variant.episodes > most:
            raise Mistake(
                f"{scenario.path}: {variant.name}: got {variant.episodes} episodes; "
                f"expected at most {most}, the tasks that fit the conditions."
            )


def _outlook(variant: Variant) -> Iterator[str]:
    from bench.playing.loop import episode_world  # noqa: PLC0415  it loads Numba, which only a check needs here

    world = episode_world(variant, 0)
    playing = sum(not entry.skipped for entry in variant.agents)
    yield (
        f"  {variant.name}: {variant.episodes} episodes of {playing} agents; "
        f"the first has an optimum of {world.shortest():g} and a budget of {world.task.budget.steps} steps"
    )
    for entry in variant.agents:
        if entry.skipped:
            yield f"    {entry.label} is skipped: {entry.skipped}"


def _counts(summary: Summary) -> str:
    ended = ", ".join(f"{count} {outcome.name}" for outcome, count in summary.outcomes.most_common())
    return f"{summary.kept} episodes were recorded before, {summary.outcomes.total()} were played now. {ended}"


def _report(scenario: Scenario, folder: Path, console: Console) -> None:
    path = folder / "run.json"
    if not path.exists():
        raise Mistake(f"{folder}: got no recorded run; expected `fogbench run {scenario.path}` to come first.")
    frame = store.read(folder, scenario, READS)
    table = write_report(frame, scenario, json.loads(path.read_text("utf-8")), folder)
    print_tables(frame, table, scenario, console)
    console.print(f"Tables and plots are in {folder}/", highlight=False)
