"""From easy tasks to the full ones (Khan et al. 2018, section 4: more and larger obstacles, goals farther away)."""

from typing import Any, cast

from pydantic import ValidationError

from fogbench.worlds.mistake import Mistake
from fogbench.worlds.settings import Settings
from fogbench.worlds.types import MapFamily

STEPS = 100
"""Of a way, as far as one goes back on it to a family that is valid."""


def eased(easy: MapFamily, full: MapFamily, share: float) -> MapFamily:
    """The family that is `share` of the way, 0 to 1, from `easy` to `full`, of one class.

    Numbers, and those in lists, lie in between, whole ones rounded; anything else is as in `easy` until the end. Where
    the family refuses that (a maze has an odd size), it is the last one before, of a hundred, that is valid.
    """
    if share >= 1:
        return full
    for step in range(STEPS):
        try:
            return _on_the_way(easy, full, share * (1 - step / STEPS))
        except ValidationError:
            continue
    return easy


def farther(near: tuple[int, int], conditions: Any, share: float) -> Any:
    """Conditions with goals that are `share` of the way, 0 to 1, from the bounds `near` to their own.

    Raises:
        Mistake: they have no bounds.
    """
    own = getattr(getattr(conditions, "tasks", None), "distance", None)
    if own is None:
        raise Mistake("got a curriculum over distance; expected `tasks: {distance: ...}`, where it ends")
    tasks = conditions.tasks.model_copy(update={"distance": _between(near, own, share)})
    return conditions.model_copy(update={"tasks": tasks})


def _on_the_way(easy: MapFamily, full: MapFamily, share: float) -> MapFamily:
    fields = cast(Settings, easy).model_dump()
    between = {name: _between(value, getattr(full, name), share) for name, value in fields.items()}
    return cast(MapFamily, type(cast(Settings, full)).model_validate(between))


def _between(easy: Any, full: Any, share: float) -> Any:
    if isinstance(easy, tuple | list) and isinstance(full, tuple | list):
        return type(easy)(_between(a, b, share) for a, b in zip(easy, full, strict=True))
    if {type(easy), type(full)} <= {int, float}:
        between = easy + share * (full - easy)
        return between if isinstance(full, float) else round(between)
    return easy
