"""Random streams: the same for the same words, on every machine and in every version."""

from hashlib import sha256
from itertools import product

import numpy as np

from fogbench.worlds.streams import digest, stream


def test_a_digest_is_the_sha256_of_its_words() -> None:
    """Words are joined by a zero byte, so that neither their order nor their borders are lost."""
    assert digest(7, "maps", "luck", 3) == sha256(b"7\0maps\0luck\x003").hexdigest()
    assert len({digest("ab", "c"), digest("a", "bc"), digest("c", "ab"), digest("abc")}) == 4


def test_a_stream_never_changes() -> None:
    """These numbers were drawn when results were first published; other numbers would be other episodes."""
    drawn = stream(0, "words", "map", 0)
    assert drawn.integers(1000, size=5).tolist() == [418, 201, 753, 720, 902]
    assert drawn.random(2).tolist() == [0.607411144828538, 0.5525382256204442]


def test_a_stream_is_the_same_on_every_call() -> None:
    """What was drawn before, from this stream or another, plays no part."""
    first = stream(1, "words", "luck", 2)
    again = first.random(100)
    stream(1, "words", "agent", 2).random(10)
    assert np.array_equal(again, stream(1, "words", "luck", 2).random(100))


def test_streams_share_nothing() -> None:
    """A change of any one word gives numbers that are unrelated: none is shared, and none correlates."""
    words = list(product((0, 1), ("a", "b"), ("map", "luck"), (0, 1)))
    drawn = np.array([stream(*four).random(4000) for four in words])  # [streams, numbers]
    assert len(np.unique(drawn)) == drawn.size
    apart = np.corrcoef(drawn) - np.eye(len(words))  # [streams, streams]
    assert np.abs(apart).max() < 5 / np.sqrt(4000)  # five standard deviations
