"""Optimizers of Python for the tables of the benchmarks: started by them, one run a request, every cost asked for.

A request is a line of JSON; then, for each evaluation, an `E` (or an `R`) and the position in the cube of width 1 go out, the cost
(or the residuals) and whether the run is over come back; a `D` ends the run. Numbers are little-endian doubles.
"""

import importlib.metadata
import json
import os
import struct
import sys
import warnings

# What a library prints must not come between.
channel = os.fdopen(os.dup(1), "wb", buffering=0)
os.dup2(2, 1)
answers = os.fdopen(os.dup(0), "rb")
warnings.filterwarnings("ignore")


class Over(BaseException):
    """The target was reached or the budget used."""


def ask(kind, position, count):
    position = [float(value) for value in position]
    channel.write(kind + struct.pack(f"<{len(position)}d", *position))
    *found, over = struct.unpack(f"<{count}dB", answers.read(8 * count + 1))
    if over:
        raise Over
    return found


def cost(position):
    return ask(b"E", position, 1)[0]


def pycma(task):
    import cma
    import numpy

    places = numpy.random.default_rng(task["seed"])
    starts = iter([task["population"][0]])
    n = len(task["population"][0])
    options = {
        "bounds": [0, 1],
        "maxfevals": task["budget"],
        "seed": task["seed"] + 1,
        "verbose": -9,
        "verb_disp": 0,
        "verb_log": 0,
        "integer_variables": [component for component, _ in task["whole"]],
    }
    counts = numpy.ones(n)
    for component, count in task["whole"]:
        counts[component] = count
    # Whole numbers are one apart for the method, and the cube is as wide as there are of them.
    options["bounds"] = [[-0.5 if k > 1 else 0 for k in counts], [k - 0.5 if k > 1 else 1 for k in counts]]
    low = numpy.array(options["bounds"][0])
    options["CMA_stds"] = counts
    cma.fmin2(
        lambda x: cost((numpy.asarray(x) - low) / counts),
        lambda: low + counts * next(starts, places.random(n)),
        task["sigma"],
        options,
        restarts=9,
        bipop=True,
    )


def differential_evolution(task):
    from scipy.optimize import Bounds, differential_evolution

    n = len(task["population"][0])
    low, counts, whole = [0.0] * n, [1.0] * n, [False] * n
    for component, count in task["whole"]:
        low[component], counts[component], whole[component] = -0.5, count, True
    # Whole numbers run from 0; all else is as wide as the cube.
    limits = Bounds([0.0] * n, [count - 1 if w else 1.0 for count, w in zip(counts, whole)])
    start = [[min(int(u * count), count - 1) if w else u for u, count, w in zip(row, counts, whole)] for row in task["population"]]
    differential_evolution(
        lambda x: cost([(v - a) / count for v, a, count in zip(x, low, counts)]),
        limits,
        init=start,
        integrality=whole,
        maxiter=10**9,
        rng=task["seed"],
    )


def dual_annealing(task):
    from scipy.optimize import dual_annealing

    start = task["population"][0]
    dual_annealing(
        cost, [(0, 1)] * len(start), x0=start, maxiter=10**9, maxfun=task["budget"], rng=task["seed"]
    )


def ngopt(task):
    import nevergrad
    import numpy

    start = numpy.array(task["population"][0])
    space = nevergrad.p.Array(init=start, lower=0, upper=1)
    space.random_state.seed(task["seed"])
    nevergrad.optimizers.NGOpt(parametrization=space, budget=task["budget"]).minimize(cost)


def least_squares(task):
    import numpy
    from scipy.optimize import least_squares

    start = numpy.clip(task["population"][0], 1e-6, 1 - 1e-6)
    failed = numpy.full(task["residuals"], 1e6)

    def residuals(position):
        found = numpy.array(ask(b"R", position, task["residuals"]))
        return found if numpy.isfinite(found).all() else failed

    least_squares(residuals, start, bounds=(0, 1))


PEERS = {
    "pycma BIPOP": (pycma, "cma"),
    "scipy differential_evolution": (differential_evolution, "scipy"),
    "scipy dual_annealing": (dual_annealing, "scipy"),
    "nevergrad NGOpt": (ngopt, "nevergrad"),
    "scipy least_squares": (least_squares, "scipy"),
}


def version(package):
    try:
        return importlib.metadata.version(package)
    except importlib.metadata.PackageNotFoundError:
        return None


channel.write(json.dumps({name: version(package) for name, (_, package) in PEERS.items()}).encode() + b"\n")
while line := answers.readline():
    request = json.loads(line)
    try:
        PEERS[request["peer"]][0](request)
    except Over:
        pass
    except Exception as error:  # It gives up; the next seed is tried.
        print(f"{request['peer']}: {error!r}", file=sys.stderr)
    channel.write(b"D")
