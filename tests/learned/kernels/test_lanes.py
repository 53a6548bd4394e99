"""Lanes: sixteen numbers that a kernel handles as one are sixteen numbers."""

from collections.abc import Callable

import numpy as np
import pytest

from fogbench.learned.kernels.lanes import at, decay, full, larger, logarithm, put, root, sigmoid, softplus, tanh, until
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


@pytest.mark.parametrize("function", [functions])
def test_nan_and_infinity(function: Callable[..., None]) -> None:
    """NaN stays NaN in every function; infinity gives the limits, e^-87 for zero."""
    x, y = np.full((1, 16), np.nan), np.empty((6, 16))
    function(x, y)
    assert np.isnan(y).all()
    x[:] = np.inf
    function(x, y)
    np.testing.assert_allclose(y[[0, 1, 2, 4], 0], [0, 1, 1, 0], atol=1e-37)
