"""Methods compared by many runs."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from . import _aep
from ._bounds import space
from ._cost import Cost
from ._minimize import _limits, _raise, _watched
from ._result import Result
from ._workers import Losses, evaluator


class Trials(list):
    """A summary of each method, in the order of their names as they were asked for."""

    def rank_test(self, first: str, second: str) -> Result:
        """Which of two methods is ahead (Mann and Whitney): ``effect``, the probability that a trial of the first is better
        than one of the second (0.5: no difference), and the two-sided ``p_value``. A trial that reached the target is better
        than one that did not; of two that did the faster one, of two that did not the lower one."""
        effect, p_value = _aep.rank_test(self[first].merits, self[second].merits)
        return Result(effect=effect, p_value=p_value)

    def __getitem__(self, key: Any) -> Any:
        if not isinstance(key, str):
            return super().__getitem__(key)
        for summary in self:
            if summary.method == key:
                return summary
        raise KeyError(f"{key}: there are trials of {', '.join(summary.method for summary in self)}")

    def to_frame(self) -> Any:
        """One row a method, as a pandas frame."""
        import pandas

        drop = {"runs", "merits"}
        return pandas.DataFrame([{k: v for k, v in summary.items() if k not in drop} for summary in self])


def trials(
    fun: Callable[..., Any],
    bounds: Any,
    args: tuple[Any, ...] = (),
    *,
    methods: Sequence[str] = ("aep-practical", "de", "cma-es"),
    count: int = 20,
    target: float = 0.0,
    maxfun: int | None = None,
    maxiter: int | None = None,
    population: int | None = None,
    seed: int = 1,
    integrality: Any = None,
    log: Any = None,
    vectorized: bool = False,
    workers: Any = 1,
    chunk: int | None = None,
    retries: int = 2,
) -> Trials:
    """Run methods ``count`` times each; trial t of every method begins from the same first positions where their populations
    are equally large.

    ``target`` is the cost that counts as solved, which also ends a trial; the other parameters are those of
    :func:`aep.minimize`. Trials follow one another; ``workers`` share the generations of each.

    Returns
    -------
    Trials
        For each method ``method``, ``trials``, ``successes``, ``mean``, ``median``, ``quartiles`` and ``range`` of the final
        costs, ``evaluations_to_target`` (median of the successful trials), ``expected_running_time`` (evaluations a success,
        failed trials counted), ``failures``, ``seconds`` (mean), and ``runs``: of each trial ``seed``, ``x``, ``fun``,
        ``nfev``, ``nit``, ``stop`` and ``improvements`` (evaluations, cost).

    Raises
    ------
    ValueError
        Bounds or settings that cannot be meant.
    aep.Interrupted
        Ctrl-C; ``result`` holds the trials that had ended.
    """
    if count < 1:
        raise ValueError(f"count is {count}\n  it is the number of trials: 1 or more")
    box = space(bounds, integrality, log)
    if maxfun is None and maxiter is None:
        maxfun = 5000 * box.dimension
    limits = _limits(maxfun, maxiter, None, target, None)
    found, cost, losses = Trials(), Cost(fun, args, vectorized), Losses()
    with evaluator(cost, workers, chunk, retries, losses) as evaluate:
        for method in methods:
            summary, runs, raised = _aep.trials(
                box, _watched(evaluate), method, population or 0, seed, count, limits, target
            )
            runs = [Result(run, x=np.array(run["x"])) for run in runs]
            merits = [(_reached(run, target), run.fun) for run in runs]
            found.append(Result(summary, runs=runs, merits=merits))
            if raised is not None:
                _raise(raised, found)
    return found


def _reached(run: Result, target: float) -> int | None:
    return next((used for used, cost in run.improvements if cost <= target), None)
