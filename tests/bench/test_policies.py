"""Learned policies in scenarios: played end to end, refused with a broken or missing checkpoint."""

from collections.abc import Generator
from pathlib import Path
from typing import Any

import pandas as pd
import pytest
import torch

from fogbench.bench.playing.episode import SCHEMA, TIMINGS
from fogbench.bench.playing.keys import agent_key
from fogbench.bench.playing.loop import episode_world
from fogbench.bench.playing.replay import End, retrace, verify
from fogbench.bench.playing.runner import run
from fogbench.bench.playing.store import read
from fogbench.bench.reading.scenario import ScenarioError, read_scenario
from fogbench.learned import checkpoint
from fogbench.learned.agent import weighted
from fogbench.learned.vin import Vin

SHIPPED = ", ".join(["none", *sorted(card.stem for card in checkpoint.SHIPPED.glob("*.json"))])

UNTRAINED = [
    "astar",
    {"macn": {"checkpoint": "none"}},
    {"macn": {"checkpoint": "none", "memory": "lstm", "label": "MACN (LSTM)"}},
    {"macn": {"checkpoint": "none", "memory": "feedforward", "label": "MACN (feed-forward)"}},
    {"macn": {"checkpoint": "none", "reading": "map", "size": [6, 6], "label": "MACN on the map"}},
    {"vin": {"checkpoint": "none"}},
    {"vin": {"checkpoint": "none", "stitched": True, "reading": "map", "size": [6, 6], "label": "VIN (stitched)"}},
    {"cnn_memory": {"checkpoint": "none"}},
]
"""Every network, with weights from its seed."""

PAGE = """\
name: small
maps: {blobs: {size: 6, obstacles: [2, 6], obstacle_size: [1, 2]}}
budget: {steps: 6}
agents:
  - astar
  - AGENT
episodes: 2
"""


def facts(scenario: Any, folder: Path, workers: int) -> pd.DataFrame:
    """All that is recorded of a run but the timings."""
    run(scenario, folder, workers, lambda progress: None)
    rows = read(folder, scenario, [name for name in SCHEMA.names if name not in TIMINGS])
    return rows.assign(actions=rows["actions"].map(tuple))


def ended(steps: Generator[Any, None, End]) -> End:
    """The end of a replay."""
    while True:
        try:
            next(steps)
        except StopIteration as stop:
            return stop.value


def test_workers_change_no_action(make: Any, tmp_path: Path) -> None:
    """All networks play to the end, the same way in one, two and four worker processes; every episode replays."""
    scenario = make(agents=UNTRAINED, rules={"collision": "blocked"})
    one = facts(scenario, tmp_path / "one", 1)
    assert len(one) == 2 * len(UNTRAINED) * 4
    assert set(one["outcome"]) <= {"REACHED", "OUT_OF_STEPS"}
    for workers in (2, 4):
        pd.testing.assert_frame_equal(one, facts(scenario, tmp_path / f"{workers}", workers), check_exact=True)
    variants = {variant.name: variant for variant in scenario.variants}
    for row in one.to_dict("records"):
        steps = retrace(variants[row["variant"]], row)
        verify(row, ended(steps))


def told(agent: str, folder: Path) -> str:
    """The one mistake of a scenario with this agent, without the name of its file."""
    with pytest.raises(ScenarioError) as caught:
        read_scenario(PAGE.replace("AGENT", agent), folder / "s.yaml")
    (line,) = caught.value.lines
    return line.removeprefix(f"{folder}/s.yaml:")


@pytest.fixture
def saved(tmp_path: Path) -> Path:
    """A checkpoint of a VIN beside the scenario."""
    place, policy = tmp_path / "vin.safetensors", Vin(checkpoint="none", iterations=3)
    checkpoint.write(place, "Vin", policy.trained(), weighted(policy).state_dict(), {})
    return place


def test_a_checkpoint_beside_the_scenario_is_found(saved: Path, tmp_path: Path) -> None:
    """A relative file starts at the scenario's folder; what is not said is as in the training."""
    scenario = read_scenario(PAGE.replace("AGENT", "vin: {checkpoint: vin.safetensors}"), tmp_path / "s.yaml")
    settings: Any = scenario.variants[0].agents[1].settings
    assert (settings.checkpoint, settings.iterations) == (str(saved), 3)


@pytest.mark.parametrize("written", ["${FOG_HERE}/vin.safetensors", "${FOG_HERE}/${FOG_VIN}.safetensors"])
def test_a_checkpoint_with_a_variable_starts_where_the_user_stands(
    written: str, saved: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As a map file does; a variable may be the name of a shipped one, too."""
    monkeypatch.chdir(tmp_path.parent)
    monkeypatch.setenv("FOG_HERE", tmp_path.name)
    monkeypatch.setenv("FOG_VIN", "vin")
    monkeypatch.setenv("FOG_MACN", "macn-grid")
    elsewhere = tmp_path / "elsewhere" / "s.yaml"
    scenario = read_scenario(PAGE.replace("AGENT", f'vin: {{checkpoint: "{written}"}}'), elsewhere)
    settings: Any = scenario.variants[0].agents[1].settings
    assert settings.checkpoint == str(saved)
    scenario = read_scenario(PAGE.replace("AGENT", 'macn: {checkpoint: "${FOG_MACN}"}'), elsewhere)
    settings = scenario.variants[0].agents[1].settings
    assert settings.checkpoint == "macn-grid"


def test_weights_that_are_replaced_are_other_weights(saved: Path, tmp_path: Path) -> None:
    """What was read under one digest stays what it was; read again, it is another agent with other weights."""
    text = PAGE.replace("AGENT", "vin: {checkpoint: vin.safetensors}")
    before: Any = read_scenario(text, tmp_path / "s.yaml").variants[0].agents[1]
    first, key = weighted(before.settings), agent_key(before)
    other = Vin(checkpoint="none", iterations=3, seed=1)
    checkpoint.write(saved, "Vin", other.trained(), weighted(other).state_dict(), {})
    after: Any = read_scenario(text, tmp_path / "s.yaml").variants[0].agents[1]
    assert (agent_key(before), weighted(before.settings)) == (key, first)
    assert agent_key(after) != key
    assert torch.equal(weighted(after.settings).output.weight, weighted(other).output.weight)


def test_maps_of_another_size_are_told_before_any_episode(tmp_path: Path) -> None:
    """Whether the size is in the file or on the card; where the maps differ in size, each episode tells."""
    assert told("vin: {checkpoint: none, reading: map, size: [6, 8]}", tmp_path) == (
        "6:10  agents[1].vin: got {checkpoint: none, reading: map, size: [6, 8]}; "
        "expected a network for maps of 6x6 (this one is for 6x8)."
    )
    place, policy = tmp_path / "vin.safetensors", Vin(checkpoint="none", reading="map", size=(6, 8))
    checkpoint.write(place, "Vin", policy.trained(), weighted(policy).state_dict(), {})
    assert told("vin: {checkpoint: vin.safetensors}", tmp_path) == (
        "6:10  agents[1].vin: got {checkpoint: vin.safetensors}; "
        "expected a network for maps of 6x6 (this one is for 6x8)."
    )
    text = PAGE.replace("AGENT", "vin: {checkpoint: vin.safetensors}").replace("steps: 6", "steps: 40")
    tunnels = "maps: {tunnel: {length: [4, 4]}}"
    scenario = read_scenario(text.replace(text.splitlines()[1], tunnels), tmp_path / "s.yaml")
    rows = facts(scenario, tmp_path / "results", 1)
    sentences = rows[rows["agent"] == "vin"]["detail"]
    assert sentences.str.fullmatch(r"Mistake: got a map of \d+x\d+; expected 6x8, the size").tolist() == [True, True]


@pytest.mark.parametrize("size", [(14, 7), (7, 14)])
def test_only_an_episode_s_own_map_counts(size: tuple[int, int], tmp_path: Path) -> None:
    """A network for maps of one size plays where they have it, whatever the size of the map to warm up on."""
    text = PAGE.replace("AGENT", f"vin: {{checkpoint: none, reading: map, size: {list(size)}}}")
    text = text.replace(text.splitlines()[1], "maps: {tunnel: {length: [8, 8]}}").replace("steps: 6", "steps: 60")
    scenario = read_scenario(text.replace("episodes: 2", "episodes: 6"), tmp_path / "s.yaml")
    extents = [episode_world(scenario.variants[0], episode).task.extent for episode in range(6)]
    rows = facts(scenario, tmp_path / "results", 1).query("agent == 'vin'").sort_values("episode")
    assert 0 < sum(extent == size for extent in extents) < 6
    for extent, outcome, detail in zip(extents, rows["outcome"], rows["detail"], strict=True):
        sentence = f"Mistake: got a map of {extent[0]}x{extent[1]}; expected {size[0]}x{size[1]}, the size"
        assert (detail == sentence) == (outcome == "CRASHED") == (extent != size)


def test_a_variant_of_another_size_is_told(tmp_path: Path) -> None:
    """Only the sizes that do not fit."""
    variants = "variants: {small: {}, large: {maps: {blobs: {size: 7}}}}"
    agent = "vin: {checkpoint: none, reading: map, size: [6, 6]}"
    assert told(f"{agent}\n{variants}", tmp_path).endswith("expected a network for maps of 7x7 (this one is for 6x6).")


def test_a_checkpoint_that_is_not_there_is_told_with_those_that_are(tmp_path: Path) -> None:
    """No file of that name, no name that ships, or none at all: one line each."""
    assert (
        told("vin", tmp_path)
        == "6:5  agents[1].vin.checkpoint: missing; give text like none, macn-grid, ./mine.safetensors."
    )
    assert told("vin: {checkpoint: no.safetensors}", tmp_path) == (
        "6:23  agents[1].vin.checkpoint: got no.safetensors; "
        f"expected an existing file (looked for {tmp_path}/no.safetensors)."
    )
    for name in ("./vin.safetensor", "vin.pt", ".", '""'):
        assert told(f"vin: {{checkpoint: {name}}}", tmp_path).endswith(
            f"expected a file that ends in .safetensors, or one of {SHIPPED}."
        )
    assert told("macn: {checkpoint: macn-gird}", tmp_path) == (
        "6:24  agents[1].macn.checkpoint: got macn-gird; "
        f"expected a file that ends in .safetensors, or one of {SHIPPED}. Did you mean macn-grid?"
    )


def test_what_is_wrong_with_a_policy_is_told_at_its_place(
    saved: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Mismatched, truncated and corrupted checkpoints, heads and devices: one line each."""
    assert told("macn: {checkpoint: vin.safetensors}", tmp_path) == (
        "6:11  agents[1].macn: got {checkpoint: vin.safetensors}; expected a checkpoint of Macn (this is one of Vin)."
    )
    assert told("vin: {checkpoint: vin.safetensors, stitched: true}", tmp_path) == (
        "6:10  agents[1].vin: got {checkpoint: vin.safetensors, stitched: true}; "
        "expected stitched False, with which the checkpoint was trained."
    )
    assert told("macn: {checkpoint: none, reads: 0}", tmp_path) == (
        "6:37  agents[1].macn.reads: got 0; expected a whole number from 1 to 64."
    )
    assert told("macn: {checkpoint: none, read: 2}", tmp_path).endswith("Did you mean reads?")
    assert told("macn: {checkpoint: none, device: gpu}", tmp_path) == (
        "6:38  agents[1].macn.device: got gpu; expected one of cpu, cuda. Did you mean cpu?"
    )
    monkeypatch.setattr("torch.cuda.is_available", lambda: False)
    assert told("macn: {checkpoint: none, device: cuda}", tmp_path) == (
        "6:38  agents[1].macn.device: got cuda; expected cpu, for PyTorch finds no CUDA device here."
    )
    whole = saved.read_bytes()
    for contents in (whole[:-1], whole[:-1] + bytes([whole[-1] ^ 1])):
        saved.write_bytes(contents)
        assert told("vin: {checkpoint: vin.safetensors}", tmp_path) == (
            "6:10  agents[1].vin: got {checkpoint: vin.safetensors}; expected a checkpoint that is whole "
            "(vin.safetensors is not the file that its card was written for)."
        )
    saved.with_suffix(".json").unlink()
    assert told("vin: {checkpoint: vin.safetensors}", tmp_path) == (
        "6:10  agents[1].vin: got {checkpoint: vin.safetensors}; "
        "expected a checkpoint with its card (there is no vin.json beside vin.safetensors)."
    )
