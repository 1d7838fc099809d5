"""What does a linear model of two coupled electric drives lack? Motors drive a pulley through a flexible belt; the sensor of
its speed loses the sign. Data: T. Wigren, M. Schoukens, Uppsala University 2017: python coupled_drives.py FILE.csv INPUT OUTPUT"""

import sys

import numpy as np

import aep

STEP, FINE = 0.02, 2


class Drives(aep.Family):
    quantity = ("speed", "V")
    laws = {
        "dynamics": lambda x: x,
        "rectifying-sensor": lambda x: np.abs(x),
        "curved-sensor": lambda x: x * x,
        "delay": lambda x: np.concatenate([np.zeros(5), x[:-5]]),
    }

    def __init__(self, voltage):
        self.voltage = voltage

    def time(self):
        return STEP * np.arange(len(self.voltage))

    def coordinates(self):
        return {"input": ("V", self.voltage)}

    def parameters(self):
        shapes = {"tau": ("s", 0.03, 1.0, 0.2), "f": ("Hz", 0.5, 10.0, 2.0), "zeta": ("1", 0.05, 1.0, 0.3)}
        factor = {name: {"c": ("V", 0.0 if "rect" in name else -20.0, 20.0, 1.0)} for name in [*self.laws, "offset"]}
        return [*(aep.Term(name, factor[name], shapes, name == "dynamics") for name in self.laws), aep.Term("offset", factor["offset"])]

    def speed(self, tau, f, zeta):
        step, omega = STEP / FINE, 2.0 * np.pi * f  # tau w' + w = u, x'' + 2 zeta omega x' + omega^2 x = omega^2 w
        lag, motor, x, slope, out = 1.0 - np.exp(-step / tau), 0.0, 0.0, 0.0, []
        for u in self.voltage.tolist():
            out.append(x)
            for _ in range(FINE):
                motor += lag * (u - motor)
                slope += step * omega * (omega * (motor - x) - 2.0 * zeta * slope)
                x += step * slope
        return np.array(out)

    def prediction(self, model):
        terms = ((law, model[name]) for name, law in self.laws.items() if name in model)
        return model.get("offset", {"c": 0.0})["c"] + sum(m["c"] * law(self.speed(m["tau"], m["f"], m["zeta"])) for law, m in terms)


if len(sys.argv) > 1:
    table = np.genfromtxt(sys.argv[1], delimiter=",", names=True)
    voltage, speed = table[sys.argv[2]], table[sys.argv[3]]
else:
    random = np.random.default_rng(1)
    voltage = np.repeat(random.choice([-1.0, 1.0], 40), random.integers(10, 40, 40))[:500]
    speed = np.abs(1.9 * Drives(voltage).speed(0.17, 3.2, 0.15)) + 0.05 * random.normal(size=500)
print(aep.discover_own(Drives(voltage), speed, time_limit=None))
