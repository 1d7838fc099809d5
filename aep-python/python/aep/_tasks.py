"""Identification tasks with a known best."""

from __future__ import annotations

from typing import Any

import numpy as np

from . import _aep


class Task:
    """An identification task: a cost to try optimizers on, with limits as people have them and a best that is known.

    ``aep.minimize(task, task.bounds, log=task.log, target=task.target)`` runs a method on it; every other optimizer takes
    ``task`` as a function of a position, too. ``aep.tasks()`` has the names.

    Attributes
    ----------
    name, subject
        Its name, and what is identified from what.
    bounds, units, truth
        Per parameter, by name: (lower, upper), the unit, and the value that the recording was made with.
    log
        Names of the parameters to be searched by their logarithm.
    best, best_cost, target
        The best parameters that are known, shape (d,); their cost; the cost that counts as solved.
    """

    def __init__(self, name: str) -> None:
        self._task = _aep.Task(name)
        self.name, self.subject = name, tasks()[name]
        rows = self._task.parameters
        self.bounds = {row[0]: (row[2], row[3]) for row in rows}
        self.units = {row[0]: row[1] for row in rows}
        self.log = {row[0] for row in rows if row[4]}
        self.truth = {row[0]: row[5] for row in rows}
        best, self.best_cost, self.target = self._task.best
        self.best = np.array(best)

    def __call__(self, x: Any) -> float:
        """The cost of a position, shape (d,); NaN where the simulation fails."""
        return float(self.costs([x])[0])

    def costs(self, points: Any) -> np.ndarray:
        """The costs of many positions, shape (n, d): what ``vectorized=True`` wants."""
        return self._task.costs(np.atleast_2d(np.asarray(points, dtype=float)))

    def residuals(self, x: Any) -> np.ndarray:
        """What the cost is the sum of squares of, in standard deviations of the sensors: for a least-squares method."""
        return self._task.residuals(np.atleast_2d(np.asarray(x, dtype=float)))[0]

    def __repr__(self) -> str:
        return f"<Task {self.name!r}: {self.subject}>"


def tasks() -> dict[str, str]:
    """The identification tasks by name, each with what is identified."""
    return dict(_aep.tasks())
