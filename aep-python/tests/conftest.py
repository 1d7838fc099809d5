import os
import shutil
import signal
import subprocess
import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


@pytest.fixture(autouse=True, scope="session")
def ctrl_c():
    """Ctrl-C as at a terminal: what a shell starts in the background ignores it, and so would Python."""
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.fixture
def box():
    return [(-6.0, 6.0)] * 2


def same(first, second):
    """Equal to the bit, as far as a result does not tell times."""
    return (first.x.tolist(), first.fun, first.nfev, first.nit, first.stop) == (
        second.x.tolist(),
        second.fun,
        second.nfev,
        second.nit,
        second.stop,
    )


ROOT = Path(__file__).parents[2]
EXAMPLE = ROOT / "aep-cli" / "examples" / "hidden" / "recording.csv"


@pytest.fixture(scope="session")
def command():
    """The command `aep`: `AEP_BINARY`, or the one that was built last."""
    target = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
    found = os.environ.get("AEP_BINARY") or shutil.which("aep", path=str(target / "release"))
    if not found:
        pytest.skip("the command is not built: cargo build --release -p aep-cli")

    def run(*words):
        told = subprocess.run([found, *map(str, words)], capture_output=True, text=True)
        assert told.returncode == 0, told.stderr
        return told.stdout

    return run


@pytest.fixture(scope="session")
def found():
    """The example with its hidden effect, searched once."""
    import aep

    return aep.discover(EXAMPLE)


@pytest.fixture(scope="session")
def columns():
    """The example as a dictionary of arrays."""
    import numpy as np

    table = np.genfromtxt(EXAMPLE, delimiter=",", names=True)
    return {name: table[name] for name in table.dtype.names}
