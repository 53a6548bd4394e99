"""What the commands do with scenario files: run them, check them, report on them."""

import re
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TypeVar

from rich.console import Console
from rich.text import Text

from fogbench.bench.playing import store
from fogbench.bench.playing.pool import cpus
from fogbench.bench.playing.provenance import read_run
from fogbench.bench.playing.runner import Summary, run
from fogbench.bench.progress import Bars
from fogbench.bench.reading.scenario import Scenario, ScenarioError, Variant, read_scenario, text_of
from fogbench.bench.reporting.report import READS, print_tables, summary, write_report
from fogbench.bench.reporting.sections import comparisons
from fogbench.bench.reporting.tables import markdown, print_table
from fogbench.worlds.files import put
from fogbench.worlds.mistake import Mistake, unknown
from fogbench.worlds.types import MapError, Outcome

Answer = TypeVar("Answer")


def run_all(paths: Sequence[Path], episodes: int | None, workers: int | None, results: Path) -> bool:
    """Run scenarios one after the other, and report on each as it ends.

    Returns:
        Whether an agent crashed or hung, now or in the episodes that were recorded before.

    Raises:
        Mistake: some scenarios could not be run; the others were.
    """
    console = Console()
    broken = _each(read_all(paths, episodes), console, lambda each: _run(each, workers or cpus(), results, console))
    return any(broken)


def report_all(paths: Sequence[Path], results: Path) -> None:
    """Report on all that is recorded of some scenarios, however many episodes their files ask for."""
    console = Console()
    _each(read_all(paths, sys.maxsize), console, lambda each: _report(each, results / each.name, console))


def compare_all(paths: Sequence[Path], label: str, results: Path) -> None:
    """Compare all agents of some scenarios with the one of a label, in the variants where it plays."""
    console = Console()

    def compare(scenario: Scenario) -> None:
        scenario, folder = _against(scenario, label), results / scenario.name
        read_run(folder)
        lines = comparisons(summary(store.read(folder, scenario, READS), scenario), scenario)
        print_table("Paired", lines, console)
        page = folder / ("-".join(["against", *re.findall(r"\w+", label)]) + ".md")
        put(page, f"# {scenario.name}, against {label}\n\n{markdown(lines)}".encode())
        _say(f"The table is in {page}", console)

    _each(read_all(paths, sys.maxsize), console, compare)


def _against(scenario: Scenario, label: str) -> Scenario:
    labels = dict.fromkeys(entry.label for variant in scenario.variants for entry in variant.agents)
    if label not in labels:
        raise unknown(f"--against, {scenario.path}", label, labels)
    having = [variant for variant in scenario.variants if any(entry.label == label for entry in variant.agents)]
    return replace(scenario, variants=tuple(replace(variant, reference=label) for variant in having))


def check_all(paths: Sequence[Path]) -> None:
    """Say what a run would play, after drawing one world of every variant."""
    console = Console()

    def check(scenario: Scenario) -> None:
        _refuse_too_many(scenario)
        for line in chain.from_iterable(_outlook(scenario, variant) for variant in scenario.variants):
            _say(line, console)
        for name, reason in scenario.left_out.items():
            _say(f"  {name} is skipped: {reason}", console)

    _each(read_all(paths, None), console, check)


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
            scenario = read_scenario(text_of(path), path)
        except ScenarioError as error:
            lines += error.lines
            continue
        twin = scenarios.setdefault(scenario.name, scenario)
        if twin is not scenario:
            lines.append(f"{path}: got the name {scenario.name}, as in {twin.path}; expected a name of its own.")
    if lines:
        raise ScenarioError(lines)
    return [_with_episodes(scenario, episodes) if episodes else scenario for scenario in scenarios.values()]


def _with_episodes(scenario: Scenario, episodes: int) -> Scenario:
    return replace(scenario, variants=tuple(replace(each, episodes=episodes) for each in scenario.variants))


def _each(scenarios: list[Scenario], console: Console, do: Callable[[Scenario], Answer]) -> list[Answer]:
    """Do the same with each scenario that is not skipped; a mistake in one does not stop the others."""
    answers, mistakes = [], []
    for scenario in scenarios:
        console.rule(Text(scenario.name), align="left")
        _say(scenario.about, console, style="dim")
        if scenario.skipped:
            _say(f"Skipped: {scenario.skipped}.", console, style="yellow")
            continue
        try:
            answers.append(do(scenario))
        except Mistake as mistake:
            mistakes.append(str(mistake))
    if mistakes:
        raise Mistake("\n".join(mistakes))
    return answers


def _run(scenario: Scenario, workers: int, results: Path, console: Console) -> bool:
    folder = results / scenario.name
    if all(entry.skipped for variant in scenario.variants for entry in variant.agents):
        raise Mistake(f"{scenario.path}: got no agent that can play here; `fogbench check {scenario.path}` says why.")
    _refuse_too_many(scenario)
    with Bars(scenario.name, console) as bars:
        played = run(scenario, folder, workers, bars.watch)
    _say(_counts(played), console)
    return _report(scenario, folder, console)


def _refuse_too_many(scenario: Scenario) -> None:
    for variant in scenario.variants:
        most = variant.family.tasks(variant.conditions)
        if most is not None and variant.episodes > most:
            raise Mistake(
                f"{scenario.path}: {variant.name}: got {variant.episodes} episodes; "
                f"expected at most {most}, the tasks that fit the conditions."
            )


def _outlook(scenario: Scenario, variant: Variant) -> Iterator[str]:
    from fogbench.bench.playing.loop import episode_world  # noqa: PLC0415  it loads Numba, which only a check needs here

    try:
        world = episode_world(variant, 0)
    except MapError as error:
        raise Mistake(f"{scenario.path}: {variant.name}: {error}.") from None
    except Exception as error:
        told = f"got {type(error).__name__}: {error}; expected a world of its map family"
        raise Mistake(f"{scenario.path}: {variant.name}: {told}.") from error
    playing = sum(not entry.skipped for entry in variant.agents)
    yield (
        f"  {variant.name}: {variant.episodes} episodes of {playing} agents; "
        f"the first has an optimum of {world.shortest():g} and a budget of {world.task.budget.steps} steps"
    )
    for entry in variant.agents:
        if entry.skipped:
            yield f"    {entry.label} is skipped: {entry.skipped}"


def _counts(played: Summary) -> str:
    ended = ", ".join(f"{count} {outcome.name}" for outcome, count in played.outcomes.most_common())
    return f"{played.kept} episodes were recorded before, {played.outcomes.total()} were played now. {ended}"


def _report(scenario: Scenario, folder: Path, console: Console) -> bool:
    """Write and print a report; whether an agent has crashed or hung."""
    run_facts = read_run(folder)
    frame = store.read(folder, scenario, READS)
    table = write_report(frame, scenario, run_facts, folder)
    print_tables(frame, table, scenario, console)
    for (variant, agent), count in store.stale(folder, scenario).items():
        _say(store.STALE.format(count=count, agent=agent, variant=variant), console)
    _say(f"Tables and plots are in {folder}/", console)
    return bool(frame["outcome"].isin([Outcome.CRASHED.name, Outcome.HUNG.name]).any())


def _say(text: str, console: Console, style: str | None = None) -> None:
    console.print(text, style=style, highlight=False, markup=False)
