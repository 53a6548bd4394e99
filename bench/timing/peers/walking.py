"""Whole episodes of a random agent on 16x16 maps, with map generation and resets.

All walk at random over a fresh map of 16x16 cells for at most 40 steps, seeing 7x7 cells without occlusion; the cost of
making maps and of all resets is in the steps per second.

    ours       scenario `grid`, variant 16x16, agent `random_walk`, which looks at its view before it draws a move, and
               whose every decision is timed; every world has a path and its optimum is known. Twice: the bare loop,
               and the recorded episode, with the judge, the reference played beside it, and the row of the store.
    pogema     one agent, Bernoulli maps of our mean density, uniform actions that are drawn without a look, no path
               promised inside the step limit.
    minigrid   an empty room, which is its cheapest map, the agent placed at random, its walls seen through; uniform
               actions among left, right and forward.
"""

import json
import subprocess
from collections.abc import Iterator
from itertools import count, islice
from pathlib import Path
from statistics import mean
from time import process_time

import numpy as np
from minigrid.envs.empty import EmptyEnv
from turns import Round, Turns, per_second

from fogbench.bench.playing.loop import Record, episode_world, start_and_roll
from fogbench.bench.playing.play import play
from fogbench.bench.reading.scenario import read_scenario
from fogbench.bench.shipped import find
from fogbench.planners.random_walk import RandomWalk

EPISODES = 100
"""In a round."""

GRID = find(["grid"])[0]
SCENARIO = read_scenario(GRID.read_text("utf-8"), GRID)
VARIANT = next(variant for variant in SCENARIO.variants if variant.name == "16x16")
WALK = RandomWalk()
ENTRY = next(entry for entry in VARIANT.agents if entry.settings == WALK)
STEPS, RADIUS, SIZE = VARIANT.conditions.budget.steps, VARIANT.conditions.sensor.radius, VARIANT.family.size
NUMBERS = count()
"""No episode is played twice, so that no world is at hand already."""


def walks(pogema_python: str) -> Iterator[Turns]:
    """Both forms of ours beside both peers."""
    for peer, theirs in (("pogema", pogema_rounds(pogema_python)), ("minigrid", minigrid_rounds())):
        yield Turns.take("episodes 16x16, bare", peer, bare_round, theirs, per_second)
        yield Turns.take("episodes 16x16, recorded", peer, recorded_round, theirs, per_second)


def bare_round() -> float:
    """Seconds per step of episodes that nobody judges or records."""
    began, steps = process_time(), 0
    for episode in islice(NUMBERS, EPISODES):
        record = Record()
        start_and_roll(episode_world(VARIANT, episode), WALK, VARIANT, episode, record, None)
        steps += len(record.actions)
    return (process_time() - began) / steps


def recorded_round() -> float:
    """Seconds per step of episodes as a run plays them."""
    began = process_time()
    steps = sum(play(SCENARIO, VARIANT, ENTRY, episode, 1).steps for episode in islice(NUMBERS, EPISODES))
    return (process_time() - began) / steps


def pogema_rounds(python: str) -> Round:
    """Seconds per step of pogema, which answers from a process of its own environment."""
    density = mean(episode_world(VARIANT, episode).covariates()["density"] for episode in islice(NUMBERS, 500))
    config = {"size": SIZE, "obs_radius": RADIUS, "max_episode_steps": STEPS, "density": density, "num_agents": 1}
    command = [python, "-I", str(Path(__file__).with_name("pogema_rounds.py")), json.dumps(config)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, bufsize=1)

    def one_round() -> float:
        process.stdin.write(f"{EPISODES}\n")
        return float(process.stdout.readline())

    return one_round


def minigrid_rounds() -> Round:
    """Seconds per step of minigrid."""
    room = EmptyEnv(size=SIZE, agent_start_pos=None, max_steps=STEPS, agent_view_size=2 * RADIUS + 1)
    rng = np.random.default_rng(0)

    def one_round() -> float:
        began, steps = process_time(), 0
        for _ in range(EPISODES):
            room.reset()
            over = False
            while not over:
                _, _, terminated, truncated, _ = room.step(int(3 * rng.random()))
                over = terminated or truncated
                steps += 1
        return (process_time() - began) / steps

    return one_round
