"""What is left of the speed-up by 1,000 workers, by numbers.

    python aep-python/examples/thousand_workers.py

Three things take from it, and each is put into numbers here:

- the batch: a generation of N positions keeps at most N workers busy, and a larger population needs more evaluations to the
  same cost. Measured: trials of three methods on a rotated, ill-conditioned valley;
- stragglers: a generation ends with its slowest evaluation. Simulated: tasks go to whichever worker is free first;
- the sequential part: what ask and tell take, measured here, and what it takes one process to send a task, assumed.

The last three columns are the same in the asynchronous mode: no individual waits for another one. Trials run on a simulated
clock, so that what the other order costs in evaluations is in them.
"""

import heapq
import statistics
import time

import numpy as np

import aep

WORKERS = 1_000
DIMENSION = 10
TARGET = 1e-6
TRIALS = 5
METHODS = ("aep-practical", "de", "cma-es")
#: Seconds of an evaluation, mean; seconds in which one process sends a task and takes its answer (Dask's scheduler: about 1 ms).
EVALUATION, SENDING = 10.0, 1e-3
POPULATIONS = (40, 200, 1_000)

ROTATION = np.linalg.qr(np.random.default_rng(0).normal(size=(DIMENSION, DIMENSION)))[0]
SCALES = 10.0 ** np.linspace(0.0, 3.0, DIMENSION)


def valley(points):
    return ((points @ ROTATION) ** 2 * SCALES).sum(axis=-1)


def durations(kind, count, random):
    """Seconds of `count` evaluations with mean `EVALUATION`."""
    if kind == "all alike":
        return np.full(count, EVALUATION)
    if kind == "log-normal":
        return EVALUATION * random.lognormal(-0.125, 0.5, count)
    return EVALUATION / 1.09 * np.where(random.random(count) < 0.01, 10.0, 1.0)


def makespan(times, workers):
    """When the last task ends; a task is sent to the worker that is free first, one after the other."""
    free = [0.0] * min(workers, len(times))
    end = 0.0
    for k, duration in enumerate(times):
        begin = max(heapq.heappop(free), (k + 1) * SENDING)
        heapq.heappush(free, begin + duration)
        end = max(end, begin + duration)
    return end


def sequential(method, population):
    """Seconds that ask and tell take in a generation, median of 20."""
    optimizer = aep.Optimizer([(-5.0, 5.0)] * DIMENSION, method=method, population=population)
    taken = []
    for _ in range(21):
        begin = time.perf_counter()
        points = optimizer.ask()
        asked = time.perf_counter() - begin
        costs = valley(points)
        begin = time.perf_counter()
        optimizer.tell(costs)
        taken.append(asked + time.perf_counter() - begin)
    return statistics.median(taken[1:])


def asynchronous(method, population, kind, seed):
    """Seconds, on a simulated clock, and evaluations until an asynchronous run reaches the target; None where it does not."""
    random, drawn = np.random.default_rng(100 + seed), []
    optimizer = aep.SteadyOptimizer([(-5.0, 5.0)] * DIMENSION, method=method, population=population, seed=seed)
    away, sent, sender, now = [], 0, 0.0, 0.0
    while optimizer.told < most(population):
        while len(away) < min(population, WORKERS):
            individual, x = optimizer.ask()
            drawn = drawn or durations(kind, 4096, random).tolist()
            sender = max(sender + SENDING, now)
            heapq.heappush(away, (sender + drawn.pop(), sent, individual, float(valley(x))))
            sent += 1
        now, _, individual, cost = heapq.heappop(away)
        optimizer.tell(individual, cost)
        if cost <= TARGET:
            return now, optimizer.told
    return None


def most(population):
    """Evaluations after which a trial is given up."""
    return 2_500 * population + 100_000


def main():
    random = np.random.default_rng(1)
    kinds = ("all alike", "log-normal", "1 % take 10x")
    print(f"{WORKERS} workers, {DIMENSION} components, evaluations of {EVALUATION:.0f} s, {1e3 * SENDING:.0f} ms to send a task")
    print("speed-up over 1 worker and 40 individuals of aep-practical: by generations, then asynchronous (evaluations in brackets)")
    head = "".join(f"{kind:>14}" for kind in kinds) + "".join(f"{kind:>23}" for kind in kinds)
    print(f"{'method':14} {'individuals':>11} {'evaluations':>12} {'ask+tell, ms':>13}  {head}")
    alone = None
    for method in METHODS:
        for population in POPULATIONS:
            found = aep.trials(
                valley, [(-5.0, 5.0)] * DIMENSION, methods=[method], count=TRIALS, target=TARGET,
                maxfun=most(population), population=population, vectorized=True,
            )[0]
            begin = f"{method:14} {population:11}"
            if found.successes < found.trials:
                print(f"{begin}  only {found.successes} of {found.trials} trials reached {TARGET} in {most(population)} evaluations")
                continue
            needed = found.evaluations_to_target
            alone = alone or needed * EVALUATION
            generations, own = needed / population, sequential(method, population)
            speeds = []
            for kind in kinds:
                each = [makespan(durations(kind, population, random), WORKERS) for _ in range(30)]
                speeds.append(alone / (generations * (statistics.mean(each) + own)))
            told = "".join(f"{speed:14.1f}" for speed in speeds)
            for kind in kinds if method != "cma-es" else ():
                each = [asynchronous(method, population, kind, seed) for seed in range(1, TRIALS + 1)]
                reached = [trial for trial in each if trial is not None]
                if len(reached) < TRIALS:
                    told += f"{f'{len(reached)} of {TRIALS}':>23}"
                    continue
                seconds, evaluations = (statistics.median(column) for column in zip(*reached))
                told += f"{f'{alone / seconds:.1f} ({evaluations:.0f})':>23}"
            print(f"{begin} {needed:12.0f} {1e3 * own:13.2f}  {told}", flush=True)


if __name__ == "__main__":
    main()
