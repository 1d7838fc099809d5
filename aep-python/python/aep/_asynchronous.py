"""A run that waits for nobody: as soon as a cost comes, its individual goes on, whoever else is still at work."""

from __future__ import annotations

import json
import math
import os
import time
import warnings
from collections.abc import Callable
from concurrent.futures import FIRST_COMPLETED, BrokenExecutor, Future, wait
from dataclasses import asdict, dataclass
from types import SimpleNamespace
from typing import Any

import numpy as np

from . import _aep
from ._cost import Cost, Evaluated
from ._result import Result, WorkersLost
from ._sending import Sends, sender
from ._workers import Losses


@dataclass
class Counts:
    """What the loop counts and a checkpoint keeps."""

    non_finite: int = 0
    errors: int = 0
    first: str | None = None
    elapsed: float = 0.0
    #: Best cost when progress was last seen, and the costs told until then.
    progress: tuple[float, int] = (math.inf, 0)


@dataclass
class Away:
    """A position somebody works on."""

    individual: int
    position: np.ndarray
    attempts: int = 0


def run(
    cost: Cost,
    steady: _aep.Steady,
    workers: Any,
    retries: int,
    losses: Losses,
    limits: SimpleNamespace,
    identity: str,
    kept: SimpleNamespace | None,
    told: Callable[[dict[str, Any]], bool] | None,
) -> tuple[dict[str, Any], BaseException | None]:
    """What a run found, as the compiled ``minimize`` tells it, and what ended it early, if anything did."""
    if retries < 0:
        raise ValueError(f"retries is {retries}\n  it is how often lost evaluations are repeated: 0 or more")
    if limits.seconds is not None and not 0.0 <= limits.seconds < math.inf:
        raise ValueError(f"the time limit is {limits.seconds} s\n  it is 0 or more")
    with sender(cost, workers, retries, losses) as sends:
        loop = _Loop(steady, sends, retries, losses, limits, identity, kept, told)
        if kept is not None and kept.resume:
            loop.counts = _read(steady.restore(kept.path, identity))
        return loop.run()


def _read(counts: str) -> Counts:
    saved = json.loads(counts)
    return Counts(**{**saved, "progress": tuple(saved["progress"])})


class _Loop:
    def __init__(
        self,
        steady: _aep.Steady,
        sends: Sends,
        retries: int,
        losses: Losses,
        limits: SimpleNamespace,
        identity: str,
        kept: SimpleNamespace | None,
        told: Callable[[dict[str, Any]], bool] | None,
    ) -> None:
        self.steady, self.sends, self.retries, self.losses = steady, sends, retries, losses
        self.limits, self.identity, self.kept, self.told = limits, identity, kept, told
        self.counts = Counts()
        self.away: dict[Future[Evaluated], Away] = {}
        self.size = steady.individuals
        self.width = min(self.size, sends.width or self.size)
        self.checkpoint_error: str | None = None
        self.stopped: str | None = None
        most = [limits.evaluations, None if limits.generations is None else self.size * (limits.generations + 1)]
        self.most = min((m for m in most if m is not None), default=None)
        self.begin = time.perf_counter()

    def run(self) -> tuple[dict[str, Any], BaseException | None]:
        self.begin = time.perf_counter() - self.counts.elapsed
        raised: BaseException | None = None
        try:
            while (stop := self._ended()) is None:
                self._send()
                if not self.away:
                    stop = self._used_up()
                    break
                self._take(wait(self.away, timeout=self._patience(), return_when=FIRST_COMPLETED).done)
        except BaseException as error:
            stop, raised = "interrupted", error
        for future in self.away:
            future.cancel()
        self.counts.elapsed = time.perf_counter() - self.begin
        self._keep()
        return self._facts(stop), raised

    def _best(self) -> float:
        best = self.steady.best
        return math.inf if best is None else best[1]

    def _ended(self) -> str | None:
        limits, told = self.limits, self.steady.told
        if limits.target is not None and self._best() <= limits.target:
            return "target"
        if self.stopped is not None:
            return self.stopped
        if limits.seconds is not None and time.perf_counter() - self.begin >= limits.seconds:
            return "time"
        if limits.stagnation is not None and told >= self.size:
            generations = (told - self.counts.progress[1]) // self.size
            return "stagnation" if generations >= limits.stagnation[0] else None
        return None

    def _used_up(self) -> str:
        return "evaluations" if self.limits.evaluations is not None and self.most == self.limits.evaluations else "generations"

    def _patience(self) -> float | None:
        if self.limits.seconds is None:
            return None
        return max(0.0, self.begin + self.limits.seconds - time.perf_counter())

    def _send(self) -> None:
        while len(self.away) < self.width and (self.most is None or self.steady.told + len(self.away) < self.most):
            asked = self.steady.ask()
            if asked is None:
                return
            self._begin(Away(*asked))

    def _begin(self, task: Away) -> None:
        try:
            self.away[self.sends(task.position)] = task
        except Exception as error:
            self._lost([task], error)

    def _take(self, done: set[Future[Evaluated]]) -> None:
        """Tells what has come, in the order in which it was sent; what was lost is sent again."""
        lost: list[Away] = []
        cause: Exception | None = None
        for future in [future for future in self.away if future in done]:
            task = self.away.pop(future)
            try:
                costs, errors, first = future.result()
            except Exception as error:
                lost.append(task)
                cause = cause or error
                continue
            self._tell(task, float(costs[0]), errors, first)
        if cause is not None:
            self._lost(lost, cause)

    def _lost(self, lost: list[Away], cause: Exception) -> None:
        if isinstance(cause, BrokenExecutor):
            # Nothing that is away will come any more.
            lost = [*lost, *self.away.values()]
            self.away.clear()
            if not self.sends.renew():
                raise WorkersLost(
                    f"the executor broke ({type(cause).__name__}: {cause}) and cannot be started again from here\n"
                    "  give workers=N: pools of its own are made anew; or checkpoint=FILE, and go on with resume=True"
                ) from cause
            self.losses.tell(f"a worker process died; {len(lost)} evaluations are repeated")
        else:
            if any(task.attempts >= self.retries for task in lost):
                raise WorkersLost(
                    f"the workers failed {self.retries + 1} times at one position; the last time: {type(cause).__name__}: {cause}\n"
                    "  what the cost raises is counted, so this is the pool itself, or a cost that cannot be sent to it"
                ) from cause
            self.losses.tell(f"workers were lost ({type(cause).__name__}: {cause}); {len(lost)} evaluations are repeated")
        for task in lost:
            task.attempts += 1
            if task.attempts > self.retries:
                costs, errors, first = self.sends.alone(task.position)
                self._tell(task, float(costs[0]), errors, first)
            else:
                self._begin(task)

    def _tell(self, task: Away, cost: float, errors: int, first: str | None) -> None:
        counts = self.counts
        self.steady.tell(task.individual, cost)
        counts.errors += errors
        counts.non_finite += 0 if errors or math.isfinite(cost) else 1
        counts.first = counts.first or first
        told, best = self.steady.told, self._best()
        reference = counts.progress[0]
        tolerance = 0.0 if self.limits.stagnation is None else self.limits.stagnation[1]
        if math.isinf(reference) or best < reference - tolerance * abs(reference):
            counts.progress = (best, told)
        if told == self.size and counts.errors == told:
            warnings.warn(f"every evaluation of the first generation failed; the first: {counts.first}", RuntimeWarning, stacklevel=2)
        if told % self.size == 0:
            self._generation(told // self.size - 1)

    def _generation(self, number: int) -> None:
        """As many costs have come as there are individuals."""
        if self.kept is not None and number % max(1, self.kept.every) == 0:
            self._keep()
        if self.told is None:
            return
        best = self.steady.best
        facts = {
            "x": np.array([]) if best is None else best[0],
            "fun": self._best(),
            "nfev": self.steady.told,
            "nit": number,
            "failures": self.counts.errors + self.counts.non_finite,
            "elapsed": time.perf_counter() - self.begin,
        }
        try:
            if self.told(facts):
                self.stopped = "interrupted"
        except StopIteration:
            self.stopped = "interrupted"

    def _keep(self) -> None:
        if self.kept is None:
            return
        self.counts.elapsed = time.perf_counter() - self.begin
        try:
            self.steady.save(os.fspath(self.kept.path), self.identity, json.dumps(asdict(self.counts)))
        except (OSError, ValueError) as error:
            self.checkpoint_error = str(error)

    def _facts(self, stop: str) -> dict[str, Any]:
        best, told = self.steady.best, self.steady.told
        return Result(
            x=np.array([]) if best is None else best[0],
            fun=self._best(),
            nfev=told,
            nit=max(0, told // self.size - 1),
            elapsed=self.counts.elapsed,
            stop=stop,
            message=_aep.stop_message(stop),
            non_finite=self.counts.non_finite,
            errors=self.counts.errors,
            first_error=self.counts.first,
            checkpoint_error=self.checkpoint_error,
        )
