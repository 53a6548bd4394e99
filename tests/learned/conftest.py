"""What the tests of policies share."""

from collections.abc import Callable
from pathlib import Path

import pytest

from fogbench.learned import checkpoint
from fogbench.learned.agent import weighted
from fogbench.learned.policy import Policy


@pytest.fixture
def save(tmp_path: Path) -> Callable[[Policy, str], str]:
    """Writes the weights of a policy as a checkpoint of a name; returns its file."""

    def save(policy: Policy, name: str) -> str:
        place = tmp_path / f"{name}.safetensors"
        checkpoint.write(place, type(policy).__name__, policy.trained(), weighted(policy).state_dict(), {"batches": 3})
        return str(place)

    return save
