"""What a report says, table by table, and `summary.md`, the page that holds them all."""

from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import pandas as pd

from fogbench.bench.playing.agenda import is_given_up, outcomes
from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting.metrics import METRICS, Metric
from fogbench.bench.reporting.pairs import COMPARISONS
from fogbench.bench.reporting.plain import escaped
from fogbench.bench.reporting.statistics import Estimate
from fogbench.bench.reporting.tables import NOTHING, Lines, heading, markdown, written
from fogbench.bench.reporting.trainings import trainings
from fogbench.bench.reporting.words import reference_name
from fogbench.worlds.types import Outcome

HEADLINE = (
    "success", "path_ratio", "reference_ratio", "test_error", "decision_p50", "decision_p95", "memory_max", "p_holm",
)  # fmt: skip
"""The metrics of the first table."""

READING = (
    "Brackets are 95 % intervals: Wilson's for shares, Bonett and Price's for paired differences, the bootstrap over "
    f"episodes for means and ratios. {NOTHING} stands where nothing was measured or published."
)

NAMED = 5
"""Episodes that are named of those that ended alike."""

LONGEST = 200
"""Characters of a detail or a reason at most."""

GIVEN_UP = "; not asked for more, so it has no rate: mend it, or raise `hard_seconds`"
"""What is told of an agent that hung in its first episodes."""

Found = Mapping[tuple[str, str, str], Estimate]
"""The estimates of a summary by variant, agent and name of the metric."""


def asked(scenario: Scenario) -> dict[str, Metric]:
    """All that is asked, by name, in the words of the kinds of world of a scenario."""
    return {metric.name: metric.of(reference_name(scenario)) for metric in (*METRICS, *COMPARISONS)}


def headline(table: pd.DataFrame, scenario: Scenario, *, short: bool = False) -> Lines:
    """The results, a row for each agent of each variant; the published numbers stand beside.

    `short` leaves out all intervals and published numbers but those of success: so much fits a terminal.
    """
    found, metrics = _found(table), asked(scenario)
    full = {name for name in HEADLINE if name == "success" or not short}
    headings = ["variant", "agent", "n"]
    for name in HEADLINE:
        headings += [heading(metrics[name]), *(["published"] if name in full & scenario.published.keys() else [])]
    rows = [_row(variant, agent, found, scenario, full) for variant, agent in _places(scenario)]
    return Lines(headings, rows)


def comparisons(table: pd.DataFrame, scenario: Scenario) -> Lines:
    """Each agent against the reference agent, on the episodes that both played."""
    found = _found(table)
    rows = [
        [variant.name, entry.label, variant.reference,
         *(written(found[variant.name, entry.label, metric.name], metric) for metric in COMPARISONS)]
        for variant in scenario.variants
        for entry in variant.agents
        if (variant.name, entry.label, COMPARISONS[0].name) in found
    ]  # fmt: skip
    return Lines(["variant", "agent", "reference", *map(heading, COMPARISONS)], rows)


def failures(frame: pd.DataFrame) -> Lines:
    """How often each agent failed in which way, in which episodes, and the first thing that was said about it, if any.

    `fogbench replay --episode` shows one.
    """
    failed = frame[frame["outcome"] != Outcome.REACHED.name]
    given_up = {
        place for place, rows in failed.groupby(["variant", "agent"], sort=False) if is_given_up(outcomes(rows))
    }
    headings, rows = ["variant", "agent", "outcome", "count", "episodes", "first detail"], list[list[str]]()
    for place, group in failed.groupby(["variant", "agent", "outcome"], sort=False):
        numbers = [*map(str, sorted(group["episode"])[:NAMED]), *(["…"] if len(group) > NAMED else [])]
        detail = next(filter(None, group["detail"]), NOTHING) + (GIVEN_UP if place[:2] in given_up else "")
        rows.append([*map(str, place), str(len(group)), ", ".join(numbers), _brief(detail)])
    told = failed["detail"].any()
    return Lines(headings, rows) if told else Lines(headings[:-1], [row[:-1] for row in rows])


def skipped(scenario: Scenario) -> Lines:
    """Who did not run, and why."""
    rows = [[name, NOTHING, _brief(reason)] for name, reason in scenario.left_out.items()]
    rows += [
        [variant.name, entry.label, _brief(scenario.skipped or entry.skipped)]
        for variant in scenario.variants
        for entry in variant.agents
        if scenario.skipped or entry.skipped
    ]
    return Lines(["variant", "agent", "reason"], rows)


def columns(scenario: Scenario) -> Lines:
    """What is asked, in which unit, and of which episodes."""
    rows = [
        [metric.heading, metric.name, metric.unit or NOTHING, metric.better or NOTHING, metric.over.words,
         metric.about]
        for metric in asked(scenario).values()
    ]  # fmt: skip
    return Lines(["column", "in summary.csv", "unit", "better", "over", "what it says"], rows)


def sections(frame: pd.DataFrame, table: pd.DataFrame, scenario: Scenario) -> dict[str, Lines]:
    """The tables of a report beside the results, by their titles, in order; those without a row are left out."""
    found = {
        "Trainings of one network: mean, lowest and highest": trainings(frame, table, scenario),
        "Paired with the reference agent, on the same episodes": comparisons(table, scenario),
        "Failures": failures(frame),
        "Skipped": skipped(scenario),
    }
    return {title: lines for title, lines in found.items() if lines.rows}


def page(
    frame: pd.DataFrame, table: pd.DataFrame, scenario: Scenario, run: Mapping[str, Any], plots: Sequence[str]
) -> str:
    """The Markdown of `summary.md`; `plots` are the names of its pictures."""
    source = scenario.published.get("source")
    parts = [
        f"# {escaped(scenario.name)}\n",
        f"{escaped(scenario.about)}\n",
        markdown(headline(table, scenario)),
        READING + (f" Published: {escaped(source)}.\n" if source else "\n"),
        *(f"![{plot.removesuffix('.png').replace('_', ' ')}]({plot})\n" for plot in plots),
    ]
    for title, lines in sections(frame, table, scenario).items():
        parts += [f"## {title}\n", markdown(lines)]
    parts += ["## How it was measured\n", "".join(f"- {escaped(fact)}\n" for fact in _facts(run))]
    parts += ["## What the columns say\n", markdown(columns(scenario))]
    return "\n".join(parts)


def _brief(text: str) -> str:
    """The text in one line of at most `LONGEST` characters."""
    line = " ".join(text.split())
    return line if len(line) <= LONGEST else f"{line[: LONGEST - 1]}…"


def _places(scenario: Scenario) -> Iterator[tuple[str, str]]:
    """Variant and agent of each row: those of the scenario, then those that only the publication has."""
    published = [numbers for metric, numbers in scenario.published.items() if metric in HEADLINE]
    for variant in scenario.variants:
        agents = [entry.label for entry in variant.agents]
        agents += [agent for numbers in published for agent, cells in numbers.items() if variant.name in cells]
        yield from ((variant.name, agent) for agent in dict.fromkeys(agents))


def _row(variant: str, agent: str, found: Found, scenario: Scenario, full: set[str]) -> list[str]:
    row = [variant, agent, str(found.get((variant, agent, "success"), Estimate()).n or NOTHING)]
    for name, metric in asked(scenario).items():
        if name in HEADLINE:
            row.append(written(found.get((variant, agent, name), Estimate()), metric, interval=name in full))
            if name in full & scenario.published.keys():
                row.append(_published(scenario, metric, variant, agent))
    return row


def _published(scenario: Scenario, metric: Metric, variant: str, agent: str) -> str:
    value = scenario.published[metric.name].get(agent, {}).get(variant)
    return NOTHING if value is None else f"{value:g}".replace("inf", "∞")


def _found(table: pd.DataFrame) -> Found:
    columns = (table[name] for name in ("variant", "agent", "metric", "value", "low", "high", "n"))
    return {(v, a, m): Estimate(value, low, high, n) for v, a, m, value, low, high, n in zip(*columns, strict=True)}


def _facts(run: Mapping[str, Any]) -> Iterator[str]:
    """What `run.json` says of the seeds and the machine; sessions that differ are told one after the other."""
    sessions = run["sessions"]
    yield f"seed: {', '.join(dict.fromkeys(map(str, run['seeds'].values())))}"
    for name in ("workers", "cpu", "cores", "system", "commit"):
        yield f"{name}: {', '.join(dict.fromkeys(str(session[name] or NOTHING) for session in sessions))}"
    for versions in {str(session["versions"]): session["versions"] for session in sessions}.values():
        yield f"versions: {', '.join(f'{package} {version}' for package, version in versions.items())}"
