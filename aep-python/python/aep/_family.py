"""A model of your own: any simulator, any subject."""

from __future__ import annotations

import warnings
from abc import ABC, abstractmethod
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np

from . import _aep
from ._discover import Found, _search, names
from ._minimize import _raise
from ._progress import Progress, listener

#: The terms of a model with the values of their parameters.
Model = Mapping[str, Mapping[str, float]]


@dataclass(frozen=True)
class Term:
    """Something that a model may have.

    ``amplitudes`` are parameters that the prediction is (nearly) linear in and at whose 0 the term is absent; ``shapes`` all
    others: a time constant, a level, a period. Each name has ``(unit, low, high, start)``. The limits are physics: what cannot
    be negative has ``low = 0``. Amplitudes are searched as they are, shapes by their logarithm, or as they are where ``low`` is
    0 or below. ``always``: every model has the term, and it is no candidate.
    """

    name: str
    amplitudes: Mapping[str, tuple[str, float, float, float]] = field(default_factory=dict)
    shapes: Mapping[str, tuple[str, float, float, float]] = field(default_factory=dict)
    always: bool = False
    title: str = ""
    equation: str = ""

    def _told(self) -> SimpleNamespace:
        parameters = [(name, unit, True, low, high, False, start) for name, (unit, low, high, start) in self.amplitudes.items()]
        parameters += [(name, unit, False, low, high, low > 0, start) for name, (unit, low, high, start) in self.shapes.items()]
        for name, _, _, low, high, _, start in parameters:
            if not (low < high and low <= start <= high and np.isfinite([low, high]).all()):
                raise ValueError(f"parameter {self.name}.{name}: {start} does not begin within {low} .. {high}\n  give (unit, low, high, start)")
        return SimpleNamespace(
            name=self.name, title=self.title or self.name, equation=self.equation, always=self.always, parameters=parameters
        )


class Family(ABC):
    """A recording seen through models of your own: MuJoCo, an FMU, your differential equation.

    Four methods say what it is. :func:`aep.discover_own` searches for what the base model lacks.
    """

    #: Name and SI unit of what is predicted.
    quantity: tuple[str, str] = ("output", "1")
    #: Standard deviation of the measurement's noise in that unit, where it is known: only then "complete" can be told of slow signals.
    noise: float | None = None

    @abstractmethod
    def time(self) -> Any:
        """Instants, s, shape (n,), increasing."""

    @abstractmethod
    def parameters(self) -> Sequence[Term]:
        """The terms that a model may have, with their parameters."""

    @abstractmethod
    def prediction(self, model: Model) -> Any:
        """What a model predicts, shape (n,): ``model["term"]["parameter"]``, with those terms only that the model has.

        It is asked for one model at a time. What it raises counts as a model that predicts nothing.
        """

    @abstractmethod
    def coordinates(self) -> Mapping[str, tuple[str, Any]]:
        """Signals that the residual may depend on, an input or a state: names with (unit, values of shape (n,)).

        A shift in time along which all of these repeat is no test of chance.
        """


class OwnFound(Found):
    """What was found of a :class:`Family`: as :class:`aep.Found`, without a model file."""

    def model(self, rung: int | None = None) -> dict[str, Any]:
        """The last model, or that of a rung, as :meth:`Family.prediction` is given it."""
        rung = self.ladder[-1 if rung is None else rung]
        values: dict[str, Any] = {name: {} for name in rung["effects"]}
        for key, estimate in rung["parameters"].items():
            term, _, name = key.partition(".")
            values.setdefault(term, {})[name or term] = estimate["value"]
        return values

    def save_model(self, path: Any) -> None:
        """There is no file for models of your own."""
        raise TypeError("a family of your own has no model file\n  model() has its values")


def discover_own(
    family: Family,
    measured: Any,
    *,
    base: Iterable[str] | str = (),
    exclude: Iterable[str] | str = (),
    seed: int = 1,
    alpha: float = 0.05,
    time_limit: float | None = 60.0,
    thresholds: Mapping[str, float] | None = None,
    progress: Progress = None,
) -> OwnFound:
    """Find out which term a model of your own lacks, or that it lacks none.

    Parameters
    ----------
    family
        What can be predicted: a :class:`Family`.
    measured
        What was measured at its instants, shape (n,), in the unit of its quantity.
    base
        Terms of the model to begin with, beside those that every model has.
    exclude, seed, alpha, time_limit, thresholds, progress
        As for :func:`aep.discover`.

    Raises
    ------
    ValueError, TypeError
        What is wrong with the family, and what mends it.
    aep.Interrupted
        Ctrl-C; ``result`` holds what was found until then.
    """
    if not isinstance(family, Family):
        raise TypeError(f"family is {type(family).__name__}, not an aep.Family\n  derive a class from it: four methods")
    time = np.asarray(family.time(), dtype=float)
    measured = _signal("measured", measured, len(time))
    coordinates = [(name, unit, _signal(name, values, len(time)).tolist()) for name, (unit, values) in family.coordinates().items()]
    terms = [term._told() for term in family.parameters()]
    subject = SimpleNamespace(
        terms=terms,
        quantity=tuple(family.quantity),
        time=time.tolist(),
        measured=measured.tolist(),
        coordinates=coordinates,
        noise=family.noise,
        prediction=lambda model: _signal("the prediction", family.prediction(model), len(time), finite=False),
    )
    # What is wrong with the family itself shows where it begins, and is raised there.
    subject.prediction({term.name: {p[0]: p[6] for p in term.parameters} for term in terms if term.always or term.name in names(base)})
    search = _search(names(base), None, exclude, None, None, seed, alpha, time_limit, thresholds, None)
    told = listener(progress)
    found, (count, first), raised = _aep.discover_own(subject, search, told)
    if count:
        warnings.warn(f"{count} predictions failed; the first: {type(first).__name__}: {first}", RuntimeWarning, stacklevel=2)
    result = OwnFound(found, f"aep.discover_own({type(family).__name__}(), measured)")
    if raised is not None:
        _raise(raised, result)
    return result


def _signal(name: str, values: Any, count: int, finite: bool = True) -> np.ndarray:
    array = np.asarray(values, dtype=float)
    if array.shape != (count,):
        raise ValueError(f"{name} has shape {array.shape}, time has {count} instants\n  give one value for each")
    if finite and not np.isfinite(array).all():
        raise ValueError(f"{name} has no number at sample {int(np.argmin(np.isfinite(array))) + 1}\n  leave such samples out")
    return array
