"""What a law costs at a step of a simulation: as its formula, and if Python were called with arrays instead.

    python aep-python/benches/law_cost.py

A step moves several models on at once (lanes); the law is called with one array of them. Medians of 9, by turns.
"""

import statistics
import time

import numpy as np

import aep
from aep import _aep

LANES, STEPS = 8, 4_000
LIMITS = {"low": 1e-4, "high": 10.0, "default": 1.0}


def law(x, v, a, p):
    return np.where(v > 0, a * np.sin(2 * np.pi * x / p), 0.0)


def main():
    text = aep.Effect("cogging", law, {"a": {"unit": "N", **LIMITS}, "p": {"unit": "m", **LIMITS}}).force
    x, v = np.random.default_rng(1).normal(size=(2, LANES))
    a, p = np.full(LANES, 2.0), np.full(LANES, 0.5)
    columns = [(name, np.tile(values, STEPS)) for name, values in (("x", x), ("v", v), ("a", a), ("p", p))]

    def called():
        for _ in range(STEPS):
            law(x, v, a, p)

    def formula():
        _aep.evaluate(text, columns, LANES * STEPS)

    taken = {called: [], formula: []}
    for _ in range(9):
        for way, seconds in taken.items():
            begin = time.perf_counter()
            way()
            seconds.append(time.perf_counter() - begin)
    by_call, by_formula = (1e6 * statistics.median(taken[way]) / STEPS for way in (called, formula))
    print(f"{text}\n{LANES} lanes, a step: called {by_call:.2f} us, formula {by_formula:.2f} us, {by_call / by_formula:.1f} times")


if __name__ == "__main__":
    main()
