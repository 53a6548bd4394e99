"""The runner: what is not recorded yet is played, and recorded."""

from collections import Counter
from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from pathlib import Path
from typing import NamedTuple

from fogbench.bench.playing.enough import refuse_unplayable
from fogbench.bench.playing.keys import keys
from fogbench.bench.playing.local import Job, RunError, play_here
from fogbench.bench.playing.outdated import sort_rows
from fogbench.bench.playing.provenance import noted
from fogbench.bench.playing.recorder import recording
from fogbench.bench.playing.store import recorded
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.types import Outcome

CHANGED = (
    "got other sources, files or packages of {what} than when the run began; expected them to stay as they are until "
    "it ends. What was played is kept; run the same command again to play the rest."
)
"""What is told when something that counts was edited meanwhile."""

Recorded = dict[tuple[str, str], set[int]]
"""The recorded episodes of each (variant, agent)."""


class Progress(NamedTuple):
    """How far one agent is in one variant."""

    variant: str
    agent: str
    done: int
    total: int
    outcome: Outcome | None
    """How its last episode ended; None: the count before the first."""


@dataclass
class Summary:
    """What a run did."""

    kept: int
    """Episodes that were recorded before."""
    outcomes: Counter[Outcome] = field(default_factory=Counter)
    """How the episodes ended that were played now."""


def run(scenario: Scenario, folder: Path, workers: int, watch: Callable[[Progress], None]) -> Summary:
    """Play and record all episodes of a scenario that are not recorded yet.

    Args:
        scenario: what to play; the workers read its text again.
        folder: of its store.
        workers: processes side by side; their number changes nothing in the records but the timings.
        watch: told the count of each variant and agent before the first episode, then after each of theirs.

    Raises:
        RunError: what plays was edited meanwhile, or the project has a bug.
        StoreError: the store is broken, or cannot be written.
        Mistake: another run records there, or a world cannot be made of what is left to play.
    """
    covariates = dict.fromkeys(name for variant in scenario.variants for name in variant.conditions.covariates)
    with recording(folder, tuple(covariates)) as recorder:
        sort_rows(folder, scenario)
        expected = keys(scenario)
        done = recorded(folder, scenario)
        counts = {pair: len(episodes) for pair, episodes in done.items()}
        totals = _totals(scenario)
        for pair, total in totals.items():
            watch(Progress(*pair, counts.setdefault(pair, 0), total, None))
        summary = Summary(kept=sum(counts.values()))
        workers = min(workers, sum(totals.values()) - summary.kept)
        if not workers:
            return summary
        left = {variant for (variant, agent), total in totals.items() if counts[variant, agent] < total}
        refuse_unplayable(variant for variant in scenario.variants if variant.name in left)
        with noted(folder, scenario, workers):
            for row in play_here(scenario, _jobs(scenario, done), workers):
                if row is None:
                    recorder.flush_if_due()
                    continue
                pair, outcome = (row.variant, row.agent), Outcome[row.outcome]
                if (row.agent_key, row.world_key) != expected[pair]:
                    raise RunError(f"{row.variant}, episode {row.episode}: {CHANGED.format(what=row.agent)}")
                recorder.append(row)
                counts[pair] += 1
                summary.outcomes[outcome] += 1
                watch(Progress(*pair, counts[pair], totals[pair], outcome))
    return summary


def _totals(scenario: Scenario) -> dict[tuple[str, str], int]:
    return {
        (variant.name, entry.label): variant.episodes
        for variant in scenario.variants
        for entry in variant.agents
        if not entry.skipped
    }


def _jobs(scenario: Scenario, done: Recorded) -> Iterator[Job]:
    """What is left to play; all agents of an episode one after the other, so that a worker may still have its world."""
    for variant in scenario.variants:
        labels = [entry.label for entry in variant.agents if not entry.skipped]
        for episode in range(variant.episodes):
            for label in labels:
                if episode not in done.get((variant.name, label), ()):
                    yield Job(variant.name, label, episode, variant.conditions.budget.hard_seconds)
