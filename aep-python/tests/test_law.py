import pickle

import numpy as np
import pytest

import aep
from conftest import EXAMPLE

PARAMETERS = {
    "d": {"unit": "N", "low": 0, "high": 50, "default": 5, "linear": True},
    "w": {"unit": "m/s", "low": 1e-4, "high": 0.1, "default": 1e-3},
}
FORMULA = "d*s*exp(-abs(v)/w)"


def of(law):
    return aep.Effect("mine", law, PARAMETERS).force


def dip(s, v, d, w):
    return d * s * np.exp(-np.abs(v) / w)


def test_a_function_of_arrays_is_found_like_its_formula_to_the_digit():
    settings = {"exclude": ["stribeck"], "thresholds": {"most": 1}}
    ours, theirs = (aep.discover(EXAMPLE, effects=[aep.Effect("mine", law, PARAMETERS)], **settings) for law in (dip, FORMULA))
    assert {**ours.facts, "wall_s": 0} == {**theirs.facts, "wall_s": 0}
    assert "mine" in {candidate["effect"] for candidate in ours.ranking[0]}


def test_it_becomes_text_at_once_and_travels():
    effect = aep.Effect("mine", lambda s, v, d, w: d * s * np.exp(-np.abs(v) / w), PARAMETERS)
    assert effect.force == FORMULA == of(FORMULA)
    assert pickle.loads(pickle.dumps(effect)) == effect == aep.Effect("mine", FORMULA, PARAMETERS)


@pytest.mark.parametrize(
    "law",
    [
        lambda x, v, d, w: d * np.where((v > 0) & ~(x < w) | (v == 0), np.clip(v / w, -1, 1), np.tanh(v / w) ** 2),
        lambda v, d, w: d * np.interp(v / w, [-1, 0, 1, 2], [0.5, 1, -2, 3]),
        lambda v, d, w: np.interp(v, [-1, -w_low, 2], [0, d, 2 * d]) / w,
        lambda v, d, w: np.select([v > 0.1, v < -0.1], [d, -d], 0 * v) / w,
        lambda v, d, w: d * np.piecewise(v, [v < 0, v >= 0.2], [lambda q: -q, lambda q: q / w, 3.0]),
        lambda v, d, w: d * (np.mod(v, w) - (-v) ** 2 / 3 - -(v**3) + v // w + np.fmod(v, w) - v % w),
        lambda v, d, w: sum(d * np.cos(k * v / w + 0.3) / k for k in range(1, 4)),
        lambda v, d, w: d * np.polyval([1, w, -0.5], v) - d * v - (d - (v - w)) + d - 2 ** -abs(v),
        lambda v, d, w: d * np.heaviside(v, 0.5) * np.rint(v / w) * np.hypot(v, w) * np.sinc(v) * np.square(v),
        lambda v, d, w: d * np.copysign(np.sqrt(np.abs(v)), v) * np.expm1(-np.abs(v)) / np.log1p(w) * np.arctan2(v, w) * np.deg2rad(v),
        lambda v, d, w, gain=3.0: -d * gain * v / -w * (1e-7 + 1e300 * 0),
        lambda x, v, a, s, t, F, d, w, temperature: d * (x + v + a * s - t) * F / w * temperature * np.pi,
        lambda v, **of: of["d"] * v / of["w"],
    ],
)
def test_what_numpy_does_with_one_sample_becomes_a_formula_with_the_same_numbers(law):
    # Function and formula are held against each other when the effect is made.
    assert isinstance(of(law), str)


w_low = 0.25


def test_what_is_added_in_place_is_followed():
    def law(v, d, w):
        force = d * v
        force /= w
        force *= -1
        return force

    assert of(law) == "d*v/w*(-1)"


def branches(v, d, w):
    if v > w:
        return d
    return -d


def writes_over(v, d, w):
    force = np.zeros_like(v)
    force[v > w] = d
    return force


def grows(v, d, w):
    for _ in range(50):
        v = v * v + v
    return d * v / w


def moves_its_argument(v, d, w):
    kept = v
    v += w
    return d * kept * v


@pytest.mark.parametrize(
    ("law", "says"),
    [
        (branches, r"a branch on 'v > w'.*\n  test_law.py, line \d+: if v > w:\n  write np.where"),
        (lambda v, d, w: d * min(v, w), "np.minimum"),
        (lambda v, d, w: d * (0 < v < w), "& and | in place of and"),
        (lambda v, d, w: d * float(v) / w, "np.sin in place of math.sin"),
        (lambda v, d, w: d * np.array([q for q in v]) / w, "one sample at a time"),
        (lambda v, d, w: d * np.cumsum(v) / w, "np.cumsum joins several samples"),
        (lambda v, d, w: d * v.mean() / w, ".mean joins several samples"),
        (lambda v, d, w: d * np.add.reduce(v) / w, "add.reduce joins several samples"),
        (lambda v, d, w: d * np.asarray(v) / w, "leave np.asarray"),
        (np.vectorize(lambda v, d, w: d * v / w), "np.vectorize"),
        (writes_over, "written over\n  write np.where|written over"),
        (lambda v, d, w: d * np.array([1, 2, 3]) * v / w, r"an array of shape \(3,\) meets a sample"),
        (lambda v, d, w: d * np.fft.fft(v) / w, "np.fft joins several samples"),
        (lambda v, d, w: d * np.isnan(v) / w, "formulas have no np.isnan"),
        (lambda v, d, w: d * np.nan_to_num(v) / w, "formulas have no np.nan_to_num"),
        (lambda v, d, w: d * v.size / w, "no '.size' of one sample"),
        (lambda v, d, w: d * v / w * np.inf, "inf is no number"),
        (lambda v, d, w: None, "None is no number"),
        (lambda v, d, w: d / 0 * v / w, "line .*\n.*called once with symbols|called once with symbols"),
        (lambda v, d: d * v, "does not take its parameter 'w'"),
        (lambda *all: 0.0, "takes 'all' by its place"),
        (np.sin, "by its place|does not tell its arguments"),
        (grows, "longer than 4096 characters"),
        (moves_its_argument, "is not what it does with symbols"),
        (lambda v, d, w: d * v / w * np.random.default_rng().normal(), "on chance"),
    ],
)
def test_what_no_formula_can_do_is_told_with_its_line_and_what_to_write(law, says):
    with pytest.raises(aep.Untraceable, match=f"(?s){says}") as raised:
        of(law)
    assert isinstance(raised.value, ValueError) and "'mine'" in str(raised.value)
