"""What a YAML file seems to be that is no scenario."""

from collections.abc import Set as AbstractSet
from pathlib import Path

from fogbench.bench.reading.scenario import ScenarioError, text_of
from fogbench.worlds.mistake import near
from fogbench.worlds.reading.document import parse

TELLING = ("maps", "agents", "budget", "episodes", "variants")
"""Keys of which every scenario has some."""

RECIPE = {"network", "learning"}

MAP = {"image", "resolution"}


def other_sort(path: Path) -> str:
    """What a file seems to be; empty: a scenario, or one with mistakes."""
    try:
        text = text_of(path)
    except ScenarioError:
        return ""
    if _first_line(text).startswith("- "):
        return "a list"
    page = parse(text, [])
    return _by_keys(page.fields().keys()) if page else ""


def _first_line(text: str) -> str:
    """That says something."""
    lines = (line for line in text.splitlines() if line.strip() and not line.startswith(("#", "---")))
    return next(lines, "")


def _by_keys(keys: AbstractSet[str]) -> str:
    if keys & RECIPE and "agents" not in keys:
        return "a recipe, which `fogbench train` reads"
    if not keys or any(near(key, TELLING) for key in keys):
        return ""
    if keys >= MAP:
        return "a map of map_server, which a scenario names under `maps: {occupancy: {map: ...}}`"
    return f"something else, without {', '.join(TELLING)}"
