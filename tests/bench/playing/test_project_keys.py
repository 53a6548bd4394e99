"""What an edit of the project's own sources does to the keys of its agents and worlds."""

import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import fogbench
from fogbench import bench, learned, planners, worlds

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

KEYS = """
import json, sys
from pathlib import Path
from fogbench.bench.playing import closure, sources
from fogbench.bench.playing import keys as used
from fogbench.bench.playing.keys import agent_key, world_key
from fogbench.bench.reading.scenario import read_scenario

texts, edits = json.load(sys.stdin)
variants = {name: read_scenario(text, Path("keys.yaml")).variants[0] for name, text in texts.items()}
agents = {entry.label: entry for entry in variants["blobs"].agents}


def keys():
    for kept in (sources.read_source, closure._find, closure._closure, used._used_here):
        kept.cache_clear()
    worlds = {name: world_key(variant) for name, variant in variants.items()}
    return worlds | {name: agent_key(entry) for name, entry in agents.items()}


before, changed = keys(), []
for edit in edits:
    texts = {Path(name): Path(name).read_text() if Path(name).exists() else None for name in edit}
    for name, text in edit.items():
        Path(name).write_text(text)
    now = keys()
    changed.append([name for name in before if now[name] != before[name]])
    for path, text in texts.items():
        path.unlink() if text is None else path.write_text(text)
print(json.dumps(changed))
"""
"""What says, for each of some edits of the project, whose keys it changes."""

WORLDS = {
    "blobs": "blobs: {size: 8, obstacles: [0, 3], obstacle_size: [1, 2]}",
    "tunnel": "tunnel: {length: [3, 3]}",
    "maze": "maze: {size: 9}",
    "rooms": "rooms: {size: 9, rooms: [2, 2], doors: [0, 1]}",
}

SEARCHING = ["astar", "memoryless", "dstar_lite", "frontier", "rrt_star"]

NETWORKS = ["macn", "vin", "cnn_memory"]

AGENTS = [*SEARCHING, "random_walk", *NETWORKS]

EDITS = {
    "planners/route.py": [*WORLDS, *SEARCHING],  # through the reference and the judge, and `glance` of A*
    "planners/astar.py": [*WORLDS, *SEARCHING],
    "planners/optimal.py": [*WORLDS],  # of the judge
    "planners/grid_teachers.py": [],
    "planners/incremental.py": ["dstar_lite", "frontier"],
    "planners/frontier.py": ["frontier"],
    "planners/segment.py": ["rrt_star"],
    "planners/random_walk.py": ["random_walk"],
    "worlds/settings.py": [*WORLDS, *AGENTS],
    "worlds/maps/cells.py": [*WORLDS, *SEARCHING, *NETWORKS],
    "worlds/maps/sight.py": [*WORLDS],
    "worlds/grid/batch.py": [],
    "worlds/maps/split.py": ["tunnel", "rooms"],
    "worlds/maps/families/tunnel.py": ["tunnel"],
    "worlds/maps/files/octile.py": [],
    "learned/macn.py": ["macn"],
    "learned/vin.py": ["macn", "vin"],
    "learned/dnc/links.py": ["macn", "cnn_memory"],
    "learned/encoding/grid.py": NETWORKS,
    "learned/encoding/grid_batch.py": [],  # as all that is played side by side
    "learned/convolution/loops.py": ["macn", "cnn_memory"],
    "learned/training/imitation.py": [],
    "bench/playing/loop.py": [*WORLDS],
    "bench/playing/runner.py": [],
    "bench/reporting/report.py": [],
    "fogbench/__init__.pyi": [],
}
"""Files of the project, and whose keys a line in them changes."""


@pytest.fixture(scope="module")
def project(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A copy of the sources."""
    folder = tmp_path_factory.mktemp("project")
    shutil.copytree(Path(fogbench.__file__).parent, folder / "fogbench", ignore=shutil.ignore_patterns("__pycache__"))
    for package in (worlds, planners, learned, bench):
        place = folder / "fogbench" / package.__name__.rpartition(".")[2]
        ignored = shutil.ignore_patterns("__pycache__", "checkpoints", "timing")
        shutil.copytree(package.__path__[0], place, ignore=ignored, dirs_exist_ok=True)
    return folder


def changed(project: Path, *edits: dict[str, str]) -> list[list[str]]:
    """The families and agents whose keys each of some edits changes; an edit has the new texts of files."""
    agents = ", ".join(f"{name}: {{checkpoint: none}}" if name in NETWORKS else name for name in AGENTS)
    texts = {name: TEXT.replace(WORLDS["blobs"], maps).replace("astar", agents) for name, maps in WORLDS.items()}
    whole = [{str(project / "fogbench" / name): text for name, text in edit.items()} for edit in edits]
    told = json.dumps([texts, whole])
    environment = {**os.environ, "PYTHONPATH": str(project)}
    command = [sys.executable, "-c", KEYS]
    done = subprocess.run(command, cwd=project, env=environment, input=told, stdout=-1, text=True, check=True)
    return list(json.loads(done.stdout))


NEW = (
    ("planners", "PLANNERS", "planners.new"),
    ("learned", "LEARNED", "learned.new"),
    ("worlds", "FAMILIES", "worlds.maps.families.new"),
)
"""Tables, and where something new in them is."""

PLUGIN = "from fogbench.planners.astar import AStar\n\n\nclass New(AStar):\n    pass\n"


def place(file: str) -> str:
    """Where a file is in the copy."""
    return file.removeprefix("fogbench/")


def test_an_edited_line_changes_the_keys_of_what_imports_it(project: Path) -> None:
    """Those, and no others."""
    texts = [{place(file): (project / "fogbench" / place(file)).read_text() + "\nEDITED = 1\n"} for file in EDITS]
    assert dict(zip(EDITS, changed(project, *texts), strict=True)) == EDITS


def test_what_is_new_beside_an_agent_and_what_is_said_of_it_change_no_key(project: Path) -> None:
    """A planner, a network or a family with its line in the table; a comment and other words in all files at once."""
    folder = project / "fogbench"
    files = {str(file.relative_to(folder)): file.read_text() for file in folder.rglob("*.py")}
    said = {name: text.replace('"""', '"""In other words: ', 1) + "# The end.\n" for name, text in files.items()}
    assert said["planners/route.py"].startswith('"""In other words: ')
    new = []
    for table, entries, where in NEW:
        line = f'{entries} = {{\n    "new": "fogbench.{where}:New",'
        lines = files[f"{table}/__init__.py"].replace(f"{entries} = {{", line, 1)
        new.append({f"{table}/__init__.py": lines, f"{where.replace('.', '/')}.py": PLUGIN})
    assert all('"new": ' in "".join(edit.values()) for edit in new)
    assert changed(project, said, *new) == [[], [], [], []]
