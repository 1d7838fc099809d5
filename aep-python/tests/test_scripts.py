import os
import subprocess
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).parents[1]


def run(script, *words, cwd):
    paths = {**os.environ, "PYTHONPATH": os.pathsep.join(path for path in sys.path if path)}
    told = subprocess.run(
        [sys.executable, PACKAGE / script, *words], cwd=cwd, env=paths, capture_output=True, text=True, timeout=280
    )
    assert told.returncode == 0, told.stderr
    return told.stdout


@pytest.mark.parametrize(
    ("example", "lacks"), [("cascaded_tanks.py", "overflow"), ("coupled_drives.py", "rectifying-sensor")]
)
def test_a_model_of_ones_own_in_under_60_lines_tells_what_it_lacks(example, lacks, tmp_path):
    script = PACKAGE / "examples" / example
    assert len(script.read_text().splitlines()) < 60
    assert run(script, cwd=tmp_path).startswith(f"Missing: {lacks}.")


def test_an_overhead_is_measured_beside_scipy(tmp_path):
    pytest.importorskip("scipy")
    told = run("benches/overhead.py", "4", cwd=tmp_path)
    assert "scipy differential_evolution" in told and "aep.minimize, aep-practical" in told


def test_results_of_coco_are_those_that_cocopp_reads(tmp_path):
    pytest.importorskip("cocoex")
    told = run("benches/coco.py", "aep-practical", "dimensions:2 function_indices:1,8 instance_indices:1", "2000", cwd=tmp_path)
    assert "aep-practical: 2 of 2 problems" in told
    info = "".join(file.read_text() for file in (tmp_path / "exdata").rglob("*.info"))
    assert "aep-practical" in info


def test_the_five_lines_of_the_readme_find_what_is_missing_and_draw_it(tmp_path):
    pytest.importorskip("pandas")
    pytest.importorskip("matplotlib")
    root = PACKAGE.parent
    readme = (root / "README.md").read_text()
    lines = readme[readme.index("import aep, pandas") :].split("```")[0]
    assert len(lines.strip().splitlines()) == 5
    lines = lines.replace("aep-cli/examples", str(root / "aep-cli/examples"))
    (tmp_path / "five.py").write_text("import matplotlib\nmatplotlib.use('Agg')\n" + lines)
    assert run(tmp_path / "five.py", cwd=tmp_path).startswith("Missing: stribeck")
    assert (tmp_path / "missing.png").stat().st_size > 10_000
