"""What a class uses: found by its imports, counted by contents or by version."""

import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from fogbench.bench.playing import closure as closures
from fogbench.bench.playing import sources
from fogbench.bench.playing.closure import Closure, closure
from fogbench.planners.astar import AStar
from fogbench.planners.random_walk import RandomWalk

Shelf = Callable[..., Path]


@pytest.fixture
def shelf(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Shelf]:
    """Writes files into a folder from which modules can be imported; whatever was read before is forgotten."""

    def shelf(files: dict[str, str], folder: str = "shelf") -> Path:
        for name, text in files.items():
            (tmp_path / folder / name).parent.mkdir(parents=True, exist_ok=True)
            (tmp_path / folder / name).write_text(text)
        monkeypatch.syspath_prepend(tmp_path / folder)
        forget()
        return tmp_path / folder

    yield shelf
    forget()


def forget() -> None:
    """Have all files looked for and read again."""
    for kept in (sources.read_source, closures._find, closures._closure):
        kept.cache_clear()


def names(found: Closure) -> set[str]:
    """What counts by its contents."""
    return {name for name, _ in found.contents}


def own(found: Closure) -> set[str]:
    """What counts by its contents and is none of the project's."""
    return {name for name in names(found) if not name.startswith("fogbench.")}


def test_a_planner_of_ours_uses_what_it_imports() -> None:
    """Files above and below it, no table, no standard library, and packages by their names."""
    found = closure(RandomWalk)
    assert names(found) == {
        f"fogbench.{name}" for name in ("planners.random_walk", "worlds.mistake", "worlds.settings", "worlds.types")
    }
    assert found.packages == {"numpy", "pydantic"}
    assert {"fogbench.planners.route", "fogbench.worlds.kernel"} < names(closure(AStar))
    assert closure(RandomWalk, AStar) == closure(AStar, "fogbench.planners.random_walk:RandomWalk")


def test_names_of_the_face_stand_for_their_modules(shelf: Shelf) -> None:
    """Those that are taken; all of them where the face itself is imported."""
    shelf({
        "face_a.py": "from fogbench import Move, search as find\n",
        "face_b.py": "import fogbench\n",
        "face_c.py": "from fogbench.worlds.types import Move\nfrom fogbench.planners.astar import search\n",
        "face_d.py": "from fogbench import planners\n",
    })  # fmt: skip
    taken = names(closure("face_a"))
    assert taken == names(closure("face_c"))
    assert "fogbench.planners.astar" in taken
    assert "fogbench.worlds.maps.layout" not in taken
    assert "fogbench.worlds.maps.layout" in names(closure("face_b"))
    assert names(closure("face_d")) == {""}


def test_imports_are_followed_in_all_their_forms(shelf: Shelf) -> None:
    """Submodules, attributes, relative ones, the packages around, and a module that imports itself in a circle."""
    shelf({
        "pack_a/__init__.py": "from pack_a.top import thing\n",
        "pack_a/top.py": "thing = 1\n",
        "pack_a/start.py": "from . import left, LATER\nfrom .room.deep import x\nfrom .. import beyond\n",
        "pack_a/left.py": "import pack_b.inner as i\nimport pack_a.start\n",
        "pack_a/aside.py": "",
        "pack_a/room/__init__.py": "",
        "pack_a/room/deep.py": "def f():\n    from ..right import *\n",
        "pack_a/right.py": "from spread.part import y\n",
        "pack_b/__init__.py": "",
        "pack_b/inner.py": "",
        "spread/part.py": "y = 1\n",
    })  # fmt: skip
    assert own(closure("pack_a.start:Planner")) == {
        *("pack_a", "pack_a.top", "pack_a.start", "pack_a.left", "pack_a.room", "pack_a.room.deep", "pack_a.right"),
        *("pack_b", "pack_b.inner", "spread", "spread.part"),
    }
    assert not {"pack_a.start", "pack_b"} & sys.modules.keys()


def test_a_stub_says_where_the_names_of_a_users_package_come_from(shelf: Shelf) -> None:
    """As the project's own does."""
    shelf({
        "lazy_a/__init__.py": "import lazy_loader\n",
        "lazy_a/__init__.pyi": "from .one import One as One\nfrom .two import Two as Two\n",
        "lazy_a/one.py": "",
        "lazy_a/two.py": "",
        "use_lazy.py": "from lazy_a import Two\n",
    })  # fmt: skip
    assert own(closure("use_lazy")) == {"", "lazy_a", "lazy_a.two"}


def test_installed_packages_count_by_name(shelf: Shelf) -> None:
    """Whatever is in them, and whatever they import; so does what is nowhere, and nothing of the standard library."""
    shelf({"lamp_a/__init__.py": "import pack_c", "lamp_a/bulb.py": ""}, "lib/site-packages")
    shelf({"pack_c.py": "", "use_lamp.py": "from lamp_a.bulb import on\nimport nowhere_a.deep\nimport json, os.path\n"})
    found = closure("use_lamp")
    assert own(found) == {""}
    assert found.packages == {"lamp_a", "nowhere_a"}


def test_the_package_of_a_plug_in_counts_by_its_contents_though_it_is_installed(shelf: Shelf) -> None:
    """What it imports of other installed packages does not."""
    lamp = {"lamp_b/__init__.py": "VERSION = 1\n", "lamp_b/plan.py": "import lamp_c\nfrom . import on\n"}
    folder = shelf({**lamp, "lamp_b/on.py": "", "lamp_c.py": ""}, "lib/site-packages")
    found = closure("lamp_b.plan:Planner")
    assert own(found) == {"lamp_b", "lamp_b.plan", "lamp_b.on"}
    assert found.packages == {"lamp_c"}
    for name, changes in (("lamp_b/__init__.py", True), ("lamp_b/on.py", True), ("lamp_c.py", False)):
        shelf({name: "CHANGED = 1\n"}, "lib/site-packages")
        assert (closure("lamp_b.plan:Planner") != found) == changes
        shelf({**lamp, "lamp_b/on.py": "", "lamp_c.py": ""}, "lib/site-packages")
    assert folder.exists()


def test_what_a_class_derives_from_counts_though_no_import_says_so(shelf: Shelf) -> None:
    """Its module is known from the class; one that has no file counts by its name."""
    shelf({"base_a.py": "class Base: pass\n"})
    made = type("Made", (__import__("base_a").Base,), {"__module__": "made_up_elsewhere"})
    found = closure(made)
    assert own(found) == {"", "base_a"}
    assert dict(found.contents)["base_a"] != dict(found.contents)[""] == ""


def test_a_users_folder_may_be_named_as_a_standard_module(shelf: Shelf) -> None:
    """A plug-in's own package is its own under any name."""
    shelf({
        "antigravity/__init__.py": "",
        "antigravity/plan.py": "from antigravity import fly",
        "antigravity/fly.py": "",
    })  # fmt: skip
    assert own(closure("antigravity.plan:Planner")) == {"antigravity", "antigravity.plan", "antigravity.fly"}
