"""Where the scenarios are: those that come with the project, and those a user names."""

from collections.abc import Iterable
from pathlib import Path

import typer

from fogbench import learned
from fogbench.worlds.mistake import Mistake, encodable, meant, near, one_of

RECIPES, CHECKPOINTS = map(Path(learned.__file__).with_name, ("recipes", "checkpoints"))
"""Where the recipes and the trained weights are that go by a name alone."""


def folder() -> Path:
    """The folder of the shipped scenarios, installed or in a checkout."""
    return Path(__file__).parents[1] / "scenarios"


def find(names: list[str] | None) -> list[Path]:
    """The scenario files that `names` stand for, each once, under the path it is first named by.

    Args:
        names: files, folders (all scenarios below), or stems of shipped files; None or empty: all that are shipped.

    Raises:
        Mistake: all the names that stand for nothing, each with the nearest.
    """
    found, lines = dict[Path, Path](), list[str]()
    for name in names or [str(folder())]:
        try:
            for path in _find_one(name):
                found.setdefault(path.resolve(), Path(encodable(str(path))))
        except Mistake as mistake:
            lines.append(str(mistake))
    if lines:
        raise Mistake("\n".join(lines))
    return list(found.values())


def recipes() -> dict[str, Path]:
    """The shipped recipes by their names."""
    return {file.stem: file for file in sorted(RECIPES.glob("*.yaml"))}


def checkpoints() -> dict[str, Path]:
    """The cards of the shipped checkpoints by their names."""
    return {file.stem: file for file in sorted(CHECKPOINTS.glob("*.json"))}


def find_recipe(name: str) -> Path:
    """The recipe file that a name stands for.

    Raises:
        Mistake: it stands for nothing; the nearest shipped one is told.
    """
    shipped = recipes()
    path = shipped.get(name, Path(name)) if not Path(name).is_file() else Path(name)
    if path.is_file():
        return path
    raise _missing(name, "a recipe file", shipped)


def _pages(place: Path) -> list[Path]:
    """The YAML files in a folder and below it; what is hidden, and what lies in hidden folders, is not looked at."""
    files = (file for file in place.rglob("*") if file.suffix in {".yaml", ".yml"} and file.is_file())
    return sorted(file for file in files if not any(part.startswith(".") for part in file.relative_to(place).parts))


def _is_passed_over(file: Path) -> bool:
    """Whether a file of a folder is plainly no scenario, which is told."""
    from fogbench.bench.reading.sorts import other_sort  # noqa: PLC0415  listing what is shipped reads nothing

    sort = other_sort(file)
    if sort:
        typer.echo(f"{file} is passed over: it seems to be {sort}.", err=True)
    return bool(sort)


def _find_one(name: str) -> list[Path]:
    path = Path(name)
    if path.is_file():
        return [path]
    if path.is_dir():
        inside = [file for file in _pages(path) if folder() in file.parents or not _is_passed_over(file)]
        if not inside:
            raise Mistake(f"{name}: got a folder without scenarios; expected *.yaml or *.yml files in it or below it.")
        return inside
    shipped = {file.stem: file for file in sorted(folder().rglob("*.yaml"))}
    if name in shipped:
        return [shipped[name]]
    raise _missing(name, "a scenario file, a folder of them", shipped)


def _missing(name: str, expected: str, shipped: Iterable[str]) -> Mistake:
    """There is no such file; the nearest name is told first, since those that ship are many."""
    own = {file.stem: str(file) for file in _beside(Path(name))}
    likely = near(Path(name).stem, [*own, *shipped])
    return Mistake(f"{name}: no such file.{meant(own.get(likely, likely))} Give {expected}, or {one_of(shipped)}.")


def _beside(path: Path) -> list[Path]:
    """The YAML files in the folder of a path, if it can be read."""
    try:
        return sorted(path.parent.glob("*.y*ml"))
    except OSError:
        return []
