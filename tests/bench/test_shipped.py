"""Where scenarios are found."""

from pathlib import Path

import pytest

from bench.shipped import find, folder
from worlds.mistake import Mistake


@pytest.fixture
def mine(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    """A scenario of a user, in the folder where he stands."""
    monkeypatch.chdir(tmp_path)
    (tmp_path / "mine.yaml").touch()
    return tmp_path / "mine.yaml"


def test_a_file_named_twice_is_found_once(mine: Path) -> None:
    """Under the path that stands first."""
    assert find(["mine.yaml", str(mine), "."]) == [Path("mine.yaml")]
    assert find([str(mine), "mine.yaml"]) == [mine]


def test_shipped_files_go_by_their_stems() -> None:
    """Without a name, all of them are meant."""
    assert find(["grid"]) == [folder() / "paper" / "grid.yaml"]
    assert find(None) == find([]) == sorted(folder().rglob("*.yaml"))


@pytest.mark.parametrize(("name", "near"), [("mine", "mine.yaml"), ("gird", "grid")])
@pytest.mark.usefixtures("mine")
def test_a_name_of_nothing_is_told_with_the_nearest(name: str, near: str) -> None:
    """A file of that stem where the user stands, else the shipped one that is most like it."""
    with pytest.raises(Mistake) as error:
        find([name])
    shipped = ", ".join(path.stem for path in sorted(folder().rglob("*.yaml")))
    assert str(error.value) == (
        f"{name}: got no such file; expected a scenario file, a folder of them, or one of {shipped}. "
        f"Did you mean {near}?"
    )
