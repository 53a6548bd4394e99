"""Classical planners, by the name they have in a scenario. Importing this imports none of them."""

PLANNERS = {
    "astar": "planners.astar:AStar",
    "memoryless": "planners.memoryless:Memoryless",
    "dstar_lite": "planners.dstar_lite:DStarLite",
    "frontier": "planners.frontier:Frontier",
    "rrt_star": "planners.rrt_star:RrtStar",
    "random_walk": "planners.random_walk:RandomWalk",
}
"""Planners that ship with the project, as `module:class`."""

EXTRAS = {"rrt_star": "ompl"}
"""The extra of the project (`pip install ".[ompl]"`) that a planner needs."""
