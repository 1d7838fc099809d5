"""What a worker does: the cost of some positions, with failures caught where they happen."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np

#: The costs of some positions, how many evaluations ended in an error, and what the first one said.
Evaluated = tuple[np.ndarray, int, "str | None"]


class Cost:
    """A user's cost with its arguments and constraints, as it travels to workers."""

    def __init__(
        self,
        fun: Callable[..., Any],
        args: tuple[Any, ...] = (),
        vectorized: bool = False,
        constraints: Callable[[np.ndarray], Any] | None = None,
        ceiling: float | None = None,
    ) -> None:
        if not callable(fun):
            raise TypeError(f"fun is {type(fun).__name__}, not a function\n  give a function of a position that returns a number")
        if constraints is not None and ceiling is None:
            raise ValueError(
                "constraints need a ceiling: a cost that no feasible position of interest exceeds\n  give ceiling=..."
            )
        self.fun, self.args, self.vectorized = fun, args, vectorized
        self.constraints, self.ceiling = constraints, ceiling

    def __call__(self, points: np.ndarray) -> Evaluated:
        """The costs, shape (n,), of ``points``, shape (n, d)."""
        if self.vectorized and self.constraints is None:
            return self._at_once(points)
        costs, errors, first = np.full(len(points), np.nan), 0, None
        one = self._one
        for k, x in enumerate(points):
            try:
                costs[k] = one(x)
            except Exception as error:
                errors += 1
                first = first or _said(error)
        return costs, errors, first

    def _one(self, x: np.ndarray) -> Any:
        if self.constraints is not None:
            excess = np.asarray(self.constraints(x), dtype=float)
            if np.isnan(excess).any():
                return np.inf
            violation = float(np.sum(np.maximum(excess, 0.0)))
            if violation > 0.0:
                return self.ceiling + violation
        if self.vectorized:
            return np.asarray(self.fun(x[None, :], *self.args), dtype=float).reshape(1)[0]
        return self.fun(x, *self.args)

    def _at_once(self, points: np.ndarray) -> Evaluated:
        try:
            costs = np.asarray(self.fun(points, *self.args), dtype=float)
        except Exception as error:
            if len(points) == 1:
                return np.array([np.nan]), 1, _said(error)
            # One bad position does not cost its neighbours.
            return joined([self._at_once(points[k : k + 1]) for k in range(len(points))])
        if costs.shape != (len(points),):
            raise ValueError(
                f"the vectorized cost returned shape {costs.shape} for {len(points)} positions\n"
                f"  return one cost for each row: shape ({len(points)},)"
            )
        return costs, 0, None


def joined(parts: list[Evaluated]) -> Evaluated:
    """Parts of a generation in their order."""
    first = next((message for _, _, message in parts if message), None)
    return np.concatenate([costs for costs, _, _ in parts]), sum(errors for _, errors, _ in parts), first


def _said(error: Exception) -> str:
    return f"{type(error).__name__}: {error}"
