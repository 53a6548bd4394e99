"""What is at hand, told without importing any of it."""

import json
from collections.abc import Mapping
from pathlib import Path

import yaml
from rich.console import Console
from rich.table import Table
from rich.text import Text

from fogbench.bench.reading.tables import LEARNER, agents, families, first_sentence
from fogbench.bench.shipped import checkpoints, find, recipes


def show() -> None:
    """Print a table of each, and how to see more."""
    console = Console()
    console.print(_pages("Scenarios", {path.stem: path for path in find(None)}))
    console.print(_classes("Map families", families()))
    console.print(_classes("Agents", agents()))
    console.print(_classes("Ways to learn", LEARNER.targets()))
    console.print(_pages("Recipes", recipes()))
    console.print(_checkpoints())
    others = "sensor, rules, tasks, budget, scenario and recipe"
    console.print(Text(f"`fogbench list NAME` shows the settings of a name; so do {others}."))


def _pages(title: str, paths: Mapping[str, Path]) -> Table:
    table = Table("name", "about", title=title)
    for name, path in paths.items():
        text = yaml.load(path.read_text(encoding="utf-8"), yaml.CSafeLoader)
        table.add_row(name, Text(text["about"]))
    return table


def _checkpoints() -> Table:
    table = Table("name", "network", title="Checkpoints")
    for name, card in checkpoints().items():
        table.add_row(name, json.loads(card.read_text("utf-8"))["network"])
    return table


def _classes(title: str, targets: dict[str, str]) -> Table:
    table = Table("name", "about", title=title)
    for name, target in targets.items():
        table.add_row(*map(Text, (name, first_sentence(target))))
    return table
