"""What does a model of two cascaded tanks lack? A pump fills the upper tank, which drains into the lower one; a sensor shows the
lower level. The upper tank runs over, which the model lacks."""

import numpy as np

import aep

STEP = 4.0


class Tanks(aep.Family):
    quantity = ("level", "cm")

    def __init__(self, pump):
        self.pump, self.asked = np.asarray(pump, dtype=float), 0

    def time(self):
        return STEP * np.arange(len(self.pump))

    def coordinates(self):
        return {"pump": ("V", self.pump)}

    def parameters(self):
        hole = ("cm^0.5/s", 0.01, 0.2, 0.05)
        return [
            aep.Term("holes", amplitudes={"g": ("1", 0.5, 2.0, 1.0)}, shapes={"a": hole, "b": hole}, always=True),
            aep.Term("overflow", shapes={"h": ("cm", 3.0, 30.0, 9.0)}, equation="x <= h"),
            aep.Term("leak", shapes={"l": ("1/s", 1e-4, 0.02, 1e-3)}, equation="-l y"),
            aep.Term("pump-lag", shapes={"T": ("s", 0.5, 60.0, 5.0)}, equation="T q' = u - q"),
            aep.Term("offset", amplitudes={"o": ("cm", -9.0, 9.0, 1.0)}, equation="o"),
        ]

    def prediction(self, model):
        def of(term, name, none):
            return model.get(term, {}).get(name, none)

        self.asked += 1
        gain, a, b = model["holes"].values()
        brim, leak, lag = of("overflow", "h", np.inf), of("leak", "l", 0.0), of("pump-lag", "T", 1e-9)
        flow, upper, lower, out = self.pump[0], 6.0, 6.0, []
        share = 1.0 - np.exp(-STEP / lag)
        for pump in self.pump.tolist():
            out.append(lower)
            flow += (pump - flow) * share
            through = a * max(upper, 0.0) ** 0.5
            upper += STEP * (0.05 * flow - through)
            spilled = max(upper - brim, 0.0)
            upper -= spilled
            lower += spilled + STEP * (through - b * max(lower, 0.0) ** 0.5 - leak * lower)
        return gain * np.array(out) + of("offset", "o", 0.0)


if __name__ == "__main__":
    random = np.random.default_rng(1)
    pump = np.repeat(random.uniform(0.5, 4.5, 60), random.integers(8, 40, 60))[:1024]
    truth = {"holes": {"g": 1.02, "a": 0.05, "b": 0.04}, "overflow": {"h": 10.0}}
    level = Tanks(pump).prediction(truth) + 0.05 * random.normal(size=1024)
    tanks = Tanks(pump)
    print(aep.discover_own(tanks, level, time_limit=None), f"{tanks.asked} predictions", sep="\n")
