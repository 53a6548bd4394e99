"""What the commands do with scenario files: run them, report on them."""

import sys
from collections.abc import Sequence
from dataclasses import replace
from itertools import chain
from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console

from fogbench.bench.check import notes, refuse_idle
from fogbench.bench.playing import store
from fogbench.bench.playing.agenda import FIRST
from fogbench.bench.playing.crashes import FOLDER, crash_file
from fogbench.bench.playing.keys import Versions
from fogbench.bench.playing.pool import cpus
from fogbench.bench.playing.provenance import differences, read_run, versions_of
from fogbench.bench.playing.runner import Summary, run
from fogbench.bench.progress import Bars
from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting.plain import escaped, stems
from fogbench.bench.reporting.report import READS, print_tables, summary, write_plots, write_tables
from fogbench.bench.reporting.sections import comparisons
from fogbench.bench.reporting.tables import markdown, print_table
from fogbench.bench.several import each, read_all, say
from fogbench.worlds.mistake import Mistake, unknown
from fogbench.worlds.types import Outcome

if TYPE_CHECKING:
    import pandas as pd

EACH = 16
"""Workers of a CPU at most: each takes some hundred megabytes."""

OUTDATED = (
    "{folder}: none of {count} recorded episodes counts any more: settings, files, sources or packages have changed. "
    "The tables stay as they are; `fogbench run` plays the episodes again."
)
"""What a user is told in place of a report without a number."""

HUNG = (
    f"{{agent}} hung in its first {FIRST} episodes of variant {{variant}}, and was not asked for the other {{count}}. "
    "Mend it and run again, or give it more time by `budget: {{hard_seconds: ...}}`, under which all agents play again."
)
"""What a user is told of episodes that were left out."""


def run_all(paths: Sequence[Path], episodes: int | None, workers: int | None, results: Path) -> bool:
    """Run scenarios one after the other, and report on each as it ends.

    Returns:
        Whether an agent crashed or hung, now or in the episodes that were recorded before.

    Raises:
        ScenarioError: all the mistakes in the files; nothing was played.
        Mistake: the workers are too many, or some scenarios could not be run; the others were.
    """
    console, most = Console(), EACH * cpus()
    if workers and workers > most:
        raise Mistake(f"--workers: got {workers}; expected at most {most}, {EACH} for each CPU here.")

    def play(scenario: Scenario) -> bool:
        return _run(scenario, workers or cpus(), results, console)

    return any(each(read_all(paths, episodes), console, play))


def report_all(paths: Sequence[Path], results: Path) -> None:
    """Report on all that is recorded of some scenarios, however many episodes their files ask for."""
    console = Console()

    def report(scenario: Scenario) -> None:
        folder = results / scenario.name
        _report(scenario, folder, console, versions_of(folder))
        _say_differences(scenario, folder, console)

    each(read_all(paths, sys.maxsize), console, report)


def compare_all(paths: Sequence[Path], label: str, results: Path) -> None:
    """Compare all agents of some scenarios with the one of a label, in the variants where it plays."""
    console = Console()

    def compare(scenario: Scenario) -> None:
        labels, folder = _labels(scenario), results / scenario.name
        scenario = _against(scenario, label)
        read_run(folder)
        frame = store.read(folder, scenario, READS, versions_of(folder))
        lines = comparisons(summary(frame, scenario), scenario)
        if not lines.rows:
            unlike = f"no episodes of {label} are recorded beside those of another agent; use `fogbench run` first"
            hung = f"{label} hung in its first episodes, so it cannot be compared; mend it, or raise `hard_seconds`"
            told = hung if set(frame.loc[frame["agent"] == label, "outcome"]) == {Outcome.HUNG.name} else unlike
            raise Mistake(f"{folder}: {told}.")
        print_table("Paired", lines, console)
        page = folder / f"against-{stems(labels)[label]}.md"
        store.write(page, f"# {escaped(scenario.name)}, against {escaped(label)}\n\n{markdown(lines)}".encode())
        say(f"The table is in {page}", console)
        _say_differences(scenario, folder, console)

    each(read_all(paths, sys.maxsize), console, compare)


def _against(scenario: Scenario, label: str) -> Scenario:
    labels = _labels(scenario)
    if label not in labels:
        raise unknown(f"--against, {scenario.path}", label, labels)
    having = [variant for variant in scenario.variants if any(entry.label == label for entry in variant.agents)]
    return replace(scenario, variants=tuple(replace(variant, reference=label) for variant in having))


def _labels(scenario: Scenario) -> list[str]:
    return list(dict.fromkeys(entry.label for variant in scenario.variants for entry in variant.agents))


def _run(scenario: Scenario, workers: int, results: Path, console: Console) -> bool:
    folder = results / scenario.name
    refuse_idle(scenario)
    for note in dict.fromkeys(chain.from_iterable(map(notes, scenario.variants))):
        say(note, console)
    with Bars(scenario.name, console) as bars:
        played = run(scenario, folder, workers, bars.watch)
    say(_counts(played), console)
    for (variant, agent), count in played.hung.items():
        say(HUNG.format(agent=agent, variant=variant, count=count), console, style="yellow")
    return _report(scenario, folder, console, None)


def _counts(played: Summary) -> str:
    ended = ", ".join(f"{count} {outcome.name}" for outcome, count in played.outcomes.most_common())
    return f"{played.kept} episodes were recorded before, {played.outcomes.total()} were played now. {ended}".strip()


def _report(scenario: Scenario, folder: Path, console: Console, versions: Versions | None) -> bool:
    """Write and print a report of what was played under some versions of packages; whether an agent crashed or hung."""
    run_facts = read_run(folder)
    frame, stale = store.read(folder, scenario, READS, versions), store.stale(folder, scenario, versions)
    if frame.empty and stale and (folder / "summary.md").exists():
        say(OUTDATED.format(folder=folder, count=sum(stale.values())), console)
        return False
    table = write_tables(frame, scenario, run_facts, folder)
    print_tables(frame, table, scenario, console)
    for (variant, agent), count in stale.items():
        say(store.STALE.format(count=count, agent=agent, variant=variant), console)
    for line in write_plots(frame, table, scenario, run_facts, folder):
        say(line, console)
    say(f"Tables and plots are in {folder}/", console)
    _say_tracebacks(frame, folder, console)
    return bool(frame["outcome"].isin([Outcome.CRASHED.name, Outcome.HUNG.name]).any())


def _say_tracebacks(frame: "pd.DataFrame", folder: Path, console: Console) -> None:
    """Say where the traceback of each agent that crashed is."""
    crashed = frame.loc[frame["outcome"] == Outcome.CRASHED.name, "agent"].unique()
    for agent, place in ((agent, folder / FOLDER / crash_file(agent)) for agent in crashed):
        if place.exists():
            say(f"{agent}: the traceback of its first crash is in {place}", console)


def _say_differences(scenario: Scenario, folder: Path, console: Console) -> None:
    if line := differences(folder, scenario):
        say(line, console)
