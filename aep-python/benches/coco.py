"""A method on the functions of COCO (N. Hansen and others), with results as `cocopp` reads them, so that others can compare.

    pip install coco-experiment cocopp
    python aep-python/benches/coco.py [METHOD] [SUITE OPTIONS, e.g. "dimensions:2,5 instance_indices:1-5"] [BUDGET per component]
    python -m cocopp exdata/METHOD

A run that ends before its budget is started again with the next seed; the target of a function ends its runs.
"""

import sys

import cocoex

import aep


def solve(problem, method: str, budget: int) -> None:
    bounds = list(zip(problem.lower_bounds, problem.upper_bounds))
    seed = 1
    while not problem.final_target_hit and problem.evaluations < budget:
        left = budget - problem.evaluations
        aep.minimize(
            problem, bounds, method=method, seed=seed, maxfun=left, stagnation=(200, 1e-12),
            callback=lambda now: bool(problem.final_target_hit),
        )
        seed += 1


def main() -> None:
    method, options, budget = (sys.argv[1:] + ["aep-practical", "dimensions:2,5 instance_indices:1-5", "2000"][len(sys.argv) - 1 :])[:3]
    suite = cocoex.Suite("bbob", "", options)
    observer = cocoex.Observer("bbob", f"result_folder: {method} algorithm_name: {method}")
    solved = 0
    for problem in suite:
        problem.observe_with(observer)
        solve(problem, method, int(budget) * problem.dimension)
        solved += int(problem.final_target_hit)
    print(f"{method}: {solved} of {len(suite)} problems to the last target within {budget} evaluations per component")
    print(f"python -m cocopp {observer.result_folder}")


if __name__ == "__main__":
    main()
