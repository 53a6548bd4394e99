"""From a recorded row to a verified picture."""

import os
from collections.abc import Generator
from pathlib import Path
from typing import Any

import numpy as np

from bench.drawing import film, known, strip, truth
from bench.playing import store
from bench.playing.replay import End, Moment, retrace, verify
from bench.reading.scenario import Scenario, Variant
from worlds.mistake import Mistake
from worlds.types import Array, Outcome

READS = ("variant", "agent", "episode", "outcome", "steps", "length", "shortest", "actions", "detail")
"""The columns of `bench.playing.episode.Episode` that a replay needs."""

PANELS, FRAMES = 5, 300
"""Moments in a strip, and the most in a film."""

Picture = tuple[Array, Array, int]
"""The truth, the known map, the step."""


def replay_recorded(
    scenario: Scenario, variant_name: str | None, agent: str, episode: int, folder: Path, out: Path
) -> str:
    """Replay one recorded episode, verify it, and draw it into `out` (`.png` or `.gif`).

    Returns:
        What was seen, in two lines.

    Raises:
        Mistake: there is no such episode, it does not replay as recorded, or `out` cannot be drawn.
    """
    kind = _kind(out)
    variant = _variant(scenario, variant_name)
    row = _row(scenario, variant, agent, episode, folder)
    most = PANELS if kind == ".png" else FRAMES
    steps = {round(step) for step in np.linspace(0, row["steps"], min(most, row["steps"] + 1)).tolist()}
    drawn, end = _pictures(retrace(variant, episode, row["actions"]), steps)
    verify(row, end)
    told = f"{agent} in {variant.name}, episode {episode}: {row['steps']} steps, optimum {row['shortest']:g}."
    if kind == ".png":
        strip(drawn, told, out)
    else:
        film(drawn, out)
    checked = "It ends as recorded" if row["steps"] else "Nothing was recorded to verify"
    return f"{told} {Outcome[row['outcome']].value} {row['detail']}\n{checked}. Drawn in {out}"


def _kind(out: Path) -> str:
    """`.png` or `.gif`, if such a file can be written."""
    if out.suffix.lower() not in (".png", ".gif"):
        raise Mistake(f"--out: got {out}; expected a name that ends in .png or .gif.")
    if out.is_dir() or not os.access(out if out.exists() else out.parent, os.W_OK):
        raise Mistake(f"--out: got {out}; expected a file in a folder that can be written.")
    return out.suffix.lower()


def _variant(scenario: Scenario, name: str | None) -> Variant:
    if scenario.skipped:
        raise Mistake(f"{scenario.name}: skipped, {scenario.skipped}.")
    for variant in scenario.variants:
        if name in (None, variant.name):
            return variant
    raise Mistake(f"--variant: got {name}; expected one of {', '.join(each.name for each in scenario.variants)}.")


def _row(scenario: Scenario, variant: Variant, agent: str, episode: int, folder: Path) -> dict[str, Any]:
    rows = store.read(folder, scenario, READS)
    rows = rows[rows["variant"] == variant.name]
    found = rows[(rows["agent"] == agent) & (rows["episode"] == episode)]
    if len(found):
        return {str(name): value for name, value in found.iloc[0].items()}
    labels = [entry.label for entry in variant.agents if not entry.skipped]
    if agent not in labels:
        raise Mistake(f"--agent: got {agent}; expected one of {', '.join(labels)}.")
    count = store.stale(folder, scenario).get((variant.name, agent))
    raise Mistake(
        f"--episode: got {episode}; expected one of the {(rows['agent'] == agent).sum()} that are recorded of {agent} "
        f"in {variant.name}."
        + (f" {store.STALE.format(count=count, agent=agent, variant=variant.name)}" if count else "")
    )


def _pictures(moments: Generator[Moment, None, End], steps: set[int]) -> tuple[list[Picture], End]:
    """The pictures of the chosen steps, and the end."""
    drawn: list[Picture] = []
    step = 0
    while True:
        try:
            moment = next(moments)
        except StopIteration as stop:
            return drawn, stop.value
        if step in steps:
            drawn.append((truth(moment), known(moment), step))
        step += 1
