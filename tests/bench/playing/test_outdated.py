"""What does not count any more is kept apart, and comes back when it counts again."""

from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from fogbench.bench.playing import outdated
from fogbench.bench.playing.episode import Episode
from fogbench.bench.playing.keys import keys
from fogbench.bench.playing.outdated import sort_rows
from fogbench.bench.playing.recorder import recording
from fogbench.bench.playing.store import recorded
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.maps.covariates import COVARIATES


def rows(scenario: Scenario, episodes: int = 3) -> list[Episode]:
    """Made-up rows of all agents of all variants, with their current keys."""
    return [
        Episode(
            *(scenario.name, variant, "grid", agent, episode, "REACHED", 2, 6, 2.0, 2.0, 2.0, None, 2, 0, 1),
            *((2.0, 1.0), 0.1, (0.25, 0.5), 36, 0, 7, (0.0, 1.0), ""),
            covariates=dict.fromkeys(COVARIATES, 0.5),
            workers=1,
            agent_key=agent_key,
            world_key=world_key,
        )
        for (variant, agent), (agent_key, world_key) in keys(scenario).items()
        for episode in range(episodes)
    ]


def record(folder: Path, scenario: Scenario) -> None:
    """What a run does: sort, then play what is missing."""
    with recording(folder, COVARIATES) as recorder:
        sort_rows(folder, scenario)
        done = recorded(folder, scenario)
        for row in rows(scenario):
            if row.episode not in done.get((row.variant, row.agent), ()):
                recorder.append(row)


def listed(folder: Path, which: str = "episodes") -> pd.DataFrame:
    """All rows of a folder as pandas reads them, in one order."""
    frame = pd.read_parquet(folder / which)
    return frame.sort_values(["variant", "agent", "episode", "world_key"], ignore_index=True)


def test_pandas_reads_current_rows_alone(make: Any, tmp_path: Path) -> None:
    """Changed settings move the rows that they made aside, whole; those of an agent that went too."""
    first, second = make(), make(variants={"short": {"budget": {"steps": 7}}, "long": {"budget": {"steps": 30}}})
    record(tmp_path, first)
    before = listed(tmp_path)
    record(tmp_path, second)
    now = listed(tmp_path)
    assert set(zip(now["agent_key"], now["world_key"], strict=True)) == {*keys(second).values()}
    aside = before[before["variant"] == "short"].reset_index(drop=True)
    pd.testing.assert_frame_equal(listed(tmp_path, "outdated"), aside)
    record(tmp_path, make(agents=["astar"]))
    assert set(listed(tmp_path)["agent"]) == {"astar"}


def test_rows_come_back_when_their_keys_hold_again(make: Any, tmp_path: Path) -> None:
    """There and back: nothing is played a second time, and nothing is there twice."""
    first, second = make(), make(seed=1)
    record(tmp_path, first)
    before = listed(tmp_path)
    record(tmp_path, second)
    assert len(listed(tmp_path, "outdated")) == len(before)
    record(tmp_path, first)
    pd.testing.assert_frame_equal(listed(tmp_path), before)
    assert set(listed(tmp_path, "outdated")["world_key"]) == {world for _, world in keys(second).values()}


def test_a_kill_in_between_loses_nothing(make: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Wherever it falls, the next run has all rows once, those that count and those that do not."""
    first, second = make(), make(variants={"short": {"budget": {"steps": 7}}, "long": {"budget": {"steps": 30}}})
    for steps in range(3):
        folder = tmp_path / str(steps)
        record(folder, first)
        left, write = iter(range(steps)), outdated.write_table

        def killed(path: Path, table: Any, left: Any = left, write: Any = write) -> None:
            if next(left, None) is None:
                raise KeyboardInterrupt
            write(path, table)

        monkeypatch.setattr(outdated, "write_table", killed)
        if steps < 2:
            with pytest.raises(KeyboardInterrupt):
                sort_rows(folder, second)
        monkeypatch.undo()
        record(folder, second)
        record(folder, first)
        assert len(listed(folder)) == len(rows(first))
        assert recorded(folder, first) == {pair: dict.fromkeys(range(3), "REACHED") for pair in keys(first)}


def test_what_cannot_play_here_stays(make: Any, tmp_path: Path) -> None:
    """An agent of another kind of world is skipped; nobody can tell whether its rows count."""
    scenario = make()
    record(tmp_path, scenario)
    missing = make(agents=["astar", {"random_walk": {"label": "memoryless"}}, "random_walk"])
    for variant in missing.variants:
        object.__setattr__(variant.agents[1], "skipped", "needs a package")
    sort_rows(tmp_path, missing)
    assert len(listed(tmp_path)) == len(rows(scenario))
