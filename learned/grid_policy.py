"""What the settings of policies on grids share: which part of the map their network sees."""

from typing import ClassVar, Literal

from fogbench.learned.encoding.grid_sizes import Frame
from fogbench.learned.policy import Policy, Size
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Task


class GridPolicy(Policy):
    """A network as an agent on grids."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    reading: Literal["window", "map"] = "window"
    """What the network plans on: a window around the agent, or the whole map, which ties it to one size."""
    size: tuple[Size, Size] = (11, 11)
    """Rows and columns of that window or map."""
    stitched: bool = False
    """Whether it sees the map known so far; else, the current view alone."""

    @property
    def frame(self) -> Frame:
        """What the network's image shows of the world."""
        return Frame(self.size, self.reading == "window")

    def shown(self, task: Task) -> Frame:
        """What the network's image shows of the world of a task.

        Raises:
            Mistake: a network that was made for maps of one size meets another.
        """
        if not self.frame.fits(task.extent):
            raise Mistake(f"got a map of {by(task.extent)}; expected {by(self.size)}, the size")
        return self.frame

    def check(self, extent: tuple[float, ...] | None) -> None:
        """Hold the size against that of all maps.

        Raises:
            Mistake: a network that is made for maps of one size is to meet others.
        """
        if extent is not None and not self.frame.fits(extent):
            raise Mistake(f"a network for maps of {by(extent)} (this one is for {by(self.size)})")


def by(extent: tuple[float, ...]) -> str:
    """A size in words: `6x9`."""
    return "x".join(map(str, extent))
