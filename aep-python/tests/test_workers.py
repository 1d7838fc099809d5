import multiprocessing
import os
import shutil
import signal
import subprocess
import sys
import threading
import time
import warnings
from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor

import pytest

import aep
import costs
from conftest import same

BUDGET = {"maxfun": 400, "seed": 7}


@pytest.fixture(scope="module")
def alone():
    return aep.minimize(costs.valley, [(-6.0, 6.0)] * 2, **BUDGET)


def test_processes_threads_and_maps_give_the_same_bits(box, alone):
    assert same(alone, aep.minimize(costs.valley, box, workers=2, **BUDGET))
    assert same(alone, aep.minimize(lambda x: costs.valley(x), box, workers=2, chunk=7, **BUDGET))
    with ThreadPoolExecutor(3) as pool:
        assert same(alone, aep.minimize(costs.valley, box, workers=pool, **BUDGET))
    with multiprocessing.get_context("spawn").Pool(2) as pool:
        assert same(alone, aep.minimize(costs.valley, box, workers=pool.map, **BUDGET))
        assert same(alone, aep.minimize(costs.valley, box, workers=pool, **BUDGET))
    with ProcessPoolExecutor(2) as pool:
        assert same(alone, aep.minimize(costs.valley, box, workers=pool, chunk=5, **BUDGET))
    assert same(alone, aep.minimize(costs.valley, box, workers=map, **BUDGET))


def test_a_process_that_is_killed_is_told_and_its_evaluations_are_repeated(box, alone, tmp_path):
    marker = tmp_path / "marker"
    marker.touch()
    with pytest.warns(RuntimeWarning, match="a worker process died; .* evaluations are repeated"):
        found = aep.minimize(costs.deadly_valley, box, (str(marker),), workers=2, **BUDGET)
    assert same(found, alone) and found.workers_lost == 1 and found.failures["errors"] == 0


def test_a_place_that_ends_every_process_is_a_failure_and_costs_no_neighbour(box):
    def instead(x):
        return float("nan") if x[0] > 2.0 else costs.valley(x)

    with warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        found = aep.minimize(costs.deadly_place, box, workers=2, retries=0, maxfun=80, seed=2)
    expected = aep.minimize(instead, box, maxfun=80, seed=2)
    assert same(found, expected)
    assert found.failures["errors"] == expected.failures["non_finite"] > 0
    assert "died at [" in found.failures["first"]


def test_an_executor_that_broke_ends_the_run_with_what_was_found(box, alone, tmp_path):
    marker, file = tmp_path / "marker", tmp_path / "run.ckpt"
    calls = []

    def arm(now):
        calls.append(now.nit)
        if now.nit == 2:
            marker.touch()

    settings = dict(BUDGET, checkpoint=file)
    with ProcessPoolExecutor(2) as pool, pytest.raises(aep.WorkersLost, match="resume=True") as raised:
        aep.minimize(costs.deadly_valley, box, (str(marker),), workers=pool, callback=arm, **settings)
    assert raised.value.result.nit == 2
    with ProcessPoolExecutor(2) as pool:
        resumed = aep.minimize(costs.deadly_valley, box, (str(marker),), workers=pool, resume=True, **settings)
    assert same(resumed, alone)


def test_a_map_that_fails_is_asked_again_a_few_times(box, alone):
    failures = iter([True, True, False])

    def shaky(function, tasks):
        if next(failures, False):
            raise ConnectionError("the scheduler is gone")
        return map(function, tasks)

    with pytest.warns(RuntimeWarning, match="ConnectionError: the scheduler is gone.; 40 evaluations are repeated"):
        found = aep.minimize(costs.valley, box, workers=shaky, **BUDGET)
    assert same(found, alone) and found.workers_lost == 2

    def gone(function, tasks):
        raise ConnectionError("the scheduler is gone")

    with pytest.raises(aep.WorkersLost, match="failed 3 times"), warnings.catch_warnings():
        warnings.simplefilter("ignore", RuntimeWarning)
        aep.minimize(costs.valley, box, workers=gone, **BUDGET)


def test_ctrl_c_ends_the_processes_and_keeps_what_was_found(box):
    timer = threading.Timer(1.5, lambda: signal.raise_signal(signal.SIGINT))
    timer.start()
    begin = time.perf_counter()
    with pytest.raises(aep.Interrupted) as raised:
        aep.minimize(costs.slow_valley, box, workers=2, maxfun=10_000)
    assert time.perf_counter() - begin < 10.0, "200 s of evaluations were left"
    assert 0 < raised.value.result.nfev < 1000
    # Not `join`: a process that the pool's own thread is just taking leave of counts as alive for a moment.
    until = time.perf_counter() + 10.0
    while multiprocessing.active_children() and time.perf_counter() < until:
        time.sleep(0.05)
    assert not multiprocessing.active_children()


def test_rows_at_once_go_to_processes_in_shares(box):
    alone = aep.minimize(costs.valley_of_rows, box, vectorized=True, **BUDGET)
    assert same(alone, aep.minimize(costs.valley_of_rows, box, vectorized=True, workers=2, **BUDGET))


def test_dask_gives_the_same_bits_and_survives_a_killed_worker(box, alone, tmp_path):
    distributed = pytest.importorskip("distributed")
    marker = tmp_path / "marker"
    with distributed.LocalCluster(2, threads_per_worker=1, dashboard_address=":0") as cluster:
        with distributed.Client(cluster) as client:
            pool = client.get_executor()
            assert same(alone, aep.minimize(costs.valley, box, workers=pool, **BUDGET))
            marker.touch()
            assert same(alone, aep.minimize(costs.deadly_valley, box, (str(marker),), workers=pool, **BUDGET))
            assert not marker.exists()


def test_ray_gives_the_same_bits(box, alone):
    os.environ["RAY_AUTH_MODE"] = "disabled"
    ray = pytest.importorskip("ray")
    from ray.util.multiprocessing import Pool

    paths = {"PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, runtime_env={"env_vars": paths})
    try:
        assert same(alone, aep.minimize(costs.valley, box, workers=Pool(2), chunk=5, **BUDGET))
    finally:
        ray.shutdown()


def test_mpi_gives_the_same_bits(alone):
    pytest.importorskip("mpi4py")
    if shutil.which("mpiexec") is None:
        pytest.skip("there is no mpiexec")
    paths = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    # Open MPI counts one rank a core, and asks root for leave; MPICH passes over these.
    paths |= {"OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    paths |= {"OMPI_MCA_rmaps_base_oversubscribe": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}
    script = os.path.join(os.path.dirname(costs.__file__), "of_mpi.py")
    command = ["mpiexec", "-n", "2", sys.executable, "-m", "mpi4py.futures", script]
    told = subprocess.run(command, env=paths, capture_output=True, text=True, timeout=120)
    assert told.returncode == 0, told.stderr
    assert told.stdout.strip() == f"{alone.x.tolist()} {alone.fun} 1"
