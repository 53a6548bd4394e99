"""What is asked of whom: everything, but for agents that hang in their first episodes of a variant."""

import random
from typing import Any

import pytest

from fogbench.bench.playing.agenda import FIRST, Agenda, Job, is_given_up
from fogbench.bench.reading.scenario import Scenario

HUNG, DONE = "HUNG", "REACHED"


def played(scenario: Scenario, hangs: Any, workers: int, luck: random.Random, done: Any = None) -> list[Job]:
    """The jobs that are handed out while so many are in hand at once, and end in a random order."""
    agenda, hand, asked = Agenda(scenario, done or {}), list[Job](), list[Job]()
    while True:
        while len(hand) < workers and (job := agenda.next()):
            hand.append(job)
            asked.append(job)
        if not hand:
            return asked
        job = hand.pop(luck.randrange(len(hand)))
        agenda.ended(job.variant, job.agent, job.episode, HUNG if hangs(job) else DONE)


@pytest.mark.parametrize("workers", [1, 2, 3, 7, 100])
def test_who_hangs_first_is_not_asked_again(make: Any, workers: int) -> None:
    """Whatever the number of workers and the order of ends: exactly its first three, and all of everyone else's."""
    scenario = make(episodes=9)
    asked = played(scenario, lambda job: job[:2] == ("short", "astar"), workers, random.Random(workers))
    assert len(asked) == len(set(asked)) == 5 * 9 + FIRST
    assert {job.episode for job in asked if job[:2] == ("short", "astar")} == set(range(FIRST))


@pytest.mark.parametrize("ends", range(FIRST))
def test_one_end_is_enough(make: Any, ends: int) -> None:
    """An agent that ends in one of its first three episodes is asked for all, though it hangs in all others."""
    asked = played(make(episodes=9), lambda job: job.episode != ends, 4, random.Random(0))
    assert len(asked) == 6 * 9


def test_what_is_recorded_counts(make: Any) -> None:
    """A second run asks nobody again who hung in the first, and whoever lacks one of the three for that one."""
    scenario = make(episodes=9, agents=["astar", "memoryless"], variants={"short": {"budget": {"steps": 6}}})
    done = {("short", "astar"): dict.fromkeys(range(3), HUNG), ("short", "memoryless"): {0: HUNG, 2: HUNG, 5: DONE}}
    assert [job[1:3] for job in played(scenario, lambda job: True, 2, random.Random(0), done)] == [("memoryless", 1)]
    others = [("memoryless", episode) for episode in (1, 3, 4, 6, 7, 8)]
    assert [job[1:3] for job in played(scenario, lambda job: False, 1, random.Random(0), done)] == others


def test_few_episodes_are_all_asked(make: Any) -> None:
    """Of three there is no rest."""
    assert len(played(make(episodes=2), lambda job: True, 2, random.Random(0))) == 6 * 2


def test_given_up_is_told_by_the_rows_alone() -> None:
    """Three rows, the first by number, all hung."""
    assert is_given_up({0: HUNG, 1: HUNG, 2: HUNG})
    assert not is_given_up({0: HUNG, 1: HUNG, 2: DONE})
    assert not is_given_up({0: HUNG, 1: HUNG, 3: HUNG})
    assert not is_given_up(dict.fromkeys(range(4), HUNG))
    assert not is_given_up({})
