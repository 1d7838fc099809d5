"""Measurements from files, dictionaries of arrays, and frames."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np

from . import _aep
from ._columns import columns_of
from ._law import formula

#: Quantities that can be read, as keywords of every function that takes data.
ROLES = ("time", "force", "position", "velocity", "reference", "segment", "temperature", "enabled", "model_force")
_UNITS = ("time_unit", "force_unit", "position_unit", "velocity_unit", "reference_unit", "temperature_unit", "model_force_unit")
_GAINS = ("force_gain", "position_gain", "velocity_gain", "reference_gain")
READING = (*ROLES, *_UNITS, *_GAINS, "regressors", "interval", "topic", "hold", "t_from", "t_to", "every")


@dataclass(frozen=True)
class Effect:
    """A physical effect of your own: a law as a formula or a function, simulated, screened and reported like those of the library.

    >>> cogging = Effect(
    ...     "cogging",
    ...     "a*sin(2*pi*x/p) + b*cos(2*pi*x/p)",
    ...     {
    ...         "a": {"unit": "N", "low": -20, "high": 20, "default": 1, "linear": True},
    ...         "b": {"unit": "N", "low": -20, "high": 20, "default": 0, "linear": True},
    ...         "p": {"unit": "m", "low": 2e-4, "high": 2e-3, "default": 6e-4},
    ...     },
    ... )

    ``force`` is what resists the motion (N or Nm); it sees position ``x``, velocity ``v``, acceleration ``a``, the sign of the
    velocity ``s``, time ``t``, the force of the drive ``F``, the parameters (which come first) and every column of the data,
    in SI. With ``level`` in place of ``force`` it adds to the level of friction. ``linear`` parameters are factors of the law.

    In place of a formula stands a function with arguments of these names, on arrays of shape (n,), parameters as numbers:

    >>> def law(x, v, a, p):
    ...     return np.where(v > 0, a * np.sin(2 * np.pi * x / p), 0.0)
    >>> limits = {"low": 1e-4, "high": 10, "default": 1}
    >>> Effect("cogging", law, {"a": {"unit": "N", **limits}, "p": {"unit": "m", **limits}}).force
    'if(v > 0, a*sin(6.283185307179586*x/p), 0)'

    It is called once with symbols, and what it does becomes the formula, so that a search costs what a formula costs. Branches
    are ``np.where``, tables ``np.interp``; what depends on other samples (a memory, a mean) is no law of one sample.

    Raises
    ------
    aep.Untraceable
        A ``ValueError``: the function does what formulas cannot; which line it is, and what to write in its place.
    """

    name: str
    force: str | Callable[..., Any] | None = None
    parameters: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    level: str | Callable[..., Any] | None = None
    title: str = ""
    shows: str = ""

    def __post_init__(self) -> None:
        # As text from the beginning: it can be sent to other processes, and a report can say what was asked.
        for slot in ("force", "level"):
            law = getattr(self, slot)
            if callable(law):
                object.__setattr__(self, slot, formula(self.name, law, self.parameters))

    def to_toml(self) -> str:
        """As ``--effects-file`` of the command reads it."""
        lines = [f"name = {_toml(self.name)}", f"title = {_toml(self.title)}", f"shows = {_toml(self.shows)}"]
        lines += [f"{key} = {_toml(law)}" for key, law in (("force", self.force), ("level", self.level)) if law is not None]
        lines.append("[parameters]")
        for name, facts in self.parameters.items():
            inside = ", ".join(f"{key} = {_toml(value)}" for key, value in facts.items())
            lines.append(f"{_toml(name)} = {{ {inside} }}")
        return "\n".join(lines) + "\n"


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float, np.integer, np.floating)):
        # A number without a point is a whole one there.
        return repr(float(value))
    return json.dumps(str(value), ensure_ascii=False)


def load(data: Any, effects: Iterable[Effect | str | os.PathLike[str]] = (), **reading: Any) -> _aep.Data:
    """A checked recording in SI.

    Parameters
    ----------
    data
        A file, or several that are pieces of one measurement (CSV, MATLAB, Parquet, ``.npz``, ``.xlsx``, HDF5, MCAP); a
        dictionary of arrays, shape (n,), or of whatever gives a buffer; a pandas or polars frame; a pyarrow table, or what else
        has the Arrow interface; a NumPy array of records; or what this function returned before.
    effects
        Laws of your own: :class:`aep.Effect`, or files of the command's ``--effects-file``.
    reading
        Names of columns or formulas over columns (``force="duty*v_in_V"``), ``*_unit``, ``*_gain``, ``regressors`` (names and
        formulas), ``interval`` (s), ``topic``, ``hold`` (``"zero-order"`` or ``"sampled"``), ``t_from`` and ``t_to`` (s),
        ``every``. What is not said is told by the columns' names: ``time_s``, ``force_N``, ``position_m``; rotary
        ``torque_Nm``, ``angle_rad``.

    Raises
    ------
    ValueError, FileNotFoundError
        What is wrong with the data, where, and what mends it.
    """
    if isinstance(data, _aep.Data):
        if any(value is not None for value in reading.values()) or list(effects):
            raise ValueError("the data have been read already\n  say how to read them, and effects, to aep.load")
        return data
    unknown = sorted(set(reading) - set(READING))
    if unknown:
        raise TypeError(f"there is no way to read {unknown[0]!r}\n  there are: {', '.join(READING)}")
    how = _reading(reading, effects)
    if isinstance(data, (str, os.PathLike)):
        return _aep.Data.of_files([os.fspath(data)], how)
    columns = columns_of(data)
    if columns is not None:
        return _aep.Data.of_columns("data", columns, how)
    if isinstance(data, Sequence) and data and all(isinstance(path, (str, os.PathLike)) for path in data):
        return _aep.Data.of_files([os.fspath(path) for path in data], how)
    raise TypeError(
        f"data is {type(data).__name__}\n  give a file, several files, a dictionary of arrays, a pandas or polars frame, or an Arrow table"
    )


def _reading(given: Mapping[str, Any], effects: Iterable[Effect | str | os.PathLike[str]]) -> SimpleNamespace:
    said = {key: value for key, value in given.items() if value is not None}
    mapping: dict[str, Any] = {}
    for role in ROLES:
        source = {
            "column": said.get(role),
            "unit": said.get(f"{role}_unit"),
            "gain": None if f"{role}_gain" not in said else float(said[f"{role}_gain"]),
        }
        source = {key: value for key, value in source.items() if value is not None}
        if source:
            mapping[role] = source
    for key, name in (("regressors", "regressors"), ("interval", "interval_s"), ("topic", "topic"), ("hold", "hold")):
        if key in said:
            mapping[name] = dict(said[key]) if key == "regressors" else said[key]
    laws = []
    for effect in effects:
        if isinstance(effect, Effect):
            laws.append(effect.to_toml())
        else:
            with open(effect, encoding="utf-8") as file:
                laws.append(file.read())
    return SimpleNamespace(
        mapping=json.dumps(mapping), effects=laws, **{"from": said.get("t_from"), "to": said.get("t_to"), "every": said.get("every")}
    )
