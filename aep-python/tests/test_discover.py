import json
import signal
import threading

import numpy as np
import pytest

import aep
from conftest import EXAMPLE


def without_time(facts):
    return {key: value for key, value in facts.items() if key != "wall_s"}


def test_python_and_the_command_say_the_same(found, command, tmp_path):
    command("discover", EXAMPLE, "--json", tmp_path / "theirs.json", "--quiet")
    theirs = json.loads((tmp_path / "theirs.json").read_text())
    assert without_time(found.facts) == without_time(theirs)
    assert (found.verdict, found.added) == ("effects_found", ["stribeck"])
    assert found.parameters == theirs["ladder"][-1]["parameters"]


def test_the_series_is_that_of_the_command(found, command, tmp_path):
    pandas = pytest.importorskip("pandas")
    command("discover", EXAMPLE, "--series", tmp_path / "points.csv", "--quiet")
    theirs = pandas.read_csv(tmp_path / "points.csv", keep_default_na=False, na_values=[""])
    ours = pandas.DataFrame(found.series)
    assert list(ours) == list(theirs) and len(ours) == len(theirs)
    for name in ours:
        if ours[name].dtype.kind == "f":
            assert np.array_equal(ours[name], theirs[name].astype(float), equal_nan=True), name
        else:
            assert (ours[name].astype(str) == theirs[name].fillna("").astype(str)).all(), name


HOLD = "zero-order" if "zero-order" in EXAMPLE.with_suffix(".toml").read_text() else "sampled"


def held(columns, kind):
    """The example as other packages hold it."""
    if kind in ("pandas", "polars"):
        return pytest.importorskip(kind).DataFrame(columns)
    if kind == "pyarrow":
        return pytest.importorskip("pyarrow").table(columns)
    if kind == "arrow interface":

        class Stream:
            def __init__(self, table):
                self.table = table

            def __arrow_c_stream__(self, requested_schema=None):
                return self.table.__arrow_c_stream__(requested_schema)

        return Stream(pytest.importorskip("pyarrow").table(columns))
    if kind == "records":
        return np.rec.fromarrays(list(columns.values()), names=list(columns)).view(np.ndarray)
    if kind == "buffers":
        return {name: memoryview(values) for name, values in columns.items()}
    return columns


@pytest.mark.parametrize("kind", ["dictionary", "buffers", "records", "pandas", "polars", "pyarrow", "arrow interface"])
def test_arrays_and_frames_are_read_as_the_file(found, columns, kind):
    ours = aep.discover(held(columns, kind), hold=HOLD, thresholds={"most": 0})
    theirs = aep.discover(EXAMPLE, thresholds={"most": 0})
    assert ours.parameters == theirs.parameters


def test_a_frame_is_searched_like_its_file(found, columns):
    ours = aep.discover(columns, hold=HOLD)
    assert ours.added == found.added and ours.parameters == found.parameters


def test_columns_with_gaps_time_zones_and_dates_are_numbers_all_the_same(columns):
    pandas = pytest.importorskip("pandas")
    frame = pandas.DataFrame(columns)
    plain = aep.load(frame).samples
    force = frame.columns[1]
    frame["time_s"] = pandas.Timestamp("2024-05-31", tz="Europe/Berlin") + pandas.to_timedelta(frame["time_s"], unit="s")
    frame[force] = frame[force].astype("Float64")
    frame.loc[7, force] = pandas.NA
    frame["remark"] = "none"
    assert aep.load(frame, time="time_s").samples == plain - 1
    lists = {name: list(values) for name, values in columns.items()}
    lists[force][7] = None
    assert aep.load(lists).samples == plain - 1
    polars = pytest.importorskip("polars")
    with pytest.raises(TypeError, match=r"give data.collect\(\)"):
        aep.load(polars.DataFrame(columns).lazy())


def test_what_nothing_is_read_from_is_not_copied(columns):
    """A wide frame: 400 columns of 20 MB each would be 8 GB."""
    import resource

    rows = 2_600_000
    spare = np.zeros(rows)
    time_s = 1e-3 * np.arange(rows)
    data = {"time_s": time_s, "force_N": np.sin(time_s), "position_m": np.cos(time_s), **{f"spare {k}": spare for k in range(400)}}
    before = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    assert aep.load(data).samples == rows
    assert resource.getrusage(resource.RUSAGE_SELF).ru_maxrss - before < 2_000_000, "kB"


def test_a_page_and_a_model_are_those_of_the_command(found, command, tmp_path):
    page = found.to_html(tmp_path / "report.html")
    assert (tmp_path / "report.html").read_text() == page
    assert page.lower().startswith("<!doctype html>") and "aep.discover(" in page
    other = aep.discover(EXAMPLE, thresholds={"most": 0}, exclude="ripple,drift", seed=2)
    assert "seed=2" in other._command and "exclude=['ripple', 'drift']" in other._command and "alpha" not in other._command
    assert len(page) > 100_000 and "stribeck" in page
    command("discover", EXAMPLE, "-o", tmp_path / "theirs.json", "--quiet")
    found.save_model(tmp_path / "ours.json")
    assert (tmp_path / "ours.json").read_text() == (tmp_path / "theirs.json").read_text()
    assert found.model() == json.loads((tmp_path / "ours.json").read_text())


def test_a_result_shows_itself(found):
    assert found.summary in repr(found) and "+ stribeck" in repr(found)
    shown = found._repr_html_()
    assert "<table>" in shown and "stribeck" in shown
    with pytest.raises(AttributeError, match="verdict"):
        found.verdicts  # noqa: B018


def test_plots_show_what_the_series_has(found):
    matplotlib = pytest.importorskip("matplotlib")
    matplotlib.use("Agg")
    for ax in [found.plot_force(), found.plot_residual(), found.plot_along("position_m"), found.plot_ladder()]:
        assert ax.get_xlabel()
    left = found.plot_residual().lines
    assert [line.get_label() for line in left] == ["base", "1_stribeck"]
    spread = [np.nanstd(line.get_ydata()) for line in left]
    assert spread[1] < 0.5 * spread[0]
    # Friction at low speed is what was missing: the mean residual along the velocity is nearly gone.
    velocity = np.gradient(found.series["position_m"], found.series["time_s"])
    bent, straight = (np.nanstd(line.get_ydata()) for line in found.plot_along(velocity, "velocity").lines)
    assert straight < bent


def test_progress_is_told_and_what_it_raises_ends_the_search():
    stages = []
    aep.discover(EXAMPLE, progress=lambda now: stages.append(now.stage), thresholds={"most": 1})
    assert stages[0] == "base-fitted" and stages[-1] == "finishing" and {"compared", "concluding"} <= set(stages)

    def fails(now):
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError) as raised:
        aep.discover(EXAMPLE, progress=fails)
    assert raised.value.result.ladder


def test_a_bar_is_moved_on_and_told_what_it_is():
    class Bar:
        moves, told = 0, []

        def update(self, n):
            self.moves += n

        def set_description(self, text, refresh=True):
            self.told.append(text)

    bar = Bar()
    aep.discover(EXAMPLE, progress=bar, thresholds={"most": 1})
    assert bar.moves == len(bar.told) > 2 and bar.told[0] == "base fitted" and bar.told[-1] == "finishing"
    assert any("stribeck" in told for told in bar.told)
    counted = Bar()
    aep.minimize(lambda x: x @ x, [(-1, 1)] * 2, maxfun=400, callback=counted)
    assert counted.moves == 400
    with pytest.raises(TypeError, match="tqdm"):
        aep.discover(EXAMPLE, progress=3)


def test_ctrl_c_ends_the_search_with_what_was_found_and_other_threads_go_on(columns):
    screening, ended = threading.Event(), threading.Event()

    def interrupt():
        # Twenty turns of another thread's, whatever the machine's speed: were the interpreter held, the search would end by itself.
        screening.wait()
        for _ in range(20):
            if ended.wait(0.001):
                return
        signal.raise_signal(signal.SIGINT)

    def begun(happening):
        # There is something to tell by then and the search is not over.
        if happening["stage"] == "screening":
            screening.set()

    thread = threading.Thread(target=interrupt)
    thread.start()
    try:
        with pytest.raises(aep.Interrupted) as raised:
            aep.discover(
                columns, hold="sampled", thresholds={"beam": 20, "fitted": 40}, time_limit=None, progress=begun
            )
    finally:
        ended.set()
        screening.set()
        thread.join()
    assert raised.value.result.stopped is True


def test_what_a_user_model_lacks_is_found_by_the_force_that_it_gives(columns):
    velocity = np.gradient(columns["position_m"], columns["time_s"])
    acceleration = np.gradient(velocity, columns["time_s"])
    mine = {**columns, "tau": 50.9 * acceleration + 13.0 * np.sign(velocity)}
    found = aep.discover(mine, model_force="tau", model_force_unit="N")
    assert found.ladder[0]["effects"] in ([], ["model-gain"]) and found.verdict
    with pytest.raises(ValueError, match="model_gain"):
        aep.discover(columns, model_gain="fit")


def test_an_effect_of_ones_own_is_a_candidate():
    law = aep.Effect(
        "my-stribeck",
        "d*s*exp(-abs(v)/w)",
        {"d": {"unit": "N", "low": 0, "high": 50, "default": 5, "linear": True}, "w": {"unit": "m/s", "low": 1e-4, "high": 0.1, "default": 1e-3}},
    )
    found = aep.discover(EXAMPLE, effects=[law], exclude=["stribeck"], thresholds={"most": 1})
    tried = {candidate["effect"] for ranking in found.ranking for candidate in ranking}
    assert "my-stribeck" in tried


@pytest.mark.parametrize(
    ("settings", "error", "says"),
    [
        ({"data": "absent.csv"}, FileNotFoundError, "no such file"),
        ({"data": 3}, TypeError, "dictionary of arrays"),
        ({"data": {}}, ValueError, "empty"),
        ({"data": {"time_s": [0.0, 1.0], "force_N": [1.0, 2.0]}}, ValueError, "position"),
        ({"base": "coulom"}, ValueError, "did you mean 'coulomb'"),
        ({"exclude": ["x"]}, ValueError, "unknown effect 'x'"),
        ({"forse": "u"}, TypeError, "force"),
        ({"force": "u_V"}, ValueError, "u_V"),
        ({"hold": "linear"}, ValueError, "zero-order"),
        ({"thresholds": {"nice": 1}}, ValueError, "better, share"),
        ({"thresholds": {"beam": 1.5}}, ValueError, "beam cannot be 1.5"),
        ({"fix": {"mass": 1.0}, "bound": {"mass": (0.5, 2.0)}}, ValueError, "both fixed and bounded"),
        ({"time_limit": -1.0}, ValueError, "time_limit"),
        ({"alpha": 2.0}, ValueError, "probability"),
        ({"effects": [aep.Effect("coulomb", "v", {})]}, ValueError, "effect of the library"),
        ({"effects": [aep.Effect("mine", "v +", {})]}, ValueError, "mine"),
        ({"t_from": 1e6}, ValueError, "the recording goes from"),
    ],
)
def test_what_cannot_be_meant_is_refused_with_what_mends_it(settings, error, says):
    with pytest.raises(error, match=says) as raised:
        aep.discover(**{"data": EXAMPLE, **settings})
    assert "--" not in str(raised.value)
