"""The loop by hand: a model held against data, what it may lack, one effect more, what to run next."""

from __future__ import annotations

import json
import os
from collections.abc import Iterable, Mapping
from typing import Any

from . import _aep
from ._data import load
from ._discover import Found, _search, command, names
from ._files import write
from ._minimize import _raise
from ._progress import Progress, listener
from ._result import Result


def _model(model: Any) -> str:
    """A model as text: from a file, a dictionary as :meth:`Found.model` returns it, or a result."""
    if isinstance(model, Found):
        return json.dumps(model.model())
    if isinstance(model, Mapping):
        return json.dumps(model)
    with open(model, encoding="utf-8") as file:
        return file.read()


def _name(model: Any, number: int) -> str:
    return os.path.splitext(os.path.basename(model))[0] if isinstance(model, (str, os.PathLike)) else f"model_{number}"


def compare(data: Any, model: Any, *others: Any, bandwidth: float | None = None, seed: int = 1, effects: Iterable[Any] = (), **reading: Any) -> Found:
    """Hold models against a measurement; nothing is fitted.

    ``data`` and ``reading`` as for :func:`aep.load`; a model is a file, what :meth:`aep.Found.model` returns, or a result. Of
    the first one everything is told (``error``, ``where``, ``regimes``, ``views``, ``series``, ``to_html()``); ``models`` has
    the views of all, side by side. Raises ``ValueError`` for models of another kind of drive.
    """
    effects = list(effects)
    given = load(data, effects, **reading)
    models = [(_name(each, number), _model(each)) for number, each in enumerate((model, *others), 1)]
    found, views, raised = _aep.compare(given, models, _search(seed=seed, bandwidth=bandwidth))
    asked = dict(bandwidth=bandwidth, seed=seed, effects=effects)
    result = Found(found, command("compare", compare, data, model, *others, **asked, **reading))
    result.facts["models"] = [{"model": name, "views": of} for (name, _), of in zip(models, json.loads(views))]
    if raised is not None:
        _raise(raised, result)
    return result


def suggest(
    data: Any,
    model: Any,
    *,
    exclude: Iterable[str] | str = (),
    effects: Iterable[Any] = (),
    fix: Mapping[str, float] | None = None,
    bound: Mapping[str, tuple[float, float]] | None = None,
    seed: int = 1,
    alpha: float = 0.05,
    time_limit: float | None = 60.0,
    thresholds: Mapping[str, float] | None = None,
    bandwidth: float | None = None,
    progress: Progress = None,
    **reading: Any,
) -> Found:
    """Suggest the effect that a model lacks, without adding it.

    The model's effects are refitted and every other one is tried beside them: ``ranking[0]`` has them with what each gains,
    ``most_likely`` the name. Parameters as for :func:`aep.discover` and :func:`aep.compare`.
    """
    effects = list(effects)
    given = load(data, effects, **reading)
    search = _search(None, None, exclude, fix, bound, seed, alpha, time_limit, thresholds, bandwidth)
    told = listener(progress)
    found, raised = _aep.suggest(given, _model(model), search, told)
    asked = dict(
        exclude=search.exclude, effects=effects, fix=fix, bound=bound, seed=seed, alpha=alpha, time_limit=time_limit,
        thresholds=thresholds, bandwidth=bandwidth,
    )
    result = Found(found, command("suggest", suggest, data, model, **asked, **reading))
    if raised is not None:
        _raise(raised, result)
    return result


def extend(
    data: Any,
    model: Any,
    add: str,
    *,
    effects: Iterable[Any] = (),
    fix: Mapping[str, float] | None = None,
    bound: Mapping[str, tuple[float, float]] | None = None,
    seed: int = 1,
    bandwidth: float | None = None,
    **reading: Any,
) -> Found:
    """Add an effect to a model and refit it: ``ladder`` has before and after, ``model()`` the extended one."""
    effects = list(effects)
    given = load(data, effects, **reading)
    search = _search(fix=fix, bound=bound, seed=seed, bandwidth=bandwidth)
    found, raised = _aep.extend(given, _model(model), add, search)
    asked = dict(add=add, effects=effects, fix=fix, bound=bound, seed=seed, bandwidth=bandwidth)
    result = Found(found, command("extend", extend, data, model, **asked, **reading))
    if raised is not None:
        _raise(raised, result)
    return result


def experiment(
    data: Any,
    rivals: Iterable[str] | str,
    *,
    below: Iterable[str] | str = ("coulomb", "viscous", "offset"),
    effects: Iterable[Any] = (),
    fix: Mapping[str, float] | None = None,
    bound: Mapping[str, tuple[float, float]] | None = None,
    seed: int = 1,
    bandwidth: float | None = None,
    **reading: Any,
) -> Result:
    """The motion that tells rival effects apart, each of them added to a model of the effects ``below``.

    Within the stroke, speed and acceleration of the data. Returns ``time`` (s) and ``position`` (m or rad), shape (n,), to be
    followed by the axis; ``motion``, ``about``, ``duration_s``, how far the rivals lie apart as ``predicted`` for it and ``here`` (``force`` in the unit of
    the force, ``deviations`` of the noise), ``is_worth_running``, ``tried``.
    """
    given = load(data, effects, **reading)
    search = _search(fix=fix, bound=bound, seed=seed, bandwidth=bandwidth)
    facts, time, position, raised = _aep.experiment(given, names(below), names(rivals), search)
    result = Result(json.loads(facts), time=time, position=position)
    if raised is not None:
        _raise(raised, result)
    return result


def simulate(data: Any, model: Any, *, effects: Iterable[Any] = (), **reading: Any) -> dict[str, Any]:
    """The motion of a model under the recorded force, each piece from its measured position on: columns, shape (n,).

    A free run drifts away from the measurement like an integral of the force error, also for a good model:
    :func:`aep.compare` judges a model better. Raises ``ValueError`` where the simulation runs away.
    """
    return dict(_aep.simulate(load(data, effects, **reading), _model(model)))


def challenge(folder: str | os.PathLike[str], hide: str = "random", *, size: str = "clear", seed: int = 1) -> Result:
    """Make data whose truth is known: a simulated ball-screw table with an effect hidden in it.

    Writes ``recording.csv`` and ``recording.toml``, which :func:`aep.discover` reads, and ``truth.json``, which it never does.
    ``hide`` is an effect, ``"random"`` or ``"nothing"``; ``size`` ``"faint"``, ``"moderate"`` or ``"clear"`` against the noise.
    Returns ``recording`` (the file) and ``truth``. Raises ``ValueError`` for what cannot hide there.
    """
    recording, reading, truth = _aep.challenge(hide, size, seed)
    os.makedirs(folder, exist_ok=True)
    for name, text in (("recording.csv", recording), ("recording.toml", reading), ("truth.json", truth + "\n")):
        write(os.path.join(folder, name), text)
    return Result(recording=os.path.join(folder, "recording.csv"), truth=json.loads(truth))


def effects() -> dict[str, dict[str, str]]:
    """The effects of the library and their forms by name, each with ``title`` and ``equation``."""
    return {name: {"title": title, "equation": equation} for name, title, equation in _aep.effects()}
