"""What a row says of a world, whoever plays in it, and how it holds an action."""

from collections.abc import Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from fogbench.bench.playing.loop import Record, episode_world, start_and_roll
from fogbench.planners import reference_settings
from fogbench.worlds.mistake import Mistake
from fogbench.worlds.types import Outcome, World

if TYPE_CHECKING:
    from fogbench.bench.reading.scenario import Variant


def numbers(action: Any) -> tuple[float, ...]:
    """An action as a row has it."""
    return tuple(map(float, action)) if isinstance(action, tuple) else (float(action),)


@lru_cache(maxsize=16)
def facts(variant: "Variant", episode: int) -> Mapping[str, Any]:
    """What the record of an episode says of its world, whoever plays."""
    world = episode_world(variant, episode)
    return {
        "kind": world.task.kind,
        "budget_steps": world.task.budget.steps,
        "straight": world.straight(),
        "shortest": world.shortest(),
        "reference_length": _reference_length(world, variant, episode),
        "covariates": _covariates(world, variant),
    }


def _reference_length(world: World, variant: "Variant", episode: int) -> float | None:
    """Length that the reference of the kind travels in the same world; None where it does not reach the goal."""
    settings, record = reference_settings(variant.kind), Record()
    if settings is None:
        return None
    start_and_roll(world, settings(), variant, episode, record, None)
    return record.length if record.outcome is Outcome.REACHED else None


def _covariates(world: World, variant: "Variant") -> dict[str, float]:
    """How difficult the world is.

    Raises:
        Mistake: it tells of other things than its conditions promise.
    """
    told, promised = dict(world.covariates()), variant.conditions.covariates
    if set(told) != set(promised):
        raise Mistake(f"covariates: got {', '.join(told) or 'none'}; expected {', '.join(promised) or 'none'}")
    return {name: float(value) for name, value in told.items()}
