"""Keys of episodes change with everything that an episode depends on, and with nothing else."""

from pathlib import Path

import pytest

from fogbench.bench.playing import closure, keys, sources
from fogbench.bench.playing.keys import agent_key, packages, world_key
from fogbench.bench.playing.packages import installed
from fogbench.bench.reading.scenario import Variant, read_scenario
from fogbench.planners.astar import AStar

TEXT = """\
name: keys
about: One agent.
maps: {blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}}
sensor: {radius: 2}
budget: {steps: 40}
agents: [astar]
episodes: 5
seed: 1
"""

PLUGIN = """
from fogbench.planners.astar import AStar


class Mine(AStar):
    depth: int = 3
"""

FAMILY = """
from fogbench.worlds.maps.families.blobs import Blobs


class Sparse(Blobs):
    pass
"""


def variant(old: str = "", new: str = "", path: Path = Path("keys.yaml")) -> Variant:
    """The one variant of the text, with a change."""
    assert old in TEXT
    return read_scenario(TEXT.replace(old, new, 1), path).variants[0]


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("seed: 1", "seed: 2"),
        ("size: 8", "size: 9"),
        ("radius: 2", "radius: 3"),
        ("steps: 40", "steps: 41"),
        ("budget", "rules: {slip: 0.1}\nbudget"),
        ("budget", "tasks: {distance: [1, 9]}\nbudget"),
        ("blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}", "tunnel: {length: [3, 3]}"),
    ],
)
def test_what_changes_the_worlds_changes_their_key(old: str, new: str) -> None:
    """Seed, map family, sensor, rules, tasks, budget."""
    assert world_key(variant(old, new)) != world_key(variant())


@pytest.mark.parametrize(
    ("old", "new"),
    [
        ("name: keys", "name: other"),
        ("about: One agent.", "about: More."),
        ("[astar]", "[memoryless, astar]"),
        ("episodes: 5", "episodes: 6"),
        ("size: 8, obstacles: [0, 3]", "obstacles: [0, 3], size: 8"),
        ("seed: 1", "variants: {one: {seed: 1}}"),
    ],
)
def test_what_changes_no_world_leaves_their_key(old: str, new: str) -> None:
    """Names, agents, the number of episodes, the order of the settings."""
    assert world_key(variant(old, new)) == world_key(variant())


def test_map_files_count_by_their_contents(tmp_path: Path) -> None:
    """A moved file is the same map, a changed one is another."""
    scenes = []
    for name, cell in (("a", "."), ("b", "."), ("c", "T")):
        (tmp_path / name).mkdir()
        rows = f"type octile\nheight 2\nwidth 2\nmap\n..\n.{cell}\n"
        (tmp_path / name / "m.map").write_text(rows)
        (tmp_path / name / "m.map.scen").write_text("version 1\n0\tm.map\t2\t2\t0\t0\t1\t0\t1\n")
        maps = "movingai: {map: m.map}"
        old = "blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}"
        scenes.append(world_key(variant(old, maps, tmp_path / name / "keys.yaml")))
    assert scenes[0] == scenes[1] != scenes[2]


def test_an_agents_settings_are_in_its_key_and_its_label_and_place_are_not() -> None:
    """Nor is the scenario that it plays in."""
    listed = "[memoryless, astar: {label: x}, astar: {replan: cut, label: y}, astar: {replan: change}]"
    memoryless, x, y, eager = map(agent_key, variant("[astar]", listed).agents)
    (astar,) = map(agent_key, variant("seed: 1", "seed: 2").agents)
    assert astar == x == y
    assert len({astar, memoryless, eager}) == 3


def test_a_plug_in_counts_by_its_source_and_not_by_its_path(tmp_path: Path) -> None:
    """Copies have the same key, with more comments too; a changed line is another agent."""
    found = []
    for name, source in (("a", PLUGIN), ("b", PLUGIN + "# more\n"), ("c", PLUGIN + "MORE = 1\n")):
        (tmp_path / name).mkdir()
        (tmp_path / name / f"{name}.py").write_text(source)
        agents = variant("[astar]", f"[./{name}.py:Mine]", tmp_path / name / "keys.yaml").agents
        found.append(agent_key(agents[0]))
    assert found[0] == found[1] != found[2]


def test_a_file_that_a_setting_names_counts_by_its_contents(tmp_path: Path) -> None:
    """Other weights under the same name are another agent; the same ones elsewhere are not."""
    found = []
    for name, weights in (("a", b"1"), ("b", b"1"), ("c", b"2")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "gru.pt").write_bytes(weights)
        (tmp_path / name / "mine.py").write_text(PLUGIN.replace("depth: int = 3", 'weights: str = "gru.pt"'))
        (agent,) = variant("[astar]", "[./mine.py:Mine]", tmp_path / name / "keys.yaml").agents
        found.append(agent_key(agent))
    assert found[0] == found[1] != found[2]


def test_a_module_that_a_plug_in_imports_is_in_its_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """In a function too: a changed line of it is another agent, a comment is not."""
    monkeypatch.syspath_prepend(tmp_path)
    inner = PLUGIN + "    def start(self, task, rng):\n        import keys_shelf\n"
    (tmp_path / "mine.py").write_text(inner)
    found = []
    for source in ("STEP = 1\n", "STEP = 1  # more\n", "STEP = 2\n"):
        (tmp_path / "keys_shelf.py").write_text(source)
        forget()
        (agent,) = variant("[astar]", "[./mine.py:Mine]", tmp_path / "keys.yaml").agents
        found.append(agent_key(agent))
    assert found[0] == found[1] != found[2]


def test_an_installed_package_is_in_a_key_by_its_version(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """By what is installed or, if one says so, by what was; its contents do not count."""
    shelf = tmp_path / "site-packages"
    (shelf / "keys_lamp").mkdir(parents=True)
    monkeypatch.syspath_prepend(shelf)
    (tmp_path / "mine.py").write_text("import keys_lamp\n" + PLUGIN)
    found = []
    for number, source in (("1", ""), ("1", "ON = 1\n"), ("2", "")):
        (shelf / "keys_lamp" / "__init__.py").write_text(source)
        forget()
        scenario = read_scenario(TEXT.replace("[astar]", "[./mine.py:Mine]"), tmp_path / "keys.yaml")
        (agent,) = scenario.variants[0].agents
        assert "keys_lamp" in packages(scenario)
        found.append(agent_key(agent, {"numpy": "2", "keys_lamp": number}))
    assert found[0] == found[1] != found[2]
    assert agent_key(agent) not in found


def test_by_default_versions_are_those_of_this_machine() -> None:
    """Of each package that is used."""
    page = read_scenario(TEXT, Path("keys.yaml"))
    (row,) = page.variants
    (agent,) = row.agents
    here = installed(packages(page))
    assert {"numba", "numpy", "pydantic"} <= here.keys()
    assert (agent_key(agent), world_key(row)) == (agent_key(agent, here), world_key(row, here))
    older = {**here, "numba": "0.1"}
    assert agent_key(agent, older) != agent_key(agent, here)
    assert world_key(row, older) != world_key(row, here)


def test_what_settings_say_that_they_use_is_in_the_key(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """As the network of a policy, which its settings do not import."""
    monkeypatch.syspath_prepend(tmp_path)
    (tmp_path / "mine.py").write_text(PLUGIN + "    def uses(self):\n        return ['keys_network:Net']\n")
    found = []
    for source in ("LAYERS = 1\n", "LAYERS = 2\n"):
        (tmp_path / "keys_network.py").write_text(source)
        forget()
        (agent,) = variant("[astar]", "[./mine.py:Mine]", tmp_path / "keys.yaml").agents
        found.append(agent_key(agent))
    assert found[0] != found[1]


def forget() -> None:
    """Have all files looked for and read again."""
    for kept in (sources.read_source, closure._find, closure._closure, keys._used_here):
        kept.cache_clear()


def test_a_users_map_family_counts_by_its_source(tmp_path: Path) -> None:
    """Its settings alone do not say what it draws."""
    found = []
    for name, source in (("a", FAMILY), ("b", FAMILY + "# more\n"), ("c", FAMILY + "MORE = 1\n")):
        (tmp_path / f"{name}.py").write_text(source)
        found.append(world_key(variant("blobs", f"./{name}.py:Sparse", tmp_path / "keys.yaml")))
    assert found[0] == found[1] != found[2]


def test_a_skipped_agent_without_settings_has_no_key(tmp_path: Path) -> None:
    """It has no episodes."""
    (tmp_path / "needs.py").write_text("import fog_lamp\n")
    (agent,) = variant("[astar]", "[./needs.py:Mine]", tmp_path / "keys.yaml").agents
    with pytest.raises(TypeError, match="Mine has no settings: needs the package fog_lamp, which is not installed"):
        agent_key(agent)


def test_keys_are_digests_that_know_a_class_by_its_name() -> None:
    """64 hexadecimal digits, the same for an equal object."""
    (agent,) = variant().agents
    assert agent.settings == AStar()
    assert len(agent_key(agent)) == len(world_key(variant())) == 64
    assert set(agent_key(agent) + world_key(variant())) <= set("0123456789abcdef")
