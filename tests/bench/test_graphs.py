"""Scenarios on graphs are checked, played, resumed, judged and replayed like any other."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import networkx as nx
import pandas as pd
import pytest

from fogbench.bench.playing.episode import SCHEMA, TIMINGS
from fogbench.bench.playing.replay import retrace, verify
from fogbench.bench.playing.runner import run
from fogbench.bench.playing.store import read
from fogbench.bench.reading.scenario import Scenario, ScenarioError, read_scenario

FACTS = [name for name in SCHEMA.names if name not in TIMINGS]

SCENARIO = """
name: graphs
about: Drawn, fixed and read graphs.
kind: graph
budget: {steps: 24}
variants:
  drawn: {maps: {random_graph: {nodes: 12, mean_degree: 3}}, rules: {slip: 0.2}}
  fixed: {maps: {fixed_graph: {nodes: 9, mean_degree: 2.5}}}
  read: {maps: {graph_file: {file: roads.graphml}}}
agents: [nearest_unvisited, breadth_first, astar, dstar_lite, random_walk, rrt_star]
episodes: 4
"""


@pytest.fixture
def scenario(tmp_path: Path) -> Callable[..., Scenario]:
    """Reads the scenario, with changes of its text, beside a file of roads."""
    roads: Any = nx.random_geometric_graph(20, 0.5, seed=1)
    assert nx.is_connected(roads)
    for _, place in roads.nodes(data=True):
        place["x"], place["y"] = place.pop("pos")
    nx.write_graphml(roads, tmp_path / "roads.graphml")

    def make(old: str = "", new: str = "") -> Scenario:
        assert old in SCENARIO
        return read_scenario(SCENARIO.replace(old, new), tmp_path / "graphs.yaml")

    return make


def play(scenario: Scenario, folder: Path, workers: int) -> pd.DataFrame:
    """Run a scenario and read all facts of it, in one order."""
    run(scenario, folder, workers, lambda progress: None)
    rows = read(folder, scenario, FACTS).sort_values(["variant", "agent", "episode"], ignore_index=True)
    return rows.assign(actions=rows["actions"].map(tuple))


def test_workers_and_pauses_change_nothing(scenario: Callable[..., Scenario], tmp_path: Path) -> None:
    """Two workers play what one plays; what was played is not played again when the run goes on."""
    first = play(scenario(), tmp_path / "one", 1)
    assert len(first) == 3 * 5 * 4
    play(scenario("episodes: 4", "episodes: 2"), tmp_path / "two", 1)
    pd.testing.assert_frame_equal(first, play(scenario(), tmp_path / "two", 2), check_exact=True)
    again = run(scenario(), tmp_path / "two", 1, lambda progress: None)
    assert (again.kept, again.outcomes.total()) == (60, 0)


def test_episodes_are_judged_referenced_and_replayed(scenario: Callable[..., Scenario], tmp_path: Path) -> None:
    """The reference is never wrong and as long as itself; recorded nodes lead to the recorded end."""
    made = scenario()
    rows = play(made, tmp_path / "one", 1)
    own = rows[rows["agent"] == "nearest_unvisited"]
    reached = own[own["outcome"] == "REACHED"]
    assert (reached["length"] == reached["reference_length"]).all()
    assert own["judged"].sum() == own["steps"].sum() > 0
    assert own[["wrong_decisions", "strict_wrong"]].to_numpy().sum() == 0
    assert rows.loc[rows["agent"] == "random_walk", "wrong_decisions"].sum() > 0
    assert set(rows["kind"]) == {"graph"}
    variants = {variant.name: variant for variant in made.variants}
    for row in rows.to_dict("records"):
        moments = retrace(variants[row["variant"]], row)
        while True:
            try:
                next(moments).picture()
            except StopIteration as stop:
                verify(row, stop.value)
                break


def test_what_plays_no_graphs_is_skipped(scenario: Callable[..., Scenario]) -> None:
    """RRT* says why."""
    for variant in scenario().variants:
        skipped = {entry.label: entry.skipped for entry in variant.agents if entry.skipped}
        assert skipped == {"rrt_star": "it plays grid, robot worlds, not graph"}


MISTAKES = {
    "random_graph: {nodes: 12, mean_degree: 3}": (
        "random_graph: {generator: watts_strogatz}",
        "7:32",
        (
            "maps.random_graph: got {generator: watts_strogatz}; expected a function of networkx that makes a graph "
            "(it has no watts_strogatz). Did you mean watts_strogatz_graph?"
        ),
    ),
    "nodes: 12, mean_degree: 3": (
        "generator: path_graph",
        "7:32",
        "maps.random_graph: got {generator: path_graph}; expected all parameters of path_graph (n is missing).",
    ),
    "nodes: 12": (
        "nodes: 100001",
        "7:40",
        "maps.random_graph.nodes: got 100001; expected a whole number from 2 to 100,000 or nothing.",
    ),
    "slip: 0.2": ("slip: 2", "7:76", "rules.slip: got 2; expected a number from 0 to 1."),
}


@pytest.mark.parametrize("old", MISTAKES)
def test_mistakes_have_their_place(scenario: Callable[..., Scenario], old: str) -> None:
    """The line and the column, what was got, what was expected, the nearest name."""
    new, place, told = MISTAKES[old]
    with pytest.raises(ScenarioError) as caught:
        scenario(old, new)
    assert str(caught.value).endswith(f"graphs.yaml:{place}  variants.drawn.{told}")
