"""The raw record of one agent in one world, and the one schema that it is stored with."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, fields
from typing import Annotated, NamedTuple

import pyarrow as pa

Seconds = Annotated[tuple[float, ...], "single precision"]
"""Times are kept to seven digits: more would double the size of long episodes."""


@dataclass(frozen=True, slots=True)
class Episode:
    """One row of the store. None where a thing is not defined or was lost with a killed process."""

    scenario: str
    variant: str
    kind: str
    agent: str
    """The agent's label in the scenario."""
    episode: int
    outcome: str
    """The name of a `fogbench.worlds.types.Outcome`."""
    steps: int
    """Decisions that were carried out."""
    budget_steps: int
    length: float
    """Length travelled, in the unit of the kind."""
    straight: float
    """Straight distance from start to goal, the length of the optimum if nothing were in the way."""
    shortest: float
    """Length of the optimum on the full map."""
    reference_length: float | None
    """Length that the kind's reference, which sees the same, travelled in the same world; None where it did not reach
    the goal, or there is none."""
    judged: int
    """Decisions taken while the agent's own known map had a path to the goal."""
    wrong_decisions: int
    """Judged decisions that no optimal plan on the agent's own known map would take."""
    strict_wrong: int
    """Judged decisions that differ from those of the kind's reference on the agent's own known map."""
    remaining: tuple[float, ...]
    """Length of the optimal path to the goal on the full map, before each decision."""
    setup_seconds: float
    decision_seconds: Seconds
    """Seconds of each decision, in order."""
    peak_memory_bytes: int
    """The most bytes carried from one decision to the next."""
    parameter_bytes: int
    search_nodes: int
    """Search effort: nodes expanded or tree vertices added."""
    actions: tuple[float, ...]
    """The actions one after the other, flat: enough to replay the episode exactly."""
    detail: str
    """One line on what went wrong, where something did; else empty."""
    covariates: Mapping[str, float]
    """How difficult the world is, by the names of its kind; each is a column of its own."""
    workers: int
    """Worker processes that ran side by side; it belongs to the timings."""
    agent_key: str
    world_key: str


class Played(NamedTuple):
    """An episode, as a worker hands it over."""

    row: Episode
    traceback: str
    """Where its agent crashed; empty if it did not, or nobody knows."""


TIMINGS = ("setup_seconds", "decision_seconds", "workers")
"""Columns that differ from run to run; all others are the same, bit for bit."""

_ARROW = {
    str: pa.string(),
    int: pa.int64(),
    float: pa.float64(),
    float | None: pa.float64(),
    tuple[float, ...]: pa.list_(pa.float64()),
    Seconds: pa.list_(pa.float32()),
}

SCHEMA = pa.schema([(field.name, _ARROW[field.type]) for field in fields(Episode) if field.name != "covariates"])  # type: ignore[index]  # or text
"""The columns of `episodes/*.parquet` that all kinds of world have."""

LATER = frozenset({"remaining"})
"""Columns that a store of an earlier version lacks."""


def table(rows: Sequence[Episode], covariates: Sequence[str]) -> pa.Table:
    """Rows as they are stored, with the covariates of all kinds of their scenario."""
    own = {name: [getattr(row, name) for row in rows] for name in SCHEMA.names}
    hard = {name: [row.covariates.get(name) for row in rows] for name in covariates}
    schema = pa.schema([*SCHEMA, *((name, pa.float64()) for name in covariates)])
    return pa.Table.from_pydict({**own, **hard}, schema=schema)
