"""Whole 16x16 episodes of an agent that costs next to nothing, each with a fresh map and all resets."""

from itertools import count

from pytest_benchmark.fixture import BenchmarkFixture

from fogbench.bench.playing.loop import Record, episode_world, start_and_roll
from fogbench.bench.playing.play import play
from fogbench.bench.reading.scenario import read_scenario
from fogbench.bench.shipped import find
from fogbench.planners.random_walk import RandomWalk

GRID = find(["grid"])[0]
SCENARIO = read_scenario(GRID.read_text("utf-8"), GRID)
VARIANT = next(variant for variant in SCENARIO.variants if variant.name == "16x16")
WALK = RandomWalk()
ENTRY = next(entry for entry in VARIANT.agents if entry.settings == WALK)
EPISODES = count()
"""No episode is played twice, so that no world is at hand already."""


def test_bare_loop(benchmark: BenchmarkFixture) -> None:
    """The world is made and the agent walks, and nothing else."""
    benchmark.group = "episode 16x16"
    bare_episode()  # compiles the kernels
    benchmark(bare_episode)


def test_recorded_episode(benchmark: BenchmarkFixture) -> None:
    """What a run does for each episode: every decision judged, the reference played beside it, the row made."""
    benchmark.group = "episode 16x16"
    recorded_episode()  # compiles the kernels
    benchmark(recorded_episode)


def bare_episode() -> None:
    """Play the next episode without a judge."""
    episode = next(EPISODES)
    start_and_roll(episode_world(VARIANT, episode), WALK, VARIANT, episode, Record(), None)


def recorded_episode() -> None:
    """Play the next episode as a worker does."""
    play(SCENARIO, VARIANT, ENTRY, next(EPISODES), 1)
