"""Symbols that stand for arrays while a law is called once: what NumPy is asked to do with them becomes a formula's text.

The law is then evaluated by the engine at every step of every simulation, where a call of Python would cost more than the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np
from numpy.lib.mixins import NDArrayOperatorsMixin

#: How tightly a text holds together, as the engine's parser reads it: a part that holds less stands in brackets.
_COMPARISON, _SUM, _PRODUCT, _SIGNED, _POWER, _ATOM = range(6)


class Untraceable(ValueError):
    """A law that cannot be made a formula: what it does, where, and what to write in its place."""


#: Most characters of a formula (``aep_formula::MOST_LENGTH``).
_LONGEST = 4096


class Symbol(NDArrayOperatorsMixin):
    """A quantity at one sample. ``text`` is the formula so far."""

    def __init__(self, text: str, rank: int = _ATOM, is_condition: bool = False) -> None:
        if len(text) > _LONGEST:
            # What is used twice is written twice, so that a few lines can grow without end.
            raise Untraceable(
                f"its formula is longer than {_LONGEST} characters here: {text[:40]}...\n"
                "  what is computed once and used often is written out each time: simplify it, or give it as a column of the data"
            )
        self.text, self.rank, self.is_condition = text, rank, is_condition

    def __repr__(self) -> str:
        return self.text

    def __array_ufunc__(self, ufunc: np.ufunc, method: str, *inputs: Any, **keywords: Any) -> Any:
        # `y += 1` names its own target; the result is bound to the name all the same.
        out = keywords.pop("out", ())
        if method != "__call__" or ufunc.__name__ in _JOINING:
            how = "" if method == "__call__" else f".{method}"
            raise Untraceable(f"np.{ufunc.__name__}{how} joins several samples{_OF_ONE_SAMPLE}")
        if keywords:
            raise Untraceable(f"np.{ufunc.__name__} with {', '.join(keywords)}\n  write np.where(condition, a, b)")
        if any(not isinstance(target, Symbol) for target in out if target is not None):
            raise Untraceable(f"np.{ufunc.__name__} writes into an array\n  let it return its result")
        if ufunc.__name__ not in _UFUNCS:
            raise Untraceable(f"formulas have no np.{ufunc.__name__}{_THERE_ARE}")
        return _UFUNCS[ufunc.__name__](*inputs)

    def __array_function__(self, function: Any, types: Any, inputs: Any, keywords: Any) -> Any:
        name = getattr(function, "__name__", repr(function))
        if name in _FUNCTIONS:
            return _FUNCTIONS[name](*inputs, **keywords)
        if name in _JOINING:
            raise Untraceable(f"np.{name} joins several samples{_OF_ONE_SAMPLE}")
        raise Untraceable(f"formulas have no np.{name}{_THERE_ARE}")

    def clip(self, min: Any = None, max: Any = None) -> Symbol:  # noqa: A002
        return _clip(self, min, max)

    def copy(self) -> Symbol:
        return self

    def __round__(self, digits: int = 0) -> Symbol:
        return _round(self, digits)

    def __bool__(self) -> bool:
        raise Untraceable(
            f"a branch on '{self.text}', which is another one at each sample\n"
            "  write np.where(condition, a, b), np.minimum, np.maximum or np.clip; & and | in place of and, or"
        )

    def _number(self) -> Any:
        raise Untraceable(f"a single number is made of '{self.text}'\n  write NumPy's functions: np.sin in place of math.sin")

    __float__ = __int__ = __index__ = __complex__ = _number

    def _items(self, *_: Any) -> Any:
        raise Untraceable(f"samples of '{self.text}' are counted, picked or gone through{_OF_ONE_SAMPLE}")

    __len__ = __iter__ = __getitem__ = __contains__ = _items

    def __setitem__(self, *_: Any) -> None:
        raise Untraceable(f"some samples of '{self.text}' are written over\n  write np.where(condition, a, b), or np.select for several")

    def __array__(self, *_: Any, **__: Any) -> Any:
        raise Untraceable(f"an array is made of '{self.text}'\n  leave np.asarray and loops (np.vectorize) out: the law is called with arrays")

    def __getattr__(self, name: str) -> Any:
        # NumPy asks what a thing is by such names; a user asks for the others.
        if name.startswith("__"):
            raise AttributeError(name)
        if name in _JOINING:
            raise Untraceable(f".{name} joins several samples{_OF_ONE_SAMPLE}")
        raise Untraceable(f"there is no '.{name}' of one sample\n  write NumPy's functions of it: np.where, np.abs, np.sin, ...")


_OF_ONE_SAMPLE = (
    ", but a law is of one sample at a time\n  what depends on others: give it as a column of the data, and take it as an argument"
)
_THERE_ARE = (
    "\n  there are arithmetic, comparisons, & | ~, roots, exponentials, trigonometric and rounding functions of one sample,\n"
    "  abs, sign, minimum, maximum, clip, where, select, piecewise, interp, polyval, heaviside, hypot"
)
#: What makes one number of many samples, or moves between them.
_JOINING = frozenset(
    "sum mean std var median min max amin amax ptp prod cumsum cumprod diff gradient trapezoid convolve argmin argmax any all roll sort "
    "percentile quantile average nanmean nanmax nanmin dot matmul cov correlate fft ifft rfft shift rolling".split()
)


def _part(value: Any) -> Symbol:
    """A symbol, or a number as one."""
    if isinstance(value, Symbol):
        return value
    array = np.asarray(value)
    if array.ndim:
        raise Untraceable(
            f"an array of shape {array.shape} meets a sample\n"
            "  a table is np.interp(x, points, values); what each sample has of its own is a column of the data"
        )
    if array.dtype.kind not in "biuf":
        raise Untraceable(f"{value!r} is no number\n  formulas are of real numbers")
    number = float(array)
    if not np.isfinite(number):
        raise Untraceable(f"{number} is no number of a formula\n  leave that limit out, or give a number")
    text = repr(abs(number)).removesuffix(".0")
    return Symbol(f"-{text}", _SIGNED) if np.signbit(number) else Symbol(text)


def _within(value: Any, rank: int) -> str:
    """In brackets where it holds less tightly than ``rank``."""
    part = _part(value)
    return part.text if part.rank >= rank else f"({part.text})"


def _infix(sign: str, rank: int) -> Callable[[Any, Any], Symbol]:
    # What stands on the right holds more tightly, so that sums are made in the order of the function.
    return lambda a, b: Symbol(f"{_within(a, rank)}{sign}{_right(b, rank)}", rank)


def _right(value: Any, rank: int) -> str:
    part = _part(value)
    return f"({part.text})" if part.rank <= rank or part.rank == _SIGNED else part.text


def _compared(sign: str) -> Callable[[Any, Any], Symbol]:
    return lambda a, b: Symbol(f"{_within(a, _SUM)} {sign} {_within(b, _SUM)}", _COMPARISON, is_condition=True)


def _called(name: str) -> Callable[..., Symbol]:
    return lambda *values: Symbol(f"{name}({', '.join(_part(value).text for value in values)})")


_add, _subtract, _multiply = _infix(" + ", _SUM), _infix(" - ", _SUM), _infix("*", _PRODUCT)
_divide, _remainder = _infix("/", _PRODUCT), _infix(" % ", _PRODUCT)
_min, _max, _exp, _log, _floor, _if = (_called(name) for name in ("min", "max", "exp", "log", "floor", "if"))
_greater, _equal, _differs = _compared(">"), _compared("=="), _compared("!=")


def _power(a: Any, b: Any) -> Symbol:
    return Symbol(f"{_within(a, _ATOM)}^{_within(b, _ATOM)}", _POWER)


def _negative(a: Any) -> Symbol:
    return Symbol(f"-{_within(a, _ATOM)}", _SIGNED)


def _condition(value: Any) -> Symbol:
    part = _part(value)
    return part if part.is_condition else _differs(part, 0)


def _as_condition(symbol: Symbol) -> Symbol:
    return Symbol(symbol.text, symbol.rank, is_condition=True)


def _bits(name: str, of_conditions: Callable[..., Symbol]) -> Callable[..., Symbol]:
    def joined(*values: Any) -> Symbol:
        if not all(isinstance(value, (bool, np.bool_)) or _part(value).is_condition for value in values):
            raise Untraceable(f"'{name}' of numbers\n  compare first, each in brackets: (v > 0) {name} (x > 0)")
        return of_conditions(*values)

    return joined


def _and(a: Any, b: Any) -> Symbol:
    return _as_condition(_multiply(_condition(a), _condition(b)))


def _or(a: Any, b: Any) -> Symbol:
    return _as_condition(_max(_condition(a), _condition(b)))


def _not(a: Any) -> Symbol:
    return _as_condition(_subtract(1, _condition(a)))


def _xor(a: Any, b: Any) -> Symbol:
    return _differs(_condition(a), _condition(b))


def _floor_divide(a: Any, b: Any) -> Symbol:
    return _floor(_divide(a, b))


def _modulo(a: Any, b: Any) -> Symbol:
    """NumPy's has the sign of b, the formula's the sign of a."""
    return _subtract(a, _multiply(_part(b), _floor_divide(a, b)))


#: By the name of NumPy's function, or SciPy's.
_UFUNCS: dict[str, Callable[..., Any]] = {
    **{name: _called(name) for name in ("sqrt", "cbrt", "exp", "log", "log2", "log10", "hypot", "sign", "floor", "ceil", "trunc")},
    **{name: _called(name) for name in ("sin", "cos", "tan", "sinh", "cosh", "tanh")},
    **{f"arc{name}": _called(f"a{name}") for name in ("sin", "cos", "tan", "tan2", "sinh", "cosh", "tanh")},
    **{f"a{name}": _called(f"a{name}") for name in ("sin", "cos", "tan", "tan2", "sinh", "cosh", "tanh")},
    "add": _add,
    "subtract": _subtract,
    "multiply": _multiply,
    "divide": _divide,
    "true_divide": _divide,
    "floor_divide": _floor_divide,
    "remainder": _modulo,
    "mod": _modulo,
    "fmod": _remainder,
    "divmod": lambda a, b: (_floor_divide(a, b), _modulo(a, b)),
    "power": _power,
    "float_power": _power,
    "pow": _power,
    "square": lambda a: _power(a, 2),
    "reciprocal": lambda a: _divide(1, a),
    "negative": _negative,
    "positive": _part,
    "absolute": _called("abs"),
    "fabs": _called("abs"),
    "minimum": _min,
    "maximum": _max,
    "fmin": _min,
    "fmax": _max,
    "rint": _called("round"),
    "exp2": lambda a: _power(2, a),
    "expm1": lambda a: _subtract(_exp(a), 1),
    "log1p": lambda a: _log(_add(1, a)),
    "deg2rad": lambda a: _multiply(a, np.pi / 180),
    "radians": lambda a: _multiply(a, np.pi / 180),
    "rad2deg": lambda a: _multiply(a, 180 / np.pi),
    "degrees": lambda a: _multiply(a, 180 / np.pi),
    "heaviside": lambda a, b: _add(_greater(a, 0), _multiply(_part(b), _equal(a, 0))),
    "copysign": lambda a, b: _multiply(_called("abs")(a), _called("signum")(b)),
    "expit": lambda a: _divide(1, _add(1, _exp(_negative(a)))),
    "greater": _greater,
    "greater_equal": _compared(">="),
    "less": _compared("<"),
    "less_equal": _compared("<="),
    "equal": _equal,
    "not_equal": _differs,
    "logical_and": _and,
    "logical_or": _or,
    "logical_not": _not,
    "logical_xor": _xor,
    "bitwise_and": _bits("&", _and),
    "bitwise_or": _bits("|", _or),
    "bitwise_xor": _bits("^", _xor),
    "invert": _bits("~", _not),
}


def _where(condition: Any, *values: Any) -> Symbol:
    if len(values) != 2:
        raise Untraceable(f"np.where finds places{_OF_ONE_SAMPLE}")
    return _if(_part(condition), *values)


def _clip(a: Any, a_min: Any = None, a_max: Any = None, **keywords: Any) -> Symbol:
    low, high = keywords.pop("min", a_min), keywords.pop("max", a_max)
    if keywords:
        raise Untraceable(f"np.clip with {', '.join(keywords)}\n  write np.clip(x, low, high)")
    bounded = _part(a) if low is None else _max(a, low)
    return bounded if high is None else _min(bounded, high)


def _round(a: Any, decimals: int = 0, out: Any = None) -> Symbol:
    if decimals:
        return _divide(_called("round")(_multiply(a, 10**decimals)), 10**decimals)
    return _called("round")(a)


def _interp(x: Any, xp: Sequence[Any], fp: Sequence[Any], left: Any = None, right: Any = None, period: Any = None) -> Symbol:
    """A table is a sum of ramps, each from a point to the next one; it stays level beyond its ends, as NumPy's does."""
    points = [float(point) for point in np.asarray(xp, dtype=float)]
    values = list(fp)
    if left is not None or right is not None or period is not None:
        raise Untraceable("np.interp with left, right or period\n  write np.interp(np.mod(x, period), ...), and np.where beyond the ends")
    if len(points) != len(values) or any(b <= a for a, b in zip(points, points[1:])):
        raise Untraceable("np.interp without rising points, or not a value for each\n  give points that rise")
    total = _part(values[0])
    for (a, b), (low, high) in zip(zip(points, points[1:]), zip(values, values[1:])):
        ramp = _subtract(_called("clamp")(x, a, b), a)
        slope = _divide(high - low, b - a) if isinstance(high - low, Symbol) else (high - low) / (b - a)
        total = _add(total, _multiply(slope, ramp))
    return total


def _polyval(p: Sequence[Any], x: Any) -> Symbol:
    first, *rest = p
    value = _part(first)
    for coefficient in rest:
        value = _add(_multiply(value, x), coefficient)
    return value


def _select(conditions: Sequence[Any], choices: Sequence[Any], default: Any = 0) -> Symbol:
    value = _part(default)
    for condition, choice in zip(reversed(list(conditions)), reversed(list(choices))):
        value = _if(_part(condition), choice, value)
    return value


def _piecewise(x: Any, conditions: Sequence[Any], functions: Sequence[Any], *args: Any, **keywords: Any) -> Symbol:
    values = [function(x, *args, **keywords) if callable(function) else function for function in functions]
    default = values[len(conditions)] if len(values) > len(conditions) else 0
    # Where several hold NumPy takes the last one.
    return _select(list(reversed(list(conditions))), list(reversed(values[: len(conditions)])), default)


def _sinc(x: Any) -> Symbol:
    turned = _multiply(x, np.pi)
    return _if(_equal(x, 0), 1, _divide(_called("sin")(turned), turned))


_FUNCTIONS: dict[str, Callable[..., Any]] = {
    "where": _where,
    "clip": _clip,
    "round": _round,
    "around": _round,
    "interp": _interp,
    "polyval": _polyval,
    "select": _select,
    "piecewise": _piecewise,
    "sinc": _sinc,
    "copy": lambda a, *_, **__: a,
    "zeros_like": lambda a, *_, **__: _part(0),
    "ones_like": lambda a, *_, **__: _part(1),
    "full_like": lambda a, value, *_, **__: _part(value),
    "empty_like": lambda a, *_, **__: _part(0),
}
