"""Which files settings name."""

from pathlib import Path

import pytest

from fogbench.bench.reading.named_files import named_files
from fogbench.worlds.settings import Settings


class Nested(Settings):
    """A block in a block."""

    list: tuple[str, ...] = ()
    tree: tuple[tuple[str, Path], ...] = ()


class Named(Settings):
    """Settings that name files in all sorts of ways."""

    weights: str = ""
    extra: Path | None = None
    more: Nested = Nested()
    number: int = 3


def test_files_are_found_wherever_a_class_may_look(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Beside the page, where the user stands, by whole paths; in lists and blocks; each once."""
    page, here = tmp_path / "page", tmp_path / "here"
    for folder in (page, here):
        folder.mkdir()
        (folder / "gru.pt").write_text(folder.name)
    (page / "a.txt").touch()
    (here / "b.txt").touch()
    monkeypatch.chdir(here)
    more = Nested(list=("a.txt", "gru.pt"), tree=(("b", Path("b.txt")),))
    found = named_files(Named(weights="gru.pt", extra=here / "b.txt", more=more), page)
    assert set(found) == {page / "gru.pt", here / "gru.pt", page / "a.txt", here / "b.txt"}
    assert len(found) == 4


@pytest.mark.parametrize("text", ["", ".", "nowhere.pt", "x" * 5000, "a\0b", "\udcff", "/"])
def test_a_text_that_is_no_file_names_none(text: str, tmp_path: Path) -> None:
    """Folders, long texts, and what no path can hold."""
    assert named_files(Named(weights=text), tmp_path) == ()


def test_a_file_beside_the_class_counts(tmp_path: Path) -> None:
    """As a plug-in finds its weights by its own `__file__`."""
    assert named_files(Named(weights=Path(__file__).name), tmp_path) == (Path(__file__),)
