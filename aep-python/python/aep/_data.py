"""Measurements from files, dictionaries of arrays, and frames."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from types import SimpleNamespace
from typing import Any

import numpy as np

from . import _aep

#: Quantities that can be read, as keywords of every function that takes data.
ROLES = ("time", "force", "position", "velocity", "reference", "segment", "temperature", "enabled", "model_force")
_UNITS = ("time_unit", "force_unit", "position_unit", "velocity_unit", "reference_unit", "temperature_unit", "model_force_unit")
_GAINS = ("force_gain", "position_gain", "velocity_gain", "reference_gain")
READING = (*ROLES, *_UNITS, *_GAINS, "regressors", "interval", "topic", "hold", "t_from", "t_to", "every")


@dataclass(frozen=True)
class Effect:
    """A physical effect of your own: a law as a formula, simulated, screened and reported like those of the library.

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
    """

    name: str
    force: str | None = None
    parameters: Mapping[str, Mapping[str, Any]] = field(default_factory=dict)
    level: str | None = None
    title: str = ""
    shows: str = ""

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
        dictionary of arrays, shape (n,); a pandas or polars frame; or what this function returned before.
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
    columns = _columns(data)
    if columns is not None:
        return _aep.Data.of_columns("data", columns, how)
    if isinstance(data, Sequence) and data and all(isinstance(path, (str, os.PathLike)) for path in data):
        return _aep.Data.of_files([os.fspath(path) for path in data], how)
    raise TypeError(
        f"data is {type(data).__name__}\n  give a file, several files, a dictionary of arrays, or a pandas or polars frame"
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


def _columns(data: Any) -> list[tuple[str, np.ndarray]] | None:
    """The numeric columns of a dictionary or frame; None where it is neither."""
    if isinstance(data, Mapping):
        named = list(data.items())
    elif hasattr(data, "columns") and hasattr(data, "__getitem__"):
        named = [(name, data[name]) for name in data.columns]
    else:
        return None
    columns = [(str(name), _numbers(values)) for name, values in named]
    return [(name, values) for name, values in columns if values is not None]


def _numbers(values: Any) -> np.ndarray | None:
    """As doubles, a view where they are; None for what is no column of numbers."""
    array = values.to_numpy() if hasattr(values, "to_numpy") else np.asarray(values)
    if array.dtype.kind in "Mm":
        # Dates count from the first one: only differences of times matter.
        elapsed = array - array[:1] if array.dtype.kind == "M" else array
        array = elapsed / np.timedelta64(1, "s")
    if array.ndim != 1 or array.dtype.kind not in "fiub":
        return None
    return np.ascontiguousarray(array, dtype=np.float64)
