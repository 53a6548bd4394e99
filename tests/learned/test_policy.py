"""Settings that find their weights, and agents that decide with them."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from pydantic import ValidationError

from fogbench.learned.agent import PolicyAgent, load, weighted
from fogbench.learned.cnn_memory import CnnMemory
from fogbench.learned.macn import Macn
from fogbench.learned.networks.network import Network
from fogbench.learned.policy import Policy
from fogbench.learned.vin import Vin
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Move, Task

Save = Callable[..., str]

POLICIES: list[Policy] = [
    Macn(checkpoint="none"),
    Macn(checkpoint="none", memory="lstm"),
    Macn(checkpoint="none", memory="feedforward"),
    Vin(checkpoint="none"),
    CnnMemory(checkpoint="none"),
]


def refusal(**fields: Any) -> str:
    """Why settings of MACN are refused, in one line."""
    with pytest.raises(ValidationError) as caught:
        Macn.model_validate(fields)
    (detail,) = caught.value.errors()
    text = str(detail["ctx"]["error"])
    assert "\n" not in text
    return text


@pytest.mark.parametrize("policy", POLICIES, ids=repr)
def test_fresh_weights_follow_from_the_seed(policy: Policy) -> None:
    """Equal seeds draw equal weights, whatever was drawn before; other seeds draw others."""
    first = policy.network().state_dict()
    torch.manual_seed(7)
    weighted.cache_clear()
    drawn, state = weighted(policy).state_dict(), torch.random.get_rng_state()
    weighted.cache_clear()
    torch.manual_seed(8)
    again = weighted(policy).state_dict()
    other = weighted(policy.model_copy(update={"seed": 1})).state_dict()
    assert drawn.keys() == first.keys()
    assert all(torch.equal(drawn[name], again[name]) for name in drawn)
    assert not any(torch.equal(drawn[name], other[name]) for name in drawn)
    torch.manual_seed(7)
    assert torch.equal(torch.random.get_rng_state(), state)  # nobody else's luck is touched


@pytest.mark.parametrize("policy", POLICIES, ids=repr)
def test_a_checkpoint_is_the_policy_that_was_saved(policy: Policy, save: Save) -> None:
    """The same scores; all settings come from the card, by the name of the file alone."""
    read = type(policy)(checkpoint=save(policy, "mine"))
    assert read.model_dump(exclude={"checkpoint"}) == policy.model_dump(exclude={"checkpoint"})
    for name, tensor in weighted(policy).state_dict().items():
        assert torch.equal(weighted(read).state_dict()[name], tensor)
    assert read.parameter_bytes() == sum(4 * tensor.numel() for tensor in weighted(policy).state_dict().values())


def test_what_no_weight_depends_on_may_change(save: Save) -> None:
    """Rows of the memory and iterations may differ from the training's; nothing else that the card says."""
    file = save(Macn(checkpoint="none", reads=2), "mine")
    changed = Macn(checkpoint=file, memory_rows=64, iterations=20, seed=5)
    assert (changed.memory_rows, changed.iterations, changed.reads) == (64, 20, 2)
    assert weighted(changed).memory.blank((1,)).access.memory.shape == (1, 8, 64)
    assert Macn(checkpoint=file, reads=2).reads == 2


def test_a_network_is_built_once(save: Save, draw: Callable[..., Any], monkeypatch: pytest.MonkeyPatch) -> None:
    """However often its settings are read and its agents start; no card needs one of its own."""
    file, task = save(Macn(checkpoint="none"), "mine"), draw("S..\n..G").task
    built, network = [], Macn.network
    monkeypatch.setattr(Macn, "network", lambda self: built.append(self) or network(self))
    for fields in ({}, {"iterations": 20}, {"checkpoint": "none"}):
        weighted.cache_clear()
        built.clear()
        policies = [Macn(**{"checkpoint": file, **fields}) for _ in range(2)]
        for policy in policies:
            policy.start(task, np.random.default_rng())
            policy.parameter_bytes()
        assert built == policies[:1]


def test_wrong_head_counts(save: Save) -> None:
    """Settings that the weights do not fit are refused with those that they do."""
    file = save(Macn(checkpoint="none"), "mine")
    assert refusal(checkpoint=file, reads=1) == "reads 4, with which the checkpoint was trained"
    assert refusal(checkpoint=file, writes=4) == "writes 1, with which the checkpoint was trained"
    assert refusal(checkpoint=file, word=4, size=(9, 9)) == "size [11, 11], with which the checkpoint was trained"
    assert refusal(checkpoint=file, memory="lstm") == "memory dnc, with which the checkpoint was trained"
    assert refusal(checkpoint=file, stitched=True) == "stitched False, with which the checkpoint was trained"


def test_weights_of_another_network(save: Save) -> None:
    """A checkpoint names the network that it is of."""
    file = save(Vin(checkpoint="none"), "mine")
    assert refusal(checkpoint=file) == "a checkpoint of Macn (this is one of Vin)"


def test_a_card_of_another_version(save: Save) -> None:
    """Settings that are no more are not passed over; one that the card lacks has its former value."""
    file = Path(save(Macn(checkpoint="none"), "mine"))
    card = json.loads(file.with_suffix(".json").read_text())
    card["settings"]["heads"] = 4
    file.with_suffix(".json").write_text(json.dumps(card))
    assert refusal(checkpoint=str(file)) == "a checkpoint of this version (its card has heads)"
    del card["settings"]["heads"], card["settings"]["reads"]
    file.with_suffix(".json").write_text(json.dumps(card))
    assert Macn(checkpoint=str(file)).reads == 4
    assert refusal(checkpoint=str(file), reads=2) == "reads 4, with which the checkpoint was trained"
    for value, sentence in (("4", "reads: '4'"), (0, "reads: Input should be greater than or equal to 1")):
        card["settings"]["reads"] = value
        file.with_suffix(".json").write_text(json.dumps(card))
        assert refusal(checkpoint=str(file)) == f"a checkpoint whose card can be read ({sentence})"


def test_a_device_that_is_not_there(monkeypatch: pytest.MonkeyPatch) -> None:
    """CUDA is refused where PyTorch finds none."""
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    assert refusal(checkpoint="none", device="cuda") == "cpu, for PyTorch finds no CUDA device here"


def test_words_are_those_of_the_weights(save: Save, tmp_path: Path) -> None:
    """What fixes a policy is its settings and its weights, not where they are."""
    file = Path(save(Vin(checkpoint="none"), "mine"))
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    moved = elsewhere / "other.safetensors"
    moved.write_bytes(file.read_bytes())
    moved.with_suffix(".json").write_bytes(file.with_suffix(".json").read_bytes())
    words = Vin(checkpoint=str(file)).words()
    assert Vin(checkpoint=str(moved)).words() == words
    assert Vin(checkpoint=str(file), iterations=3).words() != words
    other = save(Vin(checkpoint="none", seed=1), "other")
    assert Vin(checkpoint=other).words() != words


def test_weights_that_were_replaced_are_not_played(save: Save) -> None:
    """Once settings are read, a file that comes in their checkpoint's place is no longer what their words name."""
    policy = Vin(checkpoint=save(Vin(checkpoint="none"), "mine"))
    save(Vin(checkpoint="none", seed=1), "mine")
    with pytest.raises(Mistake) as caught:
        load(policy)
    assert str(caught.value) == "a checkpoint that stays as it was (mine.safetensors was replaced meanwhile)"


def test_bytes_of_every_memory(draw: Callable[..., Any]) -> None:
    """By hand, with N = 32 rows of D = 8, R = 4, W = 1, an LSTM of 256: all that the DNC's equations carry."""
    task = draw("S..\n..G").task
    lstm, content = 2 * 256, 32 * 8 + 4 * 32 + 32 + 32 + 4 * 8  # weightings, usage and what was read
    carried = [4 * (lstm + content + 32 * 32 + 32), 4 * lstm, 0, 0, 4 * (lstm + content + 32 * 32 + 32)]
    assert [policy.start(task, np.random.default_rng()).memory_bytes() for policy in POLICIES] == carried
    without = Macn(checkpoint="none", links=False)
    assert without.start(task, np.random.default_rng()).memory_bytes() == 4 * (lstm + content)
    stitched = Vin(checkpoint="none", stitched=True)
    assert stitched.start(task, np.random.default_rng()).memory_bytes() == 2 * 3  # the known map


def test_maps_of_another_size(draw: Callable[..., Any]) -> None:
    """A network on whole maps is tied to their size, and says so."""
    policy = Vin(checkpoint="none", reading="map", size=(16, 16))
    with pytest.raises(Mistake, match=r"^got a map of 2x3; expected 16x16, the size$"):
        policy.start(draw("S..\n..G").task, np.random.default_rng())


class Scores(Network):
    """Answers the same scores at every step, and remembers what it was shown."""

    def __init__(self, scores: list[float]) -> None:
        """Nothing was shown yet."""
        super().__init__()
        self.scores, self.shown = torch.tensor([scores]), []

    def blank(self, batch: tuple[int, ...]) -> Any:
        """No steps."""
        return torch.zeros(batch)

    def forward(self, inputs: Any, state: Any) -> Any:
        """One step more."""
        self.shown.append((inputs, state))
        return self.scores, state + 1


@pytest.mark.parametrize(
    ("scores", "move"), [([0, 2, 1, 2], Move.RIGHT), ([1, 1, 1, 1], Move.DOWN), ([-2, -3, -1, -2], Move.UP)]
)
def test_the_highest_score_is_taken(
    scores: list[float], move: Move, draw: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    """Of equals the first; the state and the move are handed on to the next step."""
    network = Scores(scores)
    monkeypatch.setattr("fogbench.learned.agent.weighted", lambda settings: network)
    world = draw("#..\n.S.\n..G", radius=2)
    agent = PolicyAgent(POLICIES[0], world.task)
    observation = world.sense(world.reset(), np.random.default_rng())
    assert [agent.act(observation), agent.act(observation._replace(blocked=True))] == [move, move]
    (first, zero), (second, one) = network.shown
    assert (zero.tolist(), one.tolist()) == ([0], [1])
    assert first.compass[0, 6:].tolist() == [0, 0, 0, 0, 1, 0]
    assert second.compass[0, 6:].tolist() == [*(float(move == other) for other in Move), 0, 1]
    assert torch.equal(first.image, second.image)


def test_a_stitched_map_remembers(draw: Callable[..., Any], monkeypatch: pytest.MonkeyPatch) -> None:
    """Only with `stitched` does a cell stay known when it is out of view."""
    networks = {True: Scores([0, 1, 0, 0]), False: Scores([0, 1, 0, 0])}
    monkeypatch.setattr("fogbench.learned.agent.weighted", lambda settings: networks[settings.stitched])
    world = draw("S...G")
    for stitched, network in networks.items():
        agent = PolicyAgent(Vin(checkpoint="none", stitched=stitched), world.task)
        state, luck = world.reset(), np.random.default_rng()
        for _ in range(3):
            state = world.step(state, agent.act(world.sense(state, luck)), luck).state
        free = network.shown[-1][0].image[0, 0, 5]  # the agent's row of the window, itself in column 5
        assert free.nonzero()[:, 0].tolist() == ([3, 4, 5, 6] if stitched else [4, 5, 6])


def test_every_task_has_its_own_agent(draw: Callable[..., Any]) -> None:
    """Agents of the same settings share their weights and nothing else."""
    task: Task = draw("S..\n..G").task
    one, two = (POLICIES[0].start(task, np.random.default_rng()) for _ in range(2))
    assert one.network is two.network
    assert one.state is not two.state


def test_settings_that_mean_nothing_are_refused(save: Callable[[Policy, str], str]) -> None:
    """Rather than that an LSTM seems to need no more rows; as they are by default they may stand."""
    file = save(Macn(checkpoint="none", memory="lstm"), "lstm")
    assert refusal(checkpoint=file, memory_rows=64) == "no memory_rows, which means nothing to such a network"
    for name, value in (("memory_rows", 64), ("word", 4), ("reads", 2), ("writes", 2), ("links", False)):
        told = refusal(checkpoint="none", memory="feedforward", **{name: value})
        assert told == f"no {name}, which means nothing to such a network"
    assert Macn(checkpoint=file, memory_rows=32).memory == "lstm"
