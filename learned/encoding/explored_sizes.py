"""How much a network sees of an explored graph. Importing this imports no torch."""

FRONTIER = 3
"""Numbers of a node where an agent could end: whether it is the goal, how many edges to it are known, and how near the
goal the straight line is."""

TRAITS = 4
"""Numbers of a neighbour: whether it is the goal, whether it was visited, whether the agent came from it, and how many
edges of it are known."""

TOLD = 4
"""Numbers of the agent's node: how many edges it has, how many lead to nodes that were not visited, whether the goal is
known, and whether the last action was blocked."""
