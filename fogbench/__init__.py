"""The public face: what plug-ins, notebooks and scripts need, by one name. A thing is imported when it is asked for.

`fogbench/__init__.pyi` lists the names, for people and for type checkers.
"""

from pathlib import Path

import lazy_loader

if not Path(__file__).with_name("worlds").exists():  # in a checkout the packages lie beside this folder
    __path__.append(str(Path(__file__).parents[1]))

__getattr__, __dir__, __all__ = lazy_loader.attach_stub(__name__, __file__)
