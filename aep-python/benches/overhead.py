"""Overhead of a call: what an optimizer takes beside a cost that costs nothing, in one run with scipy and pycma.

    python aep-python/benches/overhead.py [components]

Prints microseconds per evaluation, the median of five runs each, of which the time of the cost alone is a line of its own.
"""

import statistics
import sys
import time
import warnings

import numpy as np

import aep


def sphere(x):
    return float(x @ x)


def spheres(points):
    return np.einsum("ij,ij->i", points, points)


def main() -> None:
    d = int(sys.argv[1]) if len(sys.argv) > 1 else 10
    bounds, calls = [(-5.0, 5.0)] * d, 20_000
    rows = []

    def measure(name, run):
        times = []
        for seed in range(1, 6):
            begin = time.perf_counter()
            count = run(seed)
            times.append(1e6 * (time.perf_counter() - begin) / count)
        rows.append((name, statistics.median(times)))

    def alone(seed):
        x = np.random.default_rng(seed).normal(size=d)
        for _ in range(calls):
            sphere(x)
        return calls

    measure("the cost alone", alone)
    for method in ("aep-practical", "de", "cma-es"):
        measure(f"aep.minimize, {method}", lambda seed, m=method: aep.minimize(sphere, bounds, method=m, maxfun=calls, seed=seed).nfev)
    measure(
        "aep.minimize, aep-practical, vectorized",
        lambda seed: aep.minimize(spheres, bounds, maxfun=calls, seed=seed, vectorized=True).nfev,
    )
    try:
        from scipy.optimize import differential_evolution

        def theirs(seed):
            generations = calls // (15 * d) - 1
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return differential_evolution(sphere, bounds, maxiter=generations, tol=0, polish=False, seed=seed).nfev

        measure("scipy differential_evolution", theirs)
    except ImportError:
        print("scipy is not installed: left out")
    try:
        import cma

        def pycma(seed):
            options = {"bounds": [-5, 5], "maxfevals": calls, "seed": seed, "verbose": -9, "tolfun": 0, "tolx": 0, "tolfunhist": 0}
            found = cma.CMAEvolutionStrategy([1.0] * d, 1.5, {**options, "tolflatfitness": 10**9, "tolstagnation": 10**9})
            found.optimize(sphere)
            return found.result.evaluations

        measure("pycma", pycma)
    except ImportError:
        print("pycma is not installed: left out")
    print(f"{d} components, {calls} evaluations; microseconds per evaluation, median of 5 runs")
    for name, micros in rows:
        print(f"  {name:42} {micros:8.2f}")


if __name__ == "__main__":
    main()
