"""What is said of an installation, and what it leaves behind."""

import json
import os
import re
import subprocess
import sys
from importlib.metadata import PackageNotFoundError
from pathlib import Path

import pytest
from packaging.requirements import Requirement

import fogbench
from fogbench.bench.doctor import _need, _requirements, _verdict, examine
from fogbench.learned import LEARNED
from fogbench.planners import PLANNERS
from fogbench.worlds.mistake import Mistake

PLAYED = """
import json, sys
from pathlib import Path
import torch
from numba.core.registry import CPUDispatcher
from fogbench.bench.playing.play import play
from fogbench.bench.reading.scenario import read_scenario
from fogbench.bench.shipped import find
from fogbench.learned.dnc.dnc import DNC
from fogbench.learned.dnc.heads import Heads
from fogbench.learned.value_iteration.value_iteration import ValueIteration

outcomes = set()
networks = "{macn: {checkpoint: none}}, {vin: {checkpoint: none, stitched: true}}, {cnn_memory: {checkpoint: none}}"
text = "name: networks\\nmaps: {maze: {size: 21}}\\nbudget: {steps: 9}\\nepisodes: 1\\nagents: [" + networks + "]"
graphs = "{macn_graph: {checkpoint: none}}, {vin_graph: {checkpoint: none}}, {cnn_memory_graph: {checkpoint: none}}"
maps = "maps: {random_graph: {nodes: 16, mean_degree: 3}}"
other = "name: graphs\\n" + maps + "\\nbudget: {steps: 9}\\nepisodes: 1\\nagents: [" + graphs + "]"
robots = "{macn_robot: {checkpoint: none}}, {vin_robot: {checkpoint: none}}, {cnn_memory_robot: {checkpoint: none}}"
robots += ", {macn_robot: {checkpoint: none, masked: true, label: masked}}"
halls = "kind: robot\\nmaps: {blobs: {size: 90, obstacles: [9, 9], obstacle_size: [5, 10]}}"
third = "name: robots\\n" + halls + "\\nbudget: {steps: 9}\\nepisodes: 1\\nagents: [" + robots + "]"
texts = [(text, Path("networks.yaml")), (other, Path("graphs.yaml")), (third, Path("robots.yaml"))]
texts += [(path.read_text("utf-8"), path) for path in find(None)]
for text, path in texts:
    scenario = read_scenario(text, path)
    for variant in scenario.variants[:1]:
        for entry in (entry for entry in variant.agents if entry.settings):
            outcomes.add((entry.target, play(scenario, variant, entry, 0, 1).outcome))

module = ValueIteration(2, 5)
module(torch.rand(3, 2, 4, 4))[0].sum().backward()
module.requires_grad_(False)(torch.rand(1, 2, 6, 5))
DNC(3, 4, Heads(2, 2, 5))(torch.rand(7, 3, 3))[0].sum().backward()

ours = "fogbench.worlds", "fogbench.planners", "fogbench.learned", "fogbench.bench"
modules = [module for name, module in sys.modules.items() if name.startswith(ours)]
kernels = [each for module in modules for each in vars(module).values() if isinstance(each, CPUDispatcher)]
compiled = [each for each in kernels if each.stats.cache_misses]
read = [each for each in kernels if each.stats.cache_hits]
print(json.dumps({
    "played": sorted({target for target, _ in outcomes}),
    "crashed": sorted({target for target, outcome in outcomes if outcome == "CRASHED"}),
    "compiled": sorted({f"{each.__wrapped__.__module__}.{each.__wrapped__.__qualname__}" for each in compiled}),
    "read from": sorted({each.__wrapped__.__module__ for each in read}),
}))
"""
"""Plays an episode of each agent in each shipped scenario of drawn maps, learns a little, and says what it compiled."""


def rows(printed: str) -> list[list[str]]:
    """The cells of printed tables."""
    return [[cell.strip() for cell in row.split("│")[1:-1]] for row in printed.splitlines()]


def run(script: str, cache: Path) -> str:
    """What a script prints in a process of its own, which keeps its kernels in `cache`; any warning is an error."""
    packages = str(Path(fogbench.__file__).parents[1])
    environment = {name: value for name, value in os.environ.items() if name != "FOGBENCH_MAPS"}
    environment |= {"PYTHONPATH": packages, "NUMBA_CACHE_DIR": str(cache), "COLUMNS": "240"}
    return subprocess.check_output([sys.executable, "-W", "error", "-c", script], env=environment, text=True)


def test_what_is_missing_is_told_with_the_way_to_get_it(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """The project is installed from its checkout; without extras, or a place to write, all else is still examined."""
    monkeypatch.setenv("COLUMNS", "160")
    monkeypatch.setattr("fogbench.bench.doctor.requires", lambda _: ["fog-lamp", 'fog-horn; extra == "noise"'])
    for package in ("torch", "ompl"):
        monkeypatch.setitem(sys.modules, package, None)
    needy = [
        name for name in sys.modules if name == "fogbench.planners.rrt_star" or name.startswith("fogbench.learned.")
    ]
    for module in needy:
        monkeypatch.delitem(sys.modules, module)
    monkeypatch.setattr("fogbench.bench.doctor.used", lambda: None)
    with pytest.raises(Mistake) as caught:
        examine()
    assert str(caught.value) == "Verdict: broken. fog-lamp missing: pip install ."
    told = rows(capsys.readouterr().out)
    assert ["fog-lamp", "missing: pip install .", "everything"] in told
    assert ["fog-horn", 'missing: pip install ".[noise]"', "the extra noise"] in told
    assert ["kernels", "compiled by each process for itself: no place can be written"] in told
    assert not [row for row in told if row[:1] == ["value iteration, 128 maps of 16x16, 20 times"]]


BETTER = 'Verdict: all that is installed works. Missing: fog-horn (pip install ".[noise]").'


@pytest.mark.parametrize(
    ("needs", "crashed", "verdict"),
    [
        ([], [], "Verdict: everything works."),
        (["numpy>=1"], [], "Verdict: everything works."),
        (['fog-horn; extra == "noise"'], [], BETTER),
        (["numpy<1"], [], "Verdict: broken. numpy needs numpy<1: pip install ."),
        ([], ["astar: no"], "Verdict: broken. astar: no"),
    ],
)
def test_a_verdict_ends_it(needs: list[str], crashed: list[str], verdict: str) -> None:
    """Extras may be missing; what is installed must work, and what everything needs must be there."""
    read = [_need(Requirement(need)) for need in needs]
    if "broken" in verdict:
        with pytest.raises(Mistake, match=re.escape(verdict)):
            _verdict(read, crashed)
    else:
        assert _verdict(read, crashed) == verdict


def test_a_checkout_knows_what_it_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where the project itself is not installed, its own file says what an installed one does."""

    def absent(name: str) -> list[str]:
        raise PackageNotFoundError(name)

    monkeypatch.setattr("fogbench.bench.doctor.requires", absent)
    monkeypatch.setattr("fogbench.bench.doctor.PYPROJECT", Path(__file__).parents[2] / "pyproject.toml")
    needs = {need.name: need.marker for need in map(Requirement, _requirements())}
    assert needs["numpy"] is None
    assert str(needs["torch"]) == 'extra == "learned"'


def test_afterwards_nothing_is_compiled(tmp_path: Path) -> None:
    """Every kernel that shipped agents and learning need is read from where it was said to be kept."""
    told = dict(
        row for row in rows(run("from fogbench.bench.doctor import examine\nexamine()", tmp_path)) if len(row) == 2
    )
    place = Path(told["kernels"].removeprefix("compiled, kept in "))
    assert place.parent == tmp_path
    assert list(place.glob("fogbench.planners.astar.search-*.nbc"))
    assert list(place.glob("fogbench.learned.kernels.native.*.nbc"))
    assert "with gradients" in told["value iteration, 128 maps of 16x16, 20 times"]
    assert "with gradients" in told["a DNC, 64 samples, 10 steps"]
    kept = set(place.iterdir())
    found = json.loads(run(PLAYED, tmp_path))
    assert set(place.iterdir()) == kept  # loops of networks too
    assert found["played"] == sorted([*PLANNERS.values(), *LEARNED.values()])
    assert (found["crashed"], found["compiled"]) == ([], [])
    assert {"fogbench.planners.incremental", "fogbench.planners.segment"} <= set(found["read from"])
