"""Who evaluates one position at a time, while others are under way."""

from __future__ import annotations

from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from typing import Any

import numpy as np

from ._cost import Cost, Evaluated
from ._workers import Losses, Processes, count


class Sends:
    """Sends a position and returns at once."""

    #: Positions that it can work on at a time, where that is known.
    width: int | None = None

    def __call__(self, position: np.ndarray) -> Future[Evaluated]:
        raise NotImplementedError

    def renew(self) -> bool:
        """Workers in the place of those that died; whether there can be any."""
        return False

    def alone(self, position: np.ndarray) -> Evaluated:
        """A position that has ended its worker as often as it may."""
        raise NotImplementedError


@contextmanager
def sender(cost: Cost, workers: Any, retries: int, losses: Losses) -> Iterator[Sends]:
    """What sends positions to ``workers``; pools that were made for it end with it."""
    if workers is None or (isinstance(workers, int) and workers == 1):
        yield _Here(cost)
    elif isinstance(workers, (int, np.integer)):
        with Processes(cost, count(int(workers)), 1, retries, losses) as processes:
            yield _ToProcesses(processes)
    elif hasattr(workers, "submit"):
        yield _Submitted(cost, workers)
    elif hasattr(workers, "apply_async"):
        yield _Applied(cost, workers)
    else:
        raise TypeError(
            f"workers is {type(workers).__name__}, which takes all positions at once\n"
            "  asynchronous=True needs a number of processes, a concurrent.futures.Executor, or a pool with apply_async"
        )


class _Here(Sends):
    width = 1

    def __init__(self, cost: Cost) -> None:
        self.cost = cost

    def __call__(self, position: np.ndarray) -> Future[Evaluated]:
        future: Future[Evaluated] = Future()
        future.set_result(self.cost(position[None, :]))
        return future


class _ToProcesses(Sends):
    def __init__(self, processes: Processes) -> None:
        self.processes, self.width = processes, processes.count

    def __call__(self, position: np.ndarray) -> Future[Evaluated]:
        return self.processes.submit(position[None, :])

    def renew(self) -> bool:
        self.processes.end()
        return True

    def alone(self, position: np.ndarray) -> Evaluated:
        return self.processes.alone(position[None, :])


class _Submitted(Sends):
    def __init__(self, cost: Cost, executor: Any) -> None:
        self.cost, self.executor = cost, executor

    def __call__(self, position: np.ndarray) -> Future[Evaluated]:
        return self.executor.submit(self.cost, position[None, :])


class _Applied(Sends):
    """A pool of ``multiprocessing`` or of Ray."""

    def __init__(self, cost: Cost, pool: Any) -> None:
        self.cost, self.pool = cost, pool

    def __call__(self, position: np.ndarray) -> Future[Evaluated]:
        future: Future[Evaluated] = Future()

        def failed(error: BaseException) -> None:
            if not future.cancelled():
                future.set_exception(error)

        def came(result: Evaluated) -> None:
            if not future.cancelled():
                future.set_result(result)

        self.pool.apply_async(self.cost, (position[None, :],), callback=came, error_callback=failed)
        return future
