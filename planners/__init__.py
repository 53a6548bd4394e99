"""Classical planners, by the name they have in a scenario. Importing this imports none of them."""

PLANNERS = {
    "astar": "fogbench.planners.astar:AStar",
    "memoryless": "fogbench.planners.memoryless:Memoryless",
    "dstar_lite": "fogbench.planners.dstar_lite:DStarLite",
    "frontier": "fogbench.planners.frontier:Frontier",
    "rrt_star": "fogbench.planners.rrt_star:RrtStar",
    "random_walk": "fogbench.planners.random_walk:RandomWalk",
}
"""Planners that ship with the project, as `module:class`."""

EXTRAS = {"rrt_star": "ompl"}
"""The extra of the project (`pip install ".[ompl]"`) that a planner needs."""
