import json

import numpy as np
import pytest

import aep
from aep._fleet import Fleet
from aep._growth import _student, line
from conftest import EXAMPLE


@pytest.fixture(scope="module")
def model(command, tmp_path_factory):
    file = tmp_path_factory.mktemp("model") / "model.json"
    command("identify", EXAMPLE, "--effects", "coulomb,viscous,offset", "-o", file, "--quiet")
    return file


def theirs(command, tmp_path, *words):
    command(*words, "--json", tmp_path / "theirs.json", "--quiet")
    facts = json.loads((tmp_path / "theirs.json").read_text())
    facts.pop("wall_s", None)
    return facts


def test_a_comparison_is_that_of_the_command(command, model, found, tmp_path):
    found.save_model(tmp_path / "better.json")
    ours = aep.compare(EXAMPLE, model, tmp_path / "better.json")
    facts = theirs(command, tmp_path, "compare", EXAMPLE, "--model", model, "--model", tmp_path / "better.json")
    of = [each.pop("model") for each in facts["models"]], [each.pop("model") for each in ours.facts["models"]]
    assert of == ([str(model), str(tmp_path / "better.json")], ["model", "better"])
    assert ours.facts == facts
    assert "model.residual_force_N" in ours.series
    assert aep.compare(EXAMPLE, found).effects == [*ours.effects, "stribeck"]


def test_a_suggestion_is_that_of_the_command(command, model, tmp_path):
    ours = aep.suggest(EXAMPLE, model)
    facts = {key: value for key, value in ours.facts.items() if key not in ("wall_s", "friction")}
    assert facts == theirs(command, tmp_path, "suggest", EXAMPLE, "--model", model)
    assert ours.most_likely == "stribeck"


def test_an_extension_is_that_of_the_command(command, model, tmp_path):
    ours = aep.extend(EXAMPLE, model, "stribeck")
    facts = theirs(command, tmp_path, "extend", EXAMPLE, "--model", model, "--add", "stribeck", "-o", tmp_path / "more.json")
    assert ours.facts == facts
    assert ours.model() == json.loads((tmp_path / "more.json").read_text())
    with pytest.raises(ValueError, match="has 'stribeck' already"):
        aep.extend(EXAMPLE, ours, "stribeck")


def test_a_simulation_is_that_of_the_command(command, model, tmp_path):
    command("simulate", "--model", model, "--input", EXAMPLE, "-o", tmp_path / "motion.csv", "--quiet")
    table = np.genfromtxt(tmp_path / "motion.csv", delimiter=",", names=True)
    ours = aep.simulate(EXAMPLE, model)
    assert np.array_equal(ours["position_m"], table["position_m"])
    assert len(ours["time_s"]) == len(table)


def test_an_experiment_stays_within_the_stroke_and_separates_better_than_the_data(columns):
    found = aep.experiment(EXAMPLE, "stribeck,frictional-memory")
    low, high = columns["position_m"].min(), columns["position_m"].max()
    assert found.position.min() >= low - 1e-9 and found.position.max() <= high + 1e-9
    assert len(found.time) == len(found.position) > 100 and np.all(np.diff(found.time) > 0)
    assert found.predicted["deviations"] > found.here["deviations"] > 0
    with pytest.raises(ValueError, match="unknown effect 'x'"):
        aep.experiment(EXAMPLE, ["stribeck", "x"])


def test_a_challenge_is_that_of_the_command(command, tmp_path):
    made = aep.challenge(tmp_path / "ours", "stribeck", size="moderate", seed=5)
    command("challenge", "--hide", "stribeck", "--size", "moderate", "--seed", 5, "-o", tmp_path / "theirs", "--quiet")
    for name in ("recording.csv", "recording.toml"):
        assert (tmp_path / "ours" / name).read_bytes() == (tmp_path / "theirs" / name).read_bytes()
    assert made.truth == json.loads((tmp_path / "theirs" / "truth.json").read_text())
    assert made.truth["hidden"] == "stribeck"
    for settings, says in [({"hide": "coulomb"}, "base model"), ({"size": "huge"}, "moderate")]:
        with pytest.raises(ValueError, match=says):
            aep.challenge(tmp_path / "no", **settings)
    assert not (tmp_path / "no").exists()


def test_every_effect_is_listed():
    assert aep.effects()["stribeck"]["equation"]


def test_a_fleet_is_a_table_of_what_each_drive_lacks(tmp_path):
    with_it = aep.challenge(tmp_path / "a", "asymmetry", seed=2).recording
    without = aep.challenge(tmp_path / "b", "nothing", seed=3).recording
    drives = {"a": with_it, "b": without, "c": tmp_path / "absent.csv"}
    alone = aep.discover_many(drives, thresholds={"most": 1})
    assert [row["drive"] for row in alone] == ["a", "b", "c"]
    assert alone[0]["added"] == ["asymmetry"] and alone[1]["added"] == [] and "no such file" in alone[2]["failure"]
    assert alone.counts() == {"asymmetry": 1}
    assert set(alone.sizes()["coulomb.F_C"]) == {"a", "b"}
    assert aep.discover_many(drives, thresholds={"most": 1}, workers=2) == alone
    pandas = pytest.importorskip("pandas")
    frame = alone.to_frame()
    assert isinstance(frame, pandas.DataFrame) and frame.loc["a", "added"] == "asymmetry"


def test_sizes_grow_where_recordings_say_when():
    """What is known of the line: 1 N a month, estimates known to 0.1 N; the other drive's are alike."""

    def row(name, level, half=0.2):
        estimate = {"value": level, "low": level - half, "high": level + half, "unit": "N", "identifiable": True}
        return {"drive": name, "verdict": "", "added": [], "summary": "", "error": 1.0, "parameters": {"coulomb.F_C": estimate}}

    months = [f"2024-{month:02}-01" for month in range(1, 7)]
    random = np.random.default_rng(1)
    fleet = Fleet([row(("axis 7", m), 10.0 + k + 0.1 * random.normal()) for k, m in enumerate(months)])
    fleet += [row(("axis 8", m), 10.0 + 0.1 * random.normal()) for m in months]
    grown, alike = fleet.growth()
    assert (grown.drive, grown.parameter, grown.recordings, grown.per) == ("axis 7", "coulomb.F_C", 6, "d")
    assert grown.grows and not alike.grows
    assert grown.slope == pytest.approx(12 / 365.25, rel=0.1) and grown.error < 0.1 * grown.slope
    assert grown.first == pytest.approx(10.0, abs=0.5) and grown.last == pytest.approx(15.0, abs=0.5)
    by_number = Fleet([row(str(k), 10.0 + k) for k in range(2)])
    two = by_number.growth({"0": 0.0, "1": 10.0})[0]
    assert two.slope == pytest.approx(0.1) and two.p_value < 1e-6
    with pytest.raises(ValueError, match="does not say when"):
        by_number.growth()
    with pytest.raises(ValueError, match="numbers or dates"):
        by_number.growth({"0": "soon", "1": "later"})
    differs = fleet.spread()[0]
    assert differs.least < differs.median < differs.most and ("axis 7", "2024-06-01") in differs.apart
    assert "axis 7, 2024-06-01" in fleet._repr_html_()


def test_chance_grows_as_seldom_as_is_said():
    """Nothing grows. 2,000 lines of 4 recordings, 5 % expected below 0.05 where estimates scatter much more than their intervals
    say, and no more where they scatter as these say; false alarm of this test 1e-4."""
    random = np.random.default_rng(7)
    time = np.array([0.0, 30.0, 61.0, 91.0])

    def low(scatter):
        values = 10.0 + scatter * random.normal(size=(2000, 4))
        return sum(line(time, value, value - 0.203, value + 0.203)[2] < 0.05 for value in values)

    allowed = 3.9 * np.sqrt(2000 * 0.05 * 0.95)
    assert abs(low(10.0) - 100) < allowed
    assert low(0.1) < 100 + allowed
    statistics = pytest.importorskip("scipy.stats")
    for freedom in (1, 2, 3, 4, 9, 10):
        assert _student(1.7, freedom) == pytest.approx(2 * statistics.t.sf(1.7, freedom), rel=1e-9)


def test_a_model_of_another_drive_is_refused(found, tmp_path):
    turning = {**found.model(), "axis": "rotary"}
    with pytest.raises(ValueError):
        aep.compare(EXAMPLE, turning)
    with pytest.raises(FileNotFoundError):
        aep.compare(EXAMPLE, tmp_path / "absent.json")
