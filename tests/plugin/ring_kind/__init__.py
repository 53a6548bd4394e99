"""A kind of world of another package: a ring of numbered stations, some links of which are cut."""

from fogbench import Kind, Reference

RING = Kind(
    "ring_kind.conditions:RingConditions",
    unit="links",
    maps="grid",
)

REFERENCE = Reference("the shorter way", "ring_kind.walker:Walker")
