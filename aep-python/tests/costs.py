"""Costs at the top of a module, as other processes need them."""

import os
import time

import numpy as np


def valley(x):
    return 100.0 * (x[0] ** 2 - x[1]) ** 2 + (1.0 - x[0]) ** 2


def valley_of_rows(points):
    return 100.0 * (points[:, 0] ** 2 - points[:, 1]) ** 2 + (1.0 - points[:, 0]) ** 2


def slow_valley(x):
    time.sleep(0.05)
    return valley(x)


def deadly_valley(x, marker):
    """Ends its process once: by the first evaluation that gets the marker."""
    try:
        os.unlink(marker)
    except FileNotFoundError:
        return valley(x)
    os.kill(os.getpid(), 9)


def deadly_place(x):
    """Ends its process wherever x[0] > 2."""
    if x[0] > 2.0:
        os.kill(os.getpid(), 9)
    return valley(x)


def fails_on_the_left(x):
    if x[0] < -3.0:
        raise RuntimeError("no convergence")
    return np.nan if x[0] < 0.0 else valley(x)
