"""The grid world, step by step through episodes small enough to follow by hand."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.cells import manhattan
from fogbench.worlds.maps.sight import look, misread
from fogbench.worlds.types import Cell, Move, Observation, Step

Draw = Callable[..., GridWorld]
D, R, U, L = Move

CORNER = """
    S..
    .#.
    ..G
"""

CROSS = """
    #.#
    .S.
    #.#
    ##G
"""


class Luck:
    """Stands in for a generator: hands out the numbers it was given."""

    def __init__(self, *numbers: float) -> None:
        """Numbers in the order in which they are drawn."""
        self.numbers = list(numbers)

    def random(self, count: int) -> list[float]:
        """The next `count` numbers."""
        drawn, self.numbers = self.numbers[:count], self.numbers[count:]
        return drawn


def walk(world: GridWorld, *moves: Move, luck: Any = None) -> list[Step]:
    """What each move of an episode did."""
    state, steps = world.reset(), []
    for move in moves:
        steps.append(world.step(state, move, luck))
        state = steps[-1].state
    return steps


def places(steps: list[Step]) -> list[Cell]:
    """Where the agent was after each step."""
    return [step.state.place for step in steps]


def test_an_episode_to_the_goal(draw: Draw) -> None:
    """Moves change the place by their delta, each is one cell long, and only the goal ends it."""
    steps = walk(draw(CORNER), R, R, D, D)
    assert places(steps) == [(0, 1), (0, 2), (1, 2), (2, 2)]
    assert [step.state.step for step in steps] == [1, 2, 3, 4]
    assert [step.length for step in steps] == [1.0] * 4
    assert [step.reached for step in steps] == [False, False, False, True]
    assert not any(step.collided or step.state.blocked for step in steps)


@pytest.mark.parametrize(("collision", "collided"), [("fails", True), ("blocked", False)])
@pytest.mark.parametrize("moves", [(U,), (L,), (R, D), (D, R)])
def test_a_collision_goes_nowhere(draw: Draw, collision: str, collided: bool, moves: tuple[Move, ...]) -> None:
    """Walls and the border stop a move; whether that is a collision is for the rules to say."""
    world = draw(CORNER, collision=collision)
    *before, last = walk(world, *moves)
    assert last.state.place == (before[-1].state.place if before else world.start)
    assert (last.length, last.collided, last.state.blocked) == (0.0, collided, True)


def test_blocked_is_said_of_the_last_move_alone(draw: Draw) -> None:
    """An observation tells of a stopped move, and no longer after the next one."""
    world = draw(CORNER, collision="blocked")
    states = [world.reset(), *(step.state for step in walk(world, U, D, R, D))]
    told = [world.sense(state, np.random.default_rng(0)).blocked for state in states]
    assert told == [False, True, False, True, False]


def test_a_slip_stays(draw: Draw) -> None:
    """Below its probability a slip holds the agent where it is, for the price of a step; at it, the move works."""
    world = draw(CORNER, slip=0.25)
    steps = walk(world, D, D, D, luck=Luck(0.24, 0.0, 0.25, 0.0, 0.9, 0.9))
    assert places(steps) == [(0, 0), (1, 0), (2, 0)]
    assert [step.length for step in steps] == [0.0, 1.0, 1.0]
    assert [step.state.step for step in steps] == [1, 2, 3]
    assert not any(step.collided or step.state.blocked for step in steps)


@pytest.mark.parametrize(
    ("move", "side", "place"),
    [
        (D, 0.0, (1, 2)),
        (D, 0.49, (1, 2)),
        (D, 0.5, (1, 0)),
        (R, 0.0, (0, 1)),
        (R, 0.5, (2, 1)),
        (U, 0.0, (1, 0)),
        (U, 0.5, (1, 2)),
        (L, 0.0, (2, 1)),
        (L, 0.5, (0, 1)),
    ],
)
def test_a_slip_goes_sideways(draw: Draw, move: Move, side: float, place: Cell) -> None:
    """Half of the slips turn the move a quarter to one side, half to the other."""
    world = draw(CROSS, slip=0.5, slip_to="sideways")
    (step,) = walk(world, move, luck=Luck(0.4, side))
    assert step.state.place == place
    assert step.length == 1.0


def test_slipping_into_an_obstacle_is_no_collision(draw: Draw) -> None:
    """It stops the agent and tells it so; a move that ran there by itself would have ended the episode."""
    world = draw(CORNER, slip=0.5, slip_to="sideways")
    slipped, meant = walk(world, D, U, luck=Luck(0.4, 0.9, 0.6, 0.9))  # left of the map; above it
    assert (slipped.state.place, slipped.length, slipped.state.blocked, slipped.collided) == ((0, 0), 0.0, True, False)
    assert (meant.state.place, meant.length, meant.state.blocked, meant.collided) == ((0, 0), 0.0, True, True)


def test_the_goal_counts_only_after_a_post(draw: Draw) -> None:
    """Without a visit to a post the goal is a cell like any other; after one, it counts from then on."""
    steps = walk(draw("P.SG"), R, L, L, L, R, R, R)
    assert [step.reached for step in steps] == [False] * 6 + [True]
    assert [step.state.witnessed for step in steps] == [False, False, False, True, True, True, True]


def test_a_start_on_a_post_has_witnessed(draw: Draw) -> None:
    """The start counts as visited, so does the goal itself, and a world without posts asks for none."""
    for posts, witnessed in (({(0, 0)}, True), ({(0, 1)}, False), (set(), True)):
        plain = draw("SG.")
        world = GridWorld(plain.blocked, plain.start, plain.task, plain.rules, 1, frozenset(posts))
        assert world.reset().witnessed is witnessed
        assert walk(world, R)[0].reached


@pytest.mark.parametrize(
    ("action", "text"),
    [
        (1, "act returned 1 (int); expected a Move or None"),
        ("up", "act returned 'up' (str); expected a Move or None"),
        ((0, 1), "act returned (0, 1) (tuple); expected a Move or None"),
        (np.int64(2), "act returned np.int64(2) (int64); expected a Move or None"),
        (True, "act returned True (bool); expected a Move or None"),
    ],
)
def test_what_is_no_move_is_refused(draw: Draw, action: object, text: str) -> None:
    """Only a Move is a move, and the error says what was got."""
    world = draw(CORNER)
    with pytest.raises(TypeError) as caught:
        world.step(world.reset(), action, np.random.default_rng(0))
    assert str(caught.value) == text


def observations(world: GridWorld, moves: list[Move], seed: int) -> list[Observation]:
    """What an episode shows before each of its moves."""
    luck, state, seen = np.random.default_rng(seed), world.reset(), []
    for move in moves:
        seen.append(world.sense(state, luck))
        state = world.step(state, move, luck).state
    return seen


@pytest.mark.parametrize("slip", [0.0, 0.3])
def test_streams_do_not_shift(draw: Draw, slip: float) -> None:
    """The noise of the k-th look is the same whatever the agent did, wherever it stood, whatever was to see."""
    world = draw(CORNER, radius=2, occlusion=True, false_readings=0.3, slip=slip, collision="blocked")
    here, there = ([D, D, R, R, U], [U, L, R, R, R])
    for seed in range(5):
        luck = np.random.default_rng(seed)
        for pair in zip(observations(world, here, seed), observations(world, there, seed), strict=True):
            wrong = luck.random((5, 5)) < 0.3
            for seen in pair:
                true = look(world.blocked, *seen.place, 2, True)
                assert np.array_equal(seen.view, misread(true, wrong))
            if slip:
                luck.random(2)


def test_without_noise_no_number_is_drawn(draw: Draw) -> None:
    """Worlds without false readings and without slips leave the stream untouched, and show the truth."""
    world = draw(CORNER)
    luck = np.random.default_rng(0)
    state = world.step(world.reset(), D, luck).state
    seen = world.sense(state, luck)
    assert seen.view.tolist() == [[2, 1, 1], [2, 1, 2], [2, 1, 1]]
    assert (seen.step, seen.place) == (1, (1, 0))
    assert luck.random() == np.random.default_rng(0).random()


@pytest.mark.parametrize("false_readings", [0.0, 0.5])
def test_nothing_that_is_handed_out_can_be_written(draw: Draw, false_readings: float) -> None:
    """Views are read-only, and so are the map and the fields of the world."""
    world = draw(CORNER, false_readings=false_readings)
    view = world.sense(world.reset(), np.random.default_rng(0)).view
    for array in (view, world.blocked):
        with pytest.raises(ValueError, match="read-only"):
            array[0, 0] = 1
    with pytest.raises(AttributeError):
        world.start = (1, 1)


def test_facts_of_a_world(draw: Draw) -> None:
    """Optimum, straight distance, and the four covariates of a map counted by hand."""
    world = draw("S#G\n...\n.#.")
    assert (world.shortest(), world.straight()) == (4.0, 2.0)
    # Four of seven free cells end a corridor; ordered pairs of free neighbours: 2 x 6 sides, 2 x 4 diagonals.
    expected = {"density": 2 / 9, "detour": 2.0, "dead_ends": 400 / 7, "openness": 20 / 56}
    assert world.covariates() == pytest.approx(expected)
    assert manhattan((3, 1), (0, 5)) == 7
