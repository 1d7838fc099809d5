"""Where a cost is defined."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from ._aep import Space


def space(bounds: Any, integrality: Any = None, log: Any = None) -> Space:
    """The box that ``bounds`` describes: pairs, a scipy ``Bounds``, or a dictionary of names with pairs."""
    names: list[str] = []
    if isinstance(bounds, Mapping):
        names, pairs = [str(name) for name in bounds], list(bounds.values())
    elif hasattr(bounds, "lb") and hasattr(bounds, "ub"):
        lower, upper = np.broadcast_arrays(np.atleast_1d(bounds.lb), np.atleast_1d(bounds.ub))
        pairs = list(zip(lower, upper))
    else:
        pairs = list(bounds)
    try:
        limits = np.array(pairs, dtype=float).reshape(len(pairs), 2)
    except (TypeError, ValueError) as error:
        raise ValueError(
            "bounds are no pairs of numbers\n  give (lower, upper) for each component, or a dictionary of names with pairs"
        ) from error
    whole, logarithmic = _mask("integrality", integrality, names, len(limits)), _mask("log", log, names, len(limits))
    return Space(limits[:, 0].tolist(), limits[:, 1].tolist(), logarithmic, whole, names)


def _mask(what: str, given: Any, names: Sequence[str], dimension: int) -> list[bool]:
    """One truth value a component, from None, one for all, a sequence of them, or names."""
    if given is None:
        return [False] * dimension
    if isinstance(given, (set, frozenset)) or (
        not isinstance(given, str) and np.ndim(given) == 1 and len(given) and all(isinstance(x, str) for x in given)
    ):
        unknown = sorted(set(given) - set(names))
        if unknown:
            raise ValueError(f"{what}: there is no component {unknown[0]!r}\n  name those of bounds: {', '.join(names)}")
        return [name in set(given) for name in names]
    values = np.asarray(given, dtype=bool)
    if values.ndim == 0:
        return [bool(values)] * dimension
    if values.shape != (dimension,):
        raise ValueError(f"{what} has {values.size} entries for {dimension} components\n  give one for each component")
    return values.tolist()
