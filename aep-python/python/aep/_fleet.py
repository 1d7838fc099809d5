"""Many drives: what each lacks, and how sizes differ between them."""

from __future__ import annotations

import functools
import multiprocessing
import os
import signal
import statistics
from collections.abc import Iterable, Mapping
from concurrent.futures import Executor, ProcessPoolExecutor
from html import escape
from typing import Any

from ._discover import discover
from ._growth import growth, places
from ._result import Interrupted, Result
from ._workers import end


class Fleet(list):
    """A row a drive: ``drive``, ``verdict``, ``added``, ``summary``, ``error`` (x sensors, of the last model), ``friction`` and
    ``parameters`` of the last model, or ``failure`` where a drive could not be searched."""

    def sizes(self) -> dict[str, dict[str, float]]:
        """Parameters of the last models, ``"effect.parameter"`` -> drive -> value: how sizes differ between drives."""
        return {name: {drive: estimate["value"] for drive, estimate in of.items()} for name, of in self._estimates().items()}

    def spread(self) -> list[Result]:
        """How sizes differ between drives, a row a parameter: ``parameter``, ``unit``, ``drives``, ``least``, ``median``, ``most``,
        and who is ``apart``: the drives whose 95 % interval does not hold the median (of drives alike one in 20 is)."""
        rows = []
        for name, of in self._estimates().items():
            values = [estimate["value"] for estimate in of.values()]
            median = statistics.median(values)
            apart = [drive for drive, e in of.items() if e["low"] is not None and not e["low"] <= median <= e["high"]]
            unit = next(iter(of.values()))["unit"]
            rows.append(
                Result(parameter=name, unit=unit, drives=len(values), least=min(values), median=median, most=max(values), apart=apart)
            )
        return rows

    def growth(self, when: Mapping[Any, Any] | None = None) -> list[Result]:
        """How sizes grow over time, a row for each drive and parameter, the surest first.

        Recordings are named by pairs of drive and time, ``{("axis 7", "2024-05-31"): "7_may.csv", ...}``, or ``when`` gives the
        pair for each name. Times are dates or numbers. A row has ``drive``, ``parameter``, ``unit``, ``recordings``, ``first``,
        ``last``, ``slope`` (a day, where times are dates) with its standard ``error`` and ``p_value``, and ``grows``: surer than
        chance in the whole table, with one false alarm in 20 tables. Estimates count by their 95 % intervals.

        Raises ``ValueError`` where a recording has no time.
        """
        at = places([row["drive"] for row in self if "failure" not in row], when)
        return growth(self._estimates(), at)

    def _estimates(self) -> dict[str, dict[Any, dict[str, Any]]]:
        table: dict[str, dict[Any, dict[str, Any]]] = {}
        for row in self:
            for name, estimate in (row.get("parameters") or {}).items():
                table.setdefault(name, {})[row["drive"]] = estimate
        return table

    def _repr_html_(self) -> str:
        head = "".join(f"<th>{name}</th>" for name in ("drive", "what it lacks", "prediction error, x sensors", ""))
        rows = "".join(f"<tr>{''.join(f'<td>{escape(cell)}</td>' for cell in self._cells(row))}</tr>" for row in self)
        return f"<table><tr>{head}</tr>{rows}</table>"

    @staticmethod
    def _cells(row: dict[str, Any]) -> list[str]:
        name = row["drive"] if isinstance(row["drive"], str) else ", ".join(map(str, row["drive"]))
        if "failure" in row:
            return [name, "", "", row["failure"]]
        error = "" if row["error"] is None else f"{row['error']:.2f}"
        return [name, " + ".join(row["added"]) or "nothing found", error, row["summary"]]

    def counts(self) -> dict[str, int]:
        """How many drives lack each effect, the most frequent first."""
        every = [effect for row in self for effect in row.get("added") or []]
        return {effect: every.count(effect) for effect in sorted(set(every), key=lambda e: (-every.count(e), e))}

    def to_frame(self) -> Any:
        """As a pandas frame: a row a drive, the values of all parameters as columns."""
        import pandas

        plain = ("drive", "verdict", "summary", "error", "failure")
        rows = [
            {
                **{key: row.get(key) for key in plain},
                "added": ", ".join(row.get("added") or []),
                **{name: estimate["value"] for name, estimate in (row.get("parameters") or {}).items()},
            }
            for row in self
        ]
        return pandas.DataFrame(rows).set_index("drive")


def discover_many(drives: Mapping[str, Any] | Iterable[Any], *, workers: Any = 1, **settings: Any) -> Fleet:
    """Search many drives, a task each.

    Parameters
    ----------
    drives
        Names with data, or files; each as for :func:`aep.discover`.
    workers
        A number of processes, a map, or an executor. The threads of this machine are shared among the processes.
    settings
        Those of :func:`aep.discover`, the same for every drive.

    Returns
    -------
    Fleet
        A row a drive, in their order. A drive that cannot be read or searched has a ``failure``; the others go on.

    Raises
    ------
    aep.Interrupted
        Ctrl-C; ``result`` holds the drives that were done.
    """
    named = list(drives.items()) if isinstance(drives, Mapping) else [(os.fspath(file), file) for file in drives]
    task = functools.partial(_one, settings=settings)
    if isinstance(workers, int) and not isinstance(workers, bool):
        if workers < 1:
            raise ValueError(f"workers is {workers}\n  give a number of processes: 1 or more")
        if workers == 1:
            return _gathered(map(task, named))
        threads = max(1, (os.cpu_count() or 1) // workers)
        # New interpreters: the search runs on threads, which a copy of this process would not have.
        context = multiprocessing.get_context("spawn")
        pool = ProcessPoolExecutor(workers, mp_context=context, initializer=_begin, initargs=(threads,))
        try:
            return _gathered(pool.map(task, named))
        finally:
            end(pool)
    mapping = workers.map if isinstance(workers, Executor) or not callable(workers) else workers
    return _gathered(mapping(task, named))


def _gathered(rows: Iterable[dict[str, Any]]) -> Fleet:
    fleet = Fleet()
    try:
        for row in rows:
            fleet.append(row)
    except KeyboardInterrupt:
        raise Interrupted(fleet) from None
    return fleet


def _begin(threads: int) -> None:
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    os.environ.setdefault("RAYON_NUM_THREADS", str(threads))


def _one(named: tuple[str, Any], settings: Mapping[str, Any]) -> dict[str, Any]:
    name, data = named
    try:
        found = discover(data, **settings)
    except (ValueError, OSError) as error:
        return {"drive": name, "failure": str(error)}
    last = found.ladder[-1] if found.ladder else {}
    return {
        "drive": name,
        "verdict": found.verdict,
        "added": found.added,
        "summary": found.summary,
        "error": last.get("budget"),
        "friction": found.facts.get("friction"),
        "parameters": found.parameters,
    }
