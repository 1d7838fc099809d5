"""What does your model lack? Missing physics from measurements, and an evolutionary optimizer.

:func:`discover` tells which physical effect a drive's model lacks; :func:`minimize` minimises any function. See docs/python.md.
"""

from __future__ import annotations

from ._aep import __version__
from ._data import Effect, load
from ._discover import Found, discover
from ._drive import challenge, compare, effects, experiment, extend, simulate, suggest
from ._family import Family, OwnFound, Term, discover_own
from ._fleet import Fleet, discover_many
from ._minimize import minimize
from ._optimizer import Optimizer
from ._result import Interrupted, Result, WorkersLost
from ._steady import SteadyOptimizer
from ._symbol import Untraceable
from ._tasks import Task, tasks
from ._trials import Trials, trials


def methods() -> dict[str, str]:
    """The methods of :func:`minimize` by name, each with what it is."""
    from . import _aep

    return dict(_aep.methods())


__all__ = [
    "Effect",
    "Family",
    "Fleet",
    "Found",
    "Interrupted",
    "Optimizer",
    "OwnFound",
    "Result",
    "SteadyOptimizer",
    "Task",
    "Term",
    "Trials",
    "Untraceable",
    "WorkersLost",
    "__version__",
    "challenge",
    "compare",
    "discover",
    "discover_many",
    "discover_own",
    "effects",
    "experiment",
    "extend",
    "load",
    "methods",
    "minimize",
    "simulate",
    "suggest",
    "tasks",
    "trials",
]
