"""What is at hand: scenarios, map families, agents and learners, told without importing any of them."""

import yaml
from rich.console import Console
from rich.table import Table
from rich.text import Text

from fogbench.bench.reading.tables import LEARNER, agents, families, first_sentence
from fogbench.bench.shipped import find, folder


def show() -> None:
    """Print a table of each, and how to see more."""
    console = Console()
    console.print(_scenarios())
    console.print(_classes("Map families", families()))
    console.print(_classes("Agents", agents()))
    console.print(_classes("Ways to learn", LEARNER.targets()))
    console.print(Text("`fogbench list NAME` shows the settings of a name; so do sensor, budget, scenario and recipe."))


def _scenarios() -> Table:
    table = Table("scenario", "about", title="Scenarios")
    for path in find(None):
        text = yaml.load(path.read_text(encoding="utf-8"), yaml.CSafeLoader)
        table.add_row(str(path.relative_to(folder()).with_suffix("")), Text(text["about"]))
    return table


def _classes(title: str, targets: dict[str, str]) -> Table:
    table = Table("name", "about", "class", title=title)
    for name, target in targets.items():
        table.add_row(*map(Text, (name, first_sentence(target), target)))
    return table
