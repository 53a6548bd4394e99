"""The public face: what plug-ins, notebooks and scripts need, by one name.

`from fogbench import Settings, Move, KnownMap` is all that a planner asks for. A thing is imported when it is first
named, so that `import fogbench` loads none of them, nor NumPy.

The names stand in `fogbench/__init__.pyi`, which type checkers read too; `docs/extending.md` has a word on each.
"""

from pathlib import Path

import lazy_loader

if not Path(__file__).with_name("worlds").exists():  # in a checkout the packages lie beside this folder
    __path__.append(str(Path(__file__).parents[1]))

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
