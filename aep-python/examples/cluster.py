"""The same run with one process, two, Dask, Ray and MPI: equal to the bit, and how much faster on a cost of 50 ms.

    python aep-python/examples/cluster.py

The cost waits 50 ms, as for a simulator that runs elsewhere; so what is measured is what the way of sending costs. What is not
installed is left out and told. A process that is killed in the middle is the last line.
"""

import os
import shutil
import subprocess
import sys
import tempfile
import time
import warnings

import aep

BOX = [(-5.0, 5.0)] * 3
RUN = {"maxfun": 400, "seed": 1}


def cost(x):
    """The sphere, after 50 ms."""
    time.sleep(0.05)
    return float(x @ x)


def deadly(x, marker):
    """The same, which ends its process at the first position that finds the marker."""
    try:
        os.unlink(marker)
    except FileNotFoundError:
        return cost(x)
    os.kill(os.getpid(), 9)


def run(**settings):
    begin = time.perf_counter()
    found = aep.minimize(settings.pop("fun", cost), BOX, **RUN, **settings)
    return found, time.perf_counter() - begin


def dask():
    from distributed import Client, LocalCluster

    with LocalCluster(2, threads_per_worker=1, dashboard_address=":0") as cluster, Client(cluster) as client:
        return run(workers=client.get_executor())


def ray():
    os.environ["RAY_AUTH_MODE"] = "disabled"
    import ray
    from ray.util.multiprocessing import Pool

    paths = os.pathsep.join([os.path.dirname(os.path.abspath(__file__)), *filter(None, sys.path)])
    ray.init(num_cpus=2, include_dashboard=False, log_to_driver=False, runtime_env={"env_vars": {"PYTHONPATH": paths}})
    try:
        with Pool(2) as pool:
            pool.map(abs, range(4))  # the actors have started
            return run(workers=pool)
    finally:
        ray.shutdown()


def mpi():
    """Two ranks: one asks, the other evaluates, so that nothing is gained but that it is another process."""
    import mpi4py  # noqa: F401

    if shutil.which("mpiexec") is None:
        raise ImportError("there is no mpiexec")
    # Open MPI counts one rank a core, and asks root for leave; MPICH passes over these.
    surroundings = {**os.environ, "OMPI_ALLOW_RUN_AS_ROOT": "1", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1"}
    surroundings |= {"OMPI_MCA_rmaps_base_oversubscribe": "1", "PRTE_MCA_rmaps_default_mapping_policy": ":oversubscribe"}
    surroundings["PYTHONPATH"] = os.pathsep.join(filter(None, sys.path))
    command = ["mpiexec", "-n", "2", sys.executable, "-m", "mpi4py.futures", __file__, "--rank"]
    told = subprocess.run(command, env=surroundings, capture_output=True, text=True, check=True).stdout
    fun, seconds, *x = map(float, told.split())
    return aep.Result(fun=fun, x=x), seconds


def rank():
    from mpi4py.futures import MPIPoolExecutor

    with MPIPoolExecutor() as pool:
        found, seconds = run(workers=pool)
        print(repr(found.fun), seconds, *map(repr, map(float, found.x)))


def killed():
    with tempfile.TemporaryDirectory() as folder, warnings.catch_warnings(record=True) as told:
        warnings.simplefilter("always")
        marker = os.path.join(folder, "marker")

        def arm(now):
            if now.nit == 2:
                open(marker, "w").close()

        found, seconds = run(fun=deadly, args=(marker,), workers=2, callback=arm)
    print(f"    told: {told[0].message}")
    return found, seconds


def main():
    first, alone = run()
    print(f"{first.nfev} evaluations of 50 ms, {first.nit} generations after the first\n")
    print(f"  {'1 process':28} {alone:6.2f} s")
    ways = {
        "2 processes": lambda: run(workers=2),
        "8 processes": lambda: run(workers=8),
        "Dask, 2 workers": dask,
        "Ray, 2 workers": ray,
        "mpi4py, 2 ranks (1 evaluates)": mpi,
        "2 processes, one killed": killed,
    }
    for name, way in ways.items():
        try:
            found, seconds = way()
        except ImportError as error:
            print(f"  {name:28} left out: {error}")
            continue
        same = (list(found.x), found.fun) == (list(first.x), first.fun)
        print(f"  {name:28} {seconds:6.2f} s   {alone / seconds:5.2f} times as fast   {'the same bits' if same else 'ANOTHER RESULT'}")
        if not same:
            sys.exit(1)


if __name__ == "__main__":
    rank() if "--rank" in sys.argv else main()
