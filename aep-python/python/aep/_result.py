"""Results whose entries are attributes, as in scipy."""

from __future__ import annotations

from typing import Any

import numpy as np


class Result(dict):
    """A dictionary whose entries are attributes, too: ``result.x`` and ``result["x"]``."""

    def __getattr__(self, name: str) -> Any:
        try:
            return self[name]
        except KeyError as error:
            raise AttributeError(f"there is no '{name}'; there are: {', '.join(self)}") from error

    __setattr__ = dict.__setitem__
    __delattr__ = dict.__delitem__

    def __dir__(self) -> list[str]:
        return sorted(self)

    def __repr__(self) -> str:
        if not self:
            return "Result()"
        width = max(map(len, self)) + 1
        return "\n".join(f"{name:>{width}}: {_short(value)}" for name, value in self.items())


def _short(value: Any) -> str:
    if isinstance(value, np.ndarray):
        return np.array2string(value, threshold=12)
    text = repr(value)
    return text if len(text) <= 200 else text[:197] + "..."


class Interrupted(KeyboardInterrupt):
    """Ctrl-C. ``result`` holds what was found before it, complete as any other result."""

    def __init__(self, result: Any) -> None:
        super().__init__("interrupted; what was found so far is in the attribute 'result'")
        self.result = result


class WorkersLost(RuntimeError):
    """The workers died and cannot be started again from here. ``result`` holds what was found before."""

    result: Any = None
