"""Where the first crash of each agent came from: tracebacks, kept beside the results."""

import re
from pathlib import Path

from fogbench.bench.playing.episode import Played
from fogbench.bench.playing.store import write
from fogbench.worlds.streams import digest

FOLDER = "crashes"


class Crashes:
    """The first crashes of a run."""

    def __init__(self, folder: Path) -> None:
        """`folder` is that of the store."""
        self.folder, self.agents = folder / FOLDER, set[str]()

    def note(self, played: Played) -> None:
        """Write down where an agent crashed, if it did for the first time.

        Raises:
            StoreError: it cannot be written.
        """
        row = played.row
        if played.traceback and row.agent not in self.agents:
            self.agents.add(row.agent)
            self.folder.mkdir(exist_ok=True)
            text = f"{row.variant}, episode {row.episode}, {row.agent}\n\n{played.traceback}"
            write(self.folder / crash_file(row.agent), text.encode())


def crash_file(label: str) -> str:
    """The name of the file for an agent; no two labels have the same."""
    plain = re.sub(r"[^\w.,-]+", "-", label)[:80]
    return f"{plain if plain == label else f'{plain}-{digest(label)[:8]}'}.txt"
