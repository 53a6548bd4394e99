"""Memory is used again, and never by two."""

import resource

import pytest
import torch

from fogbench.learned.kernels import room as module
from fogbench.learned.kernels.room import LARGE, keep_freed, room

SIZE = LARGE // 32, 16


@pytest.mark.parametrize("dtype", [torch.float32, torch.float64])
def test_memory_is_used_again_when_no_tensor_has_it(dtype: torch.dtype) -> None:
    """A view of it is enough to hold it."""
    like = torch.empty(0, dtype=dtype)
    first = room(like, SIZE).fill_(1)
    place, view = first.data_ptr(), first[3:, 2:].t()
    del first
    second = room(like, SIZE).fill_(2)
    assert second.data_ptr() != place
    assert bool((view == 1).all())
    del view
    assert room(like, SIZE).data_ptr() == place
    assert (second.shape, second.dtype, bool((second == 2).all())) == (SIZE, dtype, True)


def test_memory_of_another_size_goes_back() -> None:
    """So no more is kept than was in use at once."""
    for height in (LARGE // 64, LARGE // 32, LARGE // 16):
        assert room(torch.empty(0), (height, 16)).shape == (height, 16)
        assert list(module._FREE) == [(height * 16, torch.float32)]


def test_little_room_is_left_to_the_allocator() -> None:
    """It keeps its own."""
    before = dict(module._FREE)
    assert room(torch.empty(0), (4, 16)).shape == (4, 16)
    assert before == module._FREE


def test_little_memory_is_kept_too() -> None:
    """The system is asked for it once, not in each of fifty rounds."""
    keep_freed()
    pages = LARGE // 4 // resource.getpagesize()
    before = resource.getrusage(resource.RUSAGE_SELF).ru_minflt
    for _ in range(50):
        torch.empty(LARGE // 4, dtype=torch.uint8).fill_(1)
    assert resource.getrusage(resource.RUSAGE_SELF).ru_minflt - before < 3 * pages
