import numpy as np
import pytest

import aep


def test_a_task_is_solved_and_its_best_has_its_cost():
    task = aep.Task("failing-rod")
    assert task(task.best) == pytest.approx(task.best_cost, rel=1e-8)
    found = aep.minimize(task, task.bounds, log=task.log, target=task.target, method="cma-es", maxfun=20000)
    assert found.stop == "target" and found.fun <= task.target
    assert found.names == list(task.bounds) and set(task.units) == set(task.truth) == set(task.bounds)


def test_residuals_and_rows_at_once_are_the_same_cost():
    for name in aep.tasks():
        task = aep.Task(name)
        points = np.array([task.best, list(task.truth.values())])
        assert list(task.costs(points)) == [task(point) for point in points]
        assert np.sum(task.residuals(points[1]) ** 2) == pytest.approx(task(points[1]), rel=1e-12)


def test_what_cannot_be_meant_is_refused():
    with pytest.raises(ValueError, match="choose one of: table"):
        aep.Task("no-such-task")
    with pytest.raises(ValueError, match="give 5, one for each"):
        aep.Task("two-decays")([1.0, 2.0])
