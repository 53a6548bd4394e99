"""The pool of worker processes: one thread each, deaf to Ctrl-C, gone when their parent is."""

import os
import signal
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from multiprocessing import active_children, get_context, resource_tracker
from time import sleep

from pebble import ProcessPool

from fogbench.bench.playing.parent_death import begin
from fogbench.bench.reading.scenario import Scenario

ONE_THREAD = dict.fromkeys(
    ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "VECLIB_MAXIMUM_THREADS", "NUMBA_NUM_THREADS"), "1"
)
"""The environment of a worker: processes run side by side, threads would only get into each other's way."""


def cpus() -> int:
    """How many CPUs this process may use."""
    return len(os.sched_getaffinity(0)) if sys.platform == "linux" else os.cpu_count() or 1


@contextmanager
def worker_pool(scenario: Scenario, workers: int) -> Iterator[ProcessPool]:
    """A pool whose processes know the scenario; at the end all of them are ended, whatever they are doing."""
    arguments = (scenario.text, scenario.path, workers)
    pool = ProcessPool(workers, initializer=begin, initargs=arguments, context=get_context("spawn"))
    with _environment(ONE_THREAD):
        try:
            with _deaf():
                pool.schedule(int)  # the first task starts the processes and the threads that will replace them
            yield pool
        finally:
            _stop(pool)


def _stop(pool: ProcessPool) -> None:
    pool.stop()  # type: ignore[no-untyped-call]  # pebble leaves it untyped
    sleep(0.2)  # pebble looks at its state every 0.1 s, then it starts no more processes
    for process in active_children():
        if process.name == "pebble_pool_worker":
            process.kill()  # pebble would ask first, and wait up to 3 s for each
    pool.join()


@contextmanager
def _deaf() -> Iterator[None]:
    """What is started in here never hears of Ctrl-C, which a terminal sends to all processes of a command."""
    resource_tracker.ensure_running()  # its start would end the deafness
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


@contextmanager
def _environment(variables: dict[str, str]) -> Iterator[None]:
    """Set environment variables for a while; processes that are started meanwhile inherit them."""
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                del os.environ[name]
            else:
                os.environ[name] = value
