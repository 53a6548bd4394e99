"""Words of a report that come from the kind of world."""

from fogbench.bench.reading.scenario import Scenario
from fogbench.planners import reference_of


def reference_name(scenario: Scenario) -> str:
    """What the same-information references of a scenario's kinds are called."""
    kinds = dict.fromkeys(variant.kind for variant in scenario.variants)
    names = dict.fromkeys(found.name for kind in kinds if (found := reference_of(kind)))
    return " or ".join(names) or "the reference"
