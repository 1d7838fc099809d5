import warnings

import numpy as np
import pytest

import aep
import costs
from conftest import same


def test_the_valley_is_found_and_the_result_is_that_of_scipy(box):
    optimize = pytest.importorskip("scipy.optimize")
    found = aep.minimize(costs.valley, box, maxfun=8000, seed=3)
    assert found.success and found.status == 1 and found.fun < 1e-8
    assert np.allclose(found.x, 1.0, atol=1e-3)
    assert costs.valley(found.x) == found.fun
    theirs = optimize.differential_evolution(costs.valley, box, maxiter=3, seed=1, polish=False)
    assert {"x", "fun", "nfev", "nit", "success", "message"} <= set(theirs) & set(found)
    assert same(found, aep.minimize(costs.valley, optimize.Bounds([-6, -6], [6, 6]), maxfun=8000, seed=3))
    assert not same(found, aep.minimize(costs.valley, box, maxfun=8000, seed=4))


@pytest.mark.parametrize("method", list(aep.methods()))
def test_every_method_descends_within_its_budget(box, method):
    found = aep.minimize(costs.valley, box, method=method, maxfun=3000)
    assert found.fun < 1.0 and found.nfev <= 3000 and len(found.x) == 2


def test_rows_at_once_are_evaluated_as_one_by_one(box):
    one_by_one = aep.minimize(costs.valley, box, maxfun=2000)
    at_once = aep.minimize(costs.valley_of_rows, box, maxfun=2000, vectorized=True)
    assert np.allclose(one_by_one.x, at_once.x) and one_by_one.nfev == at_once.nfev


def test_what_fails_is_counted_and_survived(box):
    found = aep.minimize(costs.fails_on_the_left, box, maxfun=4000)
    assert found.fun < 1e-3
    assert found.failures["errors"] > 0 and found.failures["non_finite"] > 0
    assert found.failures["first"] == "RuntimeError: no convergence"


def test_where_nothing_succeeds_the_result_says_why(box):
    def broken(x):
        return x["mass"]

    with pytest.warns(RuntimeWarning, match="IndexError"):
        found = aep.minimize(broken, box, maxfun=200)
    assert not found.success and found.fun == np.inf and np.isnan(found.x).all()
    assert "IndexError" in found.message


def test_whole_components_are_whole_and_reach_their_limits():
    seen = []

    def cost(x):
        seen.append(x[0])
        return (x[0] - 7) ** 2 + (np.log10(x[1]) + 2) ** 2

    found = aep.minimize(cost, {"teeth": (1, 7), "gain": (1e-6, 1e2)}, integrality={"teeth"}, log={"gain"}, maxfun=3000)
    assert set(seen) == {1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0}
    assert found.x[0] == 7 and found.x[1] == pytest.approx(1e-2, rel=1e-2)
    assert found.names == ["teeth", "gain"]


def test_constraints_are_kept_and_the_cost_is_not_asked_outside(box):
    def inside(x):
        assert x[0] + x[1] >= 1.0
        return x[0] ** 2 + x[1] ** 2

    found = aep.minimize(inside, box, constraints=lambda x: 1.0 - x[0] - x[1], ceiling=100.0, maxfun=8000)
    assert found.fun == pytest.approx(0.5, abs=1e-4) and found.failures["errors"] == 0


def test_a_callback_sees_each_generation_and_can_end_the_run(box):
    seen = []

    def callback(now):
        seen.append((now.nit, now.nfev, now.fun))
        return now.nit == 5

    found = aep.minimize(costs.valley, box, callback=callback)
    assert [nit for nit, _, _ in seen] == [0, 1, 2, 3, 4, 5]
    assert found.stop == "interrupted" and not found.success and found.fun == seen[-1][2]

    def stops(now):
        raise StopIteration

    assert aep.minimize(costs.valley, box, callback=stops).nit == 0

    def fails(now):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError) as raised:
        aep.minimize(costs.valley, box, callback=fails)
    assert raised.value.result.nit == 0


def test_an_interrupted_run_goes_on_to_the_same_end(box, tmp_path):
    file = tmp_path / "run.ckpt"
    whole = aep.minimize(costs.valley, box, maxfun=3000)
    calls = 0

    def valley(x):
        nonlocal calls
        calls += 1
        if calls == 1234:
            raise KeyboardInterrupt
        return costs.valley(x)

    with pytest.raises(aep.Interrupted) as raised:
        aep.minimize(valley, box, maxfun=3000, checkpoint=file, checkpoint_every=10**6)
    assert isinstance(raised.value, KeyboardInterrupt)
    assert raised.value.result.nfev < 1234 and not raised.value.result.success
    resumed = aep.minimize(valley, box, maxfun=3000, checkpoint=file, resume=True)
    assert same(resumed, whole)
    with pytest.raises(ValueError, match="seed"):
        aep.minimize(valley, box, maxfun=3000, checkpoint=file, resume=True, seed=2)
    with pytest.raises(ValueError, match="another problem"):
        aep.minimize(costs.valley, box, maxfun=3000, checkpoint=file, resume=True)
    with pytest.raises(FileNotFoundError):
        aep.minimize(valley, box, checkpoint=tmp_path / "absent", resume=True)


@pytest.mark.parametrize(
    ("settings", "says"),
    [
        ({"bounds": [(1, 1)]}, "lower"),
        ({"bounds": []}, "component"),
        ({"bounds": 3}, "bounds|int"),
        ({"bounds": [(1, 2, 3)]}, "pairs"),
        ({"bounds": [(0, 1)], "log": True}, "positive lower limit"),
        ({"bounds": [(0, 1)], "log": {"a"}}, "no component 'a'"),
        ({"bounds": [(0, 1)] * 3, "integrality": [True, False]}, "2 entries for 3"),
        ({"bounds": [(0, 1)], "method": "simplex"}, "aep-practical"),
        ({"bounds": [(0, 1)], "x0": [[5.0]]}, "outside the domain"),
        ({"bounds": [(0, 1)], "x0": [1.0, 1.0]}, "shape"),
        ({"bounds": [(0, 1)], "workers": 0}, "workers is 0"),
        ({"bounds": [(0, 1)], "workers": "many"}, "workers is str"),
        ({"bounds": [(0, 1)], "time_limit": -1.0}, "time limit"),
        ({"bounds": [(0, 1)], "resume": True}, "checkpoint"),
        ({"bounds": [(0, 1)], "constraints": len}, "ceiling"),
    ],
)
def test_what_cannot_be_meant_is_refused_with_what_mends_it(settings, says):
    with pytest.raises((ValueError, TypeError), match=says):
        aep.minimize(lambda x: 0.0, **settings)


def test_a_vectorized_cost_of_another_shape_is_refused(box):
    with pytest.raises(ValueError, match=r"shape \(\) for 40 positions"):
        aep.minimize(lambda points: 1.0, box, vectorized=True)
    with pytest.raises(TypeError, match="not a function"):
        aep.minimize(3, box)


def test_ask_and_tell_is_the_same_run(box, tmp_path):
    found = aep.minimize(costs.valley, box, maxiter=60, seed=5)
    optimizer = aep.Optimizer(box, seed=5)
    for _ in range(61):
        assert (optimizer.ask() == optimizer.ask()).all()
        optimizer.tell([costs.valley(x) for x in optimizer.ask()])
        if optimizer.generation == 30:
            optimizer.checkpoint(tmp_path / "half.ckpt")
    assert optimizer.best[0].tolist() == found.x.tolist() and optimizer.best[1] == found.fun
    again = aep.Optimizer(box, seed=5)
    again.restore(tmp_path / "half.ckpt")
    while again.generation < 60:
        again.tell([costs.valley(x) for x in again.ask()])
    assert again.best[0].tolist() == found.x.tolist()
    with pytest.raises(ValueError, match="tell without ask"):
        again.tell([1.0])
    again.ask()
    with pytest.raises(ValueError, match="3 costs for 40 points"):
        again.tell([1.0, 2.0, 3.0])
    with pytest.raises(ValueError, match="seed"):
        aep.Optimizer(box, seed=6).restore(tmp_path / "half.ckpt")


def test_trials_compare_methods_by_many_runs(box):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = aep.trials(costs.valley, box, methods=["aep-practical", "meta-ep"], count=8, target=1e-6, maxfun=3000)
    ours, theirs = found
    assert (ours.method, ours.trials, len(ours.runs)) == ("aep-practical", 8, 8)
    assert ours.successes > theirs.successes and ours.successes == sum(run.stop == "target" for run in ours.runs)
    test = found.rank_test("aep-practical", "meta-ep")
    assert test.effect > 0.8 and test.p_value < 0.05
    assert found["meta-ep"] is theirs
    assert len({run.seed for run in ours.runs}) == 8
    with pytest.raises(ValueError, match="count is 0"):
        aep.trials(costs.valley, box, count=0)
