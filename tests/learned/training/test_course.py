"""Whole trainings: they repeat, they go on after a kill as if nothing had happened, and they keep the best weights."""

import errno
import json
import os
import subprocess
import sys
import time
from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import pytest
import torch

from fogbench import learned
from fogbench.bench.reading.recipe import read_recipe
from fogbench.bench.reading.scenario import read_scenario
from fogbench.learned.agent import weighted
from fogbench.learned.policy import Policy
from fogbench.learned.training import course as training
from fogbench.learned.training.course import Course
from fogbench.learned.training.imitation import Imitation
from fogbench.learned.training.recipe import Recipe
from fogbench.worlds.mistake import Mistake

TEXT = """\
name: tiny
network: {macn: {size: [5, 5], iterations: 3, features: 16, hidden: 16, memory_rows: 4}}
maps: {blobs: {size: 6, obstacles: [0, 6], obstacle_size: [1, 2]}}
sensor: {radius: 2, false_readings: 0.05}
rules: {collision: blocked, slip: 0.1}
budget: {steps: 8}
learning:
  imitation:
    curriculum: {easy: {obstacles: [0, 1]}, until: 0.5}
    batches: BATCHES
    batch: 4
    noise: 0.05
    access_decay: 1e-4
validation: {episodes: 10, every: 5}
seed: 3
"""

ROOT = Path(learned.__file__).parents[1]


def recipe(batches: int = 12, **changes: Any) -> Recipe:
    """The tiny recipe."""
    text = TEXT.replace("BATCHES", str(batches))
    for key, value in changes.items():
        (line,) = [line for line in text.splitlines() if line.lstrip().startswith(f"{key}:")]
        text = text.replace(line, line.replace(line.lstrip(), f"{key}: {value}"))
    return read_recipe(text, Path("tiny.yaml"))


def ended(course: Course) -> dict[str, Any]:
    """All that a training leaves, but its times, once it is at its end."""
    for _ in course.go_on():
        pass
    return left(course.folder)


def left(folder: Path) -> dict[str, Any]:
    """All that a training has left in a folder, but its times."""
    state = torch.load(folder / "state.pt", weights_only=True)
    log = [json.loads(line) for line in (folder / "log.jsonl").read_text().splitlines()]
    assert log == state["trials"]
    tensors = [*state["network"].values(), *(x for each in state["optimiser"]["state"].values() for x in each.values())]
    return {
        "tensors": [tensor.numpy().tobytes() for tensor in tensors],
        "trials": [{**trial, "seconds": 0} for trial in log],
        "weights": (folder / "tiny.safetensors").read_bytes(),
        **{key: state[key] for key in ("batches", "best", "losses", "recipe")},
    }


def test_one_seed_trains_one_network(tmp_path: Path) -> None:
    """Two trainings of a recipe leave the same bytes; another seed leaves others."""
    first, again = (ended(Course(recipe(), tmp_path / name, {})) for name in "ab")
    other = ended(Course(recipe(seed=4), tmp_path / "c", {}))
    assert first == again
    assert first["batches"] == 12
    assert [trial["batch"] for trial in first["trials"]] == [5, 10, 12]
    assert all(a != b for a, b in zip(first["tensors"][:4], other["tensors"][:4], strict=True))


def test_a_stopped_training_goes_on_between_trials(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Saved after any batch, it ends as one that was never stopped, the losses between two trials included."""
    whole = ended(Course(recipe(), tmp_path / "whole", {}))
    monkeypatch.setattr(training, "SAVED_EVERY", 0.0)
    for stop in (3, 7):
        course = Course(recipe(), tmp_path / "stopped", {})
        next(news for news in course.go_on() if news.batches == stop)
        assert left_at(tmp_path / "stopped") == stop
    assert ended(Course(recipe(), tmp_path / "stopped", {})) == whole


def test_a_trial_tells_the_mean_loss_since_the_last(tmp_path: Path) -> None:
    """Of every batch in between, none twice."""
    course = Course(recipe(), tmp_path, {})
    losses = [news.loss for news in course.go_on()]
    between = [losses[:5], losses[5:10], losses[10:]]
    assert [trial["loss"] for trial in course.trials] == pytest.approx([sum(some) / len(some) for some in between])


def test_a_state_that_cannot_be_written_leaves_the_one_before(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The training goes on from there, once there is room, to the end that it would have had."""
    whole = ended(Course(recipe(), tmp_path / "whole", {}))
    course = Course(recipe(), tmp_path / "full", {})
    next(news for news in course.go_on() if news.trial)

    def full(_: int) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    course = Course(recipe(), tmp_path / "full", {})
    with monkeypatch.context() as patch:
        patch.setattr("os.fsync", full)
        with pytest.raises(OSError, match="No space left"):
            ended(course)
    assert left_at(tmp_path / "full") == 5
    assert ended(Course(recipe(), tmp_path / "full", {})) == whole


def left_at(folder: Path) -> int:
    """Batches of the state in a folder."""
    batches: int = torch.load(folder / "state.pt", weights_only=True)["batches"]
    return batches


def start(folder: Path, batches: int = 30) -> subprocess.Popen[bytes]:
    """The command, in a process of its own."""
    (folder / "tiny.yaml").write_text(TEXT.replace("BATCHES", str(batches)))
    command = [sys.executable, "-m", "fogbench", "train", "tiny.yaml", "--out", "out"]
    environment = {**os.environ, "PYTHONPATH": str(ROOT), "OMP_NUM_THREADS": "1"}  # for two at once
    pipe = subprocess.PIPE
    return subprocess.Popen(command, cwd=folder, env=environment, stdout=subprocess.DEVNULL, stderr=pipe)


def test_a_killed_training_ends_with_the_same_weights(tmp_path: Path) -> None:
    """Killed after its first trials and started again, it leaves bit for bit what an undisturbed one leaves."""
    folders = [tmp_path / "undisturbed", tmp_path / "killed"]
    for folder in folders:
        folder.mkdir()
    undisturbed, killed = map(start, folders)
    while not (folders[1] / "out" / "state.pt").exists():
        assert killed.poll() is None
        time.sleep(0.002)
    killed.kill()
    killed.communicate()
    assert left_at(folders[1] / "out") < 30
    again = start(folders[1])
    assert [process.communicate()[1] for process in (undisturbed, again)] == [b"", b""]
    assert (undisturbed.returncode, again.returncode) == (0, 0)
    assert left(folders[1] / "out") == left(folders[0] / "out")


def test_a_second_training_in_a_folder_is_refused(tmp_path: Path) -> None:
    """In one line, with exit code 2, until the first is dead; then it goes on from there."""
    first = start(tmp_path, 10**6)
    while not (tmp_path / "out" / "state.pt").exists():
        assert first.poll() is None
        time.sleep(0.01)
    second = start(tmp_path, 10**6)
    _, told = second.communicate()
    line = f"out: got a second training; expected the one in process {first.pid} to end first.\n"
    assert (second.returncode, told.decode()) == (2, line)
    first.kill()
    first.communicate()
    batches, third = left_at(tmp_path / "out"), start(tmp_path, 10**6)
    while left_at(tmp_path / "out") == batches:
        assert third.poll() is None
        time.sleep(0.01)
    third.kill()
    third.communicate()


def test_the_best_weights_are_kept_with_their_card(tmp_path: Path) -> None:
    """They are the last ones of the highest success, and say what they are, how they came about, and where."""
    course = Course(recipe(), tmp_path, {"commit": "abc"})
    kept = []
    for news in course.go_on():
        if news.trial:
            weights = {name: tensor.clone() for name, tensor in course.student.network.state_dict().items()}
            score = news.trial["variants"]["all"]
            kept.append(((score["success"], -score["test_error"]), news.batches, weights))
    _, batches, weights = max(kept, key=lambda each: each[:2])
    card = json.loads((tmp_path / "tiny.json").read_text())
    told = card["training"]
    assert (told["batches"], told["of"], told["seed"], told["commit"]) == (batches, 12, 3, "abc")
    assert (told["threads"], told["device"]) == (torch.get_num_threads(), "cpu")
    assert told["minutes"] == round(course.trials[[5, 10, 12].index(batches)]["seconds"] / 60, 1)
    assert told["recipe"] == TEXT.replace("BATCHES", "12")
    assert card["settings"]["size"] == [5, 5]
    policy = policy_of(tmp_path)
    assert all(torch.equal(tensor, weights[name]) for name, tensor in weighted(policy).state_dict().items())


def policy_of(folder: Path) -> Policy:
    """The policy that a scenario beside the checkpoint plays."""
    text = (
        "name: played\nmaps: {blobs: {size: 6, obstacles: [0, 2], obstacle_size: [1, 2]}}\nbudget: {steps: 8}\n"
        "agents: [{macn: {checkpoint: ./tiny.safetensors}}]\nepisodes: 1\n"
    )
    settings = read_scenario(text, folder / "played.yaml").variants[0].agents[0].settings
    assert isinstance(settings, Policy)
    return settings


def test_a_training_can_start_from_a_checkpoint(tmp_path: Path) -> None:
    """The first batch finds the checkpoint's weights, not fresh ones."""
    ended(Course(recipe(), tmp_path, {}))
    text = TEXT.replace("{macn: {", "{macn: {checkpoint: ./tiny.safetensors, ").replace("BATCHES", "2")
    course = Course(read_recipe(text, tmp_path / "more.yaml"), tmp_path / "more", {})
    for name, tensor in weighted(policy_of(tmp_path)).state_dict().items():
        assert torch.equal(course.student.network.state_dict()[name], tensor)


OTHERS = [
    {"name": "other"},
    {"network": "{macn: {size: [5, 5], iterations: 4, features: 16, hidden: 16, memory_rows: 4}}"},
    {"maps": "{blobs: {size: 6, obstacles: [1, 6], obstacle_size: [1, 2]}}"},
    {"sensor": "{radius: 1}"},
    {"rules": "{collision: fails}"},
    {"budget": "{steps: 9}"},
    {"curriculum": "{easy: {obstacles: [0, 2]}, until: 0.5}"},
    {"batches": 2},
    {"noise": 0},
    {"validation": "{episodes: 9, every: 5}"},
    {"seed": 4},
]
"""What makes another recipe of the tiny one."""


@pytest.mark.parametrize("changes", OTHERS, ids=lambda changes: next(iter(changes)))
def test_another_recipe_s_folder_is_refused(changes: dict[str, Any], tmp_path: Path) -> None:
    """Rather than go on with other settings than those it was begun with."""
    for _ in Course(recipe(batches=1), tmp_path, {}).go_on():
        pass
    with pytest.raises(Mistake) as caught:
        Course(recipe(**{"batches": 1, **changes}), tmp_path, {})
    told = f"{tmp_path}: This folder holds a training with other settings ("
    assert str(caught.value).startswith(told)
    assert "a file that it names" not in str(caught.value)


def test_what_differs_is_told_with_the_way_on(tmp_path: Path) -> None:
    """Setting by setting, and how its weights can be used all the same."""
    ended(Course(recipe(batches=1), tmp_path, {}))
    with pytest.raises(Mistake) as caught:
        Course(recipe(batches=2), tmp_path, {})
    assert str(caught.value) == (
        f"{tmp_path}: This folder holds a training with other settings (learning.batches 1, now 2); "
        "choose another with --out. To start from its weights, "
        f"name {tmp_path / 'tiny.safetensors'} as the `checkpoint` of the recipe's network."
    )


def test_a_state_of_another_version_is_refused(tmp_path: Path) -> None:
    """One that does not say its settings was written before states did."""
    ended(Course(recipe(batches=1), tmp_path, {}))
    state = torch.load(tmp_path / "state.pt", weights_only=True)
    del state["settings"]
    torch.save(state, tmp_path / "state.pt")
    with pytest.raises(Mistake, match="holds a training of another version of fogbench; choose another with --out"):
        Course(recipe(batches=1), tmp_path, {})


def test_another_variant_s_folder_is_refused(tmp_path: Path) -> None:
    """Also where only its name is another: the log has it."""
    text = TEXT.replace("BATCHES", "1")
    for _ in Course(read_recipe(text + "variants: {a: {}}\n", Path("tiny.yaml")), tmp_path, {}).go_on():
        pass
    for other in ("{b: {}}", "{a: {budget: {steps: 9}}}", "{a: {}, b: {}}"):
        with pytest.raises(Mistake, match="holds a training with other settings"):
            Course(read_recipe(f"{text}variants: {other}\n", Path("tiny.yaml")), tmp_path, {})


def test_other_threads_are_refused(tmp_path: Path) -> None:
    """They would lead to other weights."""
    ended(Course(recipe(batches=1), tmp_path, {}))
    threads = torch.get_num_threads()
    torch.set_num_threads(threads + 1)
    try:
        with pytest.raises(Mistake) as caught:
            Course(recipe(batches=1), tmp_path, {})
    finally:
        torch.set_num_threads(threads)
    assert str(caught.value) == (
        f"{tmp_path}: This folder holds a training on {threads} threads, now {threads + 1}; "
        f"set OMP_NUM_THREADS={threads}, or choose another with --out."
    )


def test_best_weights_that_are_gone_are_missed(tmp_path: Path) -> None:
    """Rather than that the training says where they were."""
    ended(Course(recipe(batches=1), tmp_path, {}))
    (tmp_path / "tiny.safetensors").unlink()
    with pytest.raises(Mistake) as caught:
        Course(recipe(batches=1), tmp_path, {})
    told = "missing; this file has the best weights so far. Restore it, or choose another with --out."
    assert str(caught.value) == f"{tmp_path / 'tiny.safetensors'}: {told}"


SHIPPED = sorted(Path(learned.__file__).parent.glob("recipes/*.yaml"))


@pytest.mark.parametrize("path", SHIPPED, ids=lambda path: path.stem)
def test_a_shipped_recipe_trains(path: Path, tmp_path: Path) -> None:
    """It has the name of its file, and a batch of it changes every weight that is used."""
    shipped = read_recipe(path.read_text(), path)
    assert shipped.name == path.stem
    shipped = replace(shipped, learning=cast(Imitation, shipped.learning).model_copy(update={"batch": 2}))
    student: Any = Course(shipped, tmp_path, {}).student
    before = [weight.clone() for weight in student.network.state_dict().values()]
    student.learn()
    after = student.network.state_dict().values()
    changed = [not torch.equal(a, b) for a, b in zip(before, after, strict=True)]
    assert sum(changed) >= len(changed) - 1


def test_a_state_of_another_network_is_refused(tmp_path: Path) -> None:
    """As it is after a layer was changed."""
    ended(Course(recipe(batches=1), tmp_path, {}))
    state = torch.load(tmp_path / "state.pt", weights_only=True)
    state["network"].popitem()
    torch.save(state, tmp_path / "state.pt")
    with pytest.raises(Mistake, match="got a broken file; choose another folder with --out"):
        Course(recipe(batches=1), tmp_path, {})


@pytest.mark.parametrize("broken", [b"", b"no zip", None])
def test_a_broken_state_is_refused(broken: bytes | None, tmp_path: Path) -> None:
    """In one line, whether it is empty, something else, or cut short."""
    ended(Course(recipe(batches=1), tmp_path, {}))
    state = tmp_path / "state.pt"
    state.write_bytes(state.read_bytes()[:-500] if broken is None else broken)
    with pytest.raises(Mistake) as caught:
        Course(recipe(batches=1), tmp_path, {})
    assert str(caught.value) == f"{state}: got a broken file; choose another folder with --out."
