"""What is at hand: scenarios, map families and agents, told without importing any of them."""

import yaml
from rich.console import Console
from rich.table import Table
from rich.text import Text

from fogbench.bench.reading.tables import agents, families, first_sentence
from fogbench.bench.shipped import find, folder


def show() -> None:
    """Print the three tables."""
    console = Console()
    console.print(_scenarios())
    console.print(_classes("Map families", families()))
    console.print(_classes("Agents", agents()))


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
