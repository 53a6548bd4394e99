"""The store of a scenario: `run.json` and `episodes/*.parquet` in one folder.

`pandas.read_parquet("results/grid/episodes")` reads it anywhere. Here only the rows count whose keys are those of the
scenario as it is now, under the versions of packages that one asks for: what was played under other settings stays on
the disk and enters nothing.
"""

from collections.abc import Iterator, Sequence
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from fogbench.bench.playing.episode import LATER, SCHEMA
from fogbench.bench.playing.keys import Versions, agent_key, world_key
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds import files
from fogbench.worlds.mistake import Mistake

WHO = ["variant", "agent", "episode"]
"""The columns that tell one row of a scenario from another."""

KEYS = ["variant", "agent", "agent_key", "world_key"]

pa.set_memory_pool(pa.system_memory_pool())  # Arrow's own pool keeps what is freed

LISTS = {kind: pd.ArrowDtype(kind) for kind in SCHEMA.types if pa.types.is_list(kind)}
"""Lists stay as they are stored: an object for each would take twice the memory."""

STALE = (
    "{count} recorded episodes of {agent} in {variant} do not count any more: its settings, sources or packages have "
    "changed; `fogbench run` plays them again."
)
"""What a user is told of `stale` episodes."""


class StoreError(Mistake):
    """A store that cannot be read or written; its text is one line `file: got ...; expected ...`."""


def read(folder: Path, scenario: Scenario, columns: Sequence[str], versions: Versions | None = None) -> pd.DataFrame:
    """The recorded episodes of a scenario as it is now, in its order: one row per variant, agent and episode.

    Args:
        folder: of the store.
        scenario: what was played.
        columns: of the rows.
        versions: of packages; None: those that are installed here.

    Raises:
        StoreError: a file is broken.
    """
    return _read(folder, _current(scenario, versions), columns)


def _read(folder: Path, current: pd.DataFrame, columns: Sequence[str]) -> pd.DataFrame:
    kept = list(dict.fromkeys([*WHO, *columns]))
    rows: pd.DataFrame = pd.concat(
        [_rows(table, current, kept) for table in (SCHEMA.empty_table(), *_load_all(folder, kept))], ignore_index=True
    )
    order = rows[[*WHO, "place"]].drop_duplicates(WHO).sort_values(["place", "episode"]).index
    return rows.loc[order, list(columns)].reset_index(drop=True)  # long rows are copied only once


def _rows(table: pa.Table, current: pd.DataFrame, columns: list[str]) -> pd.DataFrame:
    """Those rows of a part that agree with `current` on the columns of both, without those that said so."""
    frame = table.to_pandas(types_mapper=LISTS.get).merge(current)
    wanted: pd.DataFrame = frame.loc[frame["episode"] < frame["wanted"], [*columns, "place"]]
    return wanted


def _load_all(folder: Path, columns: list[str]) -> Iterator[pa.Table]:
    for part in parts(folder):
        yield _load(part, list(dict.fromkeys([*columns, *KEYS])))


def recorded(folder: Path, scenario: Scenario) -> dict[tuple[str, str], set[int]]:
    """The recorded episodes of each variant and agent, by both names; pairs without any are left out.

    Raises:
        StoreError: a file is broken.
    """
    return _episodes(read(folder, scenario, WHO))


def stale(folder: Path, scenario: Scenario, versions: Versions | None = None) -> dict[tuple[str, str], int]:
    """How many episodes of each variant and agent are recorded under other keys alone; pairs without any are left out.

    Raises:
        StoreError: a file is broken.
    """
    keys = _current(scenario, versions)
    current = _episodes(_read(folder, keys, WHO))
    ever = _episodes(_read(folder, keys.drop(columns=["agent_key", "world_key"]), WHO))
    counts = {pair: len(episodes - current.get(pair, set())) for pair, episodes in ever.items()}
    return {pair: count for pair, count in counts.items() if count}


def _episodes(rows: pd.DataFrame) -> dict[tuple[str, str], set[int]]:
    return {(str(v), str(a)): set(group) for (v, a), group in rows.groupby(WHO[:2], sort=False)["episode"]}


def _current(scenario: Scenario, versions: Versions | None) -> pd.DataFrame:
    """The keys of each variant and agent that runs, its place in the scenario, and how many episodes are wanted."""
    rows = [
        (variant.name, entry.label, agent_key(entry, versions), world_key(variant, versions), variant.episodes)
        for variant in scenario.variants
        for entry in variant.agents
        if not entry.skipped
    ]
    return pd.DataFrame(rows, columns=[*KEYS, "wanted"]).rename_axis("place").reset_index()


def parts(folder: Path) -> list[Path]:
    """The files of a store, oldest first."""
    return sorted((folder / "episodes").glob("[!.]*.parquet"))


def _load(part: Path, columns: list[str]) -> pa.Table:
    try:
        with pq.ParquetFile(part) as file:
            there = file.schema_arrow
            lacking = [name for name in columns if name not in there.names or there.field(name) != SCHEMA.field(name)]
            if set(lacking) - LATER:
                raise StoreError(f"{part}: got the columns of another version; expected those of this one.")
            table = file.read([name for name in columns if name not in lacking])
            for name in lacking:
                table = table.append_column(SCHEMA.field(name), pa.nulls(len(table), SCHEMA.field(name).type))
            return table
    except (pa.ArrowException, OSError) as error:
        reason = str(error).splitlines()[0]
        raise StoreError(f"{part}: got a broken file ({reason}); expected a Parquet file of episodes.") from None


def write(path: Path, content: bytes | pa.Buffer) -> None:
    """Write a whole file or none.

    Raises:
        StoreError: it cannot be written.
    """
    try:
        files.write(path, memoryview(content))
    except OSError as error:
        raise unwritable(path, error) from None


def unwritable(path: Path, error: OSError) -> StoreError:
    """What is told of a place that cannot be written."""
    return StoreError(f"{path}: got {error.strerror}; expected a place that can be written.")
