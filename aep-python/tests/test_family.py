import numpy as np
import pytest

import aep


class Signal(aep.Family):
    """A slope and, perhaps, a wave."""

    quantity = ("signal", "V")

    def __init__(self, fails=False, broken=False):
        self.fails, self.broken = fails, broken

    def time(self):
        return 0.02 * np.arange(400)

    def coordinates(self):
        return {}

    def parameters(self):
        return [
            aep.Term("slope", {"a": ("V/s", -5.0, 5.0, 1.0)}, always=True),
            aep.Term("wave", {"b": ("V", -5.0, 5.0, 1.0)}, {"w": ("rad/s", 1.0, 20.0, 5.0)}),
            aep.Term("offset", {"c": ("V", -5.0, 5.0, 1.0)}),
        ]

    def prediction(self, model):
        if self.broken:
            raise RuntimeError("no licence")
        if self.fails and "offset" in model:
            raise RuntimeError("did not converge")
        t, out = self.time(), np.zeros(400)
        for name, values in model.items():
            if name == "slope":
                out += values["a"] * t
            elif name == "wave":
                out += values["b"] * np.sin(values["w"] * t)
            else:
                out += values["c"]
        return out


@pytest.fixture(scope="module")
def measured():
    noise = 0.02 * np.random.default_rng(3).normal(size=400)
    return Signal().prediction({"slope": {"a": 0.7}, "wave": {"b": 0.4, "w": 6.0}}) + noise


def test_the_term_that_a_model_of_ones_own_lacks_is_found_the_same_each_time(measured):
    stages = []
    found = aep.discover_own(Signal(), measured, progress=lambda now: stages.append(now.stage))
    assert found.added == ["wave"] and "wave" in found.summary and stages[-1] == "finishing"
    assert found.parameters["wave.w"]["value"] == pytest.approx(6.0, abs=0.02)
    assert found.model()["wave"]["b"] == pytest.approx(0.4, abs=0.01)
    predicted = Signal().prediction(found.model())
    assert found.series["1_wave.signal_V"] == pytest.approx(predicted, abs=1e-9)
    assert np.std(found.series["1_wave.residual_signal_V"]) < 0.05
    again = aep.discover_own(Signal(), measured)
    assert {**again.facts, "wall_s": 0} == {**found.facts, "wall_s": 0}
    assert found.to_html().lower().startswith("<!doctype html>")
    with pytest.raises(TypeError, match="no model file"):
        found.save_model("x.json")


def test_where_nothing_is_missing_nothing_is_found():
    noise = 0.02 * np.random.default_rng(4).normal(size=400)
    measured = Signal().prediction({"slope": {"a": 0.7}}) + noise
    assert aep.discover_own(Signal(), measured).added == []


def test_predictions_that_fail_are_counted_and_survived(measured):
    with pytest.warns(RuntimeWarning, match="predictions failed; the first: RuntimeError: did not converge"):
        found = aep.discover_own(Signal(fails=True), measured)
    assert found.added == ["wave"]


def test_what_is_wrong_with_a_family_is_said_at_once(measured):
    with pytest.raises(RuntimeError, match="no licence"):
        aep.discover_own(Signal(broken=True), measured)
    with pytest.raises(ValueError, match=r"measured has shape \(3,\), time has 400"):
        aep.discover_own(Signal(), measured[:3])
    with pytest.raises(ValueError, match="no number at sample 8"):
        aep.discover_own(Signal(), np.where(np.arange(400) == 7, np.nan, measured))
    with pytest.raises(ValueError, match="there is no term 'waves'"):
        aep.discover_own(Signal(), measured, exclude=["waves"])
    with pytest.raises(TypeError, match="four methods"):
        aep.discover_own(object(), measured)

    class Beyond(Signal):
        def parameters(self):
            return [aep.Term("slope", {"a": ("V/s", 1.0, 5.0, 0.0)}, always=True)]

    with pytest.raises(ValueError, match="slope.a"):
        aep.discover_own(Beyond(), measured)
