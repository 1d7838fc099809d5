"""One run of one method."""

from __future__ import annotations

import os
import warnings
from collections.abc import Callable
from types import SimpleNamespace
from typing import Any

import numpy as np

from . import _aep
from ._asynchronous import run
from ._bounds import space
from ._cost import Cost
from ._progress import Bar, counter
from ._result import Interrupted, Result
from ._workers import Losses, evaluator

#: scipy's ``status``: 0 the method ended by itself or a target was met, 1 a limit was reached, 99 it was stopped.
_STATUS = {"target": 0, "stagnation": 0, "exhausted": 0, "evaluations": 1, "generations": 1, "time": 1, "interrupted": 99}


def minimize(
    fun: Callable[..., Any],
    bounds: Any,
    args: tuple[Any, ...] = (),
    *,
    method: str = "aep-practical",
    maxfun: int | None = None,
    maxiter: int | None = None,
    time_limit: float | None = None,
    target: float | None = None,
    stagnation: tuple[int, float] | None = None,
    population: int | None = None,
    seed: int = 1,
    x0: Any = None,
    integrality: Any = None,
    log: Any = None,
    constraints: Callable[[np.ndarray], Any] | None = None,
    ceiling: float | None = None,
    vectorized: bool = False,
    workers: Any = 1,
    chunk: int | None = None,
    retries: int = 2,
    asynchronous: bool = False,
    callback: Callable[[Result], Any] | Bar | None = None,
    checkpoint: str | os.PathLike[str] | None = None,
    checkpoint_every: int = 10,
    resume: bool = False,
) -> Result:
    """Minimise a function of bounded components; no derivatives, and the same seed gives the same result to the bit.

    Parameters
    ----------
    fun
        ``fun(x, *args) -> float`` with ``x`` of shape (d,); with ``vectorized`` ``fun(points, *args)`` with ``points`` of
        shape (n, d), returning shape (n,). NaN, infinity and exceptions are the worst cost: counted, and the run goes on.
    bounds
        d pairs (lower, upper); a scipy ``Bounds``; or a dictionary of names with pairs.
    method
        One of :func:`aep.methods`.
    maxfun, maxiter, time_limit, target, stagnation
        What ends the run, whatever comes first: evaluations (the first generation is always made; a generation that would
        exceed them is not begun); generations after the first; seconds; a cost that is good enough; ``(generations,
        tolerance)`` without a relative improvement by more than ``tolerance``. With none of them ``maxfun = 5000 * d``.
    population
        Individuals; by default the method's own number. With many workers: a multiple of their number.
    seed
        0 or more; fixes every random number.
    x0
        Positions to begin with, shape (d,) or (n, d); the rest of the first generation is random.
    integrality, log
        Which components are whole numbers, and which are searched by their logarithm: one truth value a component, or names.
    constraints, ceiling
        ``constraints(x)`` returns values that are 0 or negative where x is feasible. ``fun`` is never asked elsewhere: the
        cost there is ``ceiling``, which no feasible cost of interest exceeds, plus the sum of what is violated.
    workers
        A number of processes (-1: one a core); a map such as ``pool.map``; or any ``concurrent.futures.Executor``:
        ``dask.distributed.Client.get_executor()``, ``mpi4py.futures.MPIPoolExecutor``, ... See docs/python.md.
    chunk
        Positions in a task; by default a quarter of a process's share, and 1 for maps and executors.
    retries
        How often evaluations are repeated whose worker died. With a number of processes a position that ends its process
        again after that, alone, counts as failed; elsewhere :class:`aep.WorkersLost` is raised, with what was found.
    asynchronous
        No individual waits for another one: a child is made as soon as the cost of the last one has come, so that a slow
        evaluation holds up nobody. For costs whose times differ much, on workers that take one task at a time: a number of
        processes, an executor, a pool with ``apply_async``. The same seed then no longer gives the same result, as that depends
        on who is ready first. Methods whose children compete with their own parents: ``aep``, ``aep-practical``, ``de``,
        ``de-fixed``. As many costs as there are individuals count as a generation; ``maxfun`` is kept to the evaluation.
    callback
        Called after each generation with ``x``, ``fun``, ``nfev``, ``nit``, ``failures``, ``elapsed`` (s). True or
        ``StopIteration`` ends the run. Or a bar such as ``tqdm.tqdm(total=maxfun)``, which is moved on by the evaluations.
    checkpoint, checkpoint_every, resume
        A file that keeps the run, every how many generations it is written, and whether to go on from it. A resumed run ends
        as the uninterrupted one would have, to the bit.

    Returns
    -------
    Result
        What scipy's ``OptimizeResult`` has: ``x`` (shape (d,)), ``fun``, ``nfev``, ``nit``, ``success``, ``status`` (0 ended
        by itself or target, 1 a limit, 99 stopped), ``message``; ``success`` is False only where no cost was finite or the
        run was stopped. And ``stop`` (the reason in one word), ``failures`` (``non_finite``, ``errors``, ``first``: what the first error said),
        ``workers_lost``, ``elapsed`` (s), ``names``.

    Raises
    ------
    ValueError, TypeError
        Bounds, settings or a checkpoint that cannot be meant, with what would mend it.
    aep.Interrupted
        Ctrl-C (a ``KeyboardInterrupt``); its attribute ``result`` holds what was found. The generation in which it came
        counts for nothing, so that ``resume`` goes on exactly there.
    """
    box = space(bounds, integrality, log)
    if maxfun is maxiter is time_limit is target is stagnation is None:
        maxfun = 5000 * box.dimension
    limits = _limits(maxfun, maxiter, time_limit, target, stagnation)
    kept = None
    if checkpoint is not None:
        kept = SimpleNamespace(path=os.fspath(checkpoint), every=int(checkpoint_every), resume=resume)
    elif resume:
        raise ValueError("resume needs the file of the run\n  give checkpoint=FILE")
    cost, losses = Cost(fun, args, vectorized, constraints, ceiling), Losses()
    heard: Any = counter(callback) if hasattr(callback, "update") else callback  # type: ignore[arg-type]
    told = None if heard is None else lambda facts: _called(heard, facts)
    if asynchronous:
        if chunk not in (None, 1):
            raise ValueError(f"chunk is {chunk}\n  an asynchronous run sends one position at a time: leave it out")
        steady = _aep.Steady(box, method, population or 0, seed, initial(x0, box))
        facts, raised = run(cost, steady, workers, retries, losses, limits, _identity(fun), kept, told)
        return _ended(facts, raised, losses, box)
    with evaluator(cost, workers, chunk, retries, losses) as evaluate:
        facts, raised = _aep.minimize(
            box, _watched(evaluate), method, population or 0, seed, initial(x0, box), limits, _identity(fun), kept, told
        )
    return _ended(facts, raised, losses, box)


def _ended(facts: dict[str, Any], raised: BaseException | None, losses: Losses, box: _aep.Space) -> Result:
    result = _result(facts, losses, box)
    if raised is not None:
        _raise(raised, result)
    if result.failures["checkpoint"]:
        warnings.warn(f"the checkpoint could not be written: {result.failures['checkpoint']}", RuntimeWarning, stacklevel=3)
    return result


def _identity(fun: Any) -> str:
    """What a checkpoint tells the cost by."""
    return getattr(fun, "__qualname__", type(fun).__qualname__)


def _limits(maxfun: Any, maxiter: Any, time_limit: Any, target: Any, stagnation: Any) -> SimpleNamespace:
    return SimpleNamespace(
        evaluations=maxfun, generations=maxiter, seconds=time_limit, target=target, stagnation=stagnation
    )


def initial(x0: Any, box: _aep.Space) -> list[list[float]]:
    """Positions to begin with, one list each."""
    if x0 is None:
        return []
    points = np.atleast_2d(np.asarray(x0, dtype=float))
    if points.ndim != 2 or points.shape[1] != box.dimension:
        raise ValueError(f"x0 has shape {np.shape(x0)}, bounds have {box.dimension} components\n  give shape (d,) or (n, d)")
    return points.tolist()


def _watched(evaluate: Any) -> Any:
    """Tells once where not one evaluation of the first generation succeeded: mostly a mistake in the cost."""
    first = True

    def watched(points: np.ndarray) -> Any:
        nonlocal first
        costs, errors, message = evaluate(points)
        if first and errors == len(points):
            warnings.warn(f"every evaluation of the first generation failed; the first: {message}", RuntimeWarning, stacklevel=3)
        first = False
        return costs, errors, message

    return watched


def _called(callback: Callable[[Result], Any], facts: dict[str, Any]) -> bool:
    return callback(Result(facts)) is True


def _result(facts: dict[str, Any], losses: Losses, box: _aep.Space) -> Result:
    stop, found = facts["stop"], len(facts["x"]) > 0
    message = facts["message"]
    if not found:
        message = "no evaluation gave a finite cost" + (f"; the first error: {facts['first_error']}" if facts["first_error"] else "")
    return Result(
        x=facts["x"] if found else np.full(box.dimension, np.nan),
        fun=facts["fun"],
        success=found and stop != "interrupted",
        status=_STATUS[stop] if found else 2,
        message=message,
        nfev=facts["nfev"],
        nit=facts["nit"],
        stop=stop,
        failures={
            "non_finite": facts["non_finite"],
            "errors": facts["errors"],
            "first": facts["first_error"],
            "checkpoint": facts["checkpoint_error"],
        },
        workers_lost=losses.count,
        elapsed=facts["elapsed"],
        names=box.names,
    )


def _raise(raised: BaseException, result: Any) -> None:
    """Ends a run as it was ended, with what it had found."""
    if isinstance(raised, KeyboardInterrupt):
        raise Interrupted(result) from None
    if hasattr(raised, "__dict__"):
        raised.result = result  # type: ignore[attr-defined]
    raise raised
