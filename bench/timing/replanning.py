"""Repairing a search beside repeating it: D* Lite and two habits of A* on long tasks in a city, the map unknown.

    python bench/timing/replanning.py

The agents take turns on the same tasks. Expansions do not depend on the machine; seconds are of all decisions of an
episode and the agent's start.
"""

from dataclasses import asdict
from itertools import product
from pathlib import Path

import pandas as pd
from rich.console import Console
from rich.table import Table

from fogbench.bench.playing.play import play
from fogbench.bench.reading.scenario import read_scenario

TEXT = """
name: replanning
about: Long tasks in a city of the Moving AI Lab.
maps: {movingai: {map: "${FOGBENCH_MAPS}/movingai/Berlin_0_256.map"}}
sensor: {radius: 5, occlusion: true}
rules: {collision: blocked}
tasks: {distance: [101, 1000]}
budget: {steps: {per_distance: 8, plus: 100}}
agents:
  - dstar_lite: {label: D* Lite}
  - astar: {label: A* on newly blocked cells}
  - astar: {replan: change, label: A* after every change}
episodes: 100
"""


def main() -> None:
    """Play the episodes and print the table, or say in a line why not."""
    scenario = read_scenario(TEXT, Path(__file__))
    if scenario.skipped:
        print(f"replanning: not run, {scenario.skipped}")
        return
    (variant,) = scenario.variants
    turns = product(range(variant.episodes), variant.agents)
    rows = pd.DataFrame([asdict(play(scenario, variant, entry, episode, 1)) for episode, entry in turns])
    Console().print(table(rows))


def table(rows: pd.DataFrame) -> Table:
    """One line for each agent: means over its episodes."""
    seconds = rows["decision_seconds"].map(sum) + rows["setup_seconds"]
    means = rows.assign(milliseconds=1e3 * seconds).groupby("agent", sort=False)
    title = f"Means over {rows['episode'].nunique()} tasks on Berlin_0_256 with an optimum over 100 cells"
    made = Table("agent", "reached", "steps", "expansions", "ms per episode", title=title)
    for agent, group in means:
        reached = (group["outcome"] == "REACHED").mean()
        steps, nodes, time = group[["steps", "search_nodes", "milliseconds"]].mean()
        made.add_row(str(agent), f"{reached:.0%}", f"{steps:.1f}", f"{nodes:,.0f}", f"{time:.2f}")
    return made


if __name__ == "__main__":
    main()
