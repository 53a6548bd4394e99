"""From a recorded row to a verified picture."""

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


def replay_recorded(
    scenario: Scenario, variant_name: str | None, agent: str, episode: int, folder: Path, out: Path
) -> str:
    """Replay one recorded episode, verify it, and draw it into `out` (`.png` or `.gif`).

    Returns:
        What was seen, in two lines.

    Raises:
        Mistake: there is no such episode, it does not replay as recorded, or `out` is of another type.
    """
    if out.suffix not in (".png", ".gif"):
        raise Mistake(f"--out: got {out}; expected a name that ends in .png or .gif.")
    variant = _variant(scenario, variant_name)
    row = _row(scenario, variant, agent, episode, folder)
    count_of = PANELS if out.suffix == ".png" else FRAMES
    steps = {round(step) for step in np.linspace(0, row["steps"], min(count_of, row["steps"] + 1)).tolist()}
    drawn, end = _pictures(retrace(variant, episode, row["actions"]), steps)
    verify(row, end)
    told = f"{agent} in {variant.name}, episode {episode}: {row['steps']} steps, optimum {row['shortest']:g}."
    if out.suffix == ".png":
        strip(drawn, told, out)
    else:
        film(drawn, out)
    return f"{told} {Outcome[row['outcome']].value} {row['detail']}\nIt ends as recorded. Drawn in {out}"


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
    raise Mistake(
        f"--episode: got {episode}; expected one of the {(rows['agent'] == agent).sum()} that are recorded of {agent} "
        f"in {variant.name}."
    )


Picture = tuple[Array, Array, int]
"""The truth, the known map, the step."""


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
