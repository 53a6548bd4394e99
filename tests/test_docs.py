"""What stands in the documents is so: places exist, names can be imported, examples run."""

import re
from pathlib import Path
from pkgutil import resolve_name
from typing import Any

import numpy as np
import pytest
import torch
from PIL import Image

import fogbench
from fogbench.bench.playing.play import play
from fogbench.bench.reading.scenario import Scenario, read_scenario
from fogbench.worlds.types import Outcome

CHECKOUT = Path(__file__).parents[1]

DOCUMENTS = [CHECKOUT / name for name in ("README.md", "CONTRIBUTING.md")] + sorted((CHECKOUT / "docs").glob("*.md"))

EXTENDING = CHECKOUT / "docs" / "extending.md"

FOLDERS = "bench|docs|fogbench|learned|planners|results/published|scenarios|tests|worlds"

FAMILIES = """
name: mine
about: Of an example.
maps: {"./example.py:Salt": {size: 8, share: 0.1}}
sensor: {radius: 2}
budget: {steps: 40}
agents: [astar, "./planner.py:MyPlanner"]
episodes: 1
"""

GRU = """
name: gru
maps: {blobs: {size: 8, obstacles: [1, 4], obstacle_size: [1, 2]}}
sensor: {radius: 2}
rules: {collision: blocked}
budget: {steps: 10}
episodes: 1
"""


def examples(document: Path, language: str) -> list[str]:
    """The blocks of a document in some language."""
    return re.findall(rf"^```{language}\n(.*?)^```$", document.read_text("utf-8"), re.DOTALL | re.MULTILINE)


def outcomes(scenario: Scenario) -> set[str]:
    """How the first episode of each agent ends."""
    (variant,) = scenario.variants
    return {play(scenario, variant, entry, 0, 1).outcome for entry in variant.agents}


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_places_in_documents_exist(document: Path) -> None:
    """Every file and folder of the project that is named, and every document that is linked to."""
    text = document.read_text("utf-8")
    named = re.findall(rf"`((?:{FOLDERS})/[^`\s]*)`", text)
    linked = [link for link in re.findall(r"\]\(([^)#]+)\)", text) if "://" not in link]
    missing = [name for name in named if not (CHECKOUT / name).exists()]
    assert not missing + [link for link in linked if not (document.parent / link).exists()]


@pytest.mark.parametrize("document", DOCUMENTS, ids=lambda path: path.name)
def test_names_in_documents_can_be_imported(document: Path) -> None:
    """Every `fogbench.package.name` leads somewhere, and examples ask the face alone."""
    text = document.read_text("utf-8")
    for name in re.findall(r"fogbench(?:\.\w+){2,}", text):
        resolve_name(name)
    for line in re.findall(r"^\s*(?:from|import) fogbench.*$", text, re.MULTILINE):
        module, _, names = line.strip().removeprefix("from ").partition(" import ")
        assert module == "fogbench"
        assert set(names.split(", ")) <= set(fogbench.__all__)


def test_the_readme_plays(tmp_path: Path) -> None:
    """Its planner in its scenario."""
    (scenario,) = examples(CHECKOUT / "README.md", "yaml")
    (planner,) = examples(CHECKOUT / "README.md", "python")
    (tmp_path / "bold.py").write_text(planner)
    read = read_scenario(scenario, tmp_path / "mine.yaml")
    assert [entry.label for entry in read.variants[0].agents] == ["astar", "dstar_lite", "Bold"]
    assert Outcome.CRASHED.name not in outcomes(read)


def test_the_ways_to_extend_play(tmp_path: Path) -> None:
    """The planner and the map family of the page, together."""
    planner, _, family = examples(EXTENDING, "python")
    (tmp_path / "planner.py").write_text(planner)
    (tmp_path / "example.py").write_text(family)
    assert outcomes(read_scenario(FAMILIES, tmp_path / "mine.yaml")) == {Outcome.REACHED.name}


def test_the_plain_network_plays_with_its_weights(tmp_path: Path) -> None:
    """Its bytes are those of its tensors: 64 numbers of state, and the weights of a GRU cell and a linear layer."""
    _, network, _ = examples(EXTENDING, "python")
    (tmp_path / "gru.py").write_text(network)
    module: dict[str, Any] = {"__name__": "gru"}
    exec(network, module)
    torch.save(module["Brain"]().state_dict(), tmp_path / "gru.pt")
    agents = 'agents: ["./gru.py:Gru": {weights: gru.pt}]'
    (variant,) = (scenario := read_scenario(GRU + agents, tmp_path / "mine.yaml")).variants
    row = play(scenario, variant, variant.agents[0], 0, 1)
    assert (row.outcome != Outcome.CRASHED.name, row.peak_memory_bytes) == (True, 4 * 64)
    assert row.parameter_bytes == 4 * (3 * 64 * (27 + 64 + 2) + 4 * (64 + 1))


def test_the_map_of_ones_own_plays(tmp_path: Path) -> None:
    """The scenario of the page, on a floor of 10 x 16 pixels: metres and cells say the same task."""
    (text,) = examples(EXTENDING, "yaml")
    Image.new("L", (16, 10), 254).save(tmp_path / "hall.png")
    numbers = "resolution: 0.1\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.25\n"
    (tmp_path / "hall.yaml").write_text(f"image: hall.png\n{numbers}")
    scenario = read_scenario(text, tmp_path / "mine.yaml")
    worlds = [variant.family.sample(np.random.default_rng(0), 0, variant.conditions) for variant in scenario.variants]
    assert [(world.start, world.task.goal) for world in worlds] == [((2, 2), (0, 7))] * 2


def test_every_name_of_the_face_has_a_word() -> None:
    """The page that lists them has them all, and no other."""
    section = EXTENDING.read_text("utf-8").partition("## The names of fogbench\n")[2].partition("\n## ")[0]
    rows = "\n".join(line.split("|")[2] for line in section.splitlines() if line.startswith("| "))
    named = set(re.findall(r"`(\w+)`", rows))
    assert named == set(fogbench.__all__)
