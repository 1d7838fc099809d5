"""A run on the ranks of MPI, for test_workers.py: the first one asks, the others evaluate."""

import aep
import costs
from mpi4py.futures import MPIPoolExecutor

if __name__ == "__main__":
    with MPIPoolExecutor() as pool:
        found = aep.minimize(costs.valley, [(-6.0, 6.0)] * 2, maxfun=400, seed=7, workers=pool)
        print(found.x.tolist(), found.fun, pool.num_workers)
