"""The bars of a run."""

from io import StringIO

from rich.console import Console

from fogbench.bench.playing.runner import Progress
from fogbench.bench.progress import Bars


def test_names_are_printed_as_they_are() -> None:
    """Brackets in the names of scenarios, variants and agents are text, not markup."""
    console = Console(width=200, file=StringIO(), force_terminal=True, color_system=None)
    with Bars("Maps [of mine], [/red] done", console) as bars:
        bars.watch(Progress("[bold]", "[/x]", 0, 3, None))
        bars.bars.update(bars.agents["[bold]", "[/x]"], visible=True)
        bars.bars.refresh()
    assert "Maps [of mine], [/red] done" in console.file.getvalue()
    assert "[bold] · [/x]" in console.file.getvalue()
