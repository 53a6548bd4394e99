"""The ground floor: what exists, and what can be seen of it. Importing this imports no family."""

FAMILIES = {
    "blobs": "worlds.blobs:Blobs",
    "tunnel": "worlds.tunnel:Tunnel",
    "maze": "worlds.maze:Maze",
    "rooms": "worlds.rooms:Rooms",
    "bug_trap": "worlds.bug_trap:BugTrap",
    "movingai": "worlds.movingai:MovingAI",
    "occupancy": "worlds.occupancy:Occupancy",
}
"""Map families, by the name they have under `maps:` in a scenario."""

KINDS = {
    "grid": "worlds.grid:GridConditions",
}
"""Kinds of world, with the class that reads a scenario's `sensor`, `rules`, `tasks` and `budget` for it."""
