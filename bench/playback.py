"""From a recorded row to a verified picture."""

import os
from collections.abc import Generator
from pathlib import Path

import numpy as np

from fogbench.bench.drawing import Colour, key, known, truth
from fogbench.bench.film import Frame, film, strip
from fogbench.bench.playing.provenance import differences
from fogbench.bench.playing.replay import End, Moment, retrace, verify
from fogbench.bench.playing.selection import chosen_row, chosen_variant
from fogbench.bench.reading.scenario import Scenario
from fogbench.bench.reporting.plain import plain
from fogbench.worlds.mistake import Mistake, counted
from fogbench.worlds.types import Outcome

PANELS, FRAMES = 5, 300
"""Moments in a strip, and the most in a film."""


def replay_recorded(
    scenario: Scenario, variant_name: str | None, agent: str, episode: int, folder: Path, out: Path
) -> str:
    """Replay one recorded episode, verify it, and draw it into `out` (`.png` or `.gif`).

    Returns:
        What was seen, in two lines, and how the packages differ from those that it was played with, if they do.

    Raises:
        Mistake: there is no such episode, it does not replay as recorded, or `out` cannot be drawn.
    """
    kind = _kind(out)
    variant = chosen_variant(scenario, variant_name)
    row = chosen_row(scenario, variant, agent, episode, folder)
    most = PANELS if kind == ".png" else FRAMES
    steps = {round(step) for step in np.linspace(0, row["steps"], min(most, row["steps"] + 1)).tolist()}
    try:
        drawn, names, end = _pictures(retrace(variant, row), steps)
    except Exception as error:
        told = f"got {type(error).__name__}: {error}; expected a world that can be drawn"
        raise Mistake(f"{agent} in variant {variant.name}, episode {episode}: {told}.") from error
    verify(row, end)
    way = f"{counted(row['steps'], 'step')}, optimum {row['shortest']:g}"
    told = f"{agent} in variant {variant.name}, episode {episode}: {way}. {Outcome[row['outcome']].value}"
    if kind == ".png":
        strip(drawn, names, told, out)
    else:
        film(drawn, names, out)
    checked = "It ends as recorded" if row["steps"] else "Nothing was recorded to verify"
    lines = f"{told} {row['detail']}", f"{checked}. Drawn in {out}"
    return "\n".join(filter(None, [*map(plain, lines), differences(folder, scenario)]))


def _kind(out: Path) -> str:
    """`.png` or `.gif`, if such a file can be written."""
    if out.suffix.lower() not in (".png", ".gif"):
        raise Mistake(f"--out: got {out}; expected a name that ends in .png or .gif.")
    if out.is_dir() or not os.access(out if out.exists() else out.parent, os.W_OK):
        raise Mistake(f"--out: got {out}; expected a file in a folder that can be written.")
    return out.suffix.lower()


def _pictures(moments: Generator[Moment, None, End], steps: set[int]) -> tuple[list[Frame], dict[str, Colour], End]:
    """The pictures of the chosen steps, what their colours stand for, and the end."""
    drawn, names = list[Frame](), dict[str, Colour]()
    step = 0
    while True:
        try:
            moment = next(moments)
        except StopIteration as stop:
            return drawn, names, stop.value
        if step in steps:
            picture = moment.picture()
            drawn.append((truth(picture), known(picture), step))
            names |= key(picture)
        step += 1
