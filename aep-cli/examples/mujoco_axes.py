#!/usr/bin/env python3
"""Axes that MuJoCo simulates, each with something that coulomb + viscous lacks, and what `aep discover` says of them.

    pip install mujoco numpy
    python mujoco_axes.py make axes --seeds 1 2          # axes/lin-stribeck-1/{train.csv,truth.json} and others
    python mujoco_axes.py score axes --aep target/release/aep

Nothing here is shared with the library: bodies, joints, limits, friction constraints and the integrator (0.1 ms) are
MuJoCo's. A linear axis (8..60 kg, 1 um) and a rotary one (0.02..0.6 kg m^2, 17 bit), each under a PD controller at 1 kHz
whose command is held; 24 s of strokes, sines, chirps and rests. The recorded force is the controller's command.
"""

import argparse
import json
import subprocess
import sys
from collections import Counter
from pathlib import Path

import numpy as np

STEP = 1e-4  # of the integrator, s
SAMPLE = 1e-3  # of the controller and the recording, s
DURATION = 24.0  # s

# What is hidden, and the names that are right for it along such a motion; none where nothing of the library is its cause.
HIDDEN = {
    "nothing": [],
    "spring": ["spring"],
    "gravity": ["offset", "asymmetry", "gravity-pendulum"],
    "coupling": ["flexible-coupling"],
    "backlash": ["backlash"],
    "lag": ["actuator-lag", "input-delay"],
    "delay": ["input-delay", "actuator-lag"],
    "saturation": ["saturation"],
    "stribeck": ["stribeck", "rising-static"],
    "ripple": ["ripple"],
    "drag": ["quadratic-drag"],
    "asymmetry": ["asymmetry", "offset"],
    "drift": ["drift"],
    "along": ["position-friction"],
    "load": ["load-friction"],
    "soft-friction": [],
    "friction-step": [],
    "hum": [],
    "acceleration-memory": [],
    "dent": [],
}
SILENT = {"nothing"}
# A spring about another place than zero is a spring and a constant force.
MINOR = {"spring": {"offset", "asymmetry"}, "backlash": {"flexible-coupling"}}


def motion(random, stroke, speed):
    """Positions that the axis is asked for: trapezoids, sines, rests, small chirps."""
    count = round(DURATION / SAMPLE)
    wanted, filled, place = np.zeros(count), 0, 0.0
    while filled < count:
        kind = random.integers(4)
        if kind == 0:
            to = random.uniform(-stroke, stroke)
            v = speed * random.choice([0.05, 0.3, 1.0])
            duration = max(abs(to - place) / v, SAMPLE) + 0.1
            way = np.linspace(0, 1, round(min(duration, 4.0) / SAMPLE) + 1)
            if random.random() < 0.5:
                way = way**3 * (10 - 15 * way + 6 * way**2)
            piece = place + (to - place) * way * min(1.0, 4.0 / duration)
        elif kind == 1:
            t = np.arange(0, random.uniform(1.5, 4.0), SAMPLE)
            size, f = stroke * random.uniform(0.1, 0.4), random.uniform(0.3, 2.0)
            piece = place - np.sign(place or -1.0) * 0.5 * size * (1 - np.cos(2 * np.pi * f * t))
        elif kind == 2:
            piece = np.full(round(random.uniform(0.2, 0.6) / SAMPLE), place)
        else:
            t = np.arange(0, 2.0, SAMPLE)
            piece = place + 0.03 * stroke * np.sin(2 * np.pi * (t + 1.5 * t**2))
        end = min(count, filled + len(piece))
        wanted[filled:end] = piece[: end - filled]
        filled, place = end, wanted[end - 1]
    window = np.hanning(81)
    return np.convolve(np.pad(wanted, 40, mode="edge"), window / window.sum(), "valid")


class Axis:
    """Parameters of one axis, drawn, and its MuJoCo model."""

    def __init__(self, kind, linear, seed):
        self.kind, self.linear = kind, linear
        self.random = np.random.default_rng([seed, int(linear), sum(map(ord, kind))])
        log = lambda a, b: float(np.exp(self.random.uniform(np.log(a), np.log(b))))  # noqa: E731
        if linear:
            self.mass, self.stroke, self.speed, self.count = log(8, 60), 0.12, 0.4, 1e-6
            stiffness, self.coulomb, self.viscous = log(2500, 6000), log(10, 60), log(40, 300)
        else:
            self.mass, self.stroke, self.speed, self.count = log(0.02, 0.6), 1.2, 4.0, 2 * np.pi / 2**17
            stiffness, self.coulomb, self.viscous = log(1500, 4000), log(6, 18) * self.mass, log(0.5, 2) * self.mass
        self.gains = stiffness * self.mass, 1.8 * np.sqrt(stiffness) * self.mass
        self.size = self.coulomb * log(0.25, 0.6)
        self.share = self.random.uniform(0.35, 0.6)
        self.resonance, self.damping = 2 * np.pi * log(12, 30), self.random.uniform(0.01, 0.06)
        self.gap = log(30e-6, 150e-6) if linear else log(1.5e-3, 6e-3)
        self.lag, self.late = log(0.002, 0.006), int(self.random.integers(2, 7))
        self.period = (0.01 if linear else np.pi / 4) * self.random.uniform(0.8, 1.25)
        self.moment, self.phase = self.random.uniform(8, 16), self.random.uniform(0, 2 * np.pi)
        self.rest = self.random.uniform(-0.3, 0.3) * self.stroke
        self.wanted = motion(self.random, self.stroke, self.speed)
        self.limit = self.required()

    def required(self):
        """What the fastest hundredth and a half of the motion asks of the drive."""
        v = np.gradient(self.wanted, SAMPLE)
        force = self.mass * np.gradient(v, SAMPLE) + self.viscous * v + self.coulomb * np.sign(v)
        return float(np.quantile(np.abs(force), 0.985))

    def xml(self):
        kind, mass = self.kind, self.mass
        joint = 'type="slide" axis="1 0 0"' if self.linear else 'type="hinge" axis="0 1 0"'
        # The default friction constraint is soft: it lets go over 20 ms.
        hard = 'solreffriction="0.0005 1" solimpfriction="0.999 0.9999 0.001 0.5 2"'
        friction = "" if kind == "soft-friction" else hard
        load = self.share * mass if kind in ("coupling", "backlash") else 0.0
        inner, more, gravity, arm = "", "", "0 0 0", "0 0 0"
        weight = 1.0
        if kind == "spring":
            more = f'stiffness="{self.size / (0.7 * self.stroke)}" springref="{self.rest}"'
        if kind == "gravity" and self.linear:
            gravity = f"{self.size / mass} 0 0"
        if kind == "gravity" and not self.linear:
            weight, gravity = 5 * mass, "0 0 -9.81"
            arm = f"{self.size / (9.81 * weight)} 0 0"
        if kind == "coupling":
            k, d = load * self.resonance**2, 2 * self.damping * load * self.resonance
            inner = f'<joint {joint} stiffness="{k}" damping="{d}"/>'
        if kind == "backlash":
            inner = (
                f'<joint {joint} limited="true" range="{-self.gap} {self.gap}" solreflimit="-1e6 -1e3" '
                f'frictionloss="{0.3 * self.coulomb}" {friction}/>'
            )
        if inner:
            inner = f"<body>{inner}{self.inertial(load, '0 0 0', 1e-3)}</body>"
        drive = '<motor name="u" joint="j"/>'
        if kind == "lag":
            drive = f'<general name="u" joint="j" dyntype="filterexact" dynprm="{self.lag}"/>'
        if kind == "saturation":
            drive = f'<motor name="u" joint="j" ctrllimited="true" ctrlrange="{-self.limit} {self.limit}"/>'
        return (
            f'<mujoco><compiler angle="radian" inertiafromgeom="false"/>'
            f'<option timestep="{STEP}" gravity="{gravity}" integrator="implicitfast"/><worldbody><body>'
            f'<joint name="j" {joint} damping="{self.viscous}" frictionloss="{self.coulomb}" {friction} {more}/>'
            f"{self.inertial(mass - load, arm, weight)}{inner}</body></worldbody><actuator>{drive}</actuator></mujoco>"
        )

    def inertial(self, mass, place, weight):
        if self.linear:
            return f'<inertial pos="{place}" mass="{mass}" diaginertia="1 1 1"/>'
        return f'<inertial pos="{place}" mass="{weight}" diaginertia="{mass} {mass} {mass}"/>'

    def hidden(self, t, x, v, a, memory):
        """Friction level and force that act beside what the model holds."""
        level, force, size = self.coulomb, 0.0, self.size
        match self.kind:
            case "stribeck":
                level += 1.5 * size * np.exp(-((abs(v) / (0.03 * self.speed)) ** 1.3))
            case "ripple":
                force = size * np.sin(2 * np.pi * x / self.period + self.phase)
            case "drag":
                force = -size * v * abs(v) / (0.5 * self.speed) ** 2
            case "asymmetry":
                level += size if v > 0 else 0.0
            case "drift":
                level += 1.5 * size * np.exp(-t / 8.0)
            case "along":
                level += size * np.sin(1.4 * np.pi * x / self.stroke)
            case "load":
                level += 0.25 * abs(self.mass * a)
            case "friction-step":
                level += size if t > self.moment else 0.0
            case "hum":
                force = size * np.sin(2 * np.pi * 2.3 * t + self.phase)
            case "acceleration-memory":
                level += size * min(2.0, memory / (3 * self.speed))
            case "dent":
                force = size * np.exp(-(((x - 0.2 * self.stroke) / (0.03 * self.stroke)) ** 2))
        return level, force

    def record(self):
        import mujoco

        model = mujoco.MjModel.from_xml_string(self.xml())
        data = mujoco.MjData(model)
        kp, kd = self.gains
        late = [0.0] * (self.late if self.kind == "delay" else 0)
        rows, last, speed, memory = [], 0.0, 0.0, 0.0
        for k, wanted in enumerate(self.wanted):
            x = round(data.qpos[0] / self.count) * self.count
            speed += 0.5 * ((x - last) / SAMPLE - speed)
            last = x
            ahead = self.wanted[min(k + 1, len(self.wanted) - 1)]
            command = kp * (wanted - x) + kd * ((ahead - wanted) / SAMPLE - speed)
            rows.append((k * SAMPLE, x, command))
            late.append(command)
            data.ctrl[0] = late.pop(0)
            for step in range(round(SAMPLE / STEP)):
                v, a = data.qvel[0], data.qacc[0]
                memory += STEP / 0.15 * (abs(a) - memory)
                level, force = self.hidden(k * SAMPLE + step * STEP, data.qpos[0], v, a, memory)
                model.dof_frictionloss[0], data.qfrc_applied[0] = level, force
                mujoco.mj_step(model, data)
        return np.array(rows)


def make(folder, seeds):
    for seed in seeds:
        for kind in HIDDEN:
            for linear in (True, False):
                axis = Axis(kind, linear, seed)
                place = folder / f"{'lin' if linear else 'rot'}-{kind}-{seed}"
                place.mkdir(parents=True, exist_ok=True)
                header = "time_s,position_m,force_N" if linear else "time_s,angle_rad,torque_Nm"
                np.savetxt(
                    place / "train.csv", axis.record(), delimiter=",", header=header, comments="",
                    fmt=["%.4f", "%.7f", "%.5g"],
                )
                truth = {"hidden": kind, "coulomb": axis.coulomb, "size": axis.size, "mass": axis.mass}
                (place / "truth.json").write_text(json.dumps(truth))
                print(place)


def verdict(kind, found):
    """What a user was told, held against the truth."""
    effect = lambda name: name.split(":")[0]  # noqa: E731
    added = [effect(name) for name in found["added"]]
    sets = [[effect(name) for name in rival["effects"]] for rival in found.get("ambiguous", [])]
    if found["verdict"] == "stopped":
        return "stopped"
    if kind in SILENT:
        return "silent" if not added else "FALSE NAME"
    right = HIDDEN[kind]
    if not right:
        return "FALSE NAME" if added else "unexplained" if found["verdict"] == "unexplained" else "NOTHING MISSING"
    if not added:
        return "unexplained" if found["verdict"] == "unexplained" else "silent"
    fine = set(right) | MINOR.get(kind, set())
    if not set(added) & set(right):
        return "in a set" if any(set(names) & set(right) for names in sets) else "FALSE NAME"
    return "named" if set(added) <= fine else "SOMETHING BESIDES"


def score(folder, aep, limit):
    counts = Counter()
    for truth in sorted(folder.glob("*/truth.json")):
        place = truth.parent
        command = [aep, "discover", place / "train.csv", "--base", "coulomb,viscous", "--seed", "1", "--quiet"]
        command += ["--time-limit", str(limit), "--json", place / "found.json"]
        subprocess.run(command, check=True, stdout=subprocess.DEVNULL)
        kind, found = json.loads(truth.read_text())["hidden"], json.loads((place / "found.json").read_text())
        said = verdict(kind, found)
        counts[said] += 1
        print(f"{place.name:30s} {said:18s} {', '.join(found['added']) or '-':50s} {found['wall_s']:6.1f} s", flush=True)
    print(dict(counts))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["make", "score"])
    parser.add_argument("folder", type=Path)
    parser.add_argument("--seeds", type=int, nargs="+", default=[1])
    parser.add_argument("--aep", default="aep", help="the binary")
    parser.add_argument("--time-limit", type=float, default=60.0, help="of one discovery, s")
    asked = parser.parse_args()
    if asked.what == "make":
        make(asked.folder, asked.seeds)
    else:
        score(asked.folder, asked.aep, asked.time_limit)


if __name__ == "__main__":
    sys.exit(main())
