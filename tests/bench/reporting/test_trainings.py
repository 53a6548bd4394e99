"""Means over trainings, by hand."""

from collections.abc import Callable

import pandas as pd
import pytest

from bench.reading.scenario import Scenario
from bench.reporting.report import summary
from bench.reporting.trainings import trainings

Recorded = Callable[..., pd.DataFrame]
Make = Callable[..., Scenario]

FAILED = {"outcome": "COLLIDED"}


@pytest.fixture
def scenario(make: Make) -> Scenario:
    """A* against two trainings of one network, and a lonely one."""
    labels = ("Net (x)", "Net (x), seed 1", "Other, seed 1")
    return make(agents=["astar", *({"random_walk": {"label": label}} for label in labels)])


def test_means_are_over_the_trainings_of_one_network(recorded: Recorded, scenario: Scenario) -> None:
    """Of 4 episodes they solve 2 each, A* 3: differences 0, -1/2, -1 and +1/2, so -25 points on average.

    The second also plays a fifth episode, which counts for its own values alone.
    """
    first, second = {"agent": "Net (x)"}, {"agent": "Net (x), seed 1", "length": 6.0, "wrong_decisions": 1}
    frame = recorded(
        *({"episode": k, **({} if k < 3 else FAILED)} for k in range(4)),
        *({"episode": k, **first, **({} if k in {0, 1} else FAILED)} for k in range(4)),
        *({"episode": k, **second, **({} if k in {0, 3} else FAILED)} for k in range(4)),
        {"episode": 4}, {"episode": 4, **second, **FAILED},
        {"episode": 0, "agent": "Other, seed 1"},
    )  # fmt: skip
    ((variant, network, number, success, ratio, _, error, difference),) = trainings(
        frame, summary(frame, scenario), scenario
    ).rows
    assert (variant, network, number) == ("short", "Net (x)", "2")
    assert success == "45.0 (40.0 to 50.0)"
    assert ratio == "1.250 (1.000 to 1.500)"
    assert error == "0.125 (0.000 to 0.250)"
    assert difference.startswith("-25.0 [")


def test_one_training_alone_has_no_mean(recorded: Recorded, scenario: Scenario) -> None:
    """Nor has a network whose second training has not played yet, or one that plays in another variant."""
    frame = recorded({}, {"agent": "Net (x)"}, {"agent": "Net (x), seed 1", "variant": "long"})
    assert trainings(frame, summary(frame, scenario), scenario).rows == []


def test_without_the_reference_agent_there_is_no_difference(recorded: Recorded, scenario: Scenario) -> None:
    """The means are there all the same."""
    frame = recorded({"agent": "Net (x)"}, {"agent": "Net (x), seed 1", **FAILED})
    ((*_, difference),) = trainings(frame, summary(frame, scenario), scenario).rows
    assert difference == "—"
