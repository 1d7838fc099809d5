import sys
from pathlib import Path

import pytest

sys.path.insert(0, str(Path(__file__).parent))


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
