"""A batch of episodes, held against the harness that plays them one by one."""

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple

import networkx as nx
import numpy as np
import pytest
import torch

from fogbench.bench.playing import loop
from fogbench.learned.agent import PolicyAgent, load, weighted
from fogbench.learned.cnn_memory import CnnMemory
from fogbench.learned.macn import Macn
from fogbench.learned.policy import Policy
from fogbench.learned.training.rollout import Drawn, Rollout, Turn, greedy, roll_out
from fogbench.learned.training.trials import teachers_in
from fogbench.learned.vin import Vin
from fogbench.planners.grid_judge import GridJudge
from fogbench.planners.grid_teachers import GridTeachers
from fogbench.planners.judging import Verdict
from fogbench.planners.teachers import TeacherByTeacher
from fogbench.worlds.grid.world import GridWorld
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.tunnel import Tunnel
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import DELTAS, Array, Move, Observation, Outcome

SMALL = {"checkpoint": "none", "size": (7, 7), "features": 16, "hidden": 16}

POLICIES: list[Policy] = [
    Macn(**SMALL, memory_rows=4),
    Macn(**SMALL, memory="lstm", stitched=True),
    Macn(**SMALL, memory="feedforward"),
    CnnMemory(**SMALL, channels=4, memory_rows=4),
    Vin(checkpoint="none", size=(9, 9), iterations=9, stitched=True),
]

NOISE = {"false_readings": 0.1, "slip": 0.2, "slip_to": "sideways", "collision": "blocked"}

RULES = [{"radius": 2}, {"radius": 1, **NOISE}, {"radius": 3, "occlusion": True, "collision": "blocked"}]


class Seen(NamedTuple):
    """What one step of one episode was decided by, and the decision."""

    observation: Observation
    known: Array
    optimal: Array
    move: int


class Spy(GridTeachers):
    """Teaches, chooses at random, and notes down all that each episode is at each step."""

    def __init__(self, slots: int, *, hindsight: bool) -> None:
        """Nothing is noted yet."""
        super().__init__(slots, hindsight=hindsight)
        self.luck = np.random.default_rng(5)
        self.observations: Any = None
        self.seen: list[list[Seen]] = [[] for _ in range(slots)]

    def see(self, slots: Array, observations: Any) -> None:
        """Keep what is told."""
        super().see(slots, observations)
        self.observations = observations

    def choose(self, turn: Turn) -> Array:
        """Random moves."""
        moves = self.luck.integers(4, size=len(turn.episodes))
        for k, (b, move) in enumerate(zip(turn.episodes.tolist(), moves.tolist(), strict=True)):
            height, width = self.extents[b]
            known = self.known[b, :height, :width].copy()
            self.seen[b].append(Seen(self.observations[k], known, turn.targets[k], move))
        return moves

    def random(self, turn: Turn) -> Array:
        """Random moves, of which nothing is noted."""
        return self.luck.integers(4, size=len(turn.episodes))


FIELDS = ("blocked", "start", "task", "rules", "optimum", "posts")


class Wind(GridWorld):
    """A world of another class, which has no batch of its own."""


class Noting(GridJudge):
    """Judges, and notes down what it judges by."""

    def judge(self, action: Move) -> Verdict:
        """Judge a decision."""
        self.__dict__.setdefault("seen", []).append((self.observation, self.known.cells.copy(), action))
        return super().judge(action)


class Repeater(PolicyAgent):
    """Does again what was done before."""

    def __init__(self, settings: Policy, world: GridWorld, moves: list[int]) -> None:
        """With the moves to be done."""
        super().__init__(settings, world.task)
        self.moves = iter(moves)

    def act(self, observation: Observation) -> Move:
        """The next of the moves."""
        del observation
        return Move(next(self.moves))


def worlds_of(conditions: Callable[..., Any], rules: dict[str, Any], count: int = 12) -> list[GridWorld]:
    """Maps with blobs and tunnels, of several sizes, seen near and far."""
    near, far = (conditions(steps=25, distance=(3, 30), **{**rules, "radius": rules["radius"] + k}) for k in range(2))
    blobs, tunnels = Blobs(size=9, obstacles=(2, 8), obstacle_size=(1, 3)), Tunnel(length=(4, 9))
    return [
        (tunnels if k % 3 == 0 else blobs).sample(np.random.default_rng(k), 0, far if k % 2 else near)
        for k in range(count)
    ]


def luck(number: int) -> np.random.Generator:
    """That of an episode."""
    return np.random.default_rng(100 + number)


def drawn(worlds: list[GridWorld]) -> list[Drawn]:
    """An episode in each world."""
    return [Drawn(world, partial(luck, k)) for k, world in enumerate(worlds)]


def played(policy: Policy, worlds: list[GridWorld], *, hindsight: bool = False) -> tuple[Rollout, list[list[Seen]]]:
    """A rollout of some worlds at random."""
    spy = Spy(len(worlds), hindsight=hindsight)
    return roll_out(policy, weighted(policy), drawn(worlds), spy, spy.choose), spy.seen


def first_look(world: GridWorld, *, hindsight: bool) -> list[str]:
    """The moves that count at the start."""
    teacher = GridJudge.hindsight(world) if hindsight else GridJudge(world.task)
    teacher.see(world.sense(world.reset(), luck(0)))
    return [Move(move).name for move in np.flatnonzero(teacher.targets())]


def test_hindsight_takes_the_better_of_equals(draw: Callable[..., GridWorld]) -> None:
    """Down and right look alike with a view of one cell; but below everything is closed, out of sight."""
    world = draw("S.... ..#.. ##... ..... ....G", radius=1)
    assert first_look(world, hindsight=False) == ["DOWN", "RIGHT"]
    assert first_look(world, hindsight=True) == ["RIGHT"]


def test_hindsight_asks_for_nothing_that_cannot_be_known(draw: Callable[..., GridWorld]) -> None:
    """Where what looks best turns out to be a dead end, it is taught all the same."""
    world = draw("..... .#... S.#.G .#... .....", radius=1)
    assert first_look(world, hindsight=False) == first_look(world, hindsight=True) == ["RIGHT"]


@pytest.mark.parametrize("rules", RULES, ids=["exact", "noisy", "occluded"])
def test_hindsight_is_what_both_maps_agree_on(conditions: Callable[..., Any], rules: dict[str, Any]) -> None:
    """Along random walks, against networkx on the full map; some decisions are narrowed, the others as they were."""
    family = Blobs(size=16, obstacles=(15, 30), obstacle_size=(1, 4))
    worlds = [family.sample(np.random.default_rng(k), 0, conditions(steps=30, **rules)) for k in range(12)]
    (_, known), (_, seen) = (played(POLICIES[2], worlds, hindsight=late) for late in (False, True))  # the same walks
    narrowed = 0
    for world, before, after in zip(worlds, known, seen, strict=True):
        graph = nx.grid_2d_graph(*world.blocked.shape)
        graph.remove_nodes_from(zip(*np.nonzero(world.blocked), strict=True))
        distance = nx.single_source_shortest_path_length(graph, world.task.goal)
        for own, both in zip(before, after, strict=True):
            (row, column), far = own.observation.place, distance[own.observation.place]
            ahead = [distance.get((row + down, column + right)) == far - 1 for down, right in DELTAS]
            agreed = own.optimal & ahead
            assert both.optimal.tolist() == (agreed if agreed.any() else own.optimal).tolist()
            narrowed += both.optimal.sum() < own.optimal.sum()
    assert 0 < narrowed < sum(map(len, seen))


@pytest.mark.parametrize("rules", RULES, ids=["exact", "noisy", "occluded"])
def test_a_batch_is_its_single_episodes(conditions: Callable[..., Any], rules: dict[str, Any]) -> None:
    """With the same moves, every step of the harness has the same observation and known map; so have the judgements."""
    worlds = worlds_of(conditions, rules)
    rollout, seen = played(POLICIES[2], worlds)
    judged = wrong = steps = 0
    for k, world in enumerate(worlds):
        judge, record = Noting(world.task), loop.Record()
        agent = Repeater(POLICIES[2], world, [each.move for each in seen[k]])
        outcome = loop.roll(world, agent, luck(k), record, loop.Clerk(world, judge, record))
        for ours, (observation, known, move) in zip(seen[k], judge.__dict__["seen"], strict=True):
            assert ours.observation._replace(view=0) == observation._replace(view=0)
            assert np.array_equal(ours.observation.view, observation.view)
            assert np.array_equal(ours.known, known)
            assert ours.move == move
        assert record.judged == sum(each.optimal.any() for each in seen[k])
        assert record.wrong_decisions == sum(each.optimal.any() and not each.optimal[each.move] for each in seen[k])
        assert rollout.reached[k] == (outcome is Outcome.REACHED)
        judged, wrong, steps = judged + record.judged, wrong + record.wrong_decisions, steps + len(record.actions)
    assert len(rollout.outputs) == steps
    assert (int(rollout.judged.sum()), int(rollout.wrong().sum())) == (judged, wrong)
    assert 0 < wrong < judged


@pytest.mark.parametrize("rules", RULES, ids=["exact", "noisy", "occluded"])
@pytest.mark.parametrize("policy", POLICIES, ids=lambda policy: f"{type(policy).__name__} {policy.size}")
def test_a_greedy_batch_decides_as_the_policy_does(
    conditions: Callable[..., Any], policy: Policy, rules: dict[str, Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A policy in the harness takes the same moves to the same ends.

    In double precision: fresh weights score moves so much alike that single precision may prefer another.
    """
    worlds = worlds_of(conditions, rules)
    network = in_double(load(policy).requires_grad_(requires_grad=False).double())
    monkeypatch.setattr("fogbench.learned.agent.weighted", lambda _: network)
    rollout = roll_out(policy, network, drawn(worlds), teachers_in(drawn(worlds), 4), greedy)
    judged = wrong = steps = 0
    for k, world in enumerate(worlds):
        record = loop.Record()
        clerk = loop.Clerk(world, GridJudge(world.task), record)
        outcome = loop.roll(world, policy.start(world.task, luck(0)), luck(k), record, clerk)
        assert rollout.reached[k] == (outcome is Outcome.REACHED)
        judged, wrong, steps = judged + record.judged, wrong + record.wrong_decisions, steps + len(record.actions)
    assert (len(rollout.outputs), int(rollout.judged.sum()), int(rollout.wrong().sum())) == (steps, judged, wrong)


@pytest.mark.parametrize("policy", POLICIES, ids=lambda policy: f"{type(policy).__name__} {policy.size}")
def test_the_gradient_of_a_batch_is_that_of_its_episodes(conditions: Callable[..., Any], policy: Policy) -> None:
    """Episodes that end, and leave the batch, neither lose their own gradient nor change that of others."""
    worlds = worlds_of(conditions, RULES[0], 4)
    network = load(policy).double()

    def gradient(numbers: list[int]) -> list[torch.Tensor]:
        episodes = drawn([worlds[k] for k in numbers])

        def down_and_up(turn: Turn) -> Array:
            return np.full(len(turn.episodes), 2 * (turn.step % 2))

        scores = roll_out(policy, in_double(network), episodes, None, down_and_up).scores
        network.zero_grad()
        scores.square().sum().backward()
        return [torch.zeros_like(p) if p.grad is None else p.grad.clone() for p in network.parameters()]

    whole, singles = gradient([0, 1, 2, 3]), [gradient([k]) for k in range(4)]
    for together, *alone in zip(whole, *singles, strict=True):
        assert torch.allclose(together, sum(alone, torch.zeros_like(together)), rtol=1e-9, atol=1e-12)


def in_double(network: Any) -> Any:
    """The network, told its inputs in double precision."""

    def step(inputs: Any, state: Any) -> Any:
        return network(inputs._replace(image=inputs.image.double(), sight=inputs.sight.double(),
                                       compass=inputs.compass.double()), state)  # fmt: skip

    step.blank = network.blank  # type: ignore[attr-defined]
    return step


@pytest.mark.parametrize("rules", RULES, ids=["exact", "noisy", "occluded"])
@pytest.mark.parametrize("policy", POLICIES, ids=lambda policy: f"{type(policy).__name__} {policy.size}")
@pytest.mark.parametrize("hindsight", [False, True])
def test_a_batch_is_what_comes_of_one_after_the_other(
    conditions: Callable[..., Any], policy: Policy, rules: dict[str, Any], hindsight: bool
) -> None:
    """Worlds, teachers and viewpoints that are not faster together give the same rollout, bit for bit."""
    worlds = worlds_of(conditions, rules)
    apart = [Wind(**{name: getattr(world, name) for name in FIELDS}) for world in worlds]
    rollouts = []
    for places, kind in ((worlds, GridTeachers), (apart, TeacherByTeacher)):
        teachers = teachers_in(drawn(places), 4, hindsight=hindsight)
        assert type(teachers) is kind
        rollouts.append(roll_out(policy, weighted(policy), drawn(places), teachers, Spy(0, hindsight=False).random))
    for together, alone in zip(*rollouts, strict=True):
        assert np.array_equal(together, alone)


def test_a_map_of_another_size_is_refused(conditions: Callable[..., Any]) -> None:
    """A network for whole maps of one size does not start on another, as in a single episode."""
    policy = Macn(**{**SMALL, "size": (8, 8)}, reading="map", memory="feedforward")
    episodes = drawn(worlds_of(conditions, RULES[0], 2))
    with pytest.raises(Mistake, match=r"^got a map of \d+x\d+; expected 8x8, the size$"):
        roll_out(policy, weighted(policy), episodes, None, greedy)
