"""Budgets and the bounds of tasks."""

import pytest
from pydantic import ValidationError

from fogbench.worlds.conditions import BudgetSettings, PerDistance, Tasks
from fogbench.worlds.types import Budget


def test_a_number_of_steps_is_the_same_at_every_distance() -> None:
    """A plain budget is handed on as it is."""
    settings = BudgetSettings(steps=40, hard_seconds=7, memory_bytes=64)
    assert settings.over(1) == settings.over(1000) == Budget(40, 7.0, 64)


@pytest.mark.parametrize(
    ("per_distance", "plus", "straight", "steps"),
    [(4, 20, 10, 60), (1.5, 0, 3, 4), (0.5, 2, 1, 2), (0.1, 0, 3, 1)],
)
def test_steps_per_distance_are_rounded_down(per_distance: float, plus: int, straight: float, steps: int) -> None:
    """`per_distance * straight + plus`, never less than one step."""
    budget = BudgetSettings.model_validate({"steps": {"per_distance": per_distance, "plus": plus}})
    assert budget.steps == PerDistance(per_distance=per_distance, plus=plus)
    assert budget.over(straight).steps == steps


def test_what_is_not_said_is_unlimited_but_for_the_hard_limit() -> None:
    """A budget needs only its steps."""
    assert BudgetSettings(steps=1).over(0) == Budget(1, 300.0, None)


def test_the_bounds_of_a_task() -> None:
    """As given, or so that every task can be solved within its steps."""
    assert Tasks(distance=(3, 9)).bounds(Budget(5)) == (3, 9)
    assert Tasks().bounds(Budget(5)) == (1, 5)


@pytest.mark.parametrize(
    "block",
    [
        {"steps": 0},
        {"steps": {"per_distance": 0}},
        {"steps": {"per_distance": 1, "plus": -1}},
        {"steps": {"plus": 3}},
        {"steps": 1, "hard_seconds": 0},
        {"steps": 1, "hard_seconds": float("inf")},
        {"steps": 1, "memory_bytes": 0},
        {"steps": 1, "seconds": 3},
        {},
    ],
)
def test_budgets_that_make_no_sense_are_refused(block: dict[str, object]) -> None:
    """No steps, no time, no bytes, and nothing unknown."""
    with pytest.raises(ValidationError):
        BudgetSettings.model_validate(block)
