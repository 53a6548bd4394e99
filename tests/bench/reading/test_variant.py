"""What a scenario file says when nothing is wrong with it."""

import subprocess
import sys
from math import inf
from pathlib import Path

import pytest

from fogbench.bench.reading.page import Published
from fogbench.bench.reading.scenario import Scenario, ScenarioError, read_scenario
from fogbench.bench.reporting.sections import HEADLINE
from fogbench.planners.astar import AStar
from fogbench.planners.memoryless import Memoryless
from fogbench.worlds.conditions import BudgetSettings, PerDistance, Tasks
from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.grid.rules import GridRules, SquareView
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.movingai import MovingAI
from fogbench.worlds.maps.families.tunnel import Tunnel

BLOBS = "blobs: {size: 16, obstacles: [0, 12], obstacle_size: [1, 3]}"

SHORT = f"""\
name: short
maps: {{{BLOBS}}}
budget: {{steps: 40}}
agents: [astar]
episodes: 10
"""


def read(text: str) -> Scenario:
    """The scenario of a text that has no mistakes."""
    return read_scenario(text, Path("good.yaml"))


def test_defaults() -> None:
    """What is left out: one variant `all`, the first agent as reference, seed 0, nothing published."""
    scenario = read(SHORT)
    (variant,) = scenario.variants
    assert (scenario.name, scenario.about, scenario.published, scenario.skipped) == ("short", "", {}, "")
    assert (scenario.path, scenario.text) == (Path("good.yaml"), SHORT)
    assert (variant.name, variant.reference, variant.episodes, variant.seed) == ("all", "astar", 10, 0)
    assert variant.family == Blobs(size=16, obstacles=(0, 12), obstacle_size=(1, 3))
    assert variant.conditions == GridConditions(budget=BudgetSettings(steps=40))
    (agent,) = variant.agents
    assert (agent.label, agent.target, agent.settings, agent.skipped) == (
        "astar",
        "fogbench.planners.astar:AStar",
        AStar(),
        "",
    )


def test_a_variant_is_laid_over_the_rest() -> None:
    """Mappings merge, lists and scalars replace; the rest stays."""
    scenario = read(
        SHORT
        + """\
sensor: {radius: 2, occlusion: true}
tasks: {distance: [1, 9]}
variants:
  same:
  other:
    maps: {blobs: {obstacles: [5, 6]}}
    sensor: {radius: 4}
    tasks: {distance: [2, 3]}
    budget: {steps: {per_distance: 1.5}}
    agents: [memoryless, astar]
    reference: astar
    episodes: 3
    seed: 7
"""
    )
    same, other = scenario.variants
    assert (same.name, same.episodes, same.seed, same.reference) == ("same", 10, 0, "astar")
    assert same.conditions.sensor == SquareView(radius=2, occlusion=True)
    assert (other.name, other.episodes, other.seed, other.reference) == ("other", 3, 7, "astar")
    assert other.family == Blobs(size=16, obstacles=(5, 6), obstacle_size=(1, 3))
    assert other.conditions == GridConditions(
        sensor=SquareView(radius=4, occlusion=True),
        tasks=Tasks(distance=(2, 3)),
        budget=BudgetSettings(steps=PerDistance(per_distance=1.5)),
    )
    assert [agent.settings for agent in other.agents] == [Memoryless(), AStar()]


def test_another_map_family_replaces_the_first() -> None:
    """None of the settings of the first one are laid under it."""
    scenario = read(SHORT + "variants: {blobs: {}, tunnel: {maps: {tunnel: {length: [20, 20]}}}}\n")
    assert [variant.family for variant in scenario.variants] == [
        Blobs(size=16, obstacles=(0, 12), obstacle_size=(1, 3)),
        Tunnel(length=(20, 20)),
    ]


def test_labels_tell_the_same_agent_apart() -> None:
    """A label is no setting; without one the name is the label."""
    scenario = read(SHORT.replace("[astar]", "[astar: {replan: change, label: eager}, astar, {memoryless: }]"))
    (variant,) = scenario.variants
    assert [agent.label for agent in variant.agents] == ["eager", "astar", "memoryless"]
    assert [agent.settings for agent in variant.agents] == [AStar(replan="change"), AStar(), Memoryless()]
    assert variant.reference == "eager"


def test_published_numbers_may_be_of_agents_that_are_not_run() -> None:
    """They are handed on as numbers, infinite ones too, and only those that are given."""
    numbers = "success: {MACN: {all: 96.3}}, path_ratio: {VIN: {all: .inf}}"
    scenario = read(SHORT + f"published: {{source: A paper, {numbers}}}\n")
    assert scenario.published == {
        "source": "A paper",
        "success": {"MACN": {"all": 96.3}},
        "path_ratio": {"VIN": {"all": inf}},
    }


@pytest.mark.parametrize(
    ("written", "slip"), [("1e-3", 0.001), (".5", 0.5), ("0.50", 0.5), ("1", 1.0), ("'0.25'", 0.25), ("1E-3", 0.001)]
)
def test_numbers_are_what_their_field_reads(written: str, slip: float) -> None:
    """YAML 1.1 would read the first as text."""
    (variant,) = read(SHORT + f"rules: {{slip: {written}}}\n").variants
    assert variant.conditions.rules == GridRules(slip=slip)


def test_text_that_looks_like_something_else_stays_text() -> None:
    """`no`, `010`, a date and `null` in quotes are names; as a whole number, `010` is ten."""
    scenario = read(
        SHORT.replace("short", "no").replace("10\n", "010\n")
        + "about: 'null'\nvariants: {010: {}, 2024-01-01: {}, yes: {}, 1e3: {}, 0x10: {}, 16:30: {}}\n"
    )
    assert (scenario.name, scenario.about) == ("no", "null")
    assert [variant.name for variant in scenario.variants] == ["010", "2024-01-01", "yes", "1e3", "0x10", "16:30"]
    assert {variant.episodes for variant in scenario.variants} == {10}


def test_a_choice_of_numbers_is_read_as_numbers() -> None:
    """A tunnel is 1 or 3 wide."""
    maps = SHORT.replace(BLOBS, "tunnel: {length: [20, 20], width: 3}")
    assert read(maps).variants[0].family == Tunnel(length=(20, 20), width=3)
    with pytest.raises(ScenarioError) as error:
        read(maps.replace("width: 3", "width: 2"))
    assert error.value.lines == ["good.yaml:2:42  maps.tunnel.width: got 2; expected one of 1, 3."]


def test_a_path_is_relative_to_the_file(tmp_path: Path) -> None:
    """Wherever the user stands."""
    (tmp_path / "city.map").touch()
    text = SHORT.replace(BLOBS, "movingai: {map: city.map}")
    (variant,) = read_scenario(text, tmp_path / "city.yaml").variants
    assert variant.family == MovingAI(map=tmp_path / "city.map")


@pytest.mark.parametrize(
    "written", ['"${FOG_HERE}/city.map"', "'${FOG_HERE}/city.map'", "'${FOG_HERE}/${FOG_FILE}.map'"]
)
def test_a_path_with_a_variable_is_relative_to_where_the_user_stands(
    written: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """And a variable may hold any part of a text."""
    (tmp_path / "maps").mkdir()
    (tmp_path / "maps" / "city.map").touch()
    monkeypatch.chdir(tmp_path)
    monkeypatch.setenv("FOG_HERE", "maps")
    monkeypatch.setenv("FOG_FILE", "city")
    text = SHORT.replace(BLOBS, f"movingai: {{map: {written}}}")
    (variant,) = read_scenario(text, tmp_path / "elsewhere" / "city.yaml").variants
    assert variant.family == MovingAI(map=tmp_path / "maps" / "city.map")


def test_a_variable_may_stand_for_a_number(monkeypatch: pytest.MonkeyPatch) -> None:
    """What it holds is read by the field, and told as it is written."""
    monkeypatch.setenv("FOG_SEED", "12")
    assert read(SHORT + "seed: ${FOG_SEED}\n").variants[0].seed == 12
    monkeypatch.setenv("FOG_SEED", "twelve")
    with pytest.raises(ScenarioError) as error:
        read(SHORT + "seed: ${FOG_SEED}\n")
    assert error.value.lines == [
        "good.yaml:6:7  seed: got ${FOG_SEED}; expected a whole number from 0 to 4,294,967,295."
    ]


def test_a_variable_that_is_not_set_skips_the_scenario(monkeypatch: pytest.MonkeyPatch) -> None:
    """The reason names it, also where it is set to nothing; other mistakes are told all the same."""
    monkeypatch.delenv("FOG_MAPS", raising=False)
    text = SHORT.replace(BLOBS, 'movingai: {map: "${FOG_MAPS}/city.map"}') + "about: Streets.\n"
    scenario = read(text)
    assert (scenario.name, scenario.about, scenario.variants) == ("short", "Streets.", ())
    assert scenario.skipped == "environment variable FOG_MAPS is not set"
    assert read(text + "seed: ${FOG_MAPS}\n").skipped == scenario.skipped
    monkeypatch.setenv("FOG_MAPS", "")
    assert read(text).skipped == scenario.skipped
    with pytest.raises(ScenarioError) as error:
        read(text + "seed: soon\n")
    assert error.value.lines == ["good.yaml:7:7  seed: got soon; expected a whole number from 0 to 4,294,967,295."]


def test_every_published_metric_is_one_that_a_report_shows() -> None:
    """None is read in vain."""
    assert set(Published.model_fields) - {"source"} <= set(HEADLINE)


def test_reading_imports_only_what_a_scenario_names() -> None:
    """The reader itself needs no compiler, no planner, no plots."""
    heavy = {
        "numba",
        "matplotlib",
        "pandas",
        "networkx",
        "ompl",
        "fogbench.worlds.maps.families.blobs",
        "fogbench.worlds.maps.families.tunnel",
        "fogbench.planners.astar",
    }
    code = f"import fogbench.bench.reading.scenario, sys; print(sorted({heavy} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "[]\n"
