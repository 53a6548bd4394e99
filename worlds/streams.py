"""Random streams: one for each (seed, world, purpose, episode), none of which another can shift."""

import hashlib

import numpy as np


def digest(*words: object) -> str:
    """The sha256 of `words`, as 64 hexadecimal digits; equal for equal words on every machine."""
    return hashlib.sha256("\0".join(map(str, words)).encode()).hexdigest()


def stream(seed: int, world: str, purpose: str, episode: int) -> np.random.Generator:
    """The generator of one purpose in one episode.

    Args:
        seed: the scenario's seed.
        world: whatever fixes the world's settings, as text.
        purpose: `map`, `luck` (sensor and slip), `agent`; training, validation and test have their own.
        episode: counts from 0.
    """
    words = np.frombuffer(bytes.fromhex(digest(seed, world, purpose, episode)), "<u4")
    return np.random.Generator(np.random.PCG64(np.random.SeedSequence(words)))
