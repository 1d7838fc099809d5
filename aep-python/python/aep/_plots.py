"""Plots of a result, by matplotlib where it is installed."""

from __future__ import annotations

from typing import Any

import numpy as np


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    try:
        from matplotlib import pyplot
    except ImportError as error:
        raise ImportError("plots need matplotlib\n  pip install matplotlib; to_html() needs nothing") from error
    return pyplot.subplots(figsize=(8, 3.5), layout="constrained")[1]


class Plots:
    """Views of ``series`` and ``ladder``. Each draws into ``ax``, or a new figure, and returns the axes."""

    series: dict[str, Any]

    def _models(self) -> list[str]:
        return list(dict.fromkeys(name.split(".", 1)[0] for name in self.series if "." in name))

    def _name(self, prefix: str, *, of: str | None = None) -> str:
        start = prefix if of is None else f"{of}.{prefix}"
        return next(name for name in self.series if name.startswith(start))

    def plot_force(self, ax: Any = None) -> Any:
        """The compared force against time, as measured and as the first and the last model require it."""
        ax = _axes(ax)
        force = self._name("compared_")
        quantity = force.removeprefix("compared_")
        time, models = self.series["time_s"], self._models()
        ax.plot(time, self.series[force], color="0.6", linewidth=2.0, label="measured")
        for model in dict.fromkeys([models[0], models[-1]]):
            ax.plot(time, self.series[f"{model}.{quantity}"], linewidth=0.8, label=model)
        ax.set(xlabel="time, s", ylabel=quantity.replace("_", ", "))
        ax.legend()
        return ax

    def plot_residual(self, ax: Any = None) -> Any:
        """What the first and the last model leave of the compared force, against time."""
        ax = _axes(ax)
        quantity = self._name("compared_").removeprefix("compared_")
        models = self._models()
        for model in dict.fromkeys([models[0], models[-1]]):
            ax.plot(self.series["time_s"], self.series[f"{model}.residual_{quantity}"], linewidth=0.6, label=model)
        ax.set(xlabel="time, s", ylabel="residual " + quantity.replace("_", ", "))
        ax.legend()
        return ax

    def plot_along(self, coordinate: Any, label: str = "", bins: int = 60, ax: Any = None) -> Any:
        """What the first and the last model leave, mean over bins of ``coordinate``: a name of ``series`` or an array, (n,)."""
        ax = _axes(ax)
        if isinstance(coordinate, str):
            coordinate, label = self.series[coordinate], label or coordinate
        coordinate = np.asarray(coordinate, dtype=float)
        quantity = self._name("compared_").removeprefix("compared_")
        models = self._models()
        edges = np.linspace(np.nanmin(coordinate), np.nanmax(coordinate), bins + 1)
        place = np.clip(np.digitize(coordinate, edges) - 1, 0, bins - 1)
        for model in dict.fromkeys([models[0], models[-1]]):
            left = np.asarray(self.series[f"{model}.residual_{quantity}"])
            known = np.isfinite(left)
            count = np.bincount(place[known], minlength=bins)
            total = np.bincount(place[known], left[known], minlength=bins)
            mean = np.divide(total, count, out=np.full(bins, np.nan), where=count > 0)
            ax.plot((edges[:-1] + edges[1:]) / 2, mean, marker=".", label=model)
        ax.set(xlabel=label, ylabel="mean residual " + quantity.replace("_", ", "))
        ax.legend()
        return ax

    def plot_ladder(self, ax: Any = None) -> Any:
        """The prediction error of every model, in multiples of what the sensors alone make."""
        ax = _axes(ax)
        models = [" + ".join(rung["added"]) or "base model" for rung in self.ladder]  # type: ignore[attr-defined]
        errors = [rung["budget"] if rung.get("budget") is not None else np.nan for rung in self.ladder]  # type: ignore[attr-defined]
        ax.barh(models, errors)
        ax.invert_yaxis()
        ax.axvline(1.0, color="0.4", linewidth=0.8)
        ax.set(xlabel="prediction error, x sensors")
        return ax
