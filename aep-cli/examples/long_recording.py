"""A recording of any length: an axis with a Stribeck curve, 20 s of motion repeated, with noise of its own in each sample.

    python long_recording.py 1e7 long.csv

Needs numpy; nothing of aep is in it.
"""

import sys

import numpy as np

INTERVAL, CYCLE, SUB = 1e-3, 20_000, 4
MASS, COULOMB, VISCOUS, STRIBECK, SPEED = 20.0, 15.0, 100.0, 6.0, 0.01
COUNT, NOISE, RESOLUTION = 1e-7, 2e-7, 0.01


def reference(t):
    w = 2 * np.pi / (CYCLE * INTERVAL)
    return 0.08 * np.sin(2 * w * t) + 0.03 * np.sin(7 * w * t) + 0.01 * np.sin(23 * w * t)


def cycle():
    """Position and held force of the second of two cycles: the first one settles."""
    position, force = np.empty(CYCLE), np.empty(CYCLE)
    x = v = 0.0
    h = INTERVAL / SUB
    for k in list(range(CYCLE)) * 2:
        t = k * INTERVAL
        wanted = (reference(t) - reference(t - INTERVAL)) / INTERVAL
        u = round((3e4 * (reference(t) - x) + 900 * (wanted - v)) / RESOLUTION) * RESOLUTION
        position[k], force[k] = x, u
        for _ in range(SUB):
            level = COULOMB + STRIBECK * np.exp(-((v / SPEED) ** 2))
            if v == 0.0:
                after = 0.0 if abs(u) <= level else h * (u - np.sign(u) * level) / MASS
            else:
                after = v + h * (u - level * np.sign(v) - VISCOUS * v) / MASS
                after = 0.0 if after * v < 0.0 else after
            x += h * (v + after) / 2
            v = after
    return position, force


def main():
    rows, path = int(float(sys.argv[1])), sys.argv[2]
    position, force = cycle()
    rng = np.random.default_rng(1)
    with open(path, "w", encoding="ascii") as file:
        file.write("time_s,force_N,position_m\n")
        for begin in range(0, rows, 10 * CYCLE):
            k = np.arange(begin, min(rows, begin + 10 * CYCLE))
            shown = position[k % CYCLE] + rng.normal(0, NOISE, len(k))
            shown = np.round(shown / COUNT) * COUNT
            columns = np.column_stack([k * INTERVAL, force[k % CYCLE], shown])
            np.savetxt(file, columns, fmt=["%.3f", "%.2f", "%.7f"], delimiter=",")


if __name__ == "__main__":
    main()
