"""Lanes can be added, multiplied and compared as the sixteen numbers that they are."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from fogbench.learned.kernels.functions import larger
from fogbench.learned.kernels.instructions import at, full, put, until
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array

ALONE = """
import numpy as np
from fogbench.learned.kernels.instructions import at, put
from fogbench.worlds.kernel import kernel
@kernel
def twice(x):
    put(x, 0, at(x, 0) + at(x, 0))
x = np.ones((1, 16))
twice(x)
assert (x == 2).all()
"""


@fused
def operations(x: Array, y: Array) -> None:
    """Each operation of rows 0 and 1."""
    a, b = at(x, 0), at(x, 1)
    put(y, 0, (1 + a) * 2 - b / 4)
    a += b
    put(y, 1, a)
    put(y, 2, until(a, b, a, 0.5))
    put(y, 3, larger(a, b))
    put(y, 4, full(x, 3))


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
def test_operations(dtype: type) -> None:
    """They are NumPy's, with the type of the lanes, from and into arrays whose rows lie apart."""
    x = np.random.default_rng(0).normal(size=(2, 48)).astype(dtype)[:, 16:32]
    y = np.zeros((5, 32), dtype)
    operations(x, y[:, :16])
    a, b = x
    expected = [(1 + a) * 2 - b / 4, a + b, np.where(a + b <= b, a + b, 0.5), np.maximum(a + b, b), np.full(16, 3)]
    np.testing.assert_allclose(y[:, :16], expected, rtol=1e-5 if dtype is np.float32 else 1e-12)
    assert not y[:, 16:].any()


def test_whoever_has_lanes_can_add_them(tmp_path: Path) -> None:
    """The instructions alone make the operators known."""
    script = tmp_path / "alone.py"
    script.write_text(ALONE)
    subprocess.run([sys.executable, str(script)], check=True)
