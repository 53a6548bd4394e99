"""Means over trainings, by hand."""

from collections.abc import Callable
from dataclasses import replace

import pandas as pd
import pytest

from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting.report import summary
from fogbench.bench.reporting.trainings import trainings

Recorded = Callable[..., pd.DataFrame]
Make = Callable[..., Scenario]

FAILED = {"outcome": "COLLIDED"}
FIRST, SECOND, THIRD = ({"agent": f"Net (x){end}"} for end in ("", ", seed 1", ", seed 2"))


@pytest.fixture
def scenario(make: Make) -> Scenario:
    """A* against three trainings of one network, and a lonely one."""
    labels = ("Net (x)", "Net (x), seed 1", "Net (x), seed 2", "Other, seed 1")
    return make(agents=["astar", *({"random_walk": {"label": label}} for label in labels)])


def rows_of(frame: pd.DataFrame, scenario: Scenario) -> list[list[str]]:
    """The rows of the table."""
    return [list(row) for row in trainings(frame, summary(frame, scenario), scenario).rows]


def episodes(reached: set[int], **fields: object) -> list[dict[str, object]]:
    """Four episodes, of which some reach the goal."""
    return [{"episode": k, **fields, **({} if k in reached else FAILED)} for k in range(4)]


def test_means_are_over_the_trainings_of_one_network(recorded: Recorded, scenario: Scenario) -> None:
    """Two of four episodes are solved by each, three by A*: differences 0, -1/2, -1 and +1/2.

    The interval is that of these and -1 and 1: -1/6 and 1.96 times 0.7454 / sqrt(6) around it.
    """
    frame = recorded(
        *episodes({0, 1, 2}), *episodes({0, 1}, **FIRST), *episodes({0, 3}, **SECOND, length=6.0, wrong_decisions=1),
        *episodes({0}, agent="Other, seed 1"),
    )  # fmt: skip
    assert rows_of(frame, scenario) == [
        ["short", "Net (x)", "2", "50.0 (50.0 to 50.0)", "1.250 (1.000 to 1.500)", "1.250 (1.000 to 1.500)",
         "0.125 (0.000 to 0.250)", "-25.0 [-76.3, 43.0]"],
    ]  # fmt: skip


def test_one_training_alone_has_no_mean(recorded: Recorded, scenario: Scenario) -> None:
    """Nor has a network whose other training plays in another variant."""
    assert rows_of(recorded({}, FIRST, {**SECOND, "variant": "long"}), scenario) == []


def test_trainings_that_have_not_played_as_much_have_no_mean(recorded: Recorded, scenario: Scenario) -> None:
    """What the first has lost by then, the others may still lose."""
    assert rows_of(recorded(*episodes({0}), *episodes({0}, **FIRST), *episodes({0}, **SECOND)), scenario) != []
    frame = recorded(*episodes({0}), *episodes({0}, **FIRST), *episodes({0}, **SECOND), {"episode": 0, **THIRD})
    assert rows_of(frame, scenario) == []


def test_a_training_that_never_arrives_has_no_length(recorded: Recorded, scenario: Scenario) -> None:
    """The others' mean stands there, wherever it is among them; of nobody's there is none."""
    frame = recorded({}, {**FIRST, **FAILED}, {**SECOND, "length": 6.0}, {**THIRD, **FAILED}).assign(episode=0)
    ((_, _, number, success, ratio, *_),) = rows_of(frame, scenario)
    assert (number, success, ratio) == ("3", "33.3 (0.0 to 100.0)", "1.500 (1.500 to 1.500)")
    nobody = recorded({}, {**FIRST, **FAILED}, {**SECOND, **FAILED}).assign(episode=0)
    assert rows_of(nobody, scenario)[0][4] == "—"


def test_the_reference_is_not_compared_with_itself(recorded: Recorded, scenario: Scenario) -> None:
    """Where one of the trainings is the reference agent, the others' difference from it is told."""
    variants = tuple(replace(variant, reference="Net (x)") for variant in scenario.variants)
    frame = recorded(FIRST, {**SECOND, **FAILED}, {**THIRD, **FAILED}).assign(episode=0)
    ((_, _, number, *_, difference),) = rows_of(frame, replace(scenario, variants=variants))
    assert (number, difference.partition(" ")[0]) == ("2", "-100.0")


def test_without_the_reference_agent_there_is_no_difference(recorded: Recorded, scenario: Scenario) -> None:
    """The means are there all the same."""
    ((*_, difference),) = rows_of(recorded(FIRST, {**SECOND, **FAILED}).assign(episode=0), scenario)
    assert difference == "—"
