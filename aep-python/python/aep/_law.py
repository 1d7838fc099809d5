"""A law that is a function of arrays, as a formula: called once with symbols, then held against itself by numbers."""

from __future__ import annotations

import inspect
import linecache
import os
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Any

import numpy as np

from . import _aep
from ._symbol import Symbol, Untraceable, _part

#: What a law may depend on: position, velocity, acceleration, sign of the velocity, time, force of the drive.
VARIABLES = ("x", "v", "a", "s", "t", "F")
_CONSTANTS = {"pi": np.pi, "PI": np.pi, "π": np.pi, "TAU": 2 * np.pi, "τ": 2 * np.pi, "E": np.e}
#: Sets of parameters, and samples of each, at which function and formula must agree.
_SETS, _SAMPLES = 4, 32


def formula(effect: str, law: Callable[..., Any], parameters: Mapping[str, Mapping[str, Any]]) -> str:
    """The formula of a law whose arguments are named as the names of formulas: variables, parameters, columns.

    Raises :class:`aep.Untraceable` where the function does what formulas cannot.
    """
    names = _arguments(effect, law, parameters)
    try:
        result = law(**{name: Symbol(name) for name in names})
        text = _part(result).text
    except Untraceable as error:
        raise _told(effect, law, error, str(error)) from None
    except Exception as error:
        hint = "it is called once with symbols in place of arrays: arithmetic and NumPy's functions of one sample"
        raise _told(effect, law, error, f"{type(error).__name__}: {error}\n  {hint}") from error
    _hold_against(effect, law, text, names, parameters)
    return text


def _arguments(effect: str, law: Callable[..., Any], parameters: Mapping[str, Any]) -> list[str]:
    """What the law is called with: what it names, but for names with defaults of their own."""
    if isinstance(law, np.vectorize):
        raise Untraceable(f"the law of '{effect}' is np.vectorize, a loop over samples\n  give a function of arrays: np.where in place of branches")
    try:
        given = inspect.signature(law).parameters.values()
    except (TypeError, ValueError) as error:
        raise Untraceable(f"the law of '{effect}' does not tell its arguments\n  write def law(x, v, ...): return ...") from error
    known = (*VARIABLES, *parameters)
    for argument in given:
        if argument.kind is argument.POSITIONAL_ONLY or argument.kind is argument.VAR_POSITIONAL:
            raise Untraceable(f"the law of '{effect}' takes '{argument.name}' by its place\n  name its arguments: {', '.join(known)}, columns")
    takes_all = any(argument.kind is argument.VAR_KEYWORD for argument in given)
    names = [a.name for a in given if a.kind is not a.VAR_KEYWORD and (a.default is a.empty or a.name in known)]
    missing = [name for name in parameters if name not in names]
    if missing and not takes_all:
        raise Untraceable(f"the law of '{effect}' does not take its parameter '{missing[0]}'\n  make it an argument, or leave the parameter out")
    return [*names, *missing]


def _hold_against(effect: str, law: Callable[..., Any], text: str, names: list[str], parameters: Mapping[str, Mapping[str, Any]]) -> None:
    """The function on arrays must be its formula: what depends on other samples, chance or an earlier call is not."""
    random = np.random.default_rng(1)
    for _ in range(_SETS):
        values: dict[str, Any] = {}
        for name in names:
            if name in parameters:
                values[name] = _drawn(parameters[name], random)
            else:
                values[name] = _CONSTANTS.get(name, random.normal(size=_SAMPLES) * 10.0 ** random.uniform(-3, 0, _SAMPLES))
        if "s" in values and "v" in values and "s" not in parameters and "v" not in parameters:
            values["s"] = np.sign(values["v"])
        columns = [(name, np.broadcast_to(np.asarray(value, dtype=float), _SAMPLES).copy()) for name, value in values.items()]
        expected = _aep.evaluate(text, columns, _SAMPLES)
        try:
            with np.errstate(all="ignore"):
                found = np.asarray(law(**{k: np.copy(v) if np.ndim(v) else v for k, v in values.items()}), dtype=float)
                found = np.broadcast_to(found, _SAMPLES)
        except Exception as error:
            raise _told(effect, law, error, f"on arrays of {_SAMPLES} samples: {type(error).__name__}: {error}") from error
        both = np.isfinite(found) & np.isfinite(expected)
        size = np.abs(found[both])
        apart = np.abs(found[both] - expected[both]) > 1e-6 * (size + np.median(size)) if both.any() else np.zeros(0)
        if apart.any():
            k = int(np.flatnonzero(both)[np.argmax(apart)])
            at = ", ".join(f"{name}={values[k]:.4g}" for name, values in columns)
            raise Untraceable(
                f"the law of '{effect}' is not what it does with symbols: {found[k]:.6g} at {at}, its formula gives {expected[k]:.6g}\n"
                f"  {text}\n  it may depend on other samples, on chance, on an earlier call, or on the type of its arguments"
            )


def _drawn(facts: Mapping[str, Any], random: np.random.Generator) -> float:
    low, high = facts.get("low"), facts.get("high")
    if low is None or high is None or not low < high:
        # What is wrong with it is told where the effect is read.
        return float(facts.get("default", 1.0))
    return float(np.exp(random.uniform(np.log(low), np.log(high))) if low > 0 else random.uniform(low, high))


def _told(effect: str, law: Callable[..., Any], error: BaseException, what: str) -> Untraceable:
    what, _, hint = what.partition("\n")
    place = _place(law, error.__traceback__)
    return Untraceable("\n".join(filter(None, [f"the law of '{effect}' cannot be made a formula: {what}", place, hint])))


def _place(law: Callable[..., Any], trace: TracebackType | None) -> str:
    """The line of the user's where it happened: the last one that is neither NumPy's nor ours."""
    ours, found = os.path.dirname(__file__), ""
    while trace is not None:
        file, line = trace.tb_frame.f_code.co_filename, trace.tb_lineno
        if not file.startswith(ours) and f"{os.sep}numpy{os.sep}" not in file and file != "<__array_function__ internals>":
            source = linecache.getline(file, line).strip()
            found = f"  {os.path.basename(file)}, line {line}" + (f": {source}" if source else "")
        trace = trace.tb_next
    return found
