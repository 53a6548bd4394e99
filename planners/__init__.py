"""Classical planners, by the name they have in a scenario, and who judges. Importing this imports none of them."""

from typing import Any, NamedTuple

from fogbench.worlds.tables import imported, named

PLANNERS = {
    "astar": "fogbench.planners.astar:AStar",
    "memoryless": "fogbench.planners.memoryless:Memoryless",
    "dstar_lite": "fogbench.planners.dstar_lite:DStarLite",
    "frontier": "fogbench.planners.frontier:Frontier",
    "rrt_star": "fogbench.planners.rrt_star:RrtStar",
    "hfn": "fogbench.planners.hfn:HFN",
    "random_walk": "fogbench.planners.random_walk:RandomWalk",
    "breadth_first": "fogbench.planners.breadth_first:BreadthFirst",
    "nearest_unvisited": "fogbench.planners.nearest_unvisited:NearestUnvisited",
}
"""Planners that ship with the project, as `module:class`."""

EXTRAS = {"rrt_star": "ompl", "hfn": "robot"}
"""The extra of the project (`pip install ".[ompl]"`) that a planner needs."""


class Reference(NamedTuple):
    """The same-information reference of a kind of world: a planner that sees what every agent sees."""

    name: str
    """What reports call it."""
    settings: str
    """`module:class`; its defaults are played."""


REFERENCES = {
    "grid": Reference("A*", "fogbench.planners.astar:AStar"),
    "graph": Reference("nearest unvisited", "fogbench.planners.nearest_unvisited:NearestUnvisited"),
    "robot": Reference("A*", "fogbench.planners.astar:AStar"),
}
"""By the kind of world; other packages add theirs by the group `fogbench.references`."""

JUDGES = {
    "grid": "fogbench.planners.grid_judge:GridJudge",
    "graph": "fogbench.planners.graph.judge:GraphJudge",
    "robot": "fogbench.planners.robot.teacher:RobotTeacher",
}
"""What knows which actions are right (see `judging`), by the kind of world; others by the group `fogbench.judges`."""

SPEEDS = {"A* over an empty 512x512 map": "fogbench.planners.speed:search_empty_map"}
"""Work that `fogbench doctor` times."""


def reference_of(kind: str) -> Reference | None:
    """The reference of a kind; None: its episodes have none."""
    return named(REFERENCES, "fogbench.references", kind)


def reference_settings(kind: str) -> Any | None:
    """The class of the reference's settings; None: the kind has none.

    Raises:
        Mistake: it cannot be imported.
    """
    reference = reference_of(kind)
    return imported(reference.settings, f"the reference of {kind}") if reference else None


def judge_of(kind: str) -> Any | None:
    """The class of the judge of a kind, or of what only teaches; None: its episodes are not judged."""
    return named(JUDGES, "fogbench.judges", kind)
