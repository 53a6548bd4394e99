"""A scenario: one YAML file, read into worlds to sample and agents to start."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from worlds.types import AgentSettings, MapFamily


@dataclass(frozen=True, slots=True)
class Entry:
    """One agent of a variant."""

    label: str
    """Its name in tables; unique in its variant."""
    target: str
    """Where its class is: `module:class`, or `/absolute/file.py:class` for a plug-in."""
    settings: AgentSettings | None
    skipped: str
    """Why it does not run here; empty if it does."""


@dataclass(frozen=True, slots=True)
class Variant:
    """One row of a scenario's tables."""

    name: str
    family: MapFamily
    conditions: Any
    """An object of the class that `worlds.KINDS` names for `family.kind`."""
    agents: tuple[Entry, ...]
    reference: str
    """Label of the agent that the others are compared with in pairs."""
    episodes: int
    seed: int


@dataclass(frozen=True, slots=True)
class Scenario:
    """One file."""

    path: Path
    text: str
    name: str
    about: str
    variants: tuple[Variant, ...]
    published: dict[str, Any]
    """`{"source": ..., metric: {agent label: {variant: number}}}`; empty if nothing was published."""
    skipped: str
    """Why none of it runs here (a map file's environment variable is not set); empty if it does."""


class ScenarioError(ValueError):
    """A file with mistakes; `lines` has one `file:line:column  path: got X; expected Y.` for each, in order."""

    def __init__(self, lines: list[str]) -> None:
        """Collect the lines."""
        super().__init__("\n".join(lines))
        self.lines = lines


def read_scenario(text: str, path: Path) -> Scenario:
    """Read the text of a scenario file.

    Args:
        text: the YAML.
        path: where it came from; plug-ins and map files are relative to its folder.

    Raises:
        ScenarioError: all the mistakes of the file.
    """
    raise NotImplementedError
