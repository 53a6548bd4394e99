"""Grids side by side, held against `GridWorld` one by one: step by step, bit for bit."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import partial
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fogbench.worlds.batch import WorldByWorld, batch_of
from fogbench.worlds.grid.batch import GridBatch
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.world import GridState, GridWorld
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.bug_trap import BugTrap
from fogbench.worlds.maps.families.maze import Maze
from fogbench.worlds.maps.families.rooms import Rooms
from fogbench.worlds.maps.families.tunnel import Tunnel
from fogbench.worlds.types import Array, Move

FAMILIES: list[Any] = [
    Blobs(size=9, obstacles=(2, 9), obstacle_size=(1, 3)),
    Blobs(size=16, obstacles=(0, 12), obstacle_size=(1, 3)),
    Tunnel(length=(4, 9), open=0.3333),
    Tunnel(length=(4, 9), goal="inside"),
    Maze(size=11),
    Rooms(size=15, rooms=(2, 2), doors=(1, 2)),
    BugTrap(size=17, depth=(3, 6), width=(5, 7)),
]

SENSORS = st.fixed_dictionaries(
    {"radius": st.integers(1, 5), "occlusion": st.booleans(), "false_readings": st.sampled_from([0.0, 0.2])}
)
RULES = st.fixed_dictionaries(
    {
        "collision": st.sampled_from(["fails", "blocked"]),
        "slip": st.sampled_from([0.0, 0.3]),
        "slip_to": st.sampled_from(["stay", "sideways"]),
    }
)
SETTINGS = st.tuples(st.sampled_from(FAMILIES), SENSORS, RULES, st.integers(3, 30))


@dataclass
class Alone:
    """One episode, played by its own world."""

    world: GridWorld
    luck: np.random.Generator
    state: GridState = field(init=False)

    def __post_init__(self) -> None:
        """Begin."""
        self.state = self.world.reset()


def luck_of(number: int) -> np.random.Generator:
    """The luck of an episode."""
    return np.random.default_rng(number)


def world_of(made: tuple[Any, Any, Any, int], seed: int) -> GridWorld:
    """A world of some settings."""
    family, sensor, rules, steps = made
    block = {"sensor": sensor, "rules": rules, "budget": {"steps": steps}, "tasks": {"distance": [1, 60]}}
    world: GridWorld = family.sample(luck_of(seed), 0, GridConditions.model_validate(block))
    return world


def hold(batch: Any, alone: dict[int, Alone], moves: Callable[[int], Array]) -> Array:
    """One step of all, in both forms; which slots go on."""
    slots = np.array(sorted(alone))
    told = batch.sense(slots)
    assert len(told) == len(slots)
    for k, slot in enumerate(slots.tolist()):
        one = alone[slot].world.sense(alone[slot].state, alone[slot].luck)
        assert told[k]._replace(view=0) == one._replace(view=0)
        assert np.array_equal(told[k].view, one.view)
        assert not told[k].view.flags.writeable
    chosen = moves(len(slots))
    done = batch.step(slots, chosen)
    for k, slot in enumerate(slots.tolist()):
        each = alone[slot]
        step = each.world.step(each.state, Move(chosen[k]), each.luck)
        each.state = step.state
        assert (done.lengths[k], done.collided[k], done.reached[k]) == (step.length, step.collided, step.reached)
        spent = step.state.step >= each.world.task.budget.steps
        assert done.spent[k] == spent
        assert done.over[k] == (step.collided or step.reached or spent)
    return slots[~done.over]


@settings(max_examples=500, deadline=None)
@given(made=st.lists(SETTINGS, min_size=1, max_size=5), seed=st.integers(0, 2**32 - 1), anew=st.booleans())
def test_a_batch_is_its_worlds(made: list[tuple[Any, Any, Any, int]], seed: int, anew: bool) -> None:
    """Whatever families, sensors and rules stand side by side, and whichever slots get other episodes."""
    worlds = [world_of(each, seed + k) for k, each in enumerate(made)]
    batch, live = batch_of(worlds), np.arange(len(worlds))
    assert isinstance(batch, GridBatch)
    batch.reset(live, worlds, [partial(luck_of, seed + k) for k in range(len(worlds))])
    alone = {k: Alone(world, luck_of(seed + k)) for k, world in enumerate(worlds)}
    luck = luck_of(seed)
    for turn in range(20):
        live = hold(batch, alone, lambda n: luck.integers(4, size=n))
        for slot in alone.keys() - {*live.tolist()}:
            del alone[slot]
            if anew:
                fresh = world_of(made[turn % len(made)], seed + 100 + turn)
                batch.reset(np.array([slot]), [fresh], [partial(luck_of, turn)])
                alone[slot] = Alone(fresh, luck_of(turn))
        if not alone:
            break


def test_worlds_of_their_own_rules_stand_side_by_side_one_by_one() -> None:
    """A subclass inherits no batch; neither do worlds of several classes."""

    class Wind(GridWorld):
        """Another world."""

    plain = world_of((FAMILIES[0], {}, {}, 9), 1)
    windy = Wind(**{name: getattr(plain, name) for name in ("blocked", "start", "task", "rules", "optimum", "posts")})
    assert isinstance(batch_of([plain, plain]), GridBatch)
    for worlds in ([windy], [plain, windy]):
        batch = batch_of(worlds)
        assert isinstance(batch, WorldByWorld)
        alone = {k: Alone(world, luck_of(k)) for k, world in enumerate(worlds)}
        batch.reset(np.arange(len(worlds)), worlds, [partial(luck_of, k) for k in range(len(worlds))])
        luck = luck_of(7)
        for _ in range(9):
            hold(batch, alone, lambda n: [Move(move) for move in luck.integers(4, size=n)])  # noqa: B023


@pytest.mark.parametrize("move", [-1, 4])
def test_no_move(move: int) -> None:
    """What is none of the four moves is refused before anything moves."""
    world = world_of((FAMILIES[0], {}, {}, 9), 1)
    batch = batch_of([world])
    batch.reset(np.arange(1), [world], [partial(luck_of, 0)])
    with pytest.raises(TypeError) as caught:
        batch.step(np.arange(1), [move])
    assert str(caught.value) == f"got the moves [{move}]; expected numbers from 0 to 3"
    assert batch.sense(np.arange(1))[0].place == world.start
