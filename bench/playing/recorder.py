"""Writing into the store of a scenario: rows as they come, in parts that are whole, by one process at a time."""

from collections.abc import Iterator, Sequence
from contextlib import ExitStack, contextmanager
from itertools import chain
from pathlib import Path
from time import monotonic

from fogbench.bench.playing.episode import SCHEMA, Episode, table
from fogbench.bench.playing.store import CURRENT, OUTDATED, new_part, unwritable, write_table
from fogbench.worlds import files
from fogbench.worlds.mistake import Mistake

ROWS = 500
"""Rows that are held back at most."""

PAUSE, SHARE = 1.0, 0.01
"""Rows are held back for this many seconds at most, or for this share of a long run's time, so that parts stay few."""


class Recorder:
    """Appends episodes to a store. A part is written whole or not at all; only what sorts rows touches it again."""

    def __init__(self, folder: Path, covariates: Sequence[str]) -> None:
        """`folder` is that of the store."""
        self.covariates = covariates
        self.folder = folder
        self.rows: list[Episode] = []
        self.began = self.written = monotonic()

    def append(self, row: Episode) -> None:
        """Take one more row."""
        self.rows.append(row)
        if len(self.rows) >= ROWS:
            self.flush()
        else:
            self.flush_if_due()

    def flush_if_due(self) -> None:
        """Write what was held back for long enough."""
        now = monotonic()
        if now - self.written > max(PAUSE, SHARE * (now - self.began)):
            self.flush()

    def flush(self) -> None:
        """Write what is held back."""
        if self.rows:
            write_table(new_part(self.folder), table(self.rows, self.covariates))
            self.rows = []  # Ctrl-C before this leaves the rows twice, and `read` takes them once
            self.written = monotonic()


@contextmanager
def recording(folder: Path, covariates: Sequence[str]) -> Iterator[Recorder]:
    """Open a store for writing, alone; what killed runs left half written is removed.

    Args:
        folder: of the store.
        covariates: of all kinds of world that will be recorded; they are columns of every part.

    Raises:
        Mistake: another run has it open, or a covariate has the name of a column.
        StoreError: it cannot be written.
    """
    if taken := sorted(set(covariates) & set(SCHEMA.names)):
        raise Mistake(f"covariates: got {', '.join(taken)}; expected names that no column has.")
    with ExitStack() as held:
        try:
            held.enter_context(files.alone(folder, "run"))
            for which in (CURRENT, OUTDATED):
                (folder / which).mkdir(exist_ok=True)
        except OSError as error:
            raise unwritable(folder, error) from None
        for leftover in chain.from_iterable((folder / which).glob(".*.parquet") for which in (CURRENT, OUTDATED)):
            leftover.unlink()
        recorder = Recorder(folder, covariates)
        try:
            yield recorder
        finally:
            recorder.flush()
