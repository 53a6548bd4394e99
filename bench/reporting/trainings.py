"""Several trainings of one network: their mean and their spread, since one of them alone may be luck.

Words used here
    trainings  agents of a variant whose labels differ only by `, seed N` at their end: `MACN` and `MACN, seed 1`
"""

import re
from collections.abc import Sequence

import numpy as np
import pandas as pd

from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.reporting.metrics import METRICS, Metric
from fogbench.bench.reporting.pairs import COMPARISONS, pair, successes
from fogbench.bench.reporting.statistics import Estimate, difference
from fogbench.bench.reporting.tables import NOTHING, Lines, heading, number, written
from fogbench.bench.reporting.words import reference_name

AVERAGED = tuple(
    metric for metric in METRICS if metric.name in {"success", "path_ratio", "reference_ratio", "test_error"}
)
DIFFERENCE = next(metric for metric in COMPARISONS if metric.name == "success_difference")


def trainings(frame: pd.DataFrame, table: pd.DataFrame, scenario: Scenario) -> Lines:
    """Each network of several trainings: the means over them, and in brackets the lowest and the highest.

    The interval of the difference from the reference agent is one over episodes, for these trainings.

    Args:
        frame: the recorded episodes, with the columns `fogbench.bench.reporting.report.READS`.
        table: their summary.
        scenario: says who plays against whom.
    """
    values = table.set_index(["variant", "agent", "metric"])["value"]
    told = [metric.of(reference_name(scenario)) for metric in (*AVERAGED, DIFFERENCE)]
    rows = []
    for variant in scenario.variants:
        cells = frame[frame["variant"] == variant.name]
        for network, labels in _networks(variant, cells).items():
            spreads = [_spread([values[variant.name, label, metric.name] for label in labels], metric)
                       for metric in AVERAGED]  # fmt: skip
            apart = _difference(cells, labels, variant.reference)
            rows.append([variant.name, network, str(len(labels)), *spreads, written(apart, DIFFERENCE)])
    return Lines(["variant", "network", "trainings", *map(heading, told)], rows)


def network_of(label: str) -> str:
    """The network that an agent is a training of, by its label; that of any other agent is itself."""
    return re.sub(r", seed \d+$", "", label)


def _networks(variant: Variant, cells: pd.DataFrame) -> dict[str, list[str]]:
    """The labels of the trainings of each network, where several have played, and all of them as much."""
    played = cells["agent"].value_counts()
    networks: dict[str, list[str]] = {}
    for label in (entry.label for entry in variant.agents):
        if label in played and label != variant.reference:
            networks.setdefault(network_of(label), []).append(label)
    alike = {network for network, labels in networks.items() if len(set(played[labels])) == 1}
    return {network: labels for network, labels in networks.items() if network in alike and len(labels) > 1}


def _spread(values: Sequence[float], metric: Metric) -> str:
    """Of those that are known: a training that never reached the goal has no length."""
    known = [value for value in values if np.isfinite(value)]
    if not known:
        return NOTHING
    return f"{number(float(np.mean(known)), metric)} ({number(min(known), metric)} to {number(max(known), metric)})"


def _difference(cells: pd.DataFrame, labels: Sequence[str], reference: str) -> Estimate:
    """Success minus that of the reference agent; of an episode, the mean over trainings."""
    pairs = pair(cells[cells["agent"].isin(labels)], cells[cells["agent"] == reference])
    ours, theirs = successes(pairs)
    each = pairs.assign(ours=ours, theirs=theirs).groupby(["world_key", "episode"])[["ours", "theirs"]].mean()
    return difference(each["ours"], each["theirs"]).times(100)
