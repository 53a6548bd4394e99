"""What the settings of policies on graphs share: how many nodes their network is made for."""

from math import isqrt
from typing import Annotated, ClassVar

from pydantic import Field, field_validator

from fogbench.learned.showing import Showing
from fogbench.worlds.mistake import Mistake, counted


class GraphPolicy(Showing):
    """A network as an agent on graphs: it sees the row of its node, reshaped into a square (Khan et al. 2018)."""

    kinds: ClassVar[frozenset[str]] = frozenset({"graph"})

    nodes: Annotated[int, Field(ge=1, le=1024)] = 16
    """N, a square number; the network plays on graphs of so many nodes."""

    @property
    def plane(self) -> tuple[int, int]:
        """The square."""
        return isqrt(self.nodes), isqrt(self.nodes)

    @property
    def seen_count(self) -> int:
        """A row, a node, a goal, and whether the last step was blocked."""
        return 3 * self.nodes + 1

    @property
    def output_count(self) -> int:
        """The nodes."""
        return self.nodes

    def check(self, extent: tuple[float, ...] | None) -> None:
        """Hold the nodes against those of all graphs.

        Raises:
            Mistake: a network that is made for graphs of one size is to meet others.
        """
        if extent is not None and len(extent) == 1 and extent != (self.nodes,):  # other kinds have more numbers
            raise Mistake(f"a network for graphs of {counted(int(extent[0]), 'node')} (this one is for {self.nodes})")

    @field_validator("nodes")
    @classmethod
    def _square(cls, nodes: int) -> int:
        if isqrt(nodes) ** 2 != nodes:
            raise ValueError("a square number, such as 16: the row of a node is reshaped into a square")
        return nodes
