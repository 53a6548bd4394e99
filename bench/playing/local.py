"""Episodes played in worker processes of this machine, which may hang and die.

One episode is one task. A worker that hangs is ended and one that dies is replaced; either costs the episode that it
was playing, whose record says so.
"""

from collections import deque
from collections.abc import Iterator

from fogbench.bench.playing import worker
from fogbench.bench.playing.agenda import Agenda, Job
from fogbench.bench.playing.episode import Played
from fogbench.bench.playing.pool import PATIENCE, Lost, RunError, Task, worker_pool
from fogbench.bench.reading.scenario import Scenario


def play_here(scenario: Scenario, agenda: Agenda, workers: int) -> Iterator[Played | None]:
    """The episodes of an agenda as they get ready; None whenever there was none for a while.

    Raises:
        RunError: a world cannot be made, or the project has a bug.
    """
    lost = deque[Task]()
    with worker_pool(scenario, workers) as pool:
        while True:
            while pool.has_room and (task := lost.popleft() if lost else _task(agenda.next())):
                pool.give(task)
            if not pool.busy:
                return
            heard = False
            for task, answer in pool.answers():
                if isinstance(answer, Lost):
                    lost.append(_record(task, answer))
                elif isinstance(answer, str):
                    raise RunError(answer)
                else:
                    heard = True
                    yield answer
            if not heard:
                yield None


def _task(job: Job | None) -> Task | None:
    """That of playing."""
    return Task(worker.play, job[:3], job.hard_seconds) if job else None


def _record(task: Task, loss: Lost) -> Task:
    """That of recording that an episode was lost.

    Raises:
        RunError: it was this that was lost.
    """
    if task.call is worker.lose:
        variant, _, episode = task.arguments[:3]
        raise RunError(f"{variant}, episode {episode}: {loss.detail}; expected its world to be made.")
    return Task(worker.lose, (*task.arguments, *loss), PATIENCE)
