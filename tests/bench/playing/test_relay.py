"""What agents print reaches whoever reads it, and nobody else matters."""

import os
from collections.abc import Iterator
from contextlib import contextmanager
from time import monotonic

import pytest

from fogbench.bench.playing.relay import relayed


@contextmanager
def standing_for(number: int, other: int) -> Iterator[None]:
    """Let a number stand for another open file for a while."""
    kept = os.dup(number)
    os.dup2(other, number)
    yield
    os.dup2(kept, number)
    os.close(kept)


def test_both_streams_are_printed(capfd: pytest.CaptureFixture[str]) -> None:
    """Each where it belongs, and to the last letter."""
    with relayed() as (out, err):
        os.write(out.fileno(), b"o" * 200_000)
        os.write(err.fileno(), b"e")
    told = capfd.readouterr()
    assert (told.out, told.err) == ("o" * 200_000, "e")


@pytest.mark.parametrize("reader", ["gone", "asleep"])
def test_nobody_has_to_read(reader: str) -> None:
    """Far more than a pipe holds is taken without an error, and soon."""
    there, here = os.pipe()
    if reader == "gone":
        os.close(there)
    began = monotonic()
    with standing_for(1, here), relayed() as (out, _):
        for _ in range(3):
            os.write(out.fileno(), b"x" * 50_000)
    assert monotonic() - began < 10
    os.close(here)
