"""Several scenario files: read together, then taken one after the other."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import TypeVar

from rich.console import Console
from rich.text import Text

from fogbench.bench.reading.scenario import Scenario, ScenarioError, read_scenario, text_of
from fogbench.bench.reading.sorts import other_sort
from fogbench.bench.reporting.plain import plain, printable
from fogbench.worlds.mistake import Mistake

Answer = TypeVar("Answer")


def read_all(paths: Sequence[Path], episodes: int | None) -> list[Scenario]:
    """Read scenario files.

    Args:
        paths: of the files.
        episodes: per variant and agent, in place of what the files say; None: what they say.

    Raises:
        ScenarioError: all the mistakes in all the files, or two files with one name.
    """
    scenarios, errors = read_each(paths, episodes)
    if errors:
        raise ScenarioError([line for error in errors for line in error.lines])
    return scenarios


def read_each(paths: Sequence[Path], episodes: int | None) -> tuple[list[Scenario], list[ScenarioError]]:
    """The same; mistakes are returned, by the file."""
    scenarios, errors = dict[str, Scenario](), list[ScenarioError]()
    for path in paths:
        try:
            scenario = read_scenario(text_of(path), path)
        except ScenarioError as error:
            sort = other_sort(path)
            other = ScenarioError([f"{path}: seems to be {sort}; expected a scenario."])
            errors.append(other if sort else error)
            continue
        twin = scenarios.setdefault(scenario.name, scenario)
        if twin is not scenario:
            told = f"the name {scenario.name} is that of {twin.path}; choose another"
            errors.append(ScenarioError([f"{path}: {told}."], scenario))
    return [_with_episodes(each, episodes) if episodes else each for each in scenarios.values()], errors


def _with_episodes(scenario: Scenario, episodes: int) -> Scenario:
    return replace(scenario, variants=tuple(replace(each, episodes=episodes) for each in scenario.variants))


def each(scenarios: list[Scenario], console: Console, do: Callable[[Scenario], Answer]) -> list[Answer]:
    """Do the same with each scenario that is not skipped; a mistake in one does not stop the others."""
    answers, mistakes = [], []
    for scenario in scenarios:
        console.rule(Text(plain(scenario.name)), align="left")
        say(scenario.about, console, style="dim")
        if scenario.skipped:
            say(f"Skipped: {scenario.skipped}.", console, style="yellow")
            continue
        try:
            answers.append(do(scenario))
        except Mistake as mistake:
            mistakes.append(str(mistake))
    if mistakes:
        raise Mistake("\n".join(mistakes))
    return answers


def say(text: str, console: Console, style: str | None = None) -> None:
    """Print a text as it is."""
    console.print(Text(printable(text)), style=style, soft_wrap=True)
