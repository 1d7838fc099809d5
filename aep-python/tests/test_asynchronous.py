import multiprocessing
import signal
import threading
import time
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import numpy as np
import pytest

import aep
import costs

BOX = [(-6.0, 6.0)] * 2


def test_every_kind_of_worker_finds_the_minimum():
    def found(**settings):
        return aep.minimize(costs.valley, BOX, target=1e-4, maxfun=20_000, asynchronous=True, **settings)

    with ThreadPoolExecutor(3) as threads, multiprocessing.get_context("spawn").Pool(2) as pool:
        for workers in (1, 2, threads, pool):
            assert found(workers=workers).stop == "target"
    assert found(method="de", workers=2).stop == "target"


def test_budgets_are_kept_to_the_evaluation_and_generations_are_as_many_costs_as_individuals():
    told = []
    found = aep.minimize(costs.valley, BOX, maxfun=205, population=20, asynchronous=True, workers=2, callback=lambda now: told.append(now.nfev))
    assert (found.nfev, found.nit, found.stop, found.status) == (205, 9, "evaluations", 1)
    assert told == list(range(20, 201, 20))
    assert aep.minimize(costs.valley, BOX, maxiter=3, population=10, asynchronous=True).nfev == 40
    ended = aep.minimize(costs.valley, BOX, population=10, asynchronous=True, callback=lambda now: now.nit == 2)
    assert (ended.stop, ended.success, ended.nfev) == ("interrupted", False, 30)
    flat = aep.minimize(lambda x: 1.0, BOX, stagnation=(5, 0.0), population=10, asynchronous=True)
    assert flat.stop == "stagnation" and flat.nfev < 100


def test_a_slow_one_holds_up_nobody():
    waits = threading.Event()

    def cost(x):
        # The first position waits until all others of the run are done.
        if not asked:
            asked.append(x)
            assert waits.wait(30.0)
        return costs.valley(x)

    asked, told = [], []

    def hear(now):
        told.append(now.nfev)
        if now.nfev >= 900:
            waits.set()

    with ThreadPoolExecutor(4) as pool:
        found = aep.minimize(cost, BOX, maxfun=1000, population=20, asynchronous=True, workers=pool, callback=hear)
    assert found.nfev == 1000 and told[-1] == 1000


def test_one_worker_makes_the_same_run_of_the_same_seed():
    first, second, other = (aep.minimize(costs.valley, BOX, maxfun=500, seed=seed, asynchronous=True) for seed in (3, 3, 4))
    assert (first.x.tolist(), first.fun) == (second.x.tolist(), second.fun) != (other.x.tolist(), other.fun)


def test_whole_numbers_and_logarithms_are_kept():
    def cost(x):
        assert x[1] == round(x[1])
        return abs(np.log10(x[0]) - 2.0) + abs(x[1] - 17)

    found = aep.minimize(cost, {"mass": (1, 1e4), "teeth": (8, 40)}, log={"mass"}, integrality={"teeth"}, maxfun=4000, asynchronous=True)
    assert found.fun < 1e-3 and found.x[1] == 17 and found.names == ["mass", "teeth"] and found.failures["errors"] == 0


def test_failures_are_counted_and_survived():
    def shaky(x):
        if x[0] > 3:
            raise ArithmeticError("did not converge")
        return float("nan") if x[1] > 3 else costs.valley(x)

    found = aep.minimize(shaky, BOX, maxfun=400, asynchronous=True)
    assert np.isfinite(found.fun) and found.failures["errors"] > 0 and found.failures["non_finite"] > 0
    assert found.failures["first"] == "ArithmeticError: did not converge"
    with pytest.warns(RuntimeWarning, match="every evaluation of the first generation failed"):
        nothing = aep.minimize(lambda x: 1 / 0, BOX, maxfun=80, asynchronous=True)
    assert not nothing.success and np.isnan(nothing.x).all()


def test_a_process_that_is_killed_is_told_and_its_evaluations_are_repeated(tmp_path):
    marker = tmp_path / "marker"
    marker.touch()
    with pytest.warns(RuntimeWarning, match="a worker process died; . evaluations are repeated"):
        found = aep.minimize(costs.deadly_valley, BOX, (str(marker),), maxfun=300, workers=2, asynchronous=True)
    assert found.workers_lost == 1 and found.nfev == 300 and found.failures["errors"] == 0


def test_a_place_that_ends_every_process_is_a_failure():
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        found = aep.minimize(costs.deadly_place, BOX, workers=2, retries=0, maxfun=60, seed=2, asynchronous=True)
    assert found.nfev == 60 and found.failures["errors"] > 0 and "died at [" in found.failures["first"]


def test_an_executor_that_broke_ends_the_run_which_goes_on_from_its_checkpoint(tmp_path):
    marker, file = tmp_path / "marker", tmp_path / "run.ckpt"
    settings = dict(maxfun=400, asynchronous=True, checkpoint=file, checkpoint_every=1)

    def arm(now):
        if now.nit == 2:
            marker.touch()

    with ProcessPoolExecutor(2) as pool, pytest.raises(aep.WorkersLost, match="resume=True") as raised:
        aep.minimize(costs.deadly_valley, BOX, (str(marker),), workers=pool, callback=arm, **settings)
    before = raised.value.result
    assert 120 <= before.nfev < 200
    found = aep.minimize(costs.deadly_valley, BOX, (str(marker),), workers=2, resume=True, **settings)
    assert found.nfev == 400 and found.fun <= before.fun
    with pytest.raises(ValueError, match="another run"):
        aep.minimize(costs.deadly_valley, BOX, (str(marker),), resume=True, seed=9, **settings)
    with pytest.raises(ValueError, match="another problem"):
        aep.minimize(costs.valley, BOX, resume=True, **settings)


def test_ctrl_c_keeps_what_was_found_and_ends_the_processes():
    timer = threading.Timer(1.5, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    with pytest.raises(aep.Interrupted) as raised:
        aep.minimize(costs.slow_valley, BOX, workers=2, maxfun=10_000, asynchronous=True)
    assert 0 < raised.value.result.nfev < 1000
    until = time.perf_counter() + 10.0
    while multiprocessing.active_children() and time.perf_counter() < until:
        time.sleep(0.05)
    assert not multiprocessing.active_children()


def test_dask_takes_one_task_at_a_time():
    distributed = pytest.importorskip("distributed")
    with distributed.LocalCluster(2, threads_per_worker=1, dashboard_address=":0") as cluster, distributed.Client(cluster) as client:
        found = aep.minimize(costs.valley, BOX, maxfun=400, workers=client.get_executor(), asynchronous=True)
    assert found.nfev == 400 and found.fun < 10.0


@pytest.mark.parametrize(
    ("settings", "error", "says"),
    [
        ({"method": "cma-es"}, ValueError, "choose one of: aep, aep-practical, de, de-fixed"),
        ({"workers": map}, TypeError, "apply_async"),
        ({"chunk": 4}, ValueError, "one position at a time"),
        ({"retries": -1}, ValueError, "0 or more"),
        ({"time_limit": -1.0}, ValueError, "0 or more"),
        ({"population": 2, "method": "de"}, ValueError, "at least four"),
    ],
)
def test_what_cannot_be_meant_is_refused(settings, error, says):
    with pytest.raises(error, match=says):
        aep.minimize(costs.valley, BOX, asynchronous=True, **settings)


def test_ask_and_tell_take_one_position_at_a_time_in_any_order(tmp_path):
    optimizer = aep.SteadyOptimizer(BOX, population=6, seed=1)
    away = [optimizer.ask() for _ in range(6)]
    assert optimizer.ask() is None and optimizer.individuals == 6 and optimizer.best is None
    for individual, x in reversed(away):
        optimizer.tell(individual, costs.valley(x))
    with pytest.raises(ValueError, match="no cost of individual 3 is awaited"):
        optimizer.tell(3, 1.0)
    assert optimizer.told == 6 and optimizer.ask()[0] == 5
    optimizer.checkpoint(tmp_path / "run.ckpt")
    again = aep.SteadyOptimizer(BOX, population=6, seed=1)
    again.restore(tmp_path / "run.ckpt")
    assert again.told == 6 and again.best[1] == optimizer.best[1] and again.ask()[0] == 5
