"""What a drive's model lacks."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from inspect import signature
from types import SimpleNamespace
from typing import Any

from . import _aep
from ._data import load
from ._files import write
from ._minimize import _raise
from ._plots import Plots
from ._progress import Progress, listener


class Found(Plots):
    """What was found. Every entry of the JSON of the command is an attribute, too (``found.decisions``)."""

    def __init__(self, found: _aep.Found, command: str) -> None:
        self._found = found
        self._command = command
        #: All that ``aep discover --json`` writes.
        self.facts: dict[str, Any] = json.loads(found.json())
        self._series: dict[str, Any] | None = None

    def __getattr__(self, name: str) -> Any:
        facts = self.__dict__.get("facts", {})
        if name in facts:
            return facts[name]
        raise AttributeError(f"there is no '{name}'; there are: {', '.join(facts)}")

    def __dir__(self) -> list[str]:
        return sorted({*super().__dir__(), *self.facts})

    @property
    def parameters(self) -> dict[str, dict[str, Any]]:
        """Parameters of the last model, ``"effect.parameter"`` -> ``value``, ``low``, ``high``, ``unit``, ``identifiable``."""
        return self.ladder[-1]["parameters"] if self.ladder else {}

    @property
    def series(self) -> dict[str, Any]:
        """Every sample as named columns, shape (n,): what was measured and, of every model, prediction and residual, units in
        the names. ``pandas.DataFrame(found.series)`` is a frame."""
        if self._series is None:
            self._series = dict(self._found.series())
        return self._series

    def model(self, rung: int | None = None) -> dict[str, Any]:
        """The last model, or that of a rung, as a model file has it: for :func:`aep.compare` and the others."""
        return json.loads(self._found.model(len(self.ladder) - 1 if rung is None else rung))

    def save_model(self, path: str | os.PathLike[str]) -> None:
        """Writes the last model, as ``aep discover -o`` does; whole or not at all."""
        write(path, self._found.model(len(self.ladder) - 1) + "\n")

    def to_html(self, path: str | os.PathLike[str] | None = None) -> str:
        """The report page of the command, one file that loads nothing; written to ``path`` where one is given."""
        page = self._found.html(self._command)
        if path is not None:
            write(path, page)
        return page

    def to_json(self, path: str | os.PathLike[str] | None = None) -> str:
        """As the command writes it; to ``path`` where one is given."""
        text = json.dumps(self.facts, indent=2, ensure_ascii=False)
        if path is not None:
            write(path, text + "\n")
        return text

    def __repr__(self) -> str:
        rows = ["  ".join(row).rstrip() for row in _aligned(self._table())]
        return "\n".join([self.facts.get("summary", ""), *rows]).strip()

    def _repr_html_(self) -> str:
        from html import escape

        head, *rows = self._table()
        head = "".join(f"<th>{escape(cell)}</th>" for cell in head)
        body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
        notes = "".join(f"<li>{escape(note)}</li>" for note in self.facts.get("notes", []))
        return f"<p><b>{escape(self.facts.get('summary', ''))}</b></p><table><tr>{head}</tr>{body}</table><ul>{notes}</ul>"

    def _table(self) -> list[list[str]]:
        """The ladder: a row a model."""
        rows = [["model", "prediction error, x sensors", "gain, nats", "p-value"]]
        for number, rung in enumerate(self.ladder):
            name = " + ".join(rung["added"]) if number else " + ".join(rung["effects"])
            cells = [_number(rung.get(key), form) for key, form in (("budget", ".2f"), ("likelihood_gain", "+.0f"), ("p_value", ".2g"))]
            rows.append([f"+ {name}" if number else name or "base model", *cells])
        return rows


def _number(value: float | None, form: str) -> str:
    return "" if value is None else format(value, form)


def _aligned(rows: list[list[str]]) -> list[list[str]]:
    widths = [max(map(len, column)) for column in zip(*rows)]
    return [[row[0].ljust(widths[0]), *(cell.rjust(width) for cell, width in zip(row[1:], widths[1:]))] for row in rows]


def discover(
    data: Any,
    *,
    base: Iterable[str] | str | None = None,
    model_gain: str | None = None,
    exclude: Iterable[str] = (),
    effects: Iterable[Any] = (),
    fix: Mapping[str, float] | None = None,
    bound: Mapping[str, tuple[float, float]] | None = None,
    validate: Any = None,
    surrogates: int = 0,
    seed: int = 1,
    alpha: float = 0.05,
    time_limit: float | None = 60.0,
    thresholds: Mapping[str, float] | None = None,
    bandwidth: float | None = None,
    progress: Progress = None,
    **reading: Any,
) -> Found:
    """Find out which physical effect the model of a drive lacks, or that it lacks none.

    The search is that of ``aep discover``: the same numbers, the same words.

    Parameters
    ----------
    data
        See :func:`aep.load`, with the ways to read it: ``force=``, ``position_unit=``, ``hold=``, ... With ``model_force=``,
        the column of the force (N or Nm) that your own model gives for each row, what that model lacks is looked for.
    base
        Effects of the model to begin with; by default coulomb, viscous and offset, and none beside ``model_force``.
    model_gain
        ``"fit"``: a factor on the model's force is fitted.
    exclude
        Effects not to try.
    effects
        Laws of your own, see :class:`aep.Effect`.
    fix, bound
        What is known of parameters, SI: ``{"mass": 95.1}``, ``{"viscous.F_v": (0, 300)}``.
    validate
        Other recordings of the same drive, to confirm on them what was found; read in the same way.
    surrogates
        How many surrogates are searched for false alarms on this very axis.
    seed, alpha, time_limit, thresholds, bandwidth
        As the flags of the command: ``time_limit`` in s, None for no limit; ``thresholds`` by their names in
        docs/decisions.md (``better``, ``chance``, ``beam``, ...); ``bandwidth`` in Hz, of what is shown.
    progress
        Called while it runs with ``stage`` (``base-fitted``, ``screening``, ``compared``, ``concluding``,
        ``finishing``) and its numbers; or a bar such as ``tqdm.tqdm()``, which is moved on by one at each and told what it is.

    Returns
    -------
    Found
        ``verdict``, ``added``, ``summary`` (a sentence), ``ladder``, ``parameters``, ``series`` (arrays), ``plot_*``,
        ``to_html()``, ``model()``, and every other entry of the JSON.

    Raises
    ------
    ValueError, TypeError, FileNotFoundError
        Data or settings that cannot be meant: what, where, and what mends it.
    aep.Interrupted
        Ctrl-C; ``result`` holds what was found until then.
    """
    base, effects = None if base is None else names(base), list(effects)
    given = load(data, effects, **reading)
    other = None if validate is None else load(validate, effects, **reading)
    search = _search(base, model_gain, exclude, fix, bound, seed, alpha, time_limit, thresholds, bandwidth)
    told = listener(progress)
    found, raised = _aep.discover(given, search, other, int(surrogates), told)
    asked = dict(
        base=base, model_gain=model_gain, exclude=search.exclude, effects=effects, fix=fix, bound=bound, validate=validate,
        surrogates=surrogates, seed=seed, alpha=alpha, time_limit=time_limit, thresholds=thresholds, bandwidth=bandwidth,
    )
    result = Found(found, command("discover", discover, data, **asked, **reading))
    if raised is not None:
        _raise(raised, result)
    return result


def _search(
    base: Iterable[str] | str | None = None,
    model_gain: str | None = None,
    exclude: Iterable[str] | str = (),
    fix: Mapping[str, float] | None = None,
    bound: Mapping[str, tuple[float, float]] | None = None,
    seed: int = 1,
    alpha: float = 0.05,
    time_limit: float | None = None,
    thresholds: Mapping[str, float] | None = None,
    bandwidth: float | None = None,
) -> SimpleNamespace:
    if model_gain not in (None, "one", "fit"):
        raise ValueError(f"model_gain is {model_gain!r}\n  it is 'one' or 'fit'")
    return SimpleNamespace(
        base=None if base is None else names(base),
        fit_model_gain=model_gain == "fit",
        exclude=names(exclude),
        seed=seed,
        alpha=alpha,
        time_limit=time_limit,
        thresholds={name: float(value) for name, value in (thresholds or {}).items()},
        bandwidth=bandwidth,
        fix=dict(fix or {}),
        bound={name: tuple(limits) for name, limits in (bound or {}).items()},
    )


def names(given: Iterable[str] | str) -> list[str]:
    """Names of effects from a list or from ``"coulomb,viscous"``."""
    parts = given.replace("+", ",").split(",") if isinstance(given, str) else given
    return [part.strip() for part in parts if part.strip()]


def command(name: str, function: Any, *data: Any, **given: Any) -> str:
    """How a page is made again: what differs from the defaults of a function. What is no file is called ``data``."""
    defaults = {key: parameter.default for key, parameter in signature(function).parameters.items()}
    files = [repr(os.fspath(each)) if isinstance(each, (str, os.PathLike)) else "data" for each in data]
    said = [f"{key}={value!r}" for key, value in given.items() if value not in (None, [], ()) and value != defaults.get(key)]
    return f"aep.{name}({', '.join([*files, *said])})"


