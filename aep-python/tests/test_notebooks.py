from pathlib import Path

import pytest

from conftest import EXAMPLE

NOTEBOOKS = sorted((Path(__file__).parents[1] / "notebooks").glob("*.ipynb"))


@pytest.mark.parametrize("path", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_from_begin_to_end(path, tmp_path):
    nbformat, nbclient = pytest.importorskip("nbformat"), pytest.importorskip("nbclient")
    pytest.importorskip("ipykernel")
    pytest.importorskip("pandas")
    pytest.importorskip("matplotlib")
    notebook = nbformat.read(path, as_version=4)
    assert all(not cell.get("outputs") for cell in notebook.cells), "kept without outputs"
    nbclient.NotebookClient(notebook, timeout=300, kernel_name="python3", resources={"metadata": {"path": tmp_path}}).execute()


def test_ctrl_c_in_a_notebook_ends_a_search_and_the_next_cell_has_what_was_found():
    client = pytest.importorskip("jupyter_client")
    pytest.importorskip("ipykernel")
    manager, kernel = client.manager.start_new_kernel(kernel_name="python3")
    try:

        def run(code):
            return kernel.execute_interactive(code, timeout=120, output_hook=heard)

        def heard(message):
            text = message["content"].get("text", "")
            printed.append(text)
            if "begun" in text:
                manager.interrupt_kernel()

        printed = []
        begun = "lambda now: print('begun', flush=True) if now.stage == 'screening' else None"
        settings = "thresholds={'beam': 20, 'fitted': 40}, time_limit=None"
        ended = run(f"import aep\naep.discover({str(EXAMPLE)!r}, {settings}, progress={begun})")
        assert ended["content"]["status"] == "error" and ended["content"]["ename"] == "Interrupted"
        after = run("import sys; print(sys.last_value.result.stopped, len(sys.last_value.result.ladder) > 0)")
        assert after["content"]["status"] == "ok" and "True True" in "".join(printed)
    finally:
        kernel.stop_channels()
        manager.shutdown_kernel(now=True)


def test_there_are_notebooks():
    assert len(NOTEBOOKS) == 3
