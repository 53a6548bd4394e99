"""Plug-ins of users: by file, by module, by entry point; what is wrong with one is a line at its name."""

import multiprocessing
import sys
from collections.abc import Callable
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict
from pathlib import Path

import pytest

from fogbench.bench.reading.plugins import load, target
from fogbench.bench.reading.scenario import Scenario, ScenarioError, read_scenario
from fogbench.bench.reading.tables import AGENT, agents, families, first_sentence, registered
from fogbench.learned import LEARNED
from fogbench.planners import PLANNERS
from fogbench.worlds import FAMILIES

SCENARIO = """\
name: mine
maps: {blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}}
budget: {steps: 40}
agents: [astar, AGENT]
episodes: 1
"""

AGENT_FILE = '''
"""A planner."""
from pathlib import Path
from typing import ClassVar, Literal
from pydantic import field_validator
from fogbench.planners.memoryless import MemorylessAgent
from fogbench.worlds.settings import MapFile, Settings


class Mine(Settings):
    """My own planner.

    With more to say about it.
    """

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})
    depth: int = 3
    even: int = 0
    way: Literal[4, 8] | None = None
    flags: list[bool] = []
    table: MapFile | None = None

    @field_validator("even")
    @classmethod
    def _even(cls, even: int) -> int:
        if even % 2:
            raise ValueError("an even number.")
        return even

    def start(self, task, rng):
        return MemorylessAgent(task)

    def parameter_bytes(self):
        return 0


class Flyer(Mine):
    """Plays elsewhere."""

    kinds: ClassVar[frozenset[str]] = frozenset({"robot", "graph"})


class Plain:
    kinds = frozenset({"grid"})
    start = parameter_bytes = None


class Unfinished(Settings):
    """Has only settings."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})
'''

FAMILY_FILE = '''
from typing import ClassVar
from pydantic import model_validator
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.layout import DrawnMaps


class Sparse(Blobs):
    """Few obstacles."""

    @model_validator(mode="after")
    def _sparse(self):
        if self.obstacles[1] > self.size:
            raise ValueError("at most as many obstacles as rows")
        return self


class Sea(Blobs):
    kinds: ClassVar[tuple[str, ...]] = ("sea",)


class Bare(DrawnMaps):
    """Draws nothing."""


class Late(Blobs):
    def model_post_init(self, context):
        raise RuntimeError("no lamp\\nat all")
'''

POINTS = """
[fogbench.planners]
walker = fogbench.planners.random_walk:RandomWalk
astar = fogbench.planners.random_walk:RandomWalk

[fogbench.learned]
net = fogbench.planners.memoryless:Memoryless

[fogbench.families]
tubes = fogbench.worlds.maps.families.tunnel:Tunnel
"""

Read = Callable[..., Scenario]


@pytest.fixture
def read(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Read:
    """Reads a scenario with one more agent, or with other changes, beside the two files of plug-ins."""
    (tmp_path / "mine.py").write_text(AGENT_FILE)
    (tmp_path / "maps.py").write_text(FAMILY_FILE)
    monkeypatch.chdir(tmp_path)

    def read(agent: str = "memoryless", old: str = "", new: str = "") -> Scenario:
        return read_scenario(SCENARIO.replace("AGENT", agent).replace(old, new), Path("mine.yaml"))

    return read


def line(read: Read, agent: str = "memoryless", old: str = "", new: str = "") -> str:
    """The one mistake, after the name of the file."""
    with pytest.raises(ScenarioError) as error:
        read(agent, old, new)
    (line,) = error.value.lines
    return line.removeprefix("mine.yaml:")


def test_a_class_in_a_file_beside_the_scenario(read: Read, tmp_path: Path) -> None:
    """Its settings are read by its fields, its label is the class's name."""
    (tmp_path / "table.txt").touch()
    text = "./mine.py:Mine: {depth: 010, way: 8, flags: [true, false], table: table.txt}"
    agent = read(text).variants[0].agents[1]
    assert (agent.label, agent.target, agent.skipped) == ("Mine", f"{tmp_path}/mine.py:Mine", "")
    assert agent.settings is not None
    assert repr(agent.settings) == (
        f"Mine(depth=10, even=0, way=8, flags=[True, False], table={tmp_path / 'table.txt'!r})"
    )


def test_a_map_family_in_a_file(read: Read) -> None:
    """Its kind reads the rest of the scenario."""
    (variant,) = read(old="blobs", new="./maps.py:Sparse").variants
    assert type(variant.family).__name__ == "Sparse"
    assert variant.conditions.budget.steps == 40


def test_a_class_in_a_module(read: Read) -> None:
    """Any that can be imported."""
    agent = read("fogbench.planners.random_walk:RandomWalk").variants[0].agents[1]
    assert (agent.label, agent.target) == ("RandomWalk", "fogbench.planners.random_walk:RandomWalk")


def test_an_agent_of_another_kind_of_world_is_skipped_with_its_reason(read: Read) -> None:
    """Its settings are read and checked all the same."""
    agent = read("./mine.py:Flyer: {depth: 5}").variants[0].agents[1]
    assert agent.settings is not None
    assert agent.skipped == "it plays graph, robot worlds, not grid"
    assert line(read, "./mine.py:Flyer: {depth: x}").endswith("got x; expected a whole number.")


@pytest.mark.parametrize(
    ("agent", "expected"),
    [
        ("./none.py:Mine", "an existing file (looked for {folder}/none.py)."),
        ("./mine.py:Nine", "a class of mine.py, which has no Nine. Did you mean Mine?"),
        (
            "./mine.py:Plain",
            "a class derived from fogbench.Settings, with kinds, start, parameter_bytes.",
        ),
        ("./mine.py:Unfinished", "a class with kinds, start, parameter_bytes; it lacks start, parameter_bytes."),
        (
            "./broken.py:Mine",
            "code that can be imported; it raises SyntaxError: '(' was never closed (broken.py, line 1).",
        ),
        ("./raises.py:Mine", "code that can be imported; it raises ZeroDivisionError: division by zero."),
        (
            "./opens.py:Mine",
            "code that can be imported; it raises FileNotFoundError: [Errno 2] No such file or directory: 'weights'.",
        ),
        ("./leaves.py:Mine", "code that can be imported; it raises SystemExit: 3."),
        (
            "./helped.py:Mine",
            "one file alone, or a package that is installed; it imports my_lamp, which lies beside it.",
        ),
        (
            "./packed.py:Mine",
            "one file alone, or a package that is installed; it imports my_lamps, which lies beside it.",
        ),
        ("fogbench.planners.nowhere:Mine", "a module that is installed; there is no fogbench.planners.nowhere."),
        ("nowhere.at_all:Mine", "a module that is installed; there is no nowhere."),
        (
            "fogbench.planners.astar:Astar",
            "a class of fogbench.planners.astar, which has no Astar. Did you mean AStar?",
        ),
    ],
)
def test_what_is_wrong_with_a_class_of_a_user_is_one_line(
    agent: str, expected: str, read: Read, tmp_path: Path
) -> None:
    """A missing file or class, a class of another sort, code that cannot be imported."""
    (tmp_path / "broken.py").write_text("x = (\n")
    (tmp_path / "raises.py").write_text("1 / 0\n")
    (tmp_path / "opens.py").write_text("open('weights')\n")
    (tmp_path / "leaves.py").write_text("import sys\nsys.exit(3)\n")
    (tmp_path / "my_lamp.py").touch()
    (tmp_path / "helped.py").write_text("import my_lamp\n")
    (tmp_path / "my_lamps").mkdir()
    (tmp_path / "packed.py").write_text("from my_lamps.light import beam\n")
    expected = expected.replace("{folder}", str(tmp_path))
    assert line(read, agent) == f"4:17  agents[1]: got {agent}; expected {expected}"


@pytest.mark.parametrize(
    ("settings", "expected"),
    [
        ("{deep: 3}", "34  PATH: got deep; expected one of depth, even, way, flags, table. Did you mean depth?"),
        ("{even: 3}", "40  PATH.even: got 3; expected an even number."),
        ("{way: 6}", "39  PATH.way: got 6; expected one of 4, 8 or nothing."),
        ("{flags: [on]}", "42  PATH.flags[0]: got on; expected true or false."),
        ("{table: t.txt}", "41  PATH.table: got t.txt; expected an existing file (looked for {folder}/t.txt)."),
    ],
)
def test_what_is_wrong_with_its_settings_is_told_by_its_fields(
    settings: str, expected: str, read: Read, tmp_path: Path
) -> None:
    """The text of a `ValueError` is what was expected."""
    found = line(read, f"./mine.py:Mine: {settings}")
    assert found == "4:" + expected.replace("PATH", "agents[1]../mine.py:Mine").replace("{folder}", str(tmp_path))


def test_a_map_family_of_no_kind_is_one_line(read: Read) -> None:
    """A kind of world that there is none of is told at the name of the family."""
    found = line(read, old="blobs", new="./maps.py:Sea")
    expected = "a map family of the kind grid or graph or robot; this one is of 'sea'"
    assert found == f"2:8  maps: got ./maps.py:Sea; expected {expected}."


def test_a_map_family_that_lacks_a_package_skips_the_scenario(read: Read, tmp_path: Path) -> None:
    """It says which, as an agent does; the rest of the file is read."""
    (tmp_path / "needs.py").write_text("import fog_lamp\n")
    scenario = read(old="blobs", new="./needs.py:X")
    assert scenario.skipped == "./needs.py:X needs the package fog_lamp, which is not installed"
    assert scenario.variants == ()


def test_the_text_of_a_users_error_is_what_was_expected(read: Read) -> None:
    """An error about all the settings is told at their mapping."""
    with pytest.raises(ScenarioError) as error:
        read(old="blobs: {size: 8, obstacles: [0, 3]", new="./maps.py:Sparse: {size: 3, obstacles: [0, 4]")
    assert str(error.value) == (
        "mine.yaml:2:26  maps../maps.py:Sparse: got {size: 3, obstacles: [0, 4], obstacle_size: [1, 2]}; "
        "expected at most as many obstacles as rows."
    )


@pytest.mark.parametrize(
    ("family", "settings", "error"),
    [
        ("Bare", "{}", "TypeError: Can't instantiate abstract class Bare"),
        ("Late", "{size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}", "RuntimeError: no lamp."),
    ],
)
def test_whatever_a_class_raises_is_told_at_its_settings(family: str, settings: str, error: str, read: Read) -> None:
    """A family that cannot be made, or that fails after its fields were read."""
    found = line(
        read, old="blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}", new=f"./maps.py:{family}: {settings}"
    )
    expected = f"settings that its class can read; it raises {error}"
    assert found.startswith(f"2:24  maps../maps.py:{family}: got {settings}; expected {expected}")


def test_an_agent_whose_package_is_missing_is_skipped_with_its_reason(read: Read, tmp_path: Path) -> None:
    """The others play."""
    (tmp_path / "needs.py").write_text("from fog_lamp.light import beam\n")
    first, second = read("./needs.py:Mine").variants[0].agents
    assert (first.skipped, second.settings) == ("", None)
    assert second.skipped == "needs the package fog_lamp, which is not installed"


def test_a_missing_extra_is_named_with_the_way_to_get_it(read: Read, monkeypatch: pytest.MonkeyPatch) -> None:
    """As for a planner that stands on a package of an extra, here one of a file."""
    monkeypatch.setitem(AGENT.shipped, "lamp", "fog_shop:Lamp")
    monkeypatch.setattr("fogbench.bench.reading.plugins.EXTRAS", {"lamp": "light"})
    Path("fog_shop.py").write_text("import fog_lamp\n")
    monkeypatch.syspath_prepend(Path.cwd())
    (_, agent) = read("lamp").variants[0].agents
    assert (agent.label, agent.skipped) == ("lamp", 'needs the extra light: pip install ".[light]"')


def test_the_same_file_is_loaded_once_and_two_of_one_name_do_not_clash(tmp_path: Path) -> None:
    """A class is the same object however its file is named; a file of that name elsewhere is another."""
    for folder, depth in (("a", 1), ("b", 2)):
        (tmp_path / folder).mkdir()
        (tmp_path / folder / "mine.py").write_text(AGENT_FILE.replace("depth: int = 3", f"depth: int = {depth}"))
    places = [
        target(AGENT, name, tmp_path / folder)
        for name, folder in (("./mine.py:Mine", "a"), ("../a/mine.py:Mine", "b"), ("mine.py:Mine", "b"))
    ]
    one, same, other = (load(AGENT, "Mine", place) for place in places)
    assert one is same
    assert (one().model_dump()["depth"], other().model_dump()["depth"]) == (1, 2)


def test_a_spawned_process_reads_the_same_scenario(read: Read, tmp_path: Path) -> None:
    """Its plug-ins have the same names there, so that its objects can be handed over."""
    here = read("./mine.py:Mine: {depth: 5}")
    with ProcessPoolExecutor(1, mp_context=multiprocessing.get_context("spawn")) as pool:
        there = pool.submit(read_scenario, here.text, here.path).result()
    assert asdict(there) == asdict(here)


def test_a_file_that_fails_leaves_nothing_behind(read: Read, tmp_path: Path) -> None:
    """Put right, it is read."""
    (tmp_path / "late.py").write_text("1 / 0\n")
    assert line(read, "./late.py:Mine").endswith("division by zero.")
    assert not [name for name in sys.modules if name.endswith("late%2Epy")]
    (tmp_path / "late.py").write_text(AGENT_FILE)
    assert read("./late.py:Mine").variants[0].agents[1].label == "Mine"


def test_entry_points_of_other_packages(
    read: Read, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, request: pytest.FixtureRequest
) -> None:
    """They stand beside the names of the project, and cannot take one of those."""
    package = tmp_path / "other-1.0.dist-info"
    package.mkdir()
    (package / "METADATA").write_text("Metadata-Version: 2.1\nName: other\nVersion: 1.0\n")
    (package / "entry_points.txt").write_text(POINTS)
    monkeypatch.syspath_prepend(tmp_path)
    registered.cache_clear()
    request.addfinalizer(registered.cache_clear)
    assert families() == {**FAMILIES, "tubes": "fogbench.worlds.maps.families.tunnel:Tunnel"}
    walker, net = "fogbench.planners.random_walk:RandomWalk", "fogbench.planners.memoryless:Memoryless"
    assert agents() == {**PLANNERS, **LEARNED, "walker": walker, "net": net}
    assert [agent.target for agent in read("walker, net").variants[0].agents] == [PLANNERS["astar"], walker, net]
    assert line(read, "walkr").endswith("Did you mean walker?")


def test_first_sentences_are_told_without_an_import(tmp_path: Path) -> None:
    """What cannot be found has none."""
    for name in [*FAMILIES.values(), *PLANNERS.values(), *LEARNED.values()]:
        module, _, class_name = name.rpartition(":")
        __import__(module)
        assert first_sentence(name) == getattr(sys.modules[module], class_name).__doc__.partition("\n")[0]
    assert first_sentence("fogbench.planners.astar:Nothing") == ""
    assert first_sentence("nowhere.at_all:Mine") == ""
    before = set(sys.modules)
    first_sentence("fogbench.planners.frontier:Frontier")
    assert set(sys.modules) == before
