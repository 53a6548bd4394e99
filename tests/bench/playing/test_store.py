"""The store: whole files, current rows, one writer, little memory."""

import os
import pickle
import subprocess
import sys
from dataclasses import replace
from pathlib import Path
from typing import Any

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq
import pytest

from fogbench.bench.playing.episode import SCHEMA, Episode
from fogbench.bench.playing.keys import agent_key, world_key
from fogbench.bench.playing.recorder import ROWS, recording
from fogbench.bench.playing.store import StoreError, read, recorded, stale
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds.maps.covariates import COVARIATES
from fogbench.worlds.mistake import Mistake


def row(scenario: Scenario, episode: int, **changes: Any) -> Episode:
    """A made-up row of the first agent of the first variant, with its current keys."""
    variant = scenario.variants[0]
    entry = variant.agents[0]
    made_up = Episode(
        scenario=scenario.name,
        variant=variant.name,
        kind="grid",
        agent=entry.label,
        episode=episode,
        outcome="REACHED",
        steps=2,
        budget_steps=6,
        length=2.0,
        straight=2.0,
        shortest=2.0,
        reference_length=None,
        judged=2,
        wrong_decisions=0,
        strict_wrong=1,
        setup_seconds=0.1,
        decision_seconds=(0.25, 0.5),
        peak_memory_bytes=36,
        parameter_bytes=0,
        search_nodes=7,
        actions=(0.0, 1.0),
        detail="",
        remaining=(2.0, 1.0),
        covariates=dict(zip(COVARIATES, (0.1, 1.0, 0.0, 0.9), strict=True)),
        workers=1,
        agent_key=agent_key(entry),
        world_key=world_key(variant),
    )
    return replace(made_up, **changes)


def write(folder: Path, *rows: Episode) -> None:
    """Append rows as one run would."""
    with recording(folder, COVARIATES) as recorder:
        for each in rows:
            recorder.append(each)


def test_a_row_comes_back_as_it_went(make: Any, tmp_path: Path) -> None:
    """What pandas reads from the folder is what was appended, in the columns of the schema."""
    scenario = make()
    write(tmp_path / "store", row(scenario, 0), row(scenario, 1, reference_length=4.0))
    frame = pd.read_parquet(tmp_path / "store" / "episodes")
    assert list(frame.columns) == [*SCHEMA.names, *COVARIATES]
    for number, back in enumerate(frame.to_dict("records")):
        sent = row(scenario, number, reference_length=4.0 if number else None)
        for name in SCHEMA.names:
            value = getattr(sent, name)
            got = tuple(back[name]) if isinstance(value, tuple) else back[name]
            assert got == value or (value is None and pd.isna(got)), name
        assert {name: back[name] for name in COVARIATES} == sent.covariates


def test_covariates_of_all_kinds_are_columns_of_every_part(make: Any, tmp_path: Path) -> None:
    """A world of another kind has none of these, and others."""
    scenario, store = make(), tmp_path / "store"
    with recording(store, (*COVARIATES, "stations")) as recorder:
        recorder.append(row(scenario, 0))
        recorder.flush()
        recorder.append(row(scenario, 1, covariates={"stations": 7.0}))
    frame = pd.read_parquet(store / "episodes").sort_values("episode")
    assert frame["density"].tolist()[0] == 0.1
    assert frame["density"].isna().tolist() == [False, True]
    assert frame["stations"].tolist()[1] == 7.0


def test_a_store_of_before_is_read(make: Any, tmp_path: Path) -> None:
    """Rows of a version without `remaining` come back without it, beside those of today."""
    scenario, store = make(), tmp_path / "store"
    write(store, row(scenario, 0))
    part = store / "episodes" / "000001.parquet"
    pq.write_table(pq.read_table(part).drop_columns(["remaining"]), part)
    write(store, row(scenario, 1))
    frame = read(store, scenario, ["episode", "remaining"])
    assert frame["episode"].tolist() == [0, 1]
    assert frame["remaining"].isna().tolist() == [True, False]


def test_only_current_rows_are_read(make: Any, tmp_path: Path) -> None:
    """Rows with other keys, of other names and beyond the wanted episodes stay out, and none is read twice."""
    scenario = make(episodes=3)
    store = tmp_path / "store"
    stale = [row(scenario, 0, agent_key="old"), row(scenario, 1, world_key="old"), row(scenario, 2, agent="gone")]
    write(store, *stale, row(scenario, 3), row(scenario, 2, steps=5), row(scenario, 0))
    write(store, row(scenario, 2, steps=5))
    assert read(store, scenario, ["episode", "steps"]).to_dict("list") == {"episode": [0, 2], "steps": [2, 5]}
    assert recorded(store, scenario) == {("short", "astar"): {0: "REACHED", 2: "REACHED"}}


def test_stale_episodes_are_counted(make: Any, tmp_path: Path) -> None:
    """Episodes count that are there under other keys alone, once each, of agents that still play and wanted numbers."""
    scenario, store = make(episodes=3), tmp_path / "store"
    assert stale(store, scenario) == {}
    old = [row(scenario, episode, agent_key="old") for episode in (0, 1, 2, 3)]
    write(store, *old, row(scenario, 1, world_key="old"), row(scenario, 0), row(scenario, 0, agent="gone"))
    assert stale(store, scenario) == {("short", "astar"): 2}
    write(store, row(scenario, 1), row(scenario, 2))
    assert stale(store, scenario) == {}


def test_rows_are_current_by_the_versions_that_one_asks_for(make: Any, tmp_path: Path) -> None:
    """Those of the machine where they were played, in place of those here."""
    scenario, store, there = make(), tmp_path / "store", {"numpy": "1", "numba": "0.1"}
    variant = scenario.variants[0]
    keys = {"agent_key": agent_key(variant.agents[0], there), "world_key": world_key(variant, there)}
    write(store, row(scenario, 0, **keys), row(scenario, 1))
    assert read(store, scenario, ["episode"], there)["episode"].tolist() == [0]
    assert read(store, scenario, ["episode"])["episode"].tolist() == [1]
    assert stale(store, scenario, there) == stale(store, scenario) == {("short", "astar"): 1}


def test_a_stray_file_is_in_nobodys_way(make: Any, tmp_path: Path) -> None:
    """Parts are numbered past it; reading it gives the one line of any file with other columns."""
    scenario, store = make(), tmp_path / "store"
    write(store, row(scenario, 0))
    stray = store / "episodes" / "extra.parquet"
    pq.write_table(pa.table({"episode": [0]}), stray)
    write(store, row(scenario, 1))
    assert sorted(part.stem for part in (store / "episodes").iterdir()) == ["000001", "000002", "extra"]
    with pytest.raises(StoreError) as caught:
        read(store, scenario, ["episode"])
    assert str(caught.value) == f"{stray}: got the columns of another version; expected those of this one."


def test_an_empty_store_is_read_as_no_rows(make: Any, tmp_path: Path) -> None:
    """Where nothing was recorded there are the asked columns without rows."""
    frame = read(tmp_path / "nowhere", make(), ["outcome", "decision_seconds"])
    assert list(frame.columns) == ["outcome", "decision_seconds"]
    assert len(frame) == 0
    assert recorded(tmp_path / "nowhere", make()) == {}


def test_a_part_is_never_written_again(make: Any, tmp_path: Path) -> None:
    """Later runs add parts beside the earlier ones, and rows are held back up to a limit only."""
    scenario = make(episodes=10 * ROWS)
    store = tmp_path / "store"
    write(store, row(scenario, 0))
    (first,) = (store / "episodes").iterdir()
    before = first.read_bytes()
    with recording(store, ()) as recorder:
        for episode in range(1, ROWS + 1):
            recorder.append(row(scenario, episode))
        assert recorded(store, scenario) == {("short", "astar"): dict.fromkeys(range(ROWS + 1), "REACHED")}
    assert first.read_bytes() == before


def test_left_overs_are_ignored_and_removed(make: Any, tmp_path: Path) -> None:
    """A half-written dot-file is read by nobody; the next run removes it and no other file."""
    scenario, store = make(), tmp_path / "store"
    write(store, row(scenario, 0))
    half = store / "episodes" / ".000002.parquet"
    half.write_bytes(b"PAR1 half")
    assert len(read(store, scenario, ["episode"])) == 1
    assert len(pd.read_parquet(store / "episodes")) == 1
    write(store)
    assert [path.name for path in (store / "episodes").iterdir()] == ["000001.parquet"]


def test_a_broken_part_is_named_and_kept(make: Any, tmp_path: Path) -> None:
    """A file that is no Parquet file, or has other columns, gives one line; it stays where it is."""
    scenario, store = make(), tmp_path / "store"
    write(store, row(scenario, 0))
    part = store / "episodes" / "000001.parquet"
    part.write_bytes(part.read_bytes()[:-9])
    with pytest.raises(StoreError) as caught:
        read(store, scenario, ["episode"])
    text = str(caught.value)
    assert text.startswith(f"{part}: got a broken file (")
    assert text.endswith("); expected a Parquet file of episodes.")
    assert "\n" not in text
    pq.write_table(pa.table({"episode": [0]}), part)
    with pytest.raises(StoreError) as caught:
        recorded(store, scenario)
    assert str(caught.value) == f"{part}: got the columns of another version; expected those of this one."
    assert part.exists()


def test_a_second_run_is_refused(make: Any, tmp_path: Path) -> None:
    """While one run records, another gets one line; afterwards it may record."""
    store = tmp_path / "store"
    with recording(store, ()), pytest.raises(Mistake) as caught:
        write(store, row(make(), 0))
    assert str(caught.value) == f"{store}: got a second run; expected the one in process {os.getpid()} to end first."
    write(store, row(make(), 0))
    assert len(read(store, make(), ["episode"])) == 1


def test_a_store_that_cannot_be_written_is_named(tmp_path: Path) -> None:
    """A file where the folder should be gives one line."""
    (tmp_path / "store").write_text("in the way")
    with pytest.raises(StoreError) as caught, recording(tmp_path / "store", ()):
        pass
    assert str(caught.value).startswith(f"{tmp_path / 'store'}: got ")
    assert str(caught.value).endswith("; expected a place that can be written.")


MANY = """
import pickle, re, sys
from dataclasses import replace
from pathlib import Path
from fogbench.bench.reading.scenario import read_scenario
from fogbench.bench.playing.recorder import recording
from fogbench.bench.playing.store import recorded

path = Path(sys.argv[1])
scenario = read_scenario(path.read_text(), path)
first = pickle.loads(Path(sys.argv[2]).read_bytes())
with recording(path.parent / "many", ()) as recorder:
    for episode in range(100_000):
        seconds = tuple(episode + step / 40 for step in range(40))
        recorder.append(replace(first, episode=episode, decision_seconds=seconds, actions=seconds))
(found,) = recorded(path.parent / "many", scenario).values()
assert found == dict.fromkeys(range(100_000), "REACHED")
print(int(re.search("VmHWM:\\s+([0-9]+)", Path("/proc/self/status").read_text())[1]) / 1024)
"""
"""Record 100,000 episodes of 40 decisions, read back which are there, and print the peak of memory [MiB]."""


def test_a_hundred_thousand_episodes_fit_in_little_memory(make: Any, tmp_path: Path) -> None:
    """Recording them and finding them again stays under 500 MiB."""
    scenario = make(episodes=100_000)
    (tmp_path / "row").write_bytes(pickle.dumps(row(scenario, 0)))
    command = [sys.executable, "-c", MANY, str(scenario.path), str(tmp_path / "row")]
    answer = subprocess.run(command, check=True, capture_output=True, text=True)
    assert float(answer.stdout) < 500
