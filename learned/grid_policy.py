"""What the settings of policies on grids share: which part of the map their network sees."""

from typing import ClassVar, Literal

from fogbench.learned.encoding.grid_sizes import COMPASS, OUTPUTS, SEEN, Frame, by
from fogbench.learned.policy import Size
from fogbench.learned.showing import Showing
from fogbench.worlds.mistake import Mistake


class GridPolicy(Showing):
    """A network as an agent on grids."""

    kinds: ClassVar[frozenset[str]] = frozenset({"grid"})

    reading: Literal["window", "map"] = "window"
    """What the network plans on: a window around the agent, or the whole map, which ties it to one size."""
    size: tuple[Size, Size] = (11, 11)
    """Rows and columns of that window or map."""
    stitched: bool = False
    """Whether it sees the map known so far; else, the current view alone."""

    @property
    def plane(self) -> tuple[int, int]:
        """The window or the map."""
        return self.size

    @property
    def seen_count(self) -> int:
        """Numbers of the sight and the compass."""
        return SEEN + COMPASS

    @property
    def output_count(self) -> int:
        """The moves."""
        return len(OUTPUTS)

    @property
    def frame(self) -> Frame:
        """What the network's image shows of the world."""
        return Frame(self.size, self.reading == "window")

    def check(self, extent: tuple[float, ...] | None) -> None:
        """Hold the size against that of all maps.

        Raises:
            Mistake: a network that is made for maps of one size is to meet others.
        """
        if extent is not None and not self.frame.fits(extent):
            raise Mistake(f"a network for maps of {by(extent)} (this one is for {by(self.size)})")
