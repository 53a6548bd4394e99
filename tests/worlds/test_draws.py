"""What kernels draw is what NumPy's own method draws, and the generator stands where it would."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fogbench.worlds.draws import below, luck
from fogbench.worlds.kernel import kernel
from fogbench.worlds.types import Array

ENDS = st.integers(1, 40) | st.integers(1, 2**32 - 1) | st.integers(2**31, 2**31 + 5)


@given(seed=st.integers(0, 2**32), ends=st.lists(ENDS, max_size=30))
@pytest.mark.parametrize("kind", [np.random.PCG64, np.random.Philox, np.random.MT19937, np.random.SFC64])
def test_numbers_and_state_are_numpys(kind: Any, seed: int, ends: list[int]) -> None:
    """Number by number, whatever generates the bits."""
    ours, theirs = (np.random.Generator(kind(seed)) for _ in range(2))
    for end in ends:
        assert below(luck(ours), end) == theirs.integers(end)
    np.testing.assert_equal(ours.bit_generator.state, theirs.bit_generator.state)


@given(seed=st.integers(0, 2**32), count=st.integers(0, 50), end=ENDS)
def test_many_in_a_kernel_are_an_array_of_numpy(seed: int, count: int, end: int) -> None:
    """An array is drawn number by number."""
    ours, theirs = (np.random.default_rng(seed) for _ in range(2))
    np.testing.assert_array_equal(many(luck(ours), count, end), theirs.integers(end, size=count))
    assert ours.integers(7) == theirs.integers(7)


def test_half_of_a_number_that_is_kept_is_drawn_next() -> None:
    """PCG64 makes 64 bits at a time: a kernel goes on in the middle, and so does NumPy after it."""
    ours, theirs = (np.random.default_rng(4) for _ in range(2))
    drawn = [ours.integers(100), below(luck(ours), 100), below(luck(ours), 100), ours.integers(100)]
    assert drawn == theirs.integers(100, size=4).tolist()


@kernel
def many(luck: int, count: int, end: int) -> Array:
    """Some numbers in a row."""
    numbers = np.empty(count, np.int64)
    for k in range(count):
        numbers[k] = below(luck, end)
    return numbers
