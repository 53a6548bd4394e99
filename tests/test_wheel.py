"""What an installation adds: one package and one command."""

import tomllib
from importlib.metadata import PackageNotFoundError, files
from pathlib import Path
from typing import Any

import fogbench

CHECKOUT = Path(__file__).parents[1]

PROJECT: dict[str, Any] = tomllib.loads((CHECKOUT / "pyproject.toml").read_text("utf-8"))

DATA = {"scenarios": "**/*.yaml", "learned": "recipes/*.yaml", "learned/checkpoints": "*", "fogbench": "*.pyi"}
"""What is no code, by its folder in the checkout."""


def installed() -> set[str] | None:
    """The files of the installation that is tested, but for what Python makes of them; None in a checkout."""
    try:
        found = files("fogbench") or []
    except PackageNotFoundError:
        return None
    if Path(fogbench.__file__) not in {Path(str(file.locate())) for file in found}:
        return None
    return {str(file) for file in found if file.suffix != ".pyc"}


def told() -> set[str]:
    """The files that `pyproject.toml` says an installation has, as setuptools reads it."""
    setuptools = PROJECT["tool"]["setuptools"]
    folders, found = setuptools["package-dir"], set()
    for package in setuptools["packages"]:
        top, _, below = package.removeprefix("fogbench.").partition(".")
        folder = CHECKOUT / folders.get(f"fogbench.{top}", top) / below.replace(".", "/")
        for pattern in ("*.py", *setuptools["package-data"].get(package, ())):
            inside = [path for path in folder.glob(pattern) if path.is_file()]
            found |= {f"{package.replace('.', '/')}/{path.relative_to(folder)}" for path in inside}
    return found


def wanted() -> set[str]:
    """All that stands in the folders of the project, timings apart."""
    code = [path for name in ("worlds", "planners", "learned", "bench") for path in (CHECKOUT / name).rglob("*.py")]
    data = [path for folder, pattern in DATA.items() for path in (CHECKOUT / folder).glob(pattern)]
    inside = {str(path.relative_to(CHECKOUT)) for path in [*code, *data] if "timing" not in path.parts}
    face = {f"fogbench/{name}" for name in ("__init__.py", "__init__.pyi", "__main__.py", "py.typed")}
    return face | {f"fogbench/{name}" for name in inside if not name.startswith("fogbench/")}


def test_all_that_is_needed_is_shipped() -> None:
    """Every module of every folder, checkpoints, recipes, scenarios, and the types of the face."""
    shipped = installed() or told()
    assert {name for name in shipped if name.startswith("fogbench/")} == wanted()


def test_one_package_and_one_command_are_added() -> None:
    """Nothing else has a place at the top."""
    assert PROJECT["project"]["scripts"] == {"fogbench": "fogbench.bench.command:main"}
    assert {name.partition(".")[0] for name in PROJECT["tool"]["setuptools"]["packages"]} == {"fogbench"}
    tops = {name.partition("/")[0] for name in installed() or told() if not name.endswith("/bin/fogbench")}
    assert {top.removesuffix(".dist-info").partition("-")[0] for top in tops} == {"fogbench"}
