"""Random worlds, and agents played in them without the episode loop."""

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

import numpy as np
import pytest

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.rules import SquareView
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.layout import Layout, fit
from fogbench.worlds.types import BLOCKED, FREE, Agent, AgentSettings, Budget, Move, Observation, Step, Task


class Moment(NamedTuple):
    """One decision, and what became of it."""

    agent: Agent
    observation: Observation
    action: Move | None
    step: Step | None
    """None where the agent gave up."""


@pytest.fixture(scope="session")
def strew() -> Callable[..., GridWorld]:
    """Makes a connected world of cells that are blocked with probability `density`, of 2 x 2 to `side` x `side`."""

    def make(
        rng: np.random.Generator, side: int = 10, density: float = 0.3, steps: int = 2000, **fields: Any
    ) -> GridWorld:
        conditions = GridConditions.model_validate({"budget": {"steps": steps}, **fields})
        while True:
            blocked = rng.random(rng.integers(2, side, size=2, endpoint=True)) < density  # [H, W]
            world = fit(Layout(blocked), conditions, rng)
            if world is not None:
                return world

    return make


@pytest.fixture(scope="session")
def explore() -> Callable[..., Iterator[Moment]]:
    """Plays an agent in a world until it is there, collides, gives up or is out of steps, one moment at a time."""

    def play(settings: AgentSettings, world: GridWorld, rng: np.random.Generator) -> Iterator[Moment]:
        agent, state = settings.start(world.task, rng), world.reset()
        for _ in range(world.task.budget.steps):
            observation = world.sense(state, rng)
            action = agent.act(observation)
            step = None if action is None else world.step(state, action, rng)
            yield Moment(agent, observation, action, step)
            if step is None or step.reached or step.collided:
                return
            state = step.state

    return play


@pytest.fixture
def misled() -> Callable[[AgentSettings], tuple[list[Move | None], list[int]]]:
    """Closes the known map of an agent in a corridor of four cells by a false reading of the goal at its right end.

    It first stands beside the goal, then one cell further off, where it no longer sees it. Returned are its two actions
    and how many cells it had expanded by then.
    """
    task = Task("grid", (0, 3), SquareView(radius=1), Budget(2), (1, 4))

    def play(settings: AgentSettings) -> tuple[list[Move | None], list[int]]:
        agent = settings.start(task, np.random.default_rng(0))
        actions, expanded = [], []
        for step, (column, right) in enumerate([(2, BLOCKED), (1, FREE)]):
            view = np.full((3, 3), BLOCKED, np.uint8)  # [K, K]
            view[1] = FREE, FREE, right
            actions.append(agent.act(Observation(step, (0, column), view, blocked=False)))
            expanded.append(agent.search_nodes())
        return actions, expanded

    return play
