"""Who teaches in a world, and what is told where nobody can."""

from collections.abc import Callable
from typing import Any

import pytest

from fogbench.learned.training.trials import teacher_in
from fogbench.planners import JUDGES
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.mistake import Mistake


class Blind:
    """Teaches nothing, and knows no world."""

    def __init__(self, task: Any) -> None:
        """Whatever the task."""


def refusal(world: GridWorld, *, hindsight: bool) -> str:
    """Why nobody teaches."""
    with pytest.raises(Mistake) as caught:
        teacher_in(world, hindsight=hindsight)
    return str(caught.value)


def test_a_kind_without_a_judge_teaches_nothing(
    draw: Callable[..., GridWorld], monkeypatch: pytest.MonkeyPatch
) -> None:
    """One line says so, and which kinds have one; a judge that knows no world teaches without hindsight alone."""
    world = draw("S..\n..G")
    monkeypatch.setitem(JUDGES, "grid", Blind)
    assert isinstance(teacher_in(world), Blind)
    assert refusal(world, hindsight=True) == (
        "got hindsight in worlds of kind grid, whose judge has none; expected hindsight: false"
    )
    monkeypatch.delitem(JUDGES, "grid")
    monkeypatch.setitem(JUDGES, "ring", Blind)
    assert refusal(world, hindsight=False) == (
        "got worlds of kind grid, where nobody says which actions are right; expected one of graph, robot, ring"
    )
