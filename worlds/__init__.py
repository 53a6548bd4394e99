"""The ground floor: what exists, and what can be seen of it. Importing this imports no family and no kind."""

from typing import NamedTuple

from fogbench.worlds.tables import named

FAMILIES = {
    "blobs": "fogbench.worlds.maps.families.blobs:Blobs",
    "fixed_blobs": "fogbench.worlds.maps.families.fixed_blobs:FixedBlobs",
    "tunnel": "fogbench.worlds.maps.families.tunnel:Tunnel",
    "maze": "fogbench.worlds.maps.families.maze:Maze",
    "rooms": "fogbench.worlds.maps.families.rooms:Rooms",
    "bug_trap": "fogbench.worlds.maps.families.bug_trap:BugTrap",
    "movingai": "fogbench.worlds.maps.families.movingai:MovingAI",
    "occupancy": "fogbench.worlds.maps.families.occupancy:Occupancy",
    "random_graph": "fogbench.worlds.graph.families.random_graph:RandomGraph",
    "fixed_graph": "fogbench.worlds.graph.families.fixed_graph:FixedGraph",
    "graph_file": "fogbench.worlds.graph.families.graph_file:GraphFile",
}
"""Map families, by the name they have under `maps:` in a scenario."""


class Kind(NamedTuple):
    """What the harness knows of a kind of world without importing it."""

    conditions: str
    """`module:class` of its conditions; the fields of that class are blocks of a page (`sensor`, `rules`, ...)."""
    unit: str
    """Of length, in the plural."""
    extra: str = ""
    """The extra of the project (`pip install ".[robot]"`) that its worlds need; empty: none."""
    maps: str = ""
    """Another kind, whose map families can make worlds of this one too; empty: no other's."""
    rehearsal: str = ""
    """YAML of small worlds, in which `fogbench doctor` lets all agents that ship play once; empty: it does not."""


KINDS = {
    "grid": Kind(
        "fogbench.worlds.grid.conditions:GridConditions",
        unit="cells",
        rehearsal="""
maps: {blobs: {size: 12, obstacles: [8, 8], obstacle_size: [1, 3]}}
sensor: {radius: 2, occlusion: true}
budget: {steps: 40}
""",
    ),
    "graph": Kind(
        "fogbench.worlds.graph.conditions:GraphConditions",
        unit="edges",
        rehearsal="""
maps: {random_graph: {nodes: 16, mean_degree: 3}}
budget: {steps: 32}
""",
    ),
    "robot": Kind(
        "fogbench.worlds.robot.conditions:RobotConditions",
        unit="m",
        extra="robot",
        maps="grid",
        rehearsal="""
maps: {blobs: {size: 60, obstacles: [6, 6], obstacle_size: [3, 9]}}
sensor: {beams: 60}
budget: {steps: 40}
""",
    ),
}
"""Kinds of world, by the name they have under `kind:`; other packages add theirs by the group `fogbench.kinds`."""


def unit_of(kind: str) -> str:
    """The unit of length of a kind of world; its name where nobody knows the kind."""
    found: Kind | None = named(KINDS, "fogbench.kinds", kind)
    return found.unit if found else kind
