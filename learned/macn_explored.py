"""Settings of MACN on the graph explored so far: free of how many nodes there are."""

from pkgutil import resolve_name
from typing import Annotated, ClassVar

from pydantic import Field

from fogbench.learned.encoding.encoding import Encoding
from fogbench.learned.encoding.explored_sizes import FRONTIER, TOLD, TRAITS
from fogbench.learned.memory import Remembering
from fogbench.learned.policy import AGENT
from fogbench.learned.shapes import Shapes, linear, parts
from fogbench.worlds.graph.graph import NODES

ENCODING = "fogbench.learned.encoding.explored:ExploredEncoding"
"""What its network sees."""

PLANNED = 1
"""Numbers from the values: how far the best neighbour is."""

HIDDEN = 32
"""Numbers of a layer that looks at one node."""


class MacnExplored(Remembering):
    """MACN with value iteration on the graph explored so far, whose edges are the moves; its outputs are neighbours."""

    kinds: ClassVar[frozenset[str]] = frozenset({"graph"})
    made_of: ClassVar[str] = "fogbench.learned.networks.explored:ExploredNetwork"

    most: Annotated[int, Field(ge=2, le=NODES)] = 1000
    """Nodes of the largest graph that it plays on; no weight depends on them."""

    @property
    def seen_count(self) -> int:
        """Of the agent's node as a whole."""
        return TOLD

    @property
    def output_count(self) -> int:
        """What the memory says to each neighbour."""
        return HIDDEN

    def encoding(self) -> Encoding:
        """The graph explored so far."""
        made: Encoding = resolve_name(ENCODING)(self)
        return made

    def uses(self) -> tuple[str, ...]:
        """What plays for it; its encoding is not that of its kind."""
        return AGENT, self.made_of, ENCODING

    def shapes(self) -> Shapes:
        """Those of a reward of each node, of a score of each neighbour, and of a memory."""
        rewards = parts(inner=linear(FRONTIER, HIDDEN), outer=linear(HIDDEN, 1))
        scores = parts(inner=linear(TRAITS + 1, HIDDEN), outer=linear(HIDDEN, 1))
        return {"step": (1,), "trust": (1,)} | self.remembering_shapes(PLANNED) | parts(rewards=rewards, scores=scores)
