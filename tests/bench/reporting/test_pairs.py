"""Comparisons: only what both played counts, by hand."""

from collections.abc import Callable

import pandas as pd
import pytest

from fogbench.bench.reporting.pairs import COMPARISONS, pair

Recorded = Callable[..., pd.DataFrame]
FAILED = {"outcome": "COLLIDED"}


@pytest.fixture
def pairs(recorded: Recorded) -> pd.DataFrame:
    """Five common episodes: two solved by both, two by the agent alone, one by the reference alone."""
    agent = recorded({"length": 6.0}, {"length": 9.0}, {"length": 70.0}, {"length": 80.0}, FAILED, {"length": 90.0})
    reference = recorded({"length": 4.0}, {"length": 8.0}, FAILED, FAILED, {"length": 50.0})
    return pair(agent, reference)


def test_pairs_are_the_same_episode_of_the_same_world(recorded: Recorded) -> None:
    """An episode that one of them lacks, or that it played in another world, has no pair."""
    agent = recorded({}, {}, {"world_key": "other"}, {})
    found = pair(agent, recorded({}, {}, {})[1:])
    assert found["episode"].tolist() == [1]


def test_comparisons_are_what_one_gets_by_hand(pairs: pd.DataFrame) -> None:
    """Of five pairs 2 against 1 discordant ones: p = 2 (1 + 3) / 8 - 3 / 8; lengths 15 / 12."""
    values = {metric.name: (metric(pairs).value, metric(pairs).n) for metric in COMPARISONS}
    assert values == {
        "success_difference": (pytest.approx(20), 5),
        "only_agent": (2, 5),
        "only_reference": (1, 5),
        "p": (pytest.approx(5 / 8), 5),
        "p_holm": (pytest.approx(5 / 8), 5),
        "length_ratio": (15 / 12, 2),
        "solved_by_both": (2, 2),
    }


def test_lengths_are_compared_on_commonly_solved_episodes_alone(pairs: pd.DataFrame) -> None:
    """The interval of 6/4 and 9/8 stays between the two, whatever one of them did alone."""
    ratio = next(metric for metric in COMPARISONS if metric.name == "length_ratio")(pairs)
    assert 9 / 8 <= ratio.low <= ratio.value <= ratio.high <= 6 / 4


def test_swapping_the_two_inverts_the_length_ratio(recorded: Recorded) -> None:
    """A ratio of sums treats both alike, as a mean of ratios would not."""
    long, short = recorded({"length": 6.0}, {"length": 9.0}), recorded({"length": 4.0}, {"length": 8.0})
    ratio = next(metric for metric in COMPARISONS if metric.name == "length_ratio")
    assert ratio(pair(long, short)).value * ratio(pair(short, long)).value == pytest.approx(1)
