"""`fogbench train`, as a user meets it, and the curves it draws."""

import json
import sys
from collections.abc import Callable
from pathlib import Path

import pytest
from PIL import Image

from fogbench.bench.command import main
from fogbench.bench.reporting.canvas import ours
from fogbench.bench.reporting.learning import curves
from fogbench.bench.shipped import RECIPES

Fogbench = Callable[..., tuple[int, str, str]]

RECIPE = """\
name: small
network: {vin: {size: [5, 5], iterations: 2}}
maps: {blobs: {size: 6, obstacles: [0, 2], obstacle_size: [1, 2]}}
budget: {steps: 8}
learning: {imitation: {batches: 4, batch: 2}}
validation: {episodes: 3, every: 2}
variants: {few: {}, many: {maps: {blobs: {obstacles: [3, 5]}}}}
"""


@pytest.fixture
def train(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> Fogbench:
    """Gives the command its arguments in a folder with a recipe: exit code, output, errors."""
    monkeypatch.chdir(tmp_path)
    Path("small.yaml").write_text(RECIPE)

    def run(*arguments: str) -> tuple[int, str, str]:
        monkeypatch.setattr(sys, "argv", ["fogbench", "train", *arguments])
        with pytest.raises(SystemExit) as end:
            main()
        said = capsys.readouterr()
        return int(end.value.code or 0), said.out, said.err

    return run


def test_a_training_leaves_weights_a_log_and_curves(train: Fogbench) -> None:
    """Each trial is a line on the screen and in the log; a second command has nothing left to do."""
    code, out, _ = train("small.yaml")
    folder = Path("results/training/small")
    assert code == 0
    assert out.count("% success,") == 4
    best = json.loads((folder / "small.json").read_text())["training"]["variants"]
    mean = (best["few"]["success"] + best["many"]["success"]) / 2
    assert f"The best weights ({mean:.1f} % success over all variants) are in {folder}/small.safetensors" in out
    assert "goes on" not in out
    assert {file.name for file in folder.iterdir()} == {
        *(".lock", "small.safetensors", "small.json", "state.pt", "log.jsonl", "learning.png"),
    }
    log = [json.loads(line) for line in (folder / "log.jsonl").read_text().splitlines()]
    assert [trial["batch"] for trial in log] == [2, 4]
    assert f"batch 4: loss {log[1]['loss']:.3f}; few: {log[1]['variants']['few']['success']:.1f} % success" in out
    with Image.open(folder / "learning.png") as picture:
        assert min(picture.size) > 100
    share = log[1]["variants"]["few"]["test_error"]
    assert share <= 1
    assert f"% success, test error {share:.3f}" in out
    again = train("small.yaml")[1]
    assert "All 4 batches were done before." in again
    assert "few:" not in again


def test_the_command_line_comes_before_the_recipe(train: Fogbench) -> None:
    """Batches and seed are what the command says, and its card says so; another seed has another name."""
    assert train("small.yaml", "--batches", "1", "--seed", "5")[0] == 0
    card = json.loads(Path("results/training/small-seed5/small-seed5.json").read_text())["training"]
    assert (card["batches"], card["of"], card["seed"], card["device"]) == (1, 1, 5, "cpu")
    assert card["commit"] is None or len(card["commit"]) >= 40
    assert card["cpu"]


def test_a_folder_of_another_training_is_refused(train: Fogbench) -> None:
    """In one line, with exit code 2."""
    train("small.yaml", "--out", "mine", "--batches", "1")
    code, _, err = train("small.yaml", "--out", "mine")
    assert code == 2
    assert err == (
        "mine: This folder holds a training with other settings (learning.batches 1, now 4); choose another with "
        "--out. To start from its weights, name mine/small.safetensors as the `checkpoint` of the recipe's network.\n"
    )
    assert "name mine/small.safetensors as" in train("small.yaml", "--out", "mine", "--seed", "4")[2]


def test_mistakes_are_lines(train: Fogbench) -> None:
    """No such recipe, and a recipe with a mistake."""
    shipped = ", ".join(file.stem for file in sorted(RECIPES.glob("*.yaml")))
    code, _, err = train("macn-gird")
    assert code == 2
    assert err == (f"macn-gird: no such file. Did you mean macn-grid? Give a recipe file, or one of {shipped}.\n")
    Path("scene.yaml").write_text("name: scene\nmaps: {maze: {size: 9}}\nagents: [astar]\n")
    told = "got agents; expected a recipe, with a network; a scenario is for `fogbench run`"
    assert train("scene.yaml")[::2] == (2, f"scene.yaml:3:1  {told}.\n")
    Path("small.yaml").write_text(RECIPE.replace("batch: 2}}", "batch: two}}"))
    assert train("small.yaml")[::2] == (
        2,
        "small.yaml:5:43  learning.imitation.batch: got two; expected a whole number from 1 to 10,000.\n",
    )


def test_a_seed_out_of_range_is_told(train: Fogbench) -> None:
    """By the command line and by the recipe's reader, in a line each."""
    code, _, err = train("small.yaml", "--seed", str(2**32))
    assert code == 2
    assert "4294967295" in err
    Path("small.yaml").write_text(RECIPE + f"seed: {2**32}\n")
    code, _, err = train("small.yaml")
    assert code == 2
    assert err == (
        f"small.yaml:{len(RECIPE.splitlines()) + 1}:7  seed: got 4294967296; "
        "expected a whole number from 0 to 4,294,967,295.\n"
    )


def test_a_device_that_is_not_there_is_told(train: Fogbench, monkeypatch: pytest.MonkeyPatch) -> None:
    """Before anything is written."""
    monkeypatch.setattr("torch.cuda.is_available", lambda: False)
    code, _, err = train("small.yaml", "--device", "cuda")
    assert (code, err) == (2, "--device: got cuda, but PyTorch finds no CUDA device here; expected cpu.\n")
    assert not Path("results").exists()


def test_curves_are_the_trials() -> None:
    """One panel for test error and one for success; one line for each variant, with a point for each trial."""
    trials = [
        {"batch": batch, "variants": {name: {"success": batch + k, "test_error": 50 - batch - k}
         for k, name in enumerate(("a", "_$b$"))}}
        for batch in (10, 20)
    ]  # fmt: skip
    with ours():
        figure = curves(trials)
    errors, successes = figure.axes
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["a", "_$b$"]
    assert errors.get_ylabel() == "test error on held-out maps"
    assert [line.get_xydata().tolist() for line in errors.lines] == [[[10, 40], [20, 30]], [[10, 39], [20, 29]]]
    assert [line.get_xydata().tolist() for line in successes.lines] == [[[10, 10], [20, 20]], [[10, 11], [20, 21]]]
