"""Who evaluates a generation: this process, a pool of processes, a map, or an executor.

All give the same costs in the same order, so the same seed gives the same result with each of them.
"""

from __future__ import annotations

import math
import multiprocessing
import os
import pickle
import signal
import warnings
from collections.abc import Callable, Iterator
from concurrent.futures import BrokenExecutor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from typing import Any

import numpy as np

from ._cost import Cost, Evaluated, joined
from ._result import WorkersLost

Evaluate = Callable[[np.ndarray], Evaluated]


class Losses:
    """How often workers were lost; each time is told as a ``RuntimeWarning``."""

    def __init__(self) -> None:
        self.count = 0

    def tell(self, what: str) -> None:
        self.count += 1
        warnings.warn(what, RuntimeWarning, stacklevel=2)


@contextmanager
def evaluator(
    cost: Cost, workers: Any, chunk: int | None, retries: int, losses: Losses
) -> Iterator[Evaluate]:
    """What evaluates generations of ``cost`` by ``workers``; pools that were made for it end with it."""
    if chunk is not None and chunk < 1:
        raise ValueError(f"chunk is {chunk}\n  it is the number of positions in a task: 1 or more")
    if retries < 0:
        raise ValueError(f"retries is {retries}\n  it is how often lost evaluations are repeated: 0 or more")
    if workers is None or (isinstance(workers, int) and workers == 1):
        yield cost
    elif isinstance(workers, (int, np.integer)):
        with Processes(cost, count(int(workers)), chunk, retries, losses) as processes:
            yield processes
    elif hasattr(workers, "submit"):
        yield _Submitted(cost, workers, chunk, retries, losses)
    elif callable(workers) or hasattr(workers, "map"):
        yield _Mapped(cost, workers if callable(workers) else workers.map, chunk, retries, losses)
    else:
        raise TypeError(
            f"workers is {type(workers).__name__}\n"
            "  give a number of processes, a map such as pool.map, or a concurrent.futures.Executor"
        )


def count(workers: int) -> int:
    """The number of processes that ``workers`` asks for."""
    if workers == -1:
        return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    if workers < 1:
        raise ValueError(f"workers is {workers}\n  give a number of processes, or -1 for one a core")
    return workers


def _pieces(points: np.ndarray, size: int) -> list[np.ndarray]:
    return [points[k : k + size] for k in range(0, len(points), size)]


class _Mapped:
    """By a map: scipy's convention, ``workers(function, positions)``."""

    def __init__(self, cost: Cost, mapping: Callable[..., Any], chunk: int | None, retries: int, losses: Losses) -> None:
        self.cost, self.mapping, self.chunk, self.retries, self.losses = cost, mapping, chunk or 1, retries, losses

    def __call__(self, points: np.ndarray) -> Evaluated:
        pieces = _pieces(points, self.chunk)
        for attempt in range(self.retries + 1):
            try:
                parts = list(self.mapping(self.cost, pieces))
            except Exception as error:
                _repeat_or_raise(error, attempt, self.retries, len(points), self.losses)
                continue
            if len(parts) != len(pieces):
                raise ValueError(f"the map returned {len(parts)} results for {len(pieces)} tasks\n  give one like the built-in map")
            return joined(parts)
        raise AssertionError("the last attempt returns or raises")


class _Submitted:
    """By an executor of the user's: one task a piece, whatever is lost is submitted again."""

    def __init__(self, cost: Cost, executor: Any, chunk: int | None, retries: int, losses: Losses) -> None:
        self.cost, self.executor, self.chunk, self.retries, self.losses = cost, executor, chunk or 1, retries, losses

    def __call__(self, points: np.ndarray) -> Evaluated:
        pieces = _pieces(points, self.chunk)
        answers: list[Evaluated | None] = [None] * len(pieces)
        for attempt in range(self.retries + 1):
            lost = _gather(self.executor, self.cost, pieces, answers)
            if lost is None:
                return joined(answers)  # type: ignore[arg-type]
            if isinstance(lost, BrokenExecutor):
                raise WorkersLost(
                    f"the executor broke ({_said(lost)}) and cannot be started again from here\n"
                    "  give workers=N: pools of its own are made anew; or checkpoint=FILE, and go on with resume=True"
                ) from lost
            missing = sum(len(piece) for piece, answer in zip(pieces, answers) if answer is None)
            _repeat_or_raise(lost, attempt, self.retries, missing, self.losses)
        raise AssertionError("the last attempt returns or raises")


def _gather(executor: Any, task: Callable[..., Evaluated], pieces: list[np.ndarray], answers: list[Evaluated | None]) -> Exception | None:
    """Evaluates what has no answer yet; what went wrong first, if anything."""
    lost: Exception | None = None
    futures: dict[int, Future[Evaluated]] = {}
    try:
        try:
            for k, piece in enumerate(pieces):
                if answers[k] is None:
                    futures[k] = executor.submit(task, piece)
        except Exception as error:
            lost = error
        for k, future in futures.items():
            try:
                answers[k] = future.result()
            except Exception as error:
                lost = lost or error
    except BaseException:
        for future in futures.values():
            future.cancel()
        raise
    return lost


def _repeat_or_raise(error: Exception, attempt: int, retries: int, missing: int, losses: Losses) -> None:
    if attempt == retries:
        raise WorkersLost(
            f"the workers failed {retries + 1} times in one generation; the last time: {_said(error)}\n"
            "  what the cost raises is counted, so this is the pool itself, or a cost that cannot be sent to it"
        ) from error
    losses.tell(f"workers were lost ({_said(error)}); {missing} evaluations are repeated")


def _said(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}" if str(error) else type(error).__name__


def end(pool: ProcessPoolExecutor) -> None:
    """Ends a pool at once: nobody waits any more for what still runs."""
    running = list((getattr(pool, "_processes", None) or {}).values())
    pool.shutdown(wait=False, cancel_futures=True)
    for process in running:
        process.terminate()


class Processes:
    """By processes on this machine. The cost is sent to each of them once. A pool that breaks because a process died is made
    anew; positions that end their process each time, alone too, are failures."""

    def __init__(self, cost: Cost, count: int, chunk: int | None, retries: int, losses: Losses) -> None:
        self.count, self.chunk, self.retries, self.losses = count, chunk, retries, losses
        self.vectorized = cost.vectorized
        self.context = multiprocessing.get_context()
        self.cost = cost if self.context.get_start_method() == "fork" else _packed(cost)
        self.pool: ProcessPoolExecutor | None = None

    def __enter__(self) -> Processes:
        return self

    def __exit__(self, *_: object) -> None:
        self.end()

    def _begin(self, count: int) -> ProcessPoolExecutor:
        return ProcessPoolExecutor(count, mp_context=self.context, initializer=_take, initargs=(self.cost,))

    def end(self) -> None:
        """Ends the pool at once; the next task begins another one."""
        if self.pool is not None:
            end(self.pool)
            self.pool = None

    def __call__(self, points: np.ndarray) -> Evaluated:
        # A few tasks for each process, so that one slow position does not hold up a whole share.
        share = self.count if self.vectorized else 4 * self.count
        pieces = _pieces(points, self.chunk or max(1, math.ceil(len(points) / share)))
        answers: list[Evaluated | None] = [None] * len(pieces)
        for attempt in range(self.retries + 1):
            if self.pool is None:
                self.pool = self._begin(self.count)
            lost = _gather(self.pool, _evaluate, pieces, answers)
            if lost is None:
                return joined(answers)  # type: ignore[arg-type]
            if not isinstance(lost, BrokenExecutor):
                raise lost
            self.end()
            missing = sum(len(piece) for piece, answer in zip(pieces, answers) if answer is None)
            how = "repeated" if attempt < self.retries else "repeated one by one"
            self.losses.tell(f"a worker process died; {missing} evaluations are {how}")
        for k, piece in enumerate(pieces):
            if answers[k] is None:
                answers[k] = joined([self.alone(piece[j : j + 1]) for j in range(len(piece))])
        return joined(answers)  # type: ignore[arg-type]

    def submit(self, points: np.ndarray) -> Future[Evaluated]:
        """A task by itself, for who does not wait for a generation."""
        if self.pool is None:
            self.pool = self._begin(self.count)
        return self.pool.submit(_evaluate, points)

    def alone(self, point: np.ndarray) -> Evaluated:
        """A position in a process of its own."""
        with self._begin(1) as pool:
            try:
                return pool.submit(_evaluate, point).result()
            except BrokenExecutor:
                return np.array([np.nan]), 1, f"the worker process died at {point[0].tolist()}"


class _Packed:
    """A cost as bytes, for processes that do not inherit it."""

    def __init__(self, content: bytes) -> None:
        self.content = content


def _packed(cost: Cost) -> Any:
    try:
        return _Packed(pickle.dumps(cost))
    except Exception as error:
        try:
            import cloudpickle
        except ImportError:
            raise TypeError(
                f"the cost cannot be sent to other processes ({_said(error)})\n"
                "  define it at the top of a module, or install cloudpickle"
            ) from error
        return _Packed(cloudpickle.dumps(cost))


_cost: Cost | None = None


def _take(cost: Any) -> None:
    """In a new process: keeps the cost, and leaves Ctrl-C to the process that asks."""
    global _cost
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    _cost = pickle.loads(cost.content) if isinstance(cost, _Packed) else cost


def _evaluate(points: np.ndarray) -> Evaluated:
    assert _cost is not None
    return _cost(points)


