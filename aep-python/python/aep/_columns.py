"""Columns of numbers from whatever holds them: views where they are doubles already, copies where not."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np


def columns_of(data: Any) -> list[tuple[str, np.ndarray]] | None:
    """The numeric columns of a dictionary, frame, Arrow table or array of records; None where it is none of them."""
    named = _named(data)
    if named is None:
        return None
    columns = [(str(name), _numbers(values)) for name, values in named]
    return [(name, values) for name, values in columns if values is not None]


def _named(data: Any) -> Iterable[tuple[Any, Any]] | None:
    if isinstance(data, Mapping):
        return data.items()
    if isinstance(data, np.ndarray):
        return None if data.dtype.names is None else [(name, data[name]) for name in data.dtype.names]
    if hasattr(data, "collect") and not hasattr(data, "to_numpy"):
        raise TypeError(f"data is a {type(data).__name__}, which has not been computed\n  give data.collect()")
    # Arrow's tables have their columns, not the names of them, under `columns`.
    names = getattr(data, "column_names", None)
    if names is None and hasattr(data, "__getitem__"):
        names = getattr(data, "columns", None)
    if names is not None:
        return [(name, data[name]) for name in names]
    if hasattr(data, "__arrow_c_stream__"):
        try:
            import pyarrow
        except ImportError as error:
            raise TypeError(f"data is {type(data).__name__}, which pyarrow would read\n  pip install pyarrow, or give a frame") from error
        return _named(pyarrow.table(data))
    return None


def _numbers(values: Any) -> np.ndarray | None:
    """As doubles, a view where they are, NaN where there is no number; None for what is no column of numbers."""
    array = values.to_numpy() if hasattr(values, "to_numpy") else np.asarray(values)
    if array.dtype.kind == "O":
        array = _plain(values, array)
    if array.dtype.kind in "Mm":
        # Dates count from the first one: only differences of times matter.
        elapsed = array - array[:1] if array.dtype.kind == "M" else array
        array = elapsed / np.timedelta64(1, "s")
    if array.ndim != 1 or array.dtype.kind not in "fiub":
        return None
    return np.ascontiguousarray(array, dtype=np.float64)


def _plain(values: Any, array: np.ndarray) -> np.ndarray:
    """Objects as numbers or dates, where they are: pandas gives such arrays of columns that miss values or have a time zone."""
    kind = getattr(getattr(values, "dtype", None), "kind", "O")
    try:
        if kind == "M":
            return np.asarray(values.dt.tz_convert("UTC").dt.tz_localize(None), dtype="datetime64[ns]")
        if kind in "fiub":
            return values.to_numpy(dtype=np.float64, na_value=np.nan)
        first = next((value for value in array.flat if value is not None), None)
        if isinstance(first, (str, bytes)):
            return array
        return array.astype("datetime64[ns]" if hasattr(first, "isoformat") else np.float64)
    except (TypeError, ValueError, AttributeError):
        return array
