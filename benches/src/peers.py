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


def space(task):
    """Where the cube lies for methods that know whole numbers: these run from 0 and are one apart, so that such a component is
    as wide as there are of them. Lower corner, widths, and which are whole."""
    n = len(task["population"][0])
    low, width, whole = [0.0] * n, [1.0] * n, [False] * n
    for component, count in task["whole"]:
        low[component], width[component], whole[component] = -0.5, count, True
    return low, width, whole


def pycma(task):
    import cma
    import numpy

    places = numpy.random.default_rng(task["seed"])
    starts = iter([task["population"][0]])
    low, width, whole = space(task)
    low, width = numpy.array(low), numpy.array(width)
    options = {
        "bounds": [low, low + width],
        "CMA_stds": width,
        "integer_variables": list(numpy.flatnonzero(whole)),
        "maxfevals": task["budget"],
        "seed": task["seed"] + 1,
        "verbose": -9,
        "verb_disp": 0,
        "verb_log": 0,
    }
    cma.fmin2(
        lambda x: cost((numpy.asarray(x) - low) / width),
        lambda: low + width * next(starts, places.random(len(low))),
        task["sigma"],
        options,
        restarts=9,
        bipop=True,
    )


def differential_evolution(task):
    import numpy
    from scipy.optimize import Bounds, differential_evolution

    low, width, whole = space(task)
    low, width = numpy.array(low), numpy.array(width)
    start = low + width * numpy.array(task["population"])
    # A whole number is its own limit.
    edge = numpy.where(whole, 0.5, 0.0)
    limits = Bounds(low + edge, low + width - edge)
    start = numpy.clip(numpy.where(whole, numpy.round(start), start), limits.lb, limits.ub)
    differential_evolution(
        lambda x: cost((x - low) / width),
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
