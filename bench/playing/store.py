"""The store of a scenario: `run.json`, `episodes/*.parquet` and `outdated/*.parquet` in one folder.

`pandas.read_parquet("results/grid/episodes")` reads it anywhere. Only the rows count whose keys are those of the
scenario as it is now, under the versions of packages that one asks for. A run moves all others to `outdated/`, which
enters nothing, and takes back those whose keys hold again: see `fogbench.bench.playing.outdated`.
"""

from collections.abc import Iterable, Sequence
from pathlib import Path

import pandas as pd
import pyarrow as pa
import pyarrow.parquet as pq

from fogbench.bench.playing.agenda import outcomes
from fogbench.bench.playing.episode import LATER, SCHEMA
from fogbench.bench.playing.keys import Versions, keys
from fogbench.bench.reading.scenario import Scenario
from fogbench.worlds import files
from fogbench.worlds.mistake import Mistake

WHO = ["variant", "agent", "episode"]
"""The columns that tell one row of a scenario from another."""

KEYS = ["variant", "agent", "agent_key", "world_key"]

CURRENT, OUTDATED = "episodes", "outdated"
"""The folders of rows that count, and of those that do not any more."""

pa.set_memory_pool(pa.system_memory_pool())  # Arrow's own pool keeps what is freed

LISTS = {kind: pd.ArrowDtype(kind) for kind in SCHEMA.types if pa.types.is_list(kind)}
"""Lists stay as they are stored: an object for each would take twice the memory."""

STALE = (
    "{count} recorded episodes of {agent} in variant {variant} do not count any more: its settings, files, sources "
    "or packages have changed; `fogbench run` plays them again."
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
    return _wanted(_rows(parts(folder), columns), current(scenario, versions), columns)


def _rows(files: Sequence[Path], columns: Sequence[str]) -> pa.Table:
    """All rows of some parts, with what tells whether they count."""
    needed = list(dict.fromkeys([*WHO, *columns, *KEYS]))
    tables = (load(part, needed).select(needed) for part in files)
    return together(tables, needed)


def together(tables: Iterable[pa.Table], columns: list[str]) -> pa.Table:
    """The rows of any number of tables with these columns, even of none."""
    return pa.concat_tables([SCHEMA.empty_table().select(columns), *tables])


def _wanted(table: pa.Table, wanted: pd.DataFrame, columns: Sequence[str]) -> pd.DataFrame:
    """Those rows that agree with `wanted` on the columns of both, once each."""
    rows = table.to_pandas(types_mapper=LISTS.get).merge(wanted)
    told = rows.loc[rows["episode"] < rows["wanted"], [*WHO, "place"]].drop_duplicates(WHO)
    order = told.sort_values(["place", "episode"]).index
    found: pd.DataFrame = rows.loc[order, list(columns)].reset_index(drop=True)  # long rows are copied only here
    return found


def recorded(folder: Path, scenario: Scenario) -> dict[tuple[str, str], dict[int, str]]:
    """How the recorded episodes of each variant and agent ended, by their numbers; pairs without any are left out.

    Raises:
        StoreError: a file is broken.
    """
    pairs = read(folder, scenario, (*WHO, "outcome")).groupby(WHO[:2], sort=False)
    return {(str(variant), str(agent)): outcomes(rows) for (variant, agent), rows in pairs}


def stale(folder: Path, scenario: Scenario, versions: Versions | None = None) -> dict[tuple[str, str], int]:
    """How many episodes of each variant and agent are recorded under other keys alone; pairs without any are left out.

    Raises:
        StoreError: a file is broken.
    """
    wanted, rows = current(scenario, versions), _rows(parts(folder), WHO)
    valid = _episodes(_wanted(rows, wanted, WHO))
    ever = pa.concat_tables([rows, _rows(parts(folder, OUTDATED), WHO)])
    had = _episodes(_wanted(ever, wanted.drop(columns=["agent_key", "world_key"]), WHO))
    counts = {pair: len(episodes - valid.get(pair, set())) for pair, episodes in had.items()}
    return {pair: count for pair, count in counts.items() if count}


def _episodes(rows: pd.DataFrame) -> dict[tuple[str, str], set[int]]:
    return {(str(v), str(a)): set(group) for (v, a), group in rows.groupby(WHO[:2], sort=False)["episode"]}


def current(scenario: Scenario, versions: Versions | None = None) -> pd.DataFrame:
    """The keys of each variant and agent that runs, its place in the scenario, and how many episodes are wanted."""
    wanted = {variant.name: variant.episodes for variant in scenario.variants}
    rows = [(*pair, *both, wanted[pair[0]]) for pair, both in keys(scenario, versions).items()]
    return pd.DataFrame(rows, columns=[*KEYS, "wanted"]).rename_axis("place").reset_index()


def parts(folder: Path, which: str = CURRENT) -> list[Path]:
    """The files of a store, oldest first."""
    return sorted((folder / which).glob("[!.]*.parquet"))


def load(part: Path, columns: list[str]) -> pa.Table:
    """Some columns of a file of a store.

    Raises:
        StoreError: it is broken.
    """
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


def new_part(folder: Path, which: str = CURRENT) -> Path:
    """Where the next file of a store goes."""
    last = max((int(part.stem) for part in parts(folder, which) if part.stem.isdecimal()), default=0)
    return folder / which / f"{last + 1:06}.parquet"


def write_table(path: Path, rows: pa.Table) -> None:
    """Write a file of rows, whole or not at all.

    Raises:
        StoreError: it cannot be written.
    """
    sink = pa.BufferOutputStream()
    pq.write_table(rows, sink)
    write(path, sink.getvalue())


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
