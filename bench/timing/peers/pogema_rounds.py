"""Rounds of pogema, in an environment of its own (it needs NumPy 1 and pydantic 1).

    python pogema_rounds.py CONFIG        a JSON object, the fields of pogema's GridConfig

For each line of the input, a number of episodes, it plays them and prints the seconds per step, resets included.
"""

import json
import sys
from time import process_time
from typing import Any

import numpy as np
from pogema import GridConfig, pogema_v0


def main() -> None:
    """Answer until the input ends."""
    env = pogema_v0(GridConfig(**json.loads(sys.argv[1])))
    rng = np.random.default_rng(0)
    for line in sys.stdin:
        print(one_round(env, rng, int(line)), flush=True)


def one_round(env: Any, rng: np.random.Generator, episodes: int) -> float:
    """Seconds per step; pogema's five actions are the four moves and to stay."""
    began, steps = process_time(), 0
    for _ in range(episodes):
        env.reset()
        over = False
        while not over:
            _, _, terminated, truncated, _ = env.step([int(5 * rng.random())])
            over = terminated[0] or truncated[0]
            steps += 1
    return (process_time() - began) / steps


main()
