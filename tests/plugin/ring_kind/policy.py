"""A network that plays rings: its settings."""

from typing import ClassVar

from fogbench import Policy


class RingPolicy(Policy):
    """One linear layer."""

    kinds: ClassVar[frozenset[str]] = frozenset({"ring"})
    made_of: ClassVar[str] = "ring_kind.network:RingNetwork"
