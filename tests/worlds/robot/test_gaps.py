"""Gaps of cells against their definition, and kept up against made anew."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from fogbench.worlds.robot.gaps import gaps, keep_up, rings
from fogbench.worlds.types import BLOCKED, FREE, UNKNOWN, Array


def by_definition(cells: Array, reach: int) -> Array:
    """Squares of the way from each middle to the nearest point of a blocked cell or of the outside, in half cells."""
    walls = np.argwhere(np.pad(cells, 1, constant_values=BLOCKED) == BLOCKED) - 1  # [n, 2]
    gap = np.empty(cells.shape, np.int64)
    for at in np.ndindex(cells.shape):
        far = np.maximum(2 * np.abs(walls - at) - 1, 0)
        gap[at] = min((far**2).sum(1).min(), rings(reach)[-1, 2] + 1)
    return gap


def cells_of(seed: int, share: float) -> Array:
    """A map of a few cells, some of them blocked."""
    rng = np.random.default_rng(seed)
    shape = rng.integers(1, 16, 2)
    return np.where(rng.random(shape) < share, BLOCKED, rng.integers(UNKNOWN, BLOCKED, shape)).astype(np.uint8)


def test_the_nearest_come_first() -> None:
    """Within a cell and a half lie the cell itself, its eight neighbours, and four more, a cell and a half away."""
    found = rings(3).tolist()
    assert found[0] == [0, 0, 0]
    assert [gap for _, _, gap in found] == [0] + 4 * [1] + 4 * [2] + 4 * [9]
    assert sorted(found[9:]) == [[-2, 0, 9], [0, -2, 9], [0, 2, 9], [2, 0, 9]]


@given(seed=st.integers(0, 2**32 - 1), share=st.sampled_from([0.0, 0.05, 0.3, 0.9, 1.0]), reach=st.integers(1, 9))
def test_gaps_are_what_they_are_defined_as(seed: int, share: float, reach: int) -> None:
    """On any map, however dense."""
    cells = cells_of(seed, share)
    assert np.array_equal(gaps(cells, rings(reach)), by_definition(cells, reach))


@given(seed=st.integers(0, 2**32 - 1), share=st.sampled_from([0.0, 0.1, 0.4]), reach=st.integers(1, 9))
def test_gaps_are_kept_up(seed: int, share: float, reach: int) -> None:
    """After any readings they are those of the new map; told are exactly the cells that have changed."""
    rng, cells = np.random.default_rng(seed), cells_of(seed, share)
    gap = gaps(cells, rings(reach))
    for _ in range(4):
        before = gap.copy()
        touched = rng.choice(cells.size, size=rng.integers(0, min(cells.size, 9), endpoint=True), replace=False)
        touched = touched[cells.flat[touched] != UNKNOWN]
        cells.flat[touched] = FREE + BLOCKED - cells.flat[touched]
        changed = keep_up(cells, gap, rings(reach), touched.astype(np.int64))
        assert np.array_equal(gap, gaps(cells, rings(reach)))
        assert set(np.flatnonzero(gap != before).tolist()) <= set(changed.tolist())
