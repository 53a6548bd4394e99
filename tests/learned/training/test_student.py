"""What a batch teaches, in hand-computed cases, and that a network learns from it."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest
import torch

from fogbench.bench.playing.loop import episode_world
from fogbench.bench.reading.scenario import read_scenario
from fogbench.learned.agent import weighted
from fogbench.learned.encoding.grid_inputs import Inputs
from fogbench.learned.macn import Macn
from fogbench.learned.training.exploring import Explorer, Noisy, pick
from fogbench.learned.training.imitation import Curriculum, Imitation, Teacher
from fogbench.learned.training.recipe import Lesson, Recipe, Validation, Worlds
from fogbench.learned.training.rollout import Drawn, Rollout, Turn, roll_out
from fogbench.learned.training.student import access_weight, imitation_loss, part, rate
from fogbench.learned.training.trials import draw_world, refuse_unplayable
from fogbench.learned.training.trials import validate as tried
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.movingai import MovingAI
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Array

SMALL = Macn(checkpoint="none", size=(7, 7), features=32, hidden=32, memory_rows=4)

MAPS = Blobs(size=6, obstacles=(2, 6), obstacle_size=(1, 2))


def learns(recipe: Recipe) -> Any:
    """What learns by a recipe."""
    return recipe.learning.student(recipe)


@pytest.fixture
def recipe(conditions: Callable[..., Any]) -> Callable[..., Recipe]:
    """Makes a recipe on maps of 6x6 cells of the fields of its network and of its training."""

    def make(network: dict[str, Any] | None = None, seed: int = 0, **fields: Any) -> Recipe:
        worlds = Worlds(MAPS, conditions(steps=12, radius=2))
        learning = Imitation(**{"batches": 40, "batch": 16, **fields})
        policy, lessons = SMALL.model_copy(update={**(network or {}), "seed": seed}), (Lesson(worlds, MAPS),)
        return Recipe("small", "", "", policy, lessons, {"all": worlds}, learning, Validation(episodes=50), seed)

    return make


def test_the_loss_is_minus_the_logarithm_of_the_optimal_moves_share() -> None:
    """A half and three quarters of the probability are optimal; the decision without an optimal move does not count."""
    scores = torch.tensor([[0.0, 0, 0, 0], [np.log(2), np.log(3), np.log(1), np.log(2)], [9, 9, 9, 0]])
    optimal = torch.tensor([[True, True, False, False], [True, True, True, False], [False] * 4])
    rollout = Rollout(scores, optimal, torch.tensor([0, 3, 1]), np.array([True]))
    assert imitation_loss(rollout).item() == pytest.approx((np.log(2) + np.log(4 / 3)) / 2)
    assert rollout.judged.tolist() == [True, True, False]
    assert rollout.wrong().tolist() == [False, True, False]


def test_a_batch_that_teaches_nothing_has_no_loss() -> None:
    """Without any optimal move the loss is 0, not a mean of nothing."""
    rollout = Rollout(
        torch.ones(2, 4), torch.zeros(2, 4, dtype=torch.bool), torch.zeros(2, dtype=torch.long), np.ones(1)
    )
    assert imitation_loss(rollout).item() == 0


def test_columns_are_picked_as_they_weigh() -> None:
    """Chances over the unit interval pick each column for its share of it, and never one without weight."""
    weights = np.tile([0.0, 1.0, 0.0, 3.0], (1000, 1))
    picked = pick(weights, np.linspace(0, 1, 1000, endpoint=False))
    assert np.bincount(picked, minlength=4).tolist() == [0, 250, 0, 750]


def turn(count: int, scores: list[float], optimal: list[bool], open_: list[bool]) -> Turn:
    """The same step of many episodes."""
    rows = (np.tile(row, (count, 1)) for row in (scores, optimal, open_))
    return Turn(0, np.arange(count), *rows)


def moves_of(share: float, step: Turn) -> Array:
    """How often each move is chosen."""
    explorer = Explorer(np.random.default_rng(0), len(step.episodes), share)
    return np.bincount(explorer(step), minlength=4) / len(step.episodes)


def test_the_teacher_takes_any_optimal_move_and_the_network_its_own() -> None:
    """With a share of a half, half of the episodes follow each."""
    step = turn(20_000, [-50, -50, 0, 0], [True, True, False, False], [True] * 4)
    assert moves_of(1, step) == pytest.approx([0.5, 0.5, 0, 0], abs=0.02)
    assert moves_of(0, step) == pytest.approx([0, 0, 0.5, 0.5], abs=0.02)
    assert moves_of(0.5, step) == pytest.approx([0.25] * 4, abs=0.02)


def test_where_the_network_would_collide_the_teacher_decides() -> None:
    """A move into an obstacle in view is replaced by an optimal one; where there is none, it stays."""
    blocked = turn(1000, [-50, -50, 0, 0], [True, False, False, False], [True, True, False, True])
    assert moves_of(0, blocked) == pytest.approx([0.5, 0, 0, 0.5], abs=0.05)
    assert moves_of(0, blocked._replace(targets=np.zeros((1000, 4), np.bool_)))[2] == pytest.approx(0.5, abs=0.05)


def test_choices_do_not_depend_on_who_has_ended() -> None:
    """The episodes that go on meet the chances they would have met."""
    whole = turn(100, [0, 0, 0, 0], [True] * 4, [True] * 4)
    some = Turn(0, *(part[::3] for part in whole[1:]))
    explorers = [Explorer(np.random.default_rng(0), 100, 0.5) for _ in range(2)]
    assert np.array_equal(explorers[0](whole)[::3], explorers[1](some))


def test_the_rate_falls_over_the_second_half() -> None:
    """It is the first number up to the half, the geometric mean at three quarters, nearly the last at the end."""
    training = Imitation(batches=100, rate=(1e-2, 1e-4))
    assert [rate(training, done) for done in (0, 0.5, 0.75, 1)] == pytest.approx([1e-2, 1e-2, 1e-3, 1e-4])


def test_a_change_is_made_by_its_end() -> None:
    """A change over the first quarter is half made after an eighth; one over nothing is made at once."""
    assert [part(done, 0.25) for done in (0, 0.125, 0.25, 0.9)] == [0, 0.5, 1, 1]
    assert part(0, 0) == 1


def test_only_the_interface_of_the_memory_is_held_small() -> None:
    """Its squared weights are summed; a network without a memory has none, and the decay makes them smaller."""
    network = SMALL.network()
    interface: Any = network.get_submodule("memory.interface")
    assert access_weight(network).item() == pytest.approx(
        float((interface.weight.detach().numpy() ** 2).sum()), rel=1e-5
    )
    assert access_weight(SMALL.model_copy(update={"memory": "lstm"}).network()).item() == 0


def test_decay_shrinks_the_interface(recipe: Callable[..., Recipe]) -> None:
    """Ten batches with the decay leave a smaller interface than without it."""
    sizes = []
    for decay in (0.0, 0.1):
        student = learns(recipe(access_decay=decay))
        for _ in range(10):
            student.learn()
        sizes.append(access_weight(student.network).item())
    assert sizes[1] < 0.98 * sizes[0]


def test_noise_is_remembered_and_repeats() -> None:
    """The controller's output gets noise of the given size, the same for one seed; the scores of the step get none."""
    network = weighted(SMALL)
    inputs = Inputs(torch.zeros(500, 3, 7, 7), torch.full((500,), 24), torch.zeros(500, 3, 7, 7), torch.zeros(500, 12))
    scores, state = network(inputs, network.blank((500,)))
    noised = [Noisy(network, 0.1, seed)(inputs, network.blank((500,))) for seed in (1, 1, 2)]
    difference = noised[0][1].hidden - state.hidden
    assert torch.equal(noised[0][0], scores)
    assert difference.std().item() == pytest.approx(0.1, rel=0.05)
    assert torch.equal(noised[0][1].hidden, noised[1][1].hidden)
    assert not torch.equal(noised[0][1].hidden, noised[2][1].hidden)


def test_trainings_and_trials_share_no_maps(recipe: Callable[..., Recipe]) -> None:
    """Episodes of one number differ with their purpose, and repeat with it; the luck differs too."""
    ((worlds, _),) = recipe().lessons
    purposes = "training", "validation", "training"
    drawn = [[draw_world(worlds, MAPS, purpose, 0, number) for number in range(5)] for purpose in purposes]
    maps = [[cast(Any, world).blocked for world, _ in pairs] for pairs in drawn]
    assert not all(np.array_equal(a, b) for a, b in zip(maps[0], maps[1], strict=True))
    assert all(np.array_equal(a, b) for a, b in zip(maps[0], maps[2], strict=True))
    chances = [[luck().random() for _, luck in pairs] for pairs in drawn]
    assert chances[0] == chances[2] != chances[1]


def test_a_test_meets_other_maps_than_a_training() -> None:
    """Of one family, none of the maps that scenarios test on is among those to learn on or to be tried on."""
    text = "name: a\nmaps: {blobs: {size: 6, obstacles: [2, 6], obstacle_size: [1, 2]}}\nagents: [astar]\nepisodes: 20"
    (variant,) = read_scenario(text + "\nbudget: {steps: 12}", Path("a.yaml")).variants
    worlds = Worlds(variant.family, variant.conditions)
    tested = {episode_world(variant, number).blocked.tobytes() for number in range(20)}
    for purpose in ("training", "validation"):
        for number in range(20):
            world, _ = draw_world(worlds, worlds.family, purpose, 0, number)
            assert cast(Any, world).blocked.tobytes() not in tested


def test_all_seeds_are_tried_on_the_same_maps(recipe: Callable[..., Recipe]) -> None:
    """One network reaches the same on the held-out maps of two trainings."""
    network = SMALL.network()
    assert tried(recipe(seed=1), network) == tried(recipe(seed=2), network)


def test_the_teacher_and_the_rate_give_way_over_the_batches(
    recipe: Callable[..., Recipe], monkeypatch: pytest.MonkeyPatch
) -> None:
    """A training of four batches decides and descends by what its recipe says of each."""
    student = learns(recipe(batches=4, teacher=Teacher(share=(1, 0.2), until=0.5), rate=(1e-2, 1e-4)))
    shares, rates = list[float](), list[float]()

    class Spy(Explorer):
        def __init__(self, luck: Any, episodes: int, share: float) -> None:
            shares.append(share)
            super().__init__(luck, episodes, share)

    monkeypatch.setattr("fogbench.learned.training.student.Explorer", Spy)
    for _ in range(4):
        student.learn()
        rates.append(student.optimiser.param_groups[0]["lr"])
    assert shares == pytest.approx([1, 0.6, 0.2, 0.2])
    assert rates == pytest.approx([1e-2, 1e-2, 1e-2, 1e-3])


def test_hindsight_teaches_but_does_not_judge(recipe: Callable[..., Recipe], monkeypatch: pytest.MonkeyPatch) -> None:
    """A recipe with it learns from other episodes than one without, and is tried on the same."""
    late = list[bool]()

    def spy(*arguments: Any) -> Rollout:
        late.append(len(arguments[3].full) > 0)
        return roll_out(*arguments)

    monkeypatch.setattr("fogbench.learned.training.student.roll_out", spy)
    monkeypatch.setattr("fogbench.learned.training.trials.roll_out", spy)
    for hindsight in (False, True):
        taught = recipe(batches=1, teacher=Teacher(hindsight=hindsight))
        learns(taught).learn()
        tried(taught, SMALL.network())
    assert late == [False, False, True, False]


@pytest.mark.parametrize(("name", "kind"), [("adam", torch.optim.Adam), ("rmsprop", torch.optim.RMSprop)])
def test_the_optimiser_is_the_recipe_s(name: str, kind: type, recipe: Callable[..., Recipe]) -> None:
    """The paper's is RMSProp, ours Adam."""
    assert type(learns(recipe(optimiser=name)).optimiser) is kind


def test_a_gradient_is_no_longer_than_allowed(recipe: Callable[..., Recipe], monkeypatch: pytest.MonkeyPatch) -> None:
    """All that the optimiser meets together has the norm of the recipe's clip, however steep the loss."""
    student, norms = learns(recipe(clip=0.01)), list[float]()

    def step() -> None:
        gradients = [weight.grad.norm() for weight in student.network.parameters() if weight.grad is not None]
        norms.append(float(torch.stack(gradients).norm()))

    monkeypatch.setattr(student.optimiser, "step", step)
    student.learn()
    assert norms == pytest.approx([0.01], rel=1e-3)


def flat(network: Any) -> torch.Tensor:
    """All weights in a row."""
    return torch.cat([weight.detach().flatten() for weight in network.parameters()])


def test_what_is_tried_is_the_mean_of_what_has_learned(recipe: Callable[..., Recipe]) -> None:
    """Over three batches: the first, a half of the second, then a third of each; it learns as without."""
    student, plain = learns(recipe(average=3)), learns(recipe())
    weights = list[torch.Tensor]()
    for _ in range(5):
        assert student.learn() == plain.learn()
        weights.append(flat(student.learner))
        assert torch.equal(weights[-1], flat(plain.network))
    expected = weights[0]
    for latest, share in zip(weights[1:], (1 / 2, 1 / 3, 1 / 3, 1 / 3), strict=True):
        expected = (1 - share) * expected + share * latest
    torch.testing.assert_close(flat(student.network), expected)


def test_a_mean_goes_on_where_it_was_left(recipe: Callable[..., Recipe]) -> None:
    """A student that is restored ends with the same mean, bit for bit."""
    whole, parted = learns(recipe(average=3)), learns(recipe(average=3))
    for _ in range(4):
        whole.learn()
    for _ in range(2):
        parted.learn()
    resumed = learns(recipe(average=3))
    resumed.restore(parted.state())
    for _ in range(2):
        resumed.learn()
    assert torch.equal(flat(resumed.network), flat(whole.network))


def test_weights_that_grow_beyond_all_numbers_are_told(recipe: Callable[..., Recipe]) -> None:
    """Before they are changed once more: what was learned until then is left."""
    student = learns(recipe())
    student.learn()
    with torch.no_grad():
        next(student.network.parameters()).fill_(np.inf)
    before = [weight.clone() for weight in student.network.parameters()]
    with pytest.raises(Mistake) as caught:
        student.learn()
    assert str(caught.value) == "small, batch 2: got a gradient of nan; expected a smaller rate."
    assert all(torch.equal(a, b) for a, b in zip(before, student.network.parameters(), strict=True))


def test_worlds_that_cannot_be_played_are_told_at_once(
    recipe: Callable[..., Recipe], conditions: Callable[..., Any]
) -> None:
    """Of the lessons, at first and at last, and of every variant: no task is found, or the network does not fit."""
    made = recipe()
    near, far = made.lessons[0].worlds, Worlds(MAPS, conditions(distance=(50, 60)))
    refuse_unplayable(made)
    none = "Blobs: no task with an optimum of 50 to 60 cells (set by `tasks: {distance: ...}`) was found on 1000 maps."
    for changed, place in (
        (replace(made, held_out={"near": near, "far": far}), "far"),
        (replace(made, lessons=(Lesson(near, MAPS), Lesson(far, MAPS))), "lesson 2, at first"),
    ):
        with pytest.raises(Mistake) as caught:
            refuse_unplayable(changed)
        assert str(caught.value) == f"small: {place}: {none}"
    whole = SMALL.model_copy(update={"reading": "map", "size": (6, 6)})
    large = Worlds(Blobs(size=9, obstacles=(0, 1), obstacle_size=(1, 1)), near.conditions)
    with pytest.raises(Mistake) as caught:
        refuse_unplayable(replace(made, network=whole, held_out={"large": large}))
    assert str(caught.value) == "small: large: got a map of 9x9; expected 6x6, the size."


def test_listed_tasks_are_not_learned_from(recipe: Callable[..., Recipe], tmp_path: Path) -> None:
    """A scenario tests on all of them; of files, a family that draws its tasks can be learned on."""
    (tmp_path / "x.map").write_text("type octile\nheight 1\nwidth 9\nmap\n.........\n")
    (tmp_path / "x.map.scen").write_text("version 1\n0\tx.map\t9\t1\t0\t0\t8\t0\t8\n")
    made = recipe()
    listed = Worlds(MovingAI(map=tmp_path / "x.map"), made.lessons[0].worlds.conditions)
    with pytest.raises(Mistake) as caught:
        refuse_unplayable(replace(made, held_out={"city": listed}))
    expected = "got a list of tasks; expected maps or tasks that are drawn afresh."
    assert str(caught.value) == f"small: city: {expected}"


def test_a_curriculum_is_played_from_its_beginning(
    recipe: Callable[..., Recipe], monkeypatch: pytest.MonkeyPatch
) -> None:
    """At first all maps are as empty as the easy family; after its part of the batches they are full."""
    easy = Blobs(size=6, obstacles=(0, 0), obstacle_size=(1, 1))
    made = recipe(batches=4, curriculum=Curriculum(easy={}, until=0.5))
    student, walls = learns(replace(made, lessons=(made.lessons[0]._replace(easy=easy),))), list[float]()

    def rolled(settings: Any, network: Any, drawn: list[Drawn], *others: Any) -> Rollout:
        walls.append(float(np.mean([cast(Any, world).blocked.mean() for world, _ in drawn])))
        return roll_out(settings, network, drawn, *others)

    monkeypatch.setattr("fogbench.learned.training.student.roll_out", rolled)
    for _ in range(4):
        student.learn()
    assert walls[0] == 0
    assert walls[0] < walls[1] < min(walls[2:])


def test_lessons_take_turns(
    recipe: Callable[..., Recipe], conditions: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Over the batches each episode has the lesson of its number, with its own maps, sensor and budget."""
    made, wide = recipe(batch=4), Blobs(size=9, obstacles=(9, 9), obstacle_size=(1, 1))
    other = Worlds(wide, conditions(steps=20, radius=3))
    student = learns(replace(made, lessons=(*made.lessons, Lesson(other, wide), *made.lessons)))
    sizes, budgets, radii = list[int](), list[int](), list[int]()

    def rolled(settings: Any, network: Any, drawn: list[Drawn], *others: Any) -> Rollout:
        sizes.extend(len(cast(Any, world).blocked) for world, _ in drawn)
        budgets.extend(world.task.budget.steps for world, _ in drawn)
        radii.extend(world.task.sensor.radius for world, _ in drawn)
        return roll_out(settings, network, drawn, *others)

    monkeypatch.setattr("fogbench.learned.training.student.roll_out", rolled)
    for _ in range(2):
        student.learn()
    assert sizes == [6, 9, 6, 6, 9, 6, 6, 9]
    assert budgets == [12, 20, 12, 12, 20, 12, 12, 20]
    assert radii == [2, 3, 2, 2, 3, 2, 2, 3]


def test_a_network_learns(recipe: Callable[..., Recipe]) -> None:
    """A hundred small batches lead a network without memory from failing nearly always to reaching most goals."""
    student = learns(recipe({"memory": "feedforward"}, batches=100, batch=32, rate=(3e-3, 3e-4)))
    before = tried(student.recipe, student.network)["all"]
    losses = [student.learn() for _ in range(100)]
    after = tried(student.recipe, student.network)["all"]
    assert before["success"] < 40
    assert after["success"] > 80
    assert after["test_error"] < 0.1 < before["test_error"]
    assert np.mean(losses[-10:]) < 0.3 * np.mean(losses[:10])
