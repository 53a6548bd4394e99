"""The runner: the same episodes however they are run, and no agent that costs more than its own."""

import os
from collections import Counter
from pathlib import Path
from typing import Any

import pandas as pd
import pytest

from fogbench.bench.playing import closure, keys, sources
from fogbench.bench.playing.episode import SCHEMA, TIMINGS
from fogbench.bench.playing.local import RunError
from fogbench.bench.playing.runner import Progress, run
from fogbench.bench.playing.store import read
from fogbench.bench.reading.scenario import Scenario, ScenarioError
from fogbench.worlds.types import Outcome

FACTS = [name for name in SCHEMA.names if name not in TIMINGS]
"""All columns but the timings."""


SHORT = """
from fogbench import MapError
from fogbench.worlds.maps.families.blobs import Blobs


class Short(Blobs):
    def sample(self, rng, episode, conditions):
        if episode == 7:
            raise MapError("Short: no more maps")
        return super().sample(rng, episode, conditions)
"""


def silent(progress: Progress) -> None:
    """Watch nothing."""


def play(scenario: Scenario, folder: Path, workers: int = 2) -> pd.DataFrame:
    """Run a scenario and read all facts of it."""
    run(scenario, folder, workers, silent)
    return facts(scenario, folder)


def facts(scenario: Scenario, folder: Path) -> pd.DataFrame:
    """The recorded facts in one order, whatever the order of agents; lists as tuples, so that frames compare."""
    rows = read(folder, scenario, FACTS).sort_values(["variant", "agent", "episode"], ignore_index=True)
    return rows.assign(actions=rows["actions"].map(tuple))


def forget() -> None:
    """Have sources read again, which a process does once."""
    for kept in (sources.read_source, closure._closure, keys._used_here):
        kept.cache_clear()


def bad(how: str) -> dict[str, Any]:
    """An entry of the agent that fails in this way, which is also its label."""
    return {"./bad.py:Bad": {"how": how, "label": how}}


def test_workers_and_order_change_nothing(make: Any, tmp_path: Path) -> None:
    """One, two and four workers, and agents in any order, record the same facts, bit for bit."""
    first = play(make(), tmp_path / "one", 1)
    assert len(first) == 2 * 3 * 4
    pd.testing.assert_frame_equal(first, play(make(), tmp_path / "two", 2), check_exact=True)
    turned = make(agents=["random_walk", "memoryless", "astar"])
    pd.testing.assert_frame_equal(first, play(turned, tmp_path / "four", 4), check_exact=True)


def test_bad_agents_cost_their_own_episodes(make: Any, tmp_path: Path) -> None:
    """Agents that raise, lie, hang, hoard or end their process spoil the episodes they do it in, and no others."""
    changes = {"episodes": 3, "variants": {"long": {"budget": {"steps": 30}}}}
    alone = play(make(**changes), tmp_path / "alone")
    changes["variants"] = {"long": {"budget": {"steps": 30, "hard_seconds": 8, "memory_bytes": 10**6}}}
    ways = ("start", "act", "memory", "nonsense", "sleep", "hog", "exit", "segfault")
    everyone = make(**changes, agents=["astar", *map(bad, ways), "memoryless", "random_walk"])
    rows = play(everyone, tmp_path / "everyone")
    others = rows[~rows["agent"].isin(ways)].reset_index(drop=True)
    same = [name for name in FACTS if name != "world_key"]  # the limits are part of the conditions
    pd.testing.assert_frame_equal(others[same], alone[same], check_exact=True)
    reference = alone[alone["agent"] == "astar"]
    assert (reference["outcome"] == "REACHED").all()
    assert (reference["steps"] > 2).any()
    spoilt = {
        "act": ("CRASHED", "ValueError: no act (act, line "),
        "memory": ("CRASHED", "LookupError: no count (memory_bytes, line "),
        "nonsense": ("CRASHED", "TypeError: act returned 'north' (str); expected a Move or None"),
        "sleep": ("HUNG", "no answer after 8 s"),
        "hog": ("OUT_OF_MEMORY", ""),
        "exit": ("CRASHED", "the agent's process ended with exit code 3"),
        "segfault": ("CRASHED", "the agent's process was ended by SIGSEGV"),
    }
    for how, (outcome, detail) in spoilt.items():
        mine = rows[rows["agent"] == how]
        assert list(mine["outcome"]) == [outcome if steps > 2 else "REACHED" for steps in reference["steps"]], how
        assert all(row.detail.startswith(detail) for row in mine.itertuples() if row.outcome == outcome), how
    never = rows[rows["agent"] == "start"]
    assert set(never["outcome"]) == {"CRASHED"}
    assert never["detail"].str.startswith("RuntimeError: no start (start, line ").all()


def test_lost_episodes_keep_the_facts_of_their_world(make: Any, tmp_path: Path) -> None:
    """An episode whose process died has the same world as everyone's, and no decisions."""
    rows = play(make(agents=["astar", bad("exit")], episodes=3), tmp_path / "store", 1)
    died, reference = (rows[rows["agent"] == name].reset_index(drop=True) for name in ("exit", "astar"))
    world = ["variant", "episode", "kind", "budget_steps", "straight", "shortest", "reference_length", "world_key"]
    pd.testing.assert_frame_equal(died[world], reference[world], check_exact=True)
    lost = died[died["outcome"] == "CRASHED"]
    assert len(lost)
    assert not lost["steps"].any()


def test_a_world_that_cannot_be_made_stops_the_run(make: Any, tmp_path: Path) -> None:
    """The run ends with one line that names the variant, and what was recorded until then is kept."""
    (tmp_path / "short.py").write_text(SHORT)
    maps = {"./short.py:Short": {"size": 6, "obstacles": [2, 6], "obstacle_size": [1, 2]}}
    short = make(maps=maps, episodes=9)
    with pytest.raises(RunError, match=r"short, episode 7: Short: no more maps\.") as caught:
        run(short, tmp_path / "store", 1, silent)
    assert "\n" not in str(caught.value)
    assert set(facts(short, tmp_path / "store")["episode"]) == set(range(7))


def test_a_first_world_that_cannot_be_made_is_told_before_anything_is_played(make: Any, tmp_path: Path) -> None:
    """In one line with the place of its maps."""
    budget = {"budget": {"steps": 100}}
    impossible = make(variants={"fine": budget, "far": {**budget, "tasks": {"distance": [90, 99]}}})
    with pytest.raises(ScenarioError) as caught:
        run(impossible, tmp_path / "store", 2, silent)
    told = "Blobs: no task with an optimum of 90 to 99 cells (set by `tasks: {distance: ...}`) was found on 1000 maps."
    assert str(caught.value) == f"{impossible.path}:4:3  maps.blobs: {told}"
    assert facts(impossible, tmp_path / "store").empty


def test_only_what_changed_runs_again(make: Any, tmp_path: Path) -> None:
    """A new setting, a new plug-in source or more episodes run those episodes; old rows stay out of what is read."""
    store, plain = tmp_path / "store", ["astar", "random_walk", bad("none")]
    run(make(agents=plain), store, 1, silent)
    assert played(make(agents=plain), store) == {}
    eager = make(agents=[{"astar": {"replan": "change"}}, *plain[1:]])
    assert played(eager, store) == {("short", "astar"): 4, ("long", "astar"): 4}
    with (tmp_path / "bad.py").open("a") as file:
        file.write("\nNEW = True\n")
    forget()
    assert played(make(agents=plain), store) == {("short", "none"): 4, ("long", "none"): 4}
    assert len(facts(make(agents=plain), store)) == 2 * 3 * 4
    wider = make(agents=plain, variants={"short": {"budget": {"steps": 6}}, "long": {"budget": {"steps": 31}}})
    assert played(wider, store) == {("long", name): 4 for name in ("astar", "random_walk", "none")}
    assert played(make(agents=["astar"], episodes=5), store) == {("short", "astar"): 1, ("long", "astar"): 1}
    assert len(facts(make(agents=["astar"], episodes=2), store)) == 4


def played(scenario: Scenario, store: Path) -> dict[tuple[str, str], int]:
    """Run, and count the episodes of each variant and agent that were played."""
    seen: Counter[tuple[str, str]] = Counter()
    run(scenario, store, 1, lambda progress: seen.update([progress[:2]] if progress.outcome else []))
    return dict(seen)


def test_progress_counts_to_the_end(make: Any, tmp_path: Path) -> None:
    """Whoever watches is told every count once, from what was recorded before to all."""
    run(make(agents=["astar"], episodes=1), tmp_path / "store", 1, silent)
    seen: list[Progress] = []
    summary = run(make(agents=["astar"], episodes=3), tmp_path / "store", 1, seen.append)
    assert [p for p in seen if p.outcome is None] == [Progress(v, "astar", 1, 3, None) for v in ("short", "long")]
    told = [(p.variant, p.done, p.total) for p in seen if p.outcome]
    assert sorted(told) == [("long", 2, 3), ("long", 3, 3), ("short", 2, 3), ("short", 3, 3)]
    assert summary.kept == 2
    assert summary.outcomes == Counter(p.outcome for p in seen if p.outcome)
    assert summary.outcomes[Outcome.CRASHED] == 0


THREADS = """
import os
from typing import ClassVar

from threadpoolctl import threadpool_info

from fogbench.planners.random_walk import RandomWalkAgent
from fogbench.worlds.settings import Settings


class Threads(Settings):
    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    def start(self, task, rng):
        return ThreadsAgent(rng)

    def parameter_bytes(self):
        return int(os.environ["OMP_NUM_THREADS"])


class ThreadsAgent(RandomWalkAgent):
    def search_nodes(self):
        return max(library["num_threads"] for library in threadpool_info())
"""
"""A plug-in that records how many threads it might use."""


def test_workers_have_one_thread_each(make: Any, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Linear algebra runs on one thread in a worker; afterwards the environment is what it was."""
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    monkeypatch.delenv("OPENBLAS_NUM_THREADS", raising=False)
    before = dict(os.environ)
    (tmp_path / "threads.py").write_text(THREADS)
    agents = [{"./threads.py:Threads": {"label": "threads"}}]
    rows = play(make(agents=agents, reference="threads", episodes=1), tmp_path / "store", 1)
    assert set(rows["search_nodes"]) == set(rows["parameter_bytes"]) == {1}
    assert dict(os.environ) == before


EDITED = """
from pathlib import Path

from fogbench.planners.astar import AStar, AStarAgent

VERSION = 1


class Changing(AStar):
    def start(self, task, rng):
        here = Path(__file__)
        log = here.with_name("starts")
        log.write_text(log.read_text() + "x" if log.exists() else "x")
        if len(log.read_text()) == 4 and VERSION == 1:  # the second episode, after the practice and the first
            here.write_text(here.read_text().replace("VERSION = 1\\n", "VERSION = 2\\n"))
        return super().start(task, rng)
"""


def test_an_edit_while_it_plays_stops_the_run(make: Any, tmp_path: Path) -> None:
    """In a line; the old rows keep the old key, and the next run plays all anew with the new one."""
    plugin = tmp_path / "changing.py"
    plugin.write_text(EDITED)
    changes = {
        "agents": ["./changing.py:Changing"],
        "reference": "Changing",
        "variants": {"long": {"budget": {"steps": 30}}},
    }
    text = make(**changes)
    with pytest.raises(RunError, match=r"changing\.py was edited while it was played") as caught:
        run(text, tmp_path / "store", 1, silent)
    assert "\n" not in str(caught.value)
    before = pd.read_parquet(tmp_path / "store" / "episodes")
    assert 0 < len(before) < 4
    assert plugin.read_text().count("VERSION = 2")
    forget()
    again = make(**changes)
    assert run(again, tmp_path / "store", 1, silent).kept == 0
    after = pd.read_parquet(tmp_path / "store" / "episodes")
    assert len(after) == 4
    assert not {*before["agent_key"]} & {*after["agent_key"]}
