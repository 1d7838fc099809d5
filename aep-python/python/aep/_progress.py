"""Who hears how far a search is: a function, or a bar such as tqdm's."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

from ._result import Result


class Bar(Protocol):
    """A bar such as ``tqdm.tqdm()``."""

    def update(self, n: int) -> Any: ...


Progress = Callable[[Result], Any] | Bar | None


def listener(progress: Progress) -> Callable[[dict[str, Any]], Any] | None:
    """What is called with each happening. Of a bar ``update(1)`` and, where it has it, ``set_description``."""
    if progress is None:
        return None
    if hasattr(progress, "update"):
        return lambda facts: _moves(progress, Result(facts))
    if not callable(progress):
        raise TypeError(f"progress is {type(progress).__name__}\n  give a function of what happens, or a bar such as tqdm.tqdm()")
    return lambda facts: progress(Result(facts))


def _moves(bar: Any, now: Result) -> None:
    if hasattr(bar, "set_description"):
        bar.set_description(described(now), refresh=False)
    bar.update(1)


def counter(bar: Bar) -> Callable[[Result], Any]:
    """What moves a bar on by the evaluations of a run."""
    seen = 0

    def heard(now: Result) -> None:
        nonlocal seen
        if hasattr(bar, "set_description"):
            bar.set_description(f"cost {now.fun:.6g}", refresh=False)
        bar.update(now.nfev - seen)
        seen = now.nfev

    return heard


def described(now: Result) -> str:
    """A stage in words."""
    if now.stage == "screening":
        return f"model {now.rung}: screening {now.candidates} effects"
    if now.stage == "compared":
        return f"model {now.rung}: {' + '.join(now.effects)} {now.nats:+.0f} nats"
    return now.stage.replace("-", " ")
