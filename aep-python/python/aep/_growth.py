"""How sizes grow over time: a line through the estimates of each drive's recordings."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from ._result import Result

#: An estimate's 95 % interval in its standard errors.
_INTERVAL = 2 * 2.03
#: Of a change that chance alone would make in one of so many tables.
ALPHA = 0.05


def places(names: Iterable[Any], when: Mapping[Any, Any] | None) -> dict[Any, tuple[str, Any]]:
    """Drive and time of each recording, from ``when`` or from names that are pairs of them."""
    found: dict[Any, tuple[str, Any]] = {}
    for name in names:
        said = name if when is None else when.get(name)
        if said is None:
            raise ValueError(f"when does not say the time of {name!r}\n  give a time, or a pair of drive and time, for each")
        if isinstance(said, tuple) and len(said) == 2:
            found[name] = (str(said[0]), said[1])
        elif when is None:
            raise ValueError(f"{name!r} does not say when\n  name recordings by pairs (drive, time), or give when={{name: (drive, time)}}")
        else:
            found[name] = ("", said)
    return found


def elapsed(times: list[Any]) -> tuple[np.ndarray, str]:
    """Times since the first one, and their unit: days of dates, else what numbers were in."""
    if all(isinstance(time, (int, float, np.integer, np.floating)) for time in times):
        values, unit = np.array(times, dtype=float), "1"
    else:
        try:
            values, unit = np.array([np.datetime64(time) for time in times], dtype="datetime64[ms]").astype(float) / 86_400e3, "d"
        except (TypeError, ValueError) as error:
            raise ValueError(f"times are numbers or dates, but one is {times[0]!r}\n  give 2024-05-31, a datetime, or a number") from error
    return values - values.min(), unit


def line(time: np.ndarray, value: np.ndarray, low: np.ndarray, high: np.ndarray) -> tuple[float, float, float]:
    """Slope, its standard error and the two-sided p-value of none.

    Estimates count by their intervals. Where they scatter more than those say (warmth, load), the error is as much larger, and
    the p-value is of Student's t; of two recordings the intervals are all that is known.
    """
    error = np.maximum((high - low) / _INTERVAL, 1e-300)
    weight = 1.0 / error**2
    middle = np.average(time, weights=weight)
    spread = np.sum(weight * (time - middle) ** 2)
    mean = np.average(value, weights=weight)
    slope = float(np.sum(weight * (time - middle) * (value - mean)) / spread)
    own, freedom = 1.0 / math.sqrt(spread), len(time) - 2
    if freedom == 0:
        return slope, own, math.erfc(abs(slope) / own / math.sqrt(2))
    left = np.sum(weight * (value - mean - slope * (time - middle)) ** 2) / freedom
    own *= math.sqrt(max(1.0, left))
    return slope, own, _student(abs(slope) / own, freedom)


def _student(t: float, freedom: int) -> float:
    """Probability of a larger |t| (Abramowitz and Stegun 26.7.3 and 26.7.4)."""
    angle = math.atan(t / math.sqrt(freedom))
    cosine, sine = math.cos(angle) ** 2, math.sin(angle)
    odd = freedom % 2
    term = math.cos(angle) if odd else 1.0
    total = 0.0 if freedom == 1 else term
    for k in range(2 + odd, freedom - 1, 2):
        term *= cosine * (k - 1) / k
        total += term
    inside = 2 / math.pi * (angle + sine * total) if odd else sine * total
    return max(0.0, 1.0 - inside)


def growth(estimates: Mapping[str, Mapping[Any, Mapping[str, Any]]], at: Mapping[Any, tuple[str, Any]]) -> list[Result]:
    """A row for each drive and parameter that several of its recordings have."""
    if not at:
        return []
    since, unit = elapsed([time for _, time in at.values()])
    times = dict(zip(at, since))
    rows = []
    for parameter, of in estimates.items():
        drives: dict[str, list[Any]] = {}
        for name in of:
            drives.setdefault(at[name][0], []).append(name)
        for drive, recordings in drives.items():
            recordings.sort(key=times.__getitem__)
            time = np.array([times[name] for name in recordings])
            facts = [of[name] for name in recordings]
            value, low, high = (np.array([fact[key] for fact in facts], dtype=float) for key in ("value", "low", "high"))
            usable = np.isfinite([value, low, high]).all(axis=0) & (high > low)
            if usable.sum() < 2 or np.ptp(time[usable]) == 0:
                continue
            slope, error, p_value = line(time[usable], value[usable], low[usable], high[usable])
            rows.append(
                Result(
                    drive=drive, parameter=parameter, unit=facts[0]["unit"], recordings=int(usable.sum()),
                    first=float(value[usable][0]), last=float(value[usable][-1]),
                    slope=slope, error=error, per="d" if unit == "d" else "unit of time", p_value=p_value,
                )
            )
    for row in rows:
        # One false alarm in 20 tables, however many lines they have.
        row["grows"] = row.p_value < ALPHA / len(rows)
    return sorted(rows, key=lambda row: row.p_value)
