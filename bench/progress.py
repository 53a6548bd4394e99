"""Progress bars of a run: one for the scenario, and one for each agent of the variant that is being played."""

from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TaskID, TextColumn, TimeElapsedColumn
from rich.progress import TimeRemainingColumn as Eta

from fogbench.bench.playing import runner
from fogbench.bench.reporting.plain import folded
from fogbench.worlds.types import Outcome

LONG = 40
"""Characters of a name beside a bar."""


class Bars:
    """Draws what a run reports; use it as a context."""

    def __init__(self, name: str, console: Console) -> None:
        """Bars for the scenario called `name`."""
        columns = (
            TextColumn("{task.description}", markup=False),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            Eta(),
            TextColumn("{task.fields[reached]}", markup=False),
        )
        self.bars = Progress(*columns, console=console, speed_estimate_period=600)
        self.whole = self.bars.add_task(folded(name, LONG, 1), total=0, reached="")
        self.agents: dict[tuple[str, str], TaskID] = {}
        self.reached: dict[tuple[str, str], int] = {}

    def __enter__(self) -> Self:
        """Begin to draw."""
        self.bars.start()
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Stop drawing; the scenario's bar stays."""
        for bar in self.agents.values():
            self.bars.update(bar, visible=False)
        self.bars.stop()

    def watch(self, news: runner.Progress) -> None:
        """Take one more report of the run."""
        pair = (news.variant, news.agent)
        if news.outcome is None:
            self._expect(pair, news)
            return
        self.reached[pair] += news.outcome is Outcome.REACHED
        self.bars.advance(self.whole)
        self.bars.update(
            self.agents[pair],
            completed=news.done,
            visible=news.done < news.total,
            reached=f"{self.reached[pair]} reached",
        )

    def _expect(self, pair: tuple[str, str], news: runner.Progress) -> None:
        whole = self.bars.tasks[self.whole]
        self.bars.update(self.whole, total=(whole.total or 0) + news.total, completed=whole.completed + news.done)
        self.reached[pair] = 0
        name = f"{news.variant} · {news.agent}"
        self.agents[pair] = self.bars.add_task(
            f"  {folded(name, LONG, 1)}", total=news.total, completed=news.done, visible=False, reached=""
        )
