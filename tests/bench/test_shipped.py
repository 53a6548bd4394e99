"""Where scenarios are found."""

import json
from pathlib import Path
from typing import Any

import pytest
import yaml

from fogbench.bench.shipped import RECIPES, find, find_recipe, folder
from fogbench.worlds.mistake import Mistake


@pytest.fixture
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A scenario of a user, in the folder where he stands."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.yaml").touch()
    return tmp_path / "mine.yaml"


def test_a_file_named_twice_is_found_once(mine: Path) -> None:
    """Under the path that stands first."""
    assert find(["mine.yaml", str(mine), "."]) == [Path("mine.yaml")]
    assert find([str(mine), "mine.yaml"]) == [mine]


def test_shipped_files_go_by_their_stems() -> None:
    """Without a name, all of them are meant."""
    assert find(["grid"]) == [folder() / "paper" / "grid.yaml"]
    assert find(None) == find([]) == sorted(folder().rglob("*.yaml"))


@pytest.mark.parametrize(("name", "near"), [("mine", "mine.yaml"), ("gird", "grid")])
@pytest.mark.usefixtures("mine")
def test_a_name_of_nothing_is_told_with_the_nearest(name: str, near: str) -> None:
    """A file of that stem where the user stands, else the shipped one that is most like it."""
    with pytest.raises(Mistake) as error:
        find([name])
    shipped = ", ".join(path.stem for path in sorted(folder().rglob("*.yaml")))
    assert str(error.value) == (
        f"{name}: no such file. Did you mean {near}? Give a scenario file, a folder of them, or one of {shipped}."
    )


def test_all_names_of_nothing_are_told_at_once() -> None:
    """A line for each, in whatever case the nearest is written."""
    with pytest.raises(Mistake) as error:
        find(["GIRD", "grid", "mzae"])
    first, second = str(error.value).splitlines()
    assert first.startswith("GIRD: no such file. Did you mean grid?")
    assert second.startswith("mzae: no such file. Did you mean maze?")


def meaning(text: str) -> dict[str, Any]:
    """What a recipe says; imitation stood beside its other keys once, and MACN had no convolutions, without a word."""
    text = text.replace("{macn: {channels: null}}", "macn").replace("channels: null, ", "")
    said: dict[str, Any] = yaml.safe_load(text)
    learning = said.pop("learning", {"imitation": {}})
    return {**said, **learning["imitation"]}


@pytest.mark.parametrize("card", sorted(RECIPES.with_name("checkpoints").glob("*.json")), ids=lambda card: card.stem)
def test_shipped_weights_are_those_of_the_shipped_recipes(card: Path) -> None:
    """Their card means the recipe as it is now, and has the command that makes them, from a commit without changes."""
    said = json.loads(card.read_text("utf-8"))
    training, (name, _, seed) = said["training"], card.stem.partition("-seed")
    recipe = find_recipe(name).read_text("utf-8")
    assert meaning(training["recipe"]) == meaning(recipe)
    assert (said["settings"].get("channels", 0) is None) == ("channels: null" in recipe)
    assert training["command"] == f"fogbench train {name}" + (f" --seed {seed}" if seed else "")
    assert training["seed"] == int(seed or 0)
    assert not training["commit"].endswith("-dirty")
    assert card.with_suffix(".safetensors").stat().st_size <= 4_000_000
