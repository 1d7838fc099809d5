"""What waiting for the slowest costs, and what the asynchronous mode saves: the same task on the same processes both ways.

    python aep-python/examples/stragglers.py

A cost that takes 50 ms in the mean: always, log-normal (sigma 0.5), or ten times as long once in a hundred. 16 processes sleep, 16
individuals; the run ends at a cost of 1e-3. Seconds and evaluations are medians of 5 seeds. A number as argument: other processes.
"""

import statistics
import sys
import time

import numpy as np

import aep

PROCESSES = int(sys.argv[1]) if len(sys.argv) > 1 else 16
SEEDS = range(1, 6)
MEAN = 0.05
TIMES = {
    "all alike": lambda random: MEAN,
    "log-normal": lambda random: MEAN * random.lognormal(-0.125, 0.5),
    "1 % ten times as long": lambda random: MEAN / 1.09 * (10.0 if random.random() < 0.01 else 1.0),
}
ROTATION = np.linalg.qr(np.random.default_rng(0).normal(size=(4, 4)))[0]
SCALES = 10.0 ** np.linspace(0.0, 2.0, 4)


def cost(x, kind):
    """A rotated valley with condition 100; how long it takes is drawn by its position."""
    time.sleep(TIMES[kind](np.random.default_rng(x.view(np.uint64))))
    return float(np.sum((x @ ROTATION) ** 2 * SCALES))


def run(kind, seed, asynchronous):
    begin = time.perf_counter()
    found = aep.minimize(
        cost, [(-5.0, 5.0)] * 4, (kind,), target=1e-3, maxfun=20_000, seed=seed, population=PROCESSES, workers=PROCESSES,
        asynchronous=asynchronous,
    )
    if found.stop != "target":
        print(f"seed {seed} ended by {found.stop} at {found.fun}")
    return time.perf_counter() - begin, found.nfev


def main():
    print(f"{PROCESSES} processes, {PROCESSES} individuals of aep-practical\n")
    print(f"{'':24}{'by generations':>24}{'asynchronous':>24}{'times as fast':>16}")
    for kind in TIMES:
        ways = []
        for asynchronous in (False, True):
            seconds, evaluations = zip(*[run(kind, seed, asynchronous) for seed in SEEDS])
            ways.append((statistics.median(seconds), statistics.median(evaluations)))
        told = "".join(f"{f'{seconds:.2f} s, {evaluations:.0f}':>24}" for seconds, evaluations in ways)
        print(f"{kind:24}{told}{ways[0][0] / ways[1][0]:16.2f}", flush=True)


if __name__ == "__main__":
    main()
