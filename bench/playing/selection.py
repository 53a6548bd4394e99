"""What the options of a command choose: a variant of a scenario, and what is recorded of an agent in it."""

from pathlib import Path
from typing import Any

import pandas as pd

from fogbench.bench.playing import store
from fogbench.bench.playing.provenance import versions_of
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.worlds.mistake import Mistake, unknown

READS = ("variant", "agent", "episode", "outcome", "steps", "length", "shortest", "actions", "detail")
"""The columns of `fogbench.bench.playing.episode.Episode` that a replay needs."""


def chosen_variant(scenario: Scenario, name: str | None) -> Variant:
    """The variant of a name; None: the first.

    Raises:
        Mistake: the scenario has no such variant, or is skipped.
    """
    if scenario.skipped:
        raise Mistake(f"{scenario.name}: skipped, {scenario.skipped}.")
    for variant in scenario.variants:
        if name in (None, variant.name):
            return variant
    raise unknown("--variant", str(name), (each.name for each in scenario.variants))


def chosen_rows(scenario: Scenario, variant: Variant, agent: str, folder: Path) -> pd.DataFrame:
    """All that is recorded of an agent in a variant, with the columns `READS`, by the versions of the last session."""
    rows = store.read(folder, scenario, READS, versions_of(folder))
    return rows[(rows["variant"] == variant.name) & (rows["agent"] == agent)]


def chosen_row(scenario: Scenario, variant: Variant, agent: str, episode: int, folder: Path) -> dict[str, Any]:
    """One recorded episode.

    Raises:
        Mistake: it is not recorded.
    """
    rows = chosen_rows(scenario, variant, agent, folder)
    found = rows[rows["episode"] == episode]
    if len(found):
        return {str(name): value for name, value in found.iloc[0].items()}
    labels = [entry.label for entry in variant.agents if not entry.skipped]
    if agent not in labels:
        raise unknown("--agent", agent, labels)
    count = store.stale(folder, scenario, versions_of(folder)).get((variant.name, agent))
    span = f"from {rows['episode'].min()} to {rows['episode'].max()}"
    lacking = (
        f"--episode: got {episode}; expected one of the {len(rows)} of {agent} in variant {variant.name}, {span}."
        if len(rows)
        else f"{folder}: no episode of {agent} in variant {variant.name} is recorded; use `fogbench run` first."
    )
    raise Mistake(lacking + (f" {store.STALE.format(count=count, agent=agent, variant=variant.name)}" if count else ""))
