"""Work shared among PyTorch's threads is all done, and a failure is told."""

from collections.abc import Iterator

import pytest
import torch

from learned import threads
from learned.threads import share


@pytest.fixture(params=[1, 2, 3], autouse=True)
def _threads(request: pytest.FixtureRequest) -> Iterator[None]:
    before = torch.get_num_threads()
    torch.set_num_threads(request.param)
    yield
    torch.set_num_threads(before)


@pytest.mark.parametrize("count", [1, 2, 5, 16])
def test_every_number_is_in_one_range(count: int) -> None:
    """The ranges make up the whole, none twice."""
    seen: list[int] = []
    share(lambda first, last: seen.extend(range(first, last)), count)
    assert sorted(seen) == list(range(count))


def test_without_openmp(monkeypatch: pytest.MonkeyPatch) -> None:
    """Where no OpenMP library is found, the same is done in the calling thread."""
    monkeypatch.setattr(threads, "_PARALLEL", None)
    test_every_number_is_in_one_range(5)
