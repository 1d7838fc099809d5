"""Ask and tell."""

from __future__ import annotations

import os
from typing import Any

import numpy as np

from . import _aep
from ._bounds import space
from ._minimize import initial


class Optimizer:
    """An optimizer whose positions somebody else evaluates: a test bench, a queue, people.

    >>> optimizer = Optimizer([(-5, 5)] * 3, seed=1)
    >>> for _ in range(300):
    ...     points = optimizer.ask()
    ...     optimizer.tell((points**2).sum(axis=1))
    >>> bool(optimizer.best[1] < 1e-6)
    True

    Parameters as for :func:`aep.minimize`.
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
        self._optimizer = _aep.Optimizer(box, method, population or 0, seed, initial(x0, box))
        self.names: list[str] = box.names

    def ask(self) -> np.ndarray:
        """The positions to be evaluated next, shape (n, d). Asking again before telling gives the same ones."""
        return self._optimizer.ask()

    def tell(self, costs: Any) -> None:
        """The costs of the last :meth:`ask`, shape (n,), in its order; what is not finite counts as the worst.

        Raises ``ValueError`` where nothing was asked or the number is another one; the run is as before then.
        """
        self._optimizer.tell(np.ascontiguousarray(costs, dtype=float).reshape(-1))

    @property
    def best(self) -> tuple[np.ndarray, float] | None:
        """The best position so far, shape (d,), and its cost; None before the first finite cost."""
        return self._optimizer.best

    @property
    def generation(self) -> int:
        """Generations completed; the first one is generation 0."""
        return self._optimizer.generation

    @property
    def exhausted(self) -> str | None:
        """Why going on is pointless, if the method knows."""
        return self._optimizer.exhausted

    def checkpoint(self, path: str | os.PathLike[str]) -> None:
        """Writes the run to ``path``, whole or not at all; between :meth:`ask` and :meth:`tell` as it was before ``ask``."""
        self._optimizer.save(os.fspath(path))

    def restore(self, path: str | os.PathLike[str]) -> None:
        """Goes on from a file of :meth:`checkpoint` of a run with the same bounds, method, population and seed.

        Raises ``ValueError`` where the file is of another run or damaged, ``OSError`` where it cannot be read.
        """
        self._optimizer.restore(os.fspath(path))
