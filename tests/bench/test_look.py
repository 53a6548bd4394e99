"""From recorded episodes of networks to figures: what is told, drawn and refused."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from fogbench.bench.look import look_inside
from fogbench.bench.playing.play import lost, play
from fogbench.bench.playing.recorder import recording
from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reading.variant import Entry
from fogbench.learned.networks.macn import MacnNetwork
from fogbench.learned.networks.network import Network
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Move, Outcome

AGENTS: list[Any] = [
    "astar",
    {"macn": {"checkpoint": "none"}},
    {"macn": {"checkpoint": "none", "memory": "lstm", "label": "MACN (LSTM)"}},
    {"vin": {"checkpoint": "none"}},
]


@pytest.fixture
def tunnels(make: Callable[..., Scenario]) -> Scenario:
    """Networks with fresh weights in short tunnels, where a collision costs a step."""
    maps = {"tunnel": {"length": [6, 6]}}
    scenario = make(maps=maps, tasks={"distance": [1, 60]}, rules={"collision": "blocked"}, agents=AGENTS)
    absent = Entry("absent", "", None, "needs the package x, which is not installed")
    return replace(scenario, variants=tuple(replace(v, agents=(*v.agents, absent)) for v in scenario.variants))


@pytest.fixture
def played(tunnels: Scenario, tmp_path: Path) -> Scenario:
    """Four episodes of each in `long`, recorded in `tmp_path/store`; the fourth of MACN hung."""
    variant = tunnels.variants[1]
    with recording(tmp_path / "store", ()) as recorder:
        for entry in variant.agents[:4]:
            for episode in range(3):
                recorder.append(play(tunnels, variant, entry, episode, 1))
        recorder.append(lost(tunnels, variant, variant.agents[1], 3, 1, Outcome.HUNG, "no answer"))
    return tunnels


@pytest.mark.parametrize(
    ("agent", "name", "parts"),
    [
        ("macn", "macn", ["controller", "memory", "written", "read"]),
        ("MACN (LSTM)", "MACN-LSTM", ["controller", "cell"]),
        ("vin", "vin", []),
    ],
)
def test_figures_of_recorded_networks(
    agent: str, name: str, parts: list[str], played: Scenario, tmp_path: Path
) -> None:
    """Two pictures that open, and what was found; of a network that remembers nothing there is one."""
    memory, *lines, spaces = look_inside(played, "long", agent, 1, tmp_path / "store").splitlines()
    drawn = [tmp_path / "store" / f"{kind}-long-{name}.png" for kind in ("memory", "tsne")]
    if parts:
        assert memory == f"{agent} in variant long, episode 1. Drawn in {drawn[0]}"
        assert [line.split()[1] for line in lines if line][2:] == parts
    else:
        assert (
            memory == f"{agent} in variant long, episode 1: it remembers nothing, so there is no figure of its memory."
        )
        assert not drawn[0].exists()
    assert spaces.startswith(f"{agent} in variant long: ")
    assert "in 3 episodes. Nearest-neighbour accuracy: raw image " in spaces
    assert spaces.endswith(f" %). Drawn in {drawn[1]}")
    for file in drawn[not parts :]:
        with Image.open(file) as picture:
            assert min(picture.size) > 300


def test_a_network_without_a_plan_is_drawn_without_it(
    played: Scenario, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """What it sees, its scores and its memory are there; a line says what is not."""
    monkeypatch.setattr(MacnNetwork, "plan", Network.plan)
    told = look_inside(played, "long", "macn", 1, tmp_path / "store")
    assert "raw image " in told
    assert "scores of the moves " in told
    assert told.endswith(
        f"Drawn in {tmp_path}/store/tsne-long-macn.png. The network has no `plan`: no panel of a planning module"
    )


def test_what_cannot_be_drawn_is_told(tunnels: Scenario, played: Scenario, tmp_path: Path) -> None:
    """An episode without decisions; too few for t-SNE."""
    memory, _ = look_inside(played, "long", "macn", 3, tmp_path / "store").splitlines()
    assert memory == "macn in variant long, episode 3: no decision is recorded, so there is no figure of its memory."
    short = tunnels.variants[0]
    with recording(tmp_path / "few", ()) as recorder:
        recorder.append(play(tunnels, short, short.agents[3], 0, 1))
    _, spaces = look_inside(tunnels, None, "vin", 0, tmp_path / "few").splitlines()
    assert spaces.endswith(
        " decisions with one optimal move, in 1 episode; expected 10 or more, in two or more: "
        "`fogbench run --episodes` records them."
    )


@pytest.mark.parametrize(
    ("agent", "why", "meant"),
    [
        ("astar", ", which is not a network of fogbench", ""),
        ("absent", ", which is skipped (needs the package x, which is not installed)", ""),
        ("mcan", "", " Did you mean macn?"),
        ("x", "", ""),
    ],
)
def test_who_is_no_network(agent: str, why: str, meant: str, tunnels: Scenario, tmp_path: Path) -> None:
    """One line with those that are, the nearest by name."""
    with pytest.raises(Mistake) as caught:
        look_inside(tunnels, None, agent, 0, tmp_path)
    networks = "macn, MACN (LSTM), vin"
    assert str(caught.value) == f"--agent: got {agent}{why}; expected one of the networks {networks}.{meant}"


def test_a_scenario_without_networks(make: Callable[..., Scenario], tmp_path: Path) -> None:
    """There is nobody to name."""
    with pytest.raises(Mistake) as caught:
        look_inside(make(), "short", "astar", 0, tmp_path)
    assert str(caught.value) == (
        "--agent: got astar, which is not a network of fogbench; expected a class derived from Policy, as "
        "docs/extending.md tells; none plays here."
    )


def test_what_was_not_recorded(played: Scenario, tmp_path: Path) -> None:
    """A variant without episodes, an episode that was not played, and a variant that there is not."""
    for variant, episode, line in (
        (
            "short",
            0,
            f"{tmp_path}/store: no episode of vin in variant short is recorded; use `fogbench run` first.",
        ),
        ("long", 7, "--episode: got 7; expected one of the 3 of vin in variant long, from 0 to 2."),
        ("lang", 0, "--variant: got lang; expected one of short, long. Did you mean long?"),
    ):
        with pytest.raises(Mistake) as caught:
            look_inside(played, variant, "vin", episode, tmp_path / "store")
        assert str(caught.value) == line


def test_a_record_of_other_decisions_is_refused(tunnels: Scenario, tmp_path: Path) -> None:
    """Nothing is drawn of what did not happen."""
    variant = tunnels.variants[0]
    row = play(tunnels, variant, variant.agents[3], 0, 1)
    move = Move(int(row.actions[1]))
    other = Move((move + 1) % 4)
    with recording(tmp_path / "store", ()) as recorder:
        recorder.append(replace(row, actions=(row.actions[0], float(other), *row.actions[2:])))
    with pytest.raises(Mistake) as caught:
        look_inside(tunnels, None, "vin", 0, tmp_path / "store")
    assert str(caught.value) == (
        f"episode 0 of vin in variant short: got {move.name} at step 1; expected {other.name}, as recorded "
        "(on another machine?)."
    )
    assert not list((tmp_path / "store").glob("*.png"))
