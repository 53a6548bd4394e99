"""Whether the variants of a scenario can be played: what a run begins with is tried, and nothing is recorded."""

from collections.abc import Iterable, Iterator

from fogbench.bench.playing.guests import drawn
from fogbench.bench.reading.scenario import ScenarioError, Variant
from fogbench.planners import judge_of, reference_settings
from fogbench.worlds.mistake import Mistake


def refuse_unplayable(variants: Iterable[Variant]) -> None:
    """Try variants.

    Raises:
        ScenarioError: some cannot be played; all that is wrong with all of them.
    """
    if lines := list(mistakes(variants)):
        raise ScenarioError(lines)


def mistakes(variants: Iterable[Variant]) -> Iterator[str]:
    """What is wrong with variants, in lines."""
    for variant in variants:
        try:
            _try(variant)
        except Mistake as mistake:
            yield from mistake.within(variant.place).splitlines()
        except Exception as error:  # noqa: BLE001  a user's class may raise anything
            yield f"{variant.place}: got {type(error).__name__}: {' '.join(str(error).split())}; expected worlds."


def _try(variant: Variant) -> None:
    """Draw the first world, and count the tasks of a list as far as they are needed.

    Raises:
        Mistake: it cannot be played.
    """
    judge_of(variant.kind)  # what cannot be imported is told now
    reference_settings(variant.kind)
    drawn(variant, 0).shortest()
    count = variant.family.tasks(variant.conditions, variant.episodes)
    if count is not None and count < variant.episodes:
        drawn(variant, variant.episodes - 1)  # it raises, and says why
