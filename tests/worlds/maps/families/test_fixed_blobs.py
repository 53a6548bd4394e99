"""One map of rectangles for all episodes."""

import numpy as np

from fogbench.worlds.grid.conditions import GridConditions
from fogbench.worlds.maps.families.blobs import Blobs
from fogbench.worlds.maps.families.fixed_blobs import FixedBlobs

CONDITIONS = GridConditions.model_validate({"budget": {"steps": 60}})
FIELDS = {"size": 16, "obstacles": (5, 9), "obstacle_size": (1, 4)}


def test_all_episodes_share_a_map_and_no_task() -> None:
    """Whatever luck they have; the map is that of `blobs` with the seed of the map."""
    worlds = [FixedBlobs(**FIELDS).sample(np.random.default_rng(k), k, CONDITIONS) for k in range(8)]
    expected = Blobs(**FIELDS).draw(np.random.default_rng(0), CONDITIONS).blocked
    assert all(np.array_equal(world.blocked, expected) for world in worlds)
    assert len({(world.start, world.task.goal) for world in worlds}) == 8


def test_another_seed_is_another_map() -> None:
    """Of the map, not of the episode."""
    maps = [FixedBlobs(**FIELDS, map_seed=seed).draw(np.random.default_rng(0), CONDITIONS).blocked for seed in (0, 1)]
    assert not np.array_equal(*maps)
