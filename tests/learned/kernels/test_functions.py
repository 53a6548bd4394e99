"""Functions of lanes are those of sixteen numbers."""

import numpy as np
import pytest

from fogbench.learned.kernels.functions import decay, logarithm, sigmoid, softplus, tanh
from fogbench.learned.kernels.instructions import at, put, root
from fogbench.worlds.kernel import fused
from fogbench.worlds.types import Array


@fused
def functions(x: Array, y: Array) -> None:
    """Each function of row 0, in a row of its own."""
    a = at(x, 0)
    put(y, 0, decay(a))
    put(y, 1, sigmoid(a))
    put(y, 2, tanh(a))
    put(y, 3, softplus(a))
    put(y, 4, logarithm(decay(a)))
    put(y, 5, root(a * a))


@pytest.mark.parametrize(("dtype", "tolerance"), [(np.float32, 5e-7), (np.float64, 5e-15)])
@pytest.mark.parametrize("scale", [0.01, 1.0, 30.0])
def test_functions(scale: float, dtype: type, tolerance: float) -> None:
    """They are NumPy's, close to the last bit."""
    x = (scale * np.random.default_rng(0).normal(size=(1, 16))).astype(dtype)
    y = np.empty((6, 16), dtype)
    functions(x, y)
    wide = x[0].astype(np.float64)
    e = np.exp(-abs(wide))
    expected = [e, 1 / (1 + np.exp(-wide)), np.tanh(wide), np.maximum(wide, 0) + np.log1p(e), np.log1p(e), abs(wide)]
    for got, want in zip(y, expected, strict=True):
        np.testing.assert_allclose(got, want, rtol=8 * tolerance, atol=tolerance)


def test_nan_and_infinity() -> None:
    """NaN stays NaN in every function; infinity gives the limits, e^-87 for zero."""
    x, y = np.full((1, 16), np.nan), np.empty((6, 16))
    functions(x, y)
    assert np.isnan(y).all()
    x[:] = np.inf
    functions(x, y)
    np.testing.assert_allclose(y[[0, 1, 2, 4], 0], [0, 1, 1, 0], atol=1e-37)
