"""The ground floor: what exists, and what can be seen of it. Importing this imports no family."""

FAMILIES = {
    "blobs": "fogbench.worlds.maps.families.blobs:Blobs",
    "tunnel": "fogbench.worlds.maps.families.tunnel:Tunnel",
    "maze": "fogbench.worlds.maps.families.maze:Maze",
    "rooms": "fogbench.worlds.maps.families.rooms:Rooms",
    "bug_trap": "fogbench.worlds.maps.families.bug_trap:BugTrap",
    "movingai": "fogbench.worlds.maps.families.movingai:MovingAI",
    "occupancy": "fogbench.worlds.maps.families.occupancy:Occupancy",
}
"""Map families, by the name they have under `maps:` in a scenario."""

KINDS = {
    "grid": "fogbench.worlds.grid.conditions:GridConditions",
}
"""Kinds of world, with the class that reads a scenario's `sensor`, `rules`, `tasks` and `budget` for it."""
