"""Questions to two agents at once: an agent and the one it is compared with, on the episodes that both played.

Words used here
    pairs      a table of those episodes, with `outcome` and `length` of the agent (`*_ours`) and the other (`*_theirs`)
"""

import numpy as np
import pandas as pd

from fogbench.bench.reporting.metrics import Metric, Over, everything
from fogbench.bench.reporting.statistics import Estimate, difference, discordant, mcnemar, ratio_of_sums
from fogbench.worlds.types import Array, Outcome


def pair(cell: pd.DataFrame, reference: pd.DataFrame) -> pd.DataFrame:
    """The pairs of two cells: same world, same episode."""
    world = ["world_key", "episode"]
    columns = [*world, "outcome", "length"]
    return cell[columns].merge(reference[columns], on=world, suffixes=("_ours", "_theirs"))


def successes(pairs: pd.DataFrame) -> tuple[Array, Array]:
    """[n] bool each: which episodes the agent solved, and which the other."""
    ours, theirs = pairs["outcome_ours"], pairs["outcome_theirs"]
    return np.asarray(ours == Outcome.REACHED.name), np.asarray(theirs == Outcome.REACHED.name)


def _difference(pairs: pd.DataFrame) -> Estimate:
    return difference(*successes(pairs)).times(100)


def _only_agent(pairs: pd.DataFrame) -> Estimate:
    return Estimate(float(discordant(*successes(pairs))[0]), n=len(pairs))


def _only_reference(pairs: pd.DataFrame) -> Estimate:
    return Estimate(float(discordant(*successes(pairs))[1]), n=len(pairs))


def _mid_p(pairs: pd.DataFrame) -> Estimate:
    return Estimate(mcnemar(*discordant(*successes(pairs))), n=len(pairs))


def _length_ratio(pairs: pd.DataFrame) -> Estimate:
    return ratio_of_sums(pairs["length_ours"], pairs["length_theirs"])


def _number(pairs: pd.DataFrame) -> Estimate:
    return Estimate(float(len(pairs)), n=len(pairs))


COMMON = Over("common episodes", everything)
SOLVED = Over("commonly solved episodes", lambda pairs: np.logical_and(*successes(pairs)))

COMPARISONS = (
    Metric("success_difference", "success difference", "points", "higher", 1, COMMON,
           "Success of the agent minus success of the reference agent.", _difference),
    Metric("only_agent", "only agent", "episodes", "higher", 0, COMMON,
           "Episodes that the agent solved and the reference agent did not.", _only_agent),
    Metric("only_reference", "only reference", "episodes", "lower", 0, COMMON,
           "Episodes that the reference agent solved and the agent did not.", _only_reference),
    Metric("p", "p", "", "", 3, COMMON, "Mid-p of McNemar's test that both succeed equally often.", _mid_p),
    Metric("p_holm", "p (Holm)", "", "", 3, COMMON, "The same, adjusted by Holm's method over the scenario.", _mid_p),
    Metric("length_ratio", "length ratio", "", "lower", 3, SOLVED,
           "Sum of the agent's lengths / sum of the reference agent's.", _length_ratio),
    Metric("solved_by_both", "solved by both", "episodes", "", 0, SOLVED, "How many episodes that ratio is over.",
           _number),
)  # fmt: skip
"""What is asked of the pairs with the reference agent."""
