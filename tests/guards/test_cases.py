"""What broke once, each case with its right answer, through the real command. The letters are the kinds of fault.

A: a key names what was really played. B: a side product never takes the tables away. C: the hard limit measures the
episode. D: the harness owns the process that it lends to a planner. E: what `check` accepts, `run` plays. F: a map
file's own words are believed, or contradicted aloud.
"""

import os
import signal
import time
from typing import Any

import pandas as pd
import pytest

LIBRARY = "def choose(free, near):\n    return {}\n"
NEAREST = "min(free, key=near, default=None)"

CLOCK = """
import os, time
truth, monotonic, began = time.time, time.monotonic, time.monotonic()
time.time = lambda: truth() + (float(os.environ["JUMP"]) if monotonic() - began > float(os.environ["AFTER"]) else 0)
"""
"""A `sitecustomize` in which the system's clock takes a step."""

FLOOR = """\
????????????
?....#.....?
?....#.....?
?..........?
?....#.....?
????????????"""
GREY = {"?": 205, ".": 254, "#": 0}

ROS = "image: map.pgm\nmode: trinary\nresolution: 0.05\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\n"
"""What map_saver writes; `free_thresh` follows."""


def floor(desk: Any, free_thresh: str = "0.196", name: str = "map.yaml") -> None:
    """A recorded floor, its unknown border of grey 205 around two rooms."""
    rows = FLOOR.split()
    values = " ".join(str(GREY[letter]) for row in rows for letter in row)
    desk.write("map.pgm", f"P2\n{len(rows[0])} {len(rows)}\n255\n{values}\n")
    desk.write(name, f"{ROS}free_thresh: {free_thresh}\n")


# A: a key names what was really played


def test_stale_library(desk: Any) -> None:
    """A library of the user's that changes makes its planner's episodes be played again, and no others."""
    agents = ["astar", desk.planner("thin.py", top="import mylib", act="return mylib.choose(free, near)")]
    desk.scenario(agents=agents)
    place = str(desk.write("lib/mylib.py", LIBRARY.format("None")).parent)
    assert desk.fogbench("run", "s.yaml", PYTHONPATH=place).code == 0
    first = desk.rows()
    desk.write("lib/mylib.py", LIBRARY.format(NEAREST))
    assert desk.fogbench("run", "s.yaml", PYTHONPATH=place).code == 0
    second = desk.rows()
    assert set(second[second["agent"] == "Bold"]["outcome"]) == {"REACHED"}
    kept = [frame[frame["agent"] == "astar"] for frame in (first, second)]
    pd.testing.assert_frame_equal(*kept, check_exact=True)
    desk.write("lib/mylib.py", f"# a word\n{LIBRARY.format(NEAREST)}")
    assert "0 were played now" in desk.fogbench("run", "s.yaml", PYTHONPATH=place).out


def test_edited_while_running(desk: Any) -> None:
    """What version 1 played is never told as version 2's: the run stops with a line, and a new run plays version 2."""
    mark = "open('started', 'w').close(); import time; time.sleep(2); return None"
    desk.scenario(agents=["astar", desk.planner("bold.py", act=mark)])
    run = desk.start("run", "s.yaml")
    desk.wait((desk.folder / "started").exists)
    desk.planner("bold.py")
    ended = desk.end(run)
    assert ended.code == 2
    assert any("bold.py" in line for line in ended.lines)
    assert desk.fogbench("run", "s.yaml").code == 0
    rows = desk.rows()
    bold = rows[rows["agent"] == "Bold"]
    assert list(bold["outcome"]) == ["REACHED"] * 3
    assert len(set(bold["agent_key"])) == 1


def test_weights_of_a_planner_of_ones_own(desk: Any) -> None:
    """The contents of a file that a planner's settings name are part of its key."""
    planner = desk.planner(
        "own.py",
        top="from fogbench import MapFile",
        fields="weights: MapFile",
        start="text = self.weights.read_text(); return BoldAgent(task.goal) if 'go' in text else Idle()",
    )
    desk.append(
        "own.py",
        "\n\nclass Idle(BoldAgent):\n    def __init__(self):\n        pass\n\n"
        "    def act(self, observation):\n        return None\n",
    )
    desk.scenario(agents=["astar", {planner: {"weights": "w.txt"}}])
    for text, outcome in (("stay", "GAVE_UP"), ("go", "REACHED")):
        desk.write("w.txt", text)
        assert desk.fogbench("run", "s.yaml").code == 0
        rows = desk.rows()
        assert set(rows[rows["agent"] == "Bold"]["outcome"]) == {outcome}


def test_jit_off(desk: Any) -> None:
    """Numba switched off is refused in a line, or computes the same."""
    desk.scenario(
        maps={"blobs": {"size": 12, "obstacles": [4, 6], "obstacle_size": [2, 3]}},
        rules={"collision": "blocked"},
        agents=["astar", "dstar_lite", "frontier"],
    )
    ended = desk.fogbench("run", "s.yaml", "--results", "off", NUMBA_DISABLE_JIT="1")
    if ended.code == 2:
        assert "NUMBA_DISABLE_JIT" in ended.err
        assert len(ended.lines) == 1
        return
    desk.fogbench("run", "s.yaml")
    pd.testing.assert_frame_equal(desk.rows(results="off"), desk.rows(), check_exact=True)


# B: a side product never takes the tables away


@pytest.mark.parametrize(
    ("label", "environment"),
    [
        ("plain", {"MPLBACKEND": "module://matplotlib_inline.backend_inline"}),
        ("plain", {"MPLBACKEND": "no such backend"}),
        ("Ba$$in", {}),
        (r"$\floor{x}$ [/red] *b* | `c`", {}),
        ("café ✓", {"PYTHONIOENCODING": "latin-1"}),
        ("café ✓", {"LC_ALL": "C", "PYTHONUTF8": "0", "PYTHONCOERCECLOCALE": "0", "PYTHONIOENCODING": "ascii"}),
    ],
    ids=["notebook-backend", "unknown-backend", "dollar-label", "markup-label", "latin1-terminal", "ascii-terminal"],
)
def test_tables_always_come_out(desk: Any, label: str, environment: dict[str, str]) -> None:
    """Whatever backend, label or terminal: exit code 0, the tables are written, and the label stands in them."""
    desk.scenario(agents=["astar", {"memoryless": {"label": label}}], reference=label)
    ended = desk.fogbench("run", "s.yaml", **environment)
    assert (ended.code, ended.err) == (0, "")
    results = desk.folder / "results" / "small"
    assert {"summary.csv", "summary.md", "success.png"} <= {file.name for file in results.iterdir()}
    assert label in pd.read_csv(results / "summary.csv")["agent"].tolist()


@pytest.mark.parametrize("words", [["list"], ["--help"], ["check", "s.yaml"], ["schema"], ["report", "s.yaml"]])
def test_latin1_terminal(desk: Any, words: list[str]) -> None:
    """No command stops at a letter that a terminal does not have."""
    desk.scenario(name="Größe ✓", about="Ein großes ✓.")
    ended = desk.fogbench(*words, PYTHONIOENCODING="latin-1")
    assert ended.code == (2 if words[0] == "report" else 0)


# C: the hard limit measures the episode


def test_suspended(desk: Any) -> None:
    """Ctrl-Z and fg for longer than the hard limit end no episode."""
    slow = "import time; time.sleep(0.3); open('started', 'a').write('x')"
    desk.scenario(agents=[desk.planner("slow.py", act=slow)], budget={"steps": 60, "hard_seconds": 6}, episodes=2)
    run = desk.start("run", "s.yaml")
    desk.wait((desk.folder / "started").exists)
    os.killpg(run.pid, signal.SIGSTOP)
    time.sleep(7)
    os.killpg(run.pid, signal.SIGCONT)
    assert desk.end(run).code == 0
    assert "HUNG" not in set(desk.rows()["outcome"])


@pytest.mark.parametrize(
    ("jump", "act", "outcome"),
    [("3600", "import time; time.sleep(0.1)", "REACHED"), ("-3600", "import time; time.sleep(1e6)", "HUNG")],
    ids=["ahead", "back"],
)
def test_stepped_clock(desk: Any, jump: str, act: str, outcome: str) -> None:
    """A step of the system's clock ends no episode, and lets none hang."""
    desk.write("clock/sitecustomize.py", CLOCK)
    desk.scenario(agents=[desk.planner("bold.py", act=act)], budget={"steps": 60, "hard_seconds": 5}, episodes=2)
    environment = {"PYTHONPATH": str(desk.folder / "clock"), "JUMP": jump, "AFTER": "2"}
    ended = desk.fogbench("run", "s.yaml", seconds=60, **environment)
    assert ended.code == (outcome == "HUNG")
    assert set(desk.rows()["outcome"]) == {outcome}


# D: the harness owns the process that it lends to a planner


ORPHANS = {
    "hung": None,
    "ctrl-c": lambda run: os.killpg(run.pid, signal.SIGINT),
    "kill-9": lambda run: run.kill(),
    "terminated": lambda run: run.terminate(),
}


@pytest.mark.parametrize("way", ORPHANS)
def test_orphans(desk: Any, way: str) -> None:
    """A program that a planner has started does not outlive its episode, however that ends."""
    start = "import subprocess; child = subprocess.Popen(['sleep', '987'], stdout=subprocess.PIPE)\n"
    start += "open('started', 'w').close(); child.stdout.read()"
    budget = {"steps": 60, "hard_seconds": 3 if way == "hung" else 300}
    desk.scenario(agents=["astar", desk.planner("ext.py", start=start)], budget=budget, episodes=1)
    run = desk.start("run", "s.yaml")
    if way == "hung":
        assert desk.end(run).code == 1
        return
    desk.wait((desk.folder / "started").exists)
    ORPHANS[way](run)
    run.communicate(timeout=30)
    left = desk.left(run)
    for process in left:
        os.kill(process, signal.SIGKILL)
    assert not left


GLOBAL = {
    "random": ("import random", "return random.choice(free)"),
    "numpy": ("import numpy", "return free[numpy.random.randint(len(free))]"),
    "torch": ("import torch", "return free[int(torch.randint(len(free), ()))]"),
}


@pytest.mark.parametrize("library", GLOBAL)
def test_global_random(desk: Any, library: str) -> None:
    """A planner that uses a global generator plays the same episodes again, whatever the number of workers."""
    top, act = GLOBAL[library]
    desk.scenario(agents=["astar", desk.planner("glob.py", top=top, act=act)], episodes=6)
    for results, workers in (("a", "1"), ("b", "2")):
        assert desk.fogbench("run", "s.yaml", "--workers", workers, "--results", results).code == 0
    pd.testing.assert_frame_equal(desk.rows(results="a"), desk.rows(results="b"), check_exact=True)
    bold = desk.rows(results="a").query("agent == 'Bold'")
    assert bold["actions"].nunique() == 6  # each episode has luck of its own


def test_torch_default_dtype(desk: Any) -> None:
    """What a planner's file does to torch on import reaches no network, before it or after it."""
    planner = desk.planner("dbl.py", top="import torch\ntorch.set_default_dtype(torch.float64)")
    network = {"vin": {"checkpoint": "vin-grid"}}
    for file, agents in (("a", [planner, network]), ("b", [network, planner]), ("c", [network])):
        desk.scenario(f"{file}.yaml", agents=agents, reference="vin", name="small")
        assert desk.fogbench("run", f"{file}.yaml", "--results", file).code == 0
    pd.testing.assert_frame_equal(desk.rows(results="a"), desk.rows(results="b"), check_exact=True)
    alone = desk.rows(results="a").query("agent == 'vin'").reset_index(drop=True)
    pd.testing.assert_frame_equal(alone, desk.rows(results="c"), check_exact=True)


def test_planner_with_pool(desk: Any) -> None:
    """The children of a planner can import its file."""
    top = "import multiprocessing\n\n\ndef square(x):\n    return x * x\n"
    act = "with multiprocessing.get_context('spawn').Pool(1) as pool:\n    assert pool.map(square, [2]) == [4]"
    limit = {"steps": 2, "hard_seconds": 60}
    desk.scenario(agents=[desk.planner("mp_pool.py", top=top, act=act)], budget=limit, episodes=1)
    assert desk.fogbench("run", "s.yaml").code == 0
    assert desk.rows()["outcome"].item() in {"REACHED", "OUT_OF_STEPS"}


# E: what `check` accepts, `run` plays; every mistake in one go


@pytest.mark.parametrize("file", ["bold.v2.py", "my bold.py", "2bold.py", "class.py", "bold-2.py", "sub.dir/bold.py"])
def test_dotted_file(desk: Any, file: str) -> None:
    """Whatever the name of a planner's file: what `check` accepts, `run` plays."""
    desk.scenario(agents=[desk.planner(file)], episodes=1)
    assert desk.fogbench("check", "s.yaml").code == 0
    assert desk.fogbench("run", "s.yaml").code == 0
    assert desk.rows()["outcome"].item() == "REACHED"


HUGE = {
    "steps": {"budget": {"steps": 10**20}},
    "per_distance": {"budget": {"steps": {"per_distance": 1e300}}},
    "plus": {"budget": {"steps": {"per_distance": 1, "plus": 2**63}}},
    "memory": {"budget": {"steps": 60, "memory_bytes": 2**70}},
    "hard_seconds": {"budget": {"steps": 60, "hard_seconds": 1e300}},
    "episodes": {"episodes": 2**63},
    "seed": {"seed": 2**200},
    "size": {"maps": {"blobs": {"size": 10**9, "obstacles": [0, 1], "obstacle_size": [1, 1]}}},
    "obstacles": {"maps": {"blobs": {"size": 9, "obstacles": [0, 10**12], "obstacle_size": [1, 1]}}},
    "radius": {"sensor": {"radius": 10**9}},
    "distance": {"tasks": {"distance": [1, 2**70]}},
    "iterations": {"agents": [{"vin": {"checkpoint": "vin-grid", "iterations": 10**12}}]},
    "rows": {"agents": [{"macn": {"checkpoint": "none", "memory_rows": 10**12}}]},
}


def test_huge_numbers(desk: Any) -> None:
    """A number that no row or memory can hold is one line at its place."""
    files = [desk.scenario(f"{name}.yaml", **{"name": name, **changes}) for name, changes in HUGE.items()]
    ended = desk.fogbench("check", *files, seconds=60)
    assert ended.code == 2
    assert [line.partition(".")[0] for line in ended.lines] == list(HUGE)


def test_one_mistake_at_a_time(desk: Any) -> None:
    """All mistakes of all variants are told in one go, those of map files with line and column."""
    desk.write("lorr.map", "type octile\nheight 2\nwidth 5\nmap\n..EE.\n.S@..\n")
    desk.write("short.map", "type octile\nheight 3\nwidth 4\nmap\n....\n....\n")
    desk.write("fine.map", "type octile\nheight 2\nwidth 4\nmap\n....\n....\n")
    desk.write("flt.scen", "version 1\n0\tx\t4\t2\t0.0\t0.0\t3.0\t1.0\t4\n")
    desk.write("ok.scen", "version 1\n0\tx\t4\t2\t0\t0\t3\t1\t4\n")
    desk.write(
        "bad.yaml",
        "image: nosuch.pgm\nresolution: -1\norigin: [0,0]\nnegate: maybe\nmode: trinarry\n"
        "occupied_thresh: 2\nfree_thresh: 3\n",
    )

    def movingai(name: str, scen: str) -> dict[str, Any]:
        return {"maps": {"movingai": {"map": name, "scen": scen}}}

    variants = {
        "first": movingai("lorr.map", "ok.scen"),
        "second": movingai("short.map", "ok.scen"),
        "third": movingai("fine.map", "flt.scen"),
        "fourth": {"maps": {"occupancy": {"map": "bad.yaml"}}},
        "fifth": {"maps": SMALL_MAPS, "tasks": {"distance": [500, 600]}},
    }
    desk.scenario(maps=None, rules={"collision": "blocked"}, budget={"steps": 700}, variants=variants, episodes=1)
    ended = desk.fogbench("check", "s.yaml")
    assert ended.code == 2
    for place in ("lorr.map:5:3", "short.map:7", "flt.scen:2:9", "500 to 600"):
        assert sum(place in line for line in ended.lines) == 1, f"got not one line on {place}: {ended.err}"
    told = [line.partition("bad.yaml:")[2].split()[1] for line in ended.lines if "bad.yaml:" in line]
    assert told == ["image:", "resolution:", "origin:", "negate:", "mode:", "occupied_thresh:", "free_thresh:"]


SMALL_MAPS = {"blobs": {"size": 12, "obstacles": [2, 4], "obstacle_size": [2, 3]}}


def test_crlf_map(desk: Any) -> None:
    """A map and a list of tasks with the line ends of another system are read."""
    desk.write("a.map", "type octile\r\nheight 2\r\nwidth 4\r\nmap\r\n....\r\n....\r\n")
    desk.write("a.map.scen", "version 1\r\n0\ta.map\t4\t2\t0\t0\t3\t1\t4\r\n")
    desk.scenario(maps={"movingai": {"map": "a.map"}}, episodes=1)
    assert desk.fogbench("check", "s.yaml").code == 0


def test_folder_with_map_yaml(desk: Any) -> None:
    """The map beside the scenario that names it is passed over with a note, and the scenario is played."""
    floor(desk)
    desk.write("notes.yaml", "- milk\n- bread\n")
    desk.scenario("floor.yaml", maps={"occupancy": {"map": "map.yaml"}}, episodes=1)
    for word in ("check", "run"):
        ended = desk.fogbench(word, ".")
        assert ended.code == 0, ended.err
        assert "map.yaml" in ended.out + ended.err
        assert "notes.yaml" in ended.out + ended.err
    assert len(desk.rows()) == 1


def test_a_broken_scenario_in_a_folder_is_no_other_file(desk: Any) -> None:
    """Only what is plainly no scenario is passed over: a scenario with a slip in a key is told."""
    desk.scenario("fine.yaml", name="fine")
    desk.scenario("slip.yaml", name="slip", agents=None, agnets=["astar"])
    ended = desk.fogbench("check", ".")
    assert ended.code == 2
    assert any(line.startswith("slip.yaml:") for line in ended.lines)


# F: a map file's own words are believed, or contradicted aloud


@pytest.mark.parametrize("free_thresh", ["0.25", "0.196"])
def test_ros2_free_thresh(desk: Any, free_thresh: str) -> None:
    """What was never seen is blocked, as the map's own threshold says or against it, or its number of cells is told."""
    floor(desk, free_thresh)
    desk.scenario(maps={"occupancy": {"map": "map.yaml"}}, rules={"collision": "blocked"}, episodes=4)
    checked, ran = desk.fogbench("check", "s.yaml"), desk.fogbench("run", "s.yaml")
    assert (checked.code, ran.code) == (0, 0)
    rows = desk.rows()
    blocked = 3 / 40  # of the known cells, a wall of three
    unknown = 72 - 40
    if free_thresh == "0.196" or abs(rows["density"].iloc[0] - blocked) < 1e-9:
        assert rows["density"].tolist() == pytest.approx([blocked] * 4)
    else:
        assert str(unknown) in checked.out + checked.err
        assert "unknown" in checked.out + checked.err


def test_wrong_scen(desk: Any) -> None:
    """A list of tasks that names another map is told, and so is each task on an obstacle."""
    desk.write("a.map", "type octile\nheight 4\nwidth 8\nmap\n........\n..@@@@..\n........\n........\n")
    lines = [
        "version 1",
        "0\tb.map\t8\t4\t0\t0\t7\t0\t7",
        "0\tb.map\t8\t4\t3\t1\t7\t3\t6",
        "0\tb.map\t8\t4\t0\t3\t7\t3\t7",
    ]
    desk.write("a.map.scen", "\n".join(lines) + "\n")
    desk.scenario(
        maps={"movingai": {"map": "a.map"}}, rules={"collision": "blocked"}, budget={"steps": 400}, episodes=2
    )
    ended = desk.fogbench("check", "s.yaml")
    said = ended.out + ended.err
    assert "b.map" in said
    assert "1 of them on obstacles" in said


def test_a_task_that_does_not_fit_is_told_with_its_line(desk: Any) -> None:
    """More episodes than usable tasks: the line of the list that is not usable is named."""
    desk.write("a.map", "type octile\nheight 2\nwidth 4\nmap\n....\n.@..\n")
    desk.write("a.map.scen", "version 1\n0\ta.map\t4\t2\t0\t0\t3\t1\t4\n0\ta.map\t4\t2\t1\t1\t3\t1\t2\n")
    desk.scenario(maps={"movingai": {"map": "a.map"}}, episodes=2)
    ended = desk.fogbench("check", "s.yaml")
    assert ended.code == 2
    assert "a.map.scen: only 1 of 2 tasks is usable, for 2 episodes: line 3: " in ended.err


@pytest.mark.parametrize("suffix", ["png", "bmp"])
@pytest.mark.parametrize("mode", ["trinary", "scale", "raw"])
def test_images_that_map_server_reads(desk: Any, suffix: str, mode: str) -> None:
    """PNG and BMP images are read, in each mode."""
    from PIL import Image  # noqa: PLC0415

    floor(desk)
    Image.open(desk.folder / "map.pgm").save(desk.folder / f"map.{suffix}")
    desk.write("map.yaml", f"{ROS}free_thresh: 0.196\n".replace("map.pgm", f"map.{suffix}").replace("trinary", mode))
    desk.scenario(maps={"occupancy": {"map": "map.yaml"}}, episodes=1)
    ended = desk.fogbench("check", "s.yaml")
    if mode == "raw":  # its values are no greys: a value above 100 is unknown
        assert ended.code in (0, 2)
        assert all("map." in line for line in ended.lines)
    else:
        assert ended.code == 0, ended.err


def test_a_mistake_in_one_file_hides_none_in_another(desk: Any) -> None:
    """A planner that cannot decide is told beside a number that is none."""
    desk.scenario("number.yaml", name="number", episodes="many")
    desk.scenario("planner.yaml", name="planner", agents=[desk.planner("bold.py", act="raise ValueError('no')")])
    ended = desk.fogbench("check", "number.yaml", "planner.yaml")
    assert ended.code == 2
    assert [line.partition(":")[0] for line in ended.lines] == ["number.yaml", "planner.yaml"]


def test_a_mended_planner_has_no_traceback(desk: Any) -> None:
    """A report names the traceback of a crash that counts, and none of a planner as it was before."""
    desk.scenario(agents=[desk.planner("bold.py", act="raise ValueError('no')")], episodes=1)
    assert "the traceback of its first crash is in results/small/crashes/" in desk.fogbench("run", "s.yaml").out
    desk.planner("bold.py")
    assert "traceback" not in desk.fogbench("run", "s.yaml").out
