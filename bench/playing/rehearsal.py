"""One decision of each user's agent on a throw-away task, so that what cannot play is told before a run."""

from collections.abc import Iterator

from fogbench.bench.playing import worker
from fogbench.bench.playing.guests import guests
from fogbench.bench.playing.pool import Lost, Pool, RunError, Task, cpus, worker_pool
from fogbench.bench.reading.scenario import Scenario, Variant
from fogbench.bench.reading.variant import Entry


def rehearsed(scenario: Scenario) -> list[str]:
    """What is wrong with the agents of a scenario that do not ship with the project, each at its place in the file.

    Raises:
        RunError: a world cannot be made, or a process cannot begin.
    """
    asked, lines, unasked = guests(scenario), dict[str, str](), list[str]()
    with worker_pool(scenario, min(cpus(), len(asked))) as pool:
        wrong = dict(_answers(pool, list(asked.values()), unasked))
    for pair, (variant, entry) in asked.items():
        if wrong.get(pair):
            lines.setdefault(entry.label, _line(scenario, variant, entry, wrong[pair]))
    if unasked and not lines:
        raise RunError(unasked[0])
    return list(lines.values())


def _answers(
    pool: Pool, left: list[tuple[Variant, Entry]], unasked: list[str]
) -> Iterator[tuple[tuple[str, str], str]]:
    """What each did wrong, by variant and label; one that failed in a variant is not asked in the next.

    Why one could not be asked is added to `unasked`.
    """
    failed = set[str]()
    left.reverse()
    while True:
        while left and pool.has_room:
            variant, entry = left.pop()
            if entry.label not in failed:
                seconds = variant.conditions.budget.hard_seconds
                pool.give(Task(worker.rehearse, (variant.name, entry.label, 0), seconds))
        if not pool.busy:
            return
        for task, answer in pool.answers():
            if isinstance(answer, str):
                unasked.append(answer)
                continue
            wrong = answer.detail if isinstance(answer, Lost) else answer.wrong
            failed |= {task.arguments[1]} if wrong else set()
            yield task.arguments[:2], wrong


def _line(scenario: Scenario, variant: Variant, entry: Entry, wrong: str) -> str:
    expected = f"an agent that can decide; its first decision in variant {variant.name} ended with {wrong}"
    return entry.named._replace(expected=expected).text(str(scenario.path))
