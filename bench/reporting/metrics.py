"""Questions to the recorded episodes of an agent: one table, in which each says its unit, direction and episodes.

Words used here
    cell       the episodes of one agent in one variant: rows of `fogbench.bench.playing.episode`
    optimum    the shortest path on the full map
    reference  the same-information reference of the kind of world, which is recorded with every episode; its name, such
               as A*, stands in place of `{reference}` where a metric is told
"""

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
import pandas as pd
import pyarrow as pa
import pyarrow.compute as pc
from numpy.typing import ArrayLike

from fogbench.bench.playing.episode import SCHEMA
from fogbench.bench.reporting.statistics import Estimate, mean, ratio_of_sums, share
from fogbench.worlds.types import Array, Outcome


class Over(NamedTuple):
    """The episodes that a metric is made of."""

    words: str
    chosen: Callable[[pd.DataFrame], Array]
    """[n] bool of a table of n episodes."""


@dataclass(frozen=True, slots=True)
class Metric:
    """One question to a table of episodes."""

    name: str
    heading: str
    unit: str
    better: str
    """`higher`, `lower`, or empty where neither is better."""
    digits: int
    """Digits after the point that a report prints; of times and bytes, significant digits."""
    over: Over
    about: str
    measure: Callable[[pd.DataFrame], Estimate]

    def of(self, reference: str) -> "Metric":
        """The same, told of a reference by its name."""
        heading, about, words = (
            text.format(reference=reference) for text in (self.heading, self.about, self.over.words)
        )
        return replace(self, heading=heading, about=about, over=self.over._replace(words=words))

    def __call__(self, episodes: pd.DataFrame) -> Estimate:
        """The answer, from those of the episodes that the metric is over."""
        return self.measure(episodes[self.over.chosen(episodes)])


def everything(episodes: pd.DataFrame) -> Array:
    """[n] bool: all of them."""
    return np.ones(len(episodes), np.bool_)


def reached(cell: pd.DataFrame) -> Array:
    """[n] bool: those that reached the goal."""
    return np.asarray(cell["outcome"] == Outcome.REACHED.name)


def decided(cell: pd.DataFrame) -> Array:
    """[n] bool: those with a decision; a process that hung or died left nothing but the facts of its world."""
    return np.asarray(pc.list_value_length(_lists(cell)).fill_null(0)) > 0


def decision_milliseconds(cell: pd.DataFrame) -> Array:
    """[decisions] float64, of the episodes one after the other."""
    return 1e3 * np.asarray(pc.list_flatten(_lists(cell)), np.float64)


def spl(cell: pd.DataFrame) -> Array:
    """[n] success weighted by path length, 0 to 1 (Anderson et al. 2018, equation 1)."""
    return np.where(reached(cell), cell["shortest"] / np.maximum(cell["length"], cell["shortest"]), 0.0)


def _lists(cell: pd.DataFrame) -> Any:
    return pa.array(cell["decision_seconds"], type=SCHEMA.field("decision_seconds").type, from_pandas=True)


def _mean(name: str) -> Callable[[pd.DataFrame], Estimate]:
    return lambda cell: mean(cell[name])


def _ratio(name: str) -> Callable[[pd.DataFrame], Estimate]:
    return lambda cell: mean(cell["length"] / cell[name])


def _errors(name: str) -> Callable[[pd.DataFrame], Estimate]:
    return lambda cell: ratio_of_sums(cell[name], cell["judged"])


def _decisions(percent: float) -> Callable[[pd.DataFrame], Estimate]:
    return lambda cell: _percentile(decision_milliseconds(cell), percent)


def _percentile(values: ArrayLike, percent: float) -> Estimate:
    values = np.asarray(values)
    return Estimate(float(np.percentile(values, percent)), n=len(values)) if len(values) else Estimate()


def _count(outcome: Outcome) -> Callable[[pd.DataFrame], Estimate]:
    return lambda cell: Estimate(float(np.sum(cell["outcome"] == outcome.name)), n=len(cell))


ALL = Over("all episodes", everything)
DECIDED = Over("episodes with a decision", decided)
OWN = Over("own successes", reached)
BOTH = Over("own successes that {reference} solved too", lambda cell: reached(cell) & cell["reference_length"].notna())

METRICS = (
    Metric("success", "success", "%", "higher", 1, ALL, "Episodes that reached the goal.",
           lambda cell: share(reached(cell)).times(100)),
    Metric("spl", "SPL", "", "higher", 3, ALL, "Mean of success x optimum / max(length, optimum).",
           lambda cell: mean(spl(cell))),
    Metric("path_ratio", "ratio to optimum", "", "lower", 3, OWN,
           "Mean of length / length of the shortest path on the full map.", _ratio("shortest")),
    Metric("reference_ratio", "ratio to {reference}", "", "lower", 3, BOTH,
           "Mean of length / length of {reference} on the map seen so far, in the same world.",
           _ratio("reference_length")),
    Metric("test_error", "test error", "", "lower", 3, DECIDED,
           "Share of decisions that no optimal plan on the agent's own known map takes; without a plan none is judged.",
           _errors("wrong_decisions")),
    Metric("strict_error", "strict error", "", "lower", 3, DECIDED,
           "Share of the same decisions that differ from those of {reference} on the agent's own known map.",
           _errors("strict_wrong")),
    Metric("decision_p50", "decision p50", "ms", "lower", 3, DECIDED, "Median time of a decision.", _decisions(50)),
    Metric("decision_p95", "decision p95", "ms", "lower", 3, DECIDED, "95th percentile of the same.", _decisions(95)),
    Metric("decision_max", "decision max", "ms", "lower", 3, DECIDED, "The largest of the same.", _decisions(100)),
    Metric("setup", "setup", "ms", "lower", 3, DECIDED, "Median time before the first decision.",
           lambda cell: _percentile(cell["setup_seconds"], 50).times(1e3)),
    Metric("memory_mean", "memory mean", "bytes", "lower", 3, DECIDED,
           "Mean over episodes of the most bytes carried from one decision to the next.", _mean("peak_memory_bytes")),
    Metric("memory_max", "memory max", "bytes", "lower", 3, DECIDED, "The largest of the same.",
           lambda cell: _percentile(cell["peak_memory_bytes"], 100)),
    Metric("steps", "steps", "steps", "lower", 1, OWN, "Mean number of decisions carried out.", _mean("steps")),
    Metric("search_nodes", "search nodes", "nodes", "lower", 0, DECIDED,
           "Mean number of nodes expanded or tree vertices added in an episode.", _mean("search_nodes")),
    *(Metric(f"outcome_{outcome.name.lower()}", outcome.name, "episodes", "", 0, ALL, outcome.value, _count(outcome))
      for outcome in Outcome),
)  # fmt: skip
"""What is asked of every cell."""
