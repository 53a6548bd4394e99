"""Every mistake in one go, also those in the worlds of variants; and files that are no scenarios."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fogbench.bench.check import check_all
from fogbench.bench.several import read_each
from fogbench.bench.shipped import find
from fogbench.worlds.mistake import Mistake

SCENARIO = """
name: many
maps: {blobs: {size: 12, obstacles: [2, 4], obstacle_size: [2, 3]}}
budget: {steps: 400}
variants:
  first: {maps: {movingai: {map: lorr.map, scen: ok.scen}}}
  second: {}
  third: {maps: {movingai: {map: short.map, scen: ok.scen}}}
  fourth: {tasks: {distance: [500, 600]}}
agents: [astar]
episodes: 1
"""

MAP = "type octile\nheight 2\nwidth 4\nmap\n....\n{}\n"

ROS = "image: map.pgm\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"

RECIPE = "name: r\nnetwork: vin\nmaps: {maze: {size: 9}}\nlearning: {imitation: {batches: 3}}\nbudget: {steps: 9}\n"


@pytest.fixture
def mistakes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Callable[..., list[str]]:
    """What is wrong with files, as lines."""
    monkeypatch.chdir(tmp_path)

    def told(*names: str) -> list[str]:
        with pytest.raises(Mistake) as caught:
            check_all(find(list(names)))
        return str(caught.value).splitlines()

    Path("lorr.map").write_text(MAP.format(".E.."))
    Path("short.map").write_text(MAP.format("..."))
    Path("ok.scen").write_text("version 1\n0\tx\t4\t2\t0\t0\t3\t1\t4\n")
    Path("many.yaml").write_text(SCENARIO)
    return told


def test_all_variants_are_looked_at(mistakes: Callable[..., list[str]]) -> None:
    """Each that cannot be played has its place; those that can are not mentioned."""
    lines = mistakes("many.yaml")
    starts = [
        "many.yaml:6:18  variants.first.maps.movingai: ",
        "many.yaml:8:18  variants.third.maps.movingai: ",
        "many.yaml:3:8  maps.blobs: ",
    ]
    assert [line.startswith(start) for line, start in zip(lines, starts, strict=True)] == [True] * 3


def test_mistakes_of_the_file_do_not_hide_those_of_its_worlds(mistakes: Callable[..., list[str]]) -> None:
    """Nor those of another file."""
    Path("many.yaml").write_text(SCENARIO.replace("astar", "asta"))
    Path("other.yaml").write_text(SCENARIO.replace("many", "other").replace("episodes: 1", "episodes: 5"))
    lines = mistakes("many.yaml", "other.yaml")
    assert lines[0].startswith("many.yaml:10:10  agents[0]: got asta;")
    assert [line.split("  ")[0] for line in lines[1:]] == [
        *("many.yaml:6:18", "many.yaml:8:18", "many.yaml:3:8"),
        *("other.yaml:6:18", "other.yaml:8:18", "other.yaml:3:8"),
    ]


ODD_AGENT = """
from typing import ClassVar
from fogbench import Settings

class Odd(Settings):
    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    def start(self, task, rng):
        return object()

    def parameter_bytes(self):
        return 0
"""


@pytest.mark.parametrize(("word", "wrong"), [("astar", "astra"), ("[1, 3]", "[500, 600]")])
def test_agents_that_cannot_decide_are_told_beside_all_other_mistakes(
    mistakes: Callable[..., list[str]], word: str, wrong: str
) -> None:
    """Of the page, and of its worlds."""
    Path("odd.py").write_text(ODD_AGENT)
    page = "name: mine\nmaps: {maze: {size: 9}}\nbudget: {steps: 40}\nepisodes: 1\n"
    page += "variants: {far: {tasks: {distance: [1, 3]}}, near: {tasks: {distance: [1, 2]}}}\n"
    Path("mine.yaml").write_text(f"{page}agents: [astar, './odd.py:Odd']\n".replace(word, wrong))
    lines = mistakes("mine.yaml")
    assert any(line.startswith("mine.yaml:6:") and "an agent that can decide" in line for line in lines)
    assert len(lines) == 2


def test_more_episodes_than_tasks_are_told(mistakes: Callable[..., list[str]]) -> None:
    """With how many there are."""
    Path("lorr.map").write_text(MAP.format("...."))
    text = (
        SCENARIO.replace("episodes: 1", "episodes: 5").replace("  third", "  # third").replace("  fourth", "  # fourth")
    )
    Path("many.yaml").write_text(text)
    told = f"{Path('ok.scen').absolute()}: 1 task for 5 episodes; set `episodes: 1`, or give more tasks."
    assert mistakes("many.yaml") == [f"many.yaml:6:18  variants.first.maps.movingai: {told}"]


def test_what_is_plainly_no_scenario_is_passed_over(
    mistakes: Callable[..., list[str]], capsys: pytest.CaptureFixture[str]
) -> None:
    """In a folder, with a note; hidden files are not even looked at, and a misspelt scenario stays a mistake."""
    for name, text in {
        "map.yaml": ROS,
        "recipe.yaml": RECIPE,
        "compose.yml": "name: x\nservices: {a: {image: b}}\n",
        "list.yaml": "# what is to be done\n- a\n- b\n",
        ".hidden.yaml": "x: [",
    }.items():
        Path(name).write_text(text)
    Path("folder.yaml").mkdir()
    assert find(["."]) == [Path("many.yaml")]
    assert capsys.readouterr().err == (
        "compose.yml is passed over: it seems to be something else, without maps, agents, budget, episodes, variants.\n"
        "list.yaml is passed over: it seems to be a list.\n"
        "map.yaml is passed over: it seems to be a map of map_server, "
        "which a scenario names under `maps: {occupancy: {map: ...}}`.\n"
        "recipe.yaml is passed over: it seems to be a recipe, which `fogbench train` reads.\n"
    )
    Path("misspelt.yaml").write_text(SCENARIO.replace("maps:", "mapps:").replace("many", "misspelt"))
    assert find(["."]) == [Path("many.yaml"), Path("misspelt.yaml")]
    assert any("misspelt.yaml" in line and "mapps" in line for line in mistakes("."))


def test_a_named_file_that_is_no_scenario_is_told_as_what_it_is(mistakes: Callable[..., list[str]]) -> None:
    """In place of its mistakes as a scenario."""
    Path("map.yaml").write_text(ROS)
    (line,) = mistakes("map.yaml")
    assert line.startswith("map.yaml: seems to be a map of map_server, ")


def test_two_scenarios_of_one_name_are_told(mistakes: Callable[..., list[str]]) -> None:
    """Their results would lie in one folder."""
    del mistakes
    Path("again.yaml").write_text(SCENARIO)
    _, errors = read_each([Path("many.yaml"), Path("again.yaml")], None)
    assert [str(error) for error in errors] == ["again.yaml: the name many is that of many.yaml; choose another."]
