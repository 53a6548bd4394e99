"""What scenarios and recipes have in common: the keys of a page, a map family, a kind of world and its conditions."""

from dataclasses import replace
from functools import partial
from pathlib import Path
from typing import Generic, TypeVar, cast

from fogbench.bench.reading.finding import Finder, of_family
from fogbench.bench.reading.page import blocks, with_blocks
from fogbench.worlds.reading.positions import Value
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import MapFamily

Keys = TypeVar("Keys", bound=Settings)


class Reading(Finder, Generic[Keys]):
    """What a page says; whatever is wrong with one part of it, the others are read too."""

    def __init__(self, keys: type[Keys], page: Value, folder: Path) -> None:
        """Read a page whose keys are those of a class and the blocks of its kind of world."""
        super().__init__(folder)
        found = self.family_class(page)
        self.kind, conditions = self.kind_class(page, found[0] if found else None)
        self.page = cast(Keys | None, self.block(with_blocks(keys, conditions), page))
        self.family = cast(MapFamily | None, self.block(*found)) if found else None
        own = self.family if self.family and self.kind in self.family.kinds else None  # its extents are of its kinds
        self.around["extent"] = self.asked(own.extent, None, partial(of_family, page)) if own else None
        self.conditions = self._conditions(conditions, page)

    def _conditions(self, conditions: type[Settings] | None, page: Value) -> Settings | None:
        if conditions is None:
            return None
        own = {key: value for key, value in page.fields().items() if key in blocks(conditions)}
        return self.block(conditions, replace(page, content=own))
