"""Files of users as modules, each under a name that says where it lies: any process can import it by that name alone.

So what a planner hands to its own processes finds its functions there. This module is a package without a folder; who
imports a module of it has imported this file, which finds it.
"""

import os
import sys
from collections.abc import Sequence
from importlib.abc import MetaPathFinder
from importlib.machinery import ModuleSpec, SourceFileLoader
from pathlib import Path
from types import ModuleType
from urllib.parse import quote, unquote_to_bytes

__path__: list[str] = []


def module_name(file: Path) -> str:
    """The name of the module of a file; its only dots are those before it."""
    return f"{__name__}.{quote(os.fsencode(file), safe='').replace('.', '%2E')}"


def is_file(module: str) -> bool:
    """Whether a module is a file of a user's, by its name."""
    return module.startswith(f"{__name__}.")


class _Alone(ModuleSpec):
    """Of a file without neighbours: `from . import` is refused."""

    @property
    def parent(self) -> str:
        """None."""
        return ""


class _Finder(MetaPathFinder):
    """Finds a file by its name."""

    def find_spec(
        self, fullname: str, _path: Sequence[str] | None = None, _target: ModuleType | None = None
    ) -> ModuleSpec | None:
        """Where it is, there or not."""
        if not is_file(fullname):
            return None
        file = os.fsdecode(unquote_to_bytes(fullname.removeprefix(f"{__name__}.")))
        spec = _Alone(fullname, SourceFileLoader(fullname, file), origin=file)
        spec.has_location = True
        return spec


sys.meta_path.append(_Finder())
