"""Ask and tell, one position at a time."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from . import _aep
from ._bounds import space
from ._minimize import initial


class SteadyOptimizer:
    """An optimizer that waits for nobody: its positions are asked and told one at a time, in any order.

    For a queue whose evaluations take different times. The same seed gives the same run where costs come in the same order.

    >>> optimizer = SteadyOptimizer([(-5, 5)] * 3, seed=1)
    >>> while optimizer.told < 8_000:
    ...     first, second = optimizer.ask(), optimizer.ask()
    ...     for individual, x in (second, first):
    ...         optimizer.tell(individual, (x**2).sum())
    >>> bool(optimizer.best[1] < 1e-6)
    True

    Parameters as for :func:`aep.minimize`; ``method`` is one with an asynchronous mode.
    """

    def __init__(
        self,
        bounds: Any,
        *,
        method: str = "aep-practical",
        population: int | None = None,
        seed: int = 1,
        x0: Any = None,
        integrality: Any = None,
        log: Any = None,
    ) -> None:
        box = space(bounds, integrality, log)
        self._steady = _aep.Steady(box, method, population or 0, seed, initial(x0, box))
        self.names: list[str] = box.names

    def ask(self) -> tuple[int, np.ndarray] | None:
        """An individual and its position, shape (d,); None while the costs of all individuals are awaited."""
        return self._steady.ask()

    def tell(self, individual: int, cost: float) -> None:
        """The cost of the position that was asked for an individual; what is not finite counts as the worst.

        Raises ``ValueError`` where no cost of it is awaited; the run is as before then.
        """
        self._steady.tell(individual, float(cost))

    @property
    def best(self) -> tuple[np.ndarray, float] | None:
        """The best position so far, shape (d,), and its cost; None before the first finite cost."""
        return self._steady.best

    @property
    def individuals(self) -> int:
        """How many costs can be awaited at the same time."""
        return self._steady.individuals

    @property
    def told(self) -> int:
        """Costs told."""
        return self._steady.told

    def checkpoint(self, path: str | os.PathLike[str]) -> None:
        """Writes the run to ``path``, whole or not at all; positions whose costs are awaited are made anew after it."""
        self._steady.save(os.fspath(path), "", "")

    def restore(self, path: str | os.PathLike[str]) -> None:
        """Goes on from a file of :meth:`checkpoint` of a run with the same bounds, method, population and seed.

        Raises ``ValueError`` where the file is of another run or damaged, ``OSError`` where it cannot be read.
        """
        self._steady.restore(os.fspath(path), "")
