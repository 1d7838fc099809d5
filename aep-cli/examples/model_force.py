#!/usr/bin/env python3
"""Recordings of a linear axis together with the force that somebody's own model gives: for `aep discover --model-force`.

The axis is simulated here, with nothing of aep: a mass under Coulomb and viscous friction, driven by a PD controller
through a command that is held for 1 ms, seen by an encoder. One effect may be hidden in it that the model does not have.
The model's force is a column: from the states of this simulation, as a simulator exports it, or from the encoder,
differentiated as one does it by hand (Savitzky-Golay).

    python3 model_force.py --hide stribeck --out run.csv
    aep discover run.csv --model-force model_N
"""

import argparse

import numpy as np

SAMPLE = 1e-3
SUBSTEPS = 50
MASS, LEVEL, VISCOUS, OFFSET = 20.0, 8.0, 60.0, 1.5
COUNT = 1e-6
HIDDEN = [
    "nothing", "stribeck", "ripple", "load-friction", "backlash", "input-delay", "asymmetry", "inertia", "model-gain",
]


def reference(random, seconds):
    """Strokes of changing length and speed, some of them slow, with rests between them."""
    points, position = [], 0.0
    while len(points) * SAMPLE < seconds:
        target = random.uniform(-0.12, 0.12)
        speed = 10 ** random.uniform(-2.3, -0.7)
        duration = max(abs(target - position) / speed, 0.15)
        share = np.arange(0.0, 1.0, SAMPLE / duration)
        smooth = share - np.sin(2 * np.pi * share) / (2 * np.pi)
        points.extend(position + (target - position) * smooth)
        points.extend([target] * int(random.uniform(0.0, 0.15) / SAMPLE))
        position = target
    return np.array(points[: int(seconds / SAMPLE)])


def friction(velocity, force, hidden, load_force):
    """Level of the friction for motion in a direction; the stick state uses it at velocity 0."""
    direction = np.sign(velocity) if velocity != 0.0 else np.sign(force)
    level = LEVEL
    if hidden == "stribeck":
        level += 5.0 * np.exp(-((velocity / 8e-3) ** 2))
    if hidden == "asymmetry":
        level += (1.5 + 30.0 * abs(velocity)) * direction
    if hidden == "load-friction":
        level += 0.08 * abs(load_force)
    return level


def step(state, force, level, mass, viscous, dt):
    """One step of a mass with set-valued friction."""
    position, velocity = state
    free = velocity + dt * (force - viscous * velocity) / mass
    stopped = dt * level / mass
    if abs(free) <= stopped:
        new = 0.0
    else:
        new = free - np.sign(free) * stopped
    return position + dt * new, new


def simulate(hidden, seed, seconds, measured):
    random = np.random.default_rng(seed)
    wanted = reference(random, seconds)
    samples = len(wanted)
    dt = SAMPLE / SUBSTEPS
    kp, kd = 4.0e4, 900.0
    seen = np.zeros(samples)
    command = np.zeros(samples)
    states = np.zeros((samples, 3))
    state, load = (0.0, 0.0), (0.0, 0.0)
    two = hidden == "backlash"
    gap, contact, damper = 6e-5, 4e6, 1.5e3
    motor, behind = 0.6 * MASS, 0.4 * MASS
    late = 7.3e-3 if hidden == "input-delay" else 0.0
    before = 0.0
    for k in range(samples):
        seen[k] = np.floor(state[0] / COUNT + 0.5) * COUNT
        speed = (seen[k] - before) / SAMPLE
        before = seen[k]
        rate = (wanted[k] - wanted[max(k - 1, 0)]) / SAMPLE
        command[k] = np.clip(kp * (wanted[k] - seen[k]) + kd * (rate - speed), -150.0, 150.0)
        noise = 0.15 * random.standard_normal()
        start = state
        for j in range(SUBSTEPS):
            now = k * SAMPLE + j * dt - late
            drive = command[int(now / SAMPLE)] + noise if now >= 0.0 else 0.0
            force = drive - OFFSET
            if hidden == "ripple":
                force -= 2.0 * np.sin(2 * np.pi * state[0] / 12.5e-3 + 0.7)
            if two:
                between = state[0] - load[0]
                press = np.sign(between) * max(abs(between) - 0.5 * gap, 0.0)
                push = contact * press + (damper * (state[1] - load[1]) if press != 0.0 else 0.0)
                push = push if push * press > 0.0 else 0.0
                load = step(load, push, 0.6 * LEVEL, behind, 0.5 * VISCOUS, dt)
                state = step(state, force - push, 0.4 * LEVEL, motor, 0.5 * VISCOUS, dt)
            else:
                level = friction(state[1], force, hidden, drive)
                state = step(state, force, level, MASS, VISCOUS, dt)
        states[k] = (start[0], start[1], (state[1] - start[1]) / SAMPLE)
    force = command + 0.3 * random.standard_normal(samples) if measured else command
    return np.arange(samples) * SAMPLE, force, seen, states


def from_encoder(seen, half=12):
    """Velocity and acceleration by a local parabola (Savitzky-Golay)."""
    at = np.arange(-half, half + 1) * SAMPLE
    fit = np.linalg.pinv(np.stack([np.ones_like(at), at, at**2], axis=1))
    padded = np.pad(seen, half, mode="edge")
    velocity = np.convolve(padded, fit[1][::-1], mode="valid")
    acceleration = 2.0 * np.convolve(padded, fit[2][::-1], mode="valid")
    return velocity, acceleration


def model(hidden, velocity, acceleration, frictionless):
    mass = 17.0 if hidden == "inertia" else MASS
    direction = np.where(np.abs(velocity) > 1e-4, np.sign(velocity), velocity / 1e-4)
    force = mass * acceleration
    if not frictionless:
        force += LEVEL * direction + VISCOUS * velocity + OFFSET
    return 0.93 * force if hidden == "model-gain" else force


def recorded(how, force, seen):
    """Force and position as people's files have them."""
    if how == "coarse":
        return force, np.round(seen / 2e-5) * 2e-5
    if how == "filtered":
        keep, lagged = np.exp(-SAMPLE / 1e-3), np.zeros_like(force)
        for k in range(len(force)):
            lagged[k] = keep * lagged[max(k - 1, 0)] + (1 - keep) * force[k]
        return lagged, seen
    if how == "early":
        return np.roll(force, -1), seen
    if how == "noisy":
        return force + 2.0 * np.random.default_rng(5).standard_normal(len(force)), seen
    return force, seen


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--hide", choices=HIDDEN, default="stribeck")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--seconds", type=float, default=20.0)
    parser.add_argument("--from-encoder", action="store_true", help="the model sees the encoder, not the states")
    parser.add_argument("--frictionless", action="store_true", help="the model is a mass and nothing else")
    parser.add_argument("--measured", action="store_true", help="the force is measured with noise, not the command")
    parser.add_argument(
        "--recorded",
        choices=["plain", "coarse", "filtered", "early", "noisy"],
        default="plain",
        help="position in steps of 20 um; force behind a lag of 1 ms, a sample early, with 2 N of noise",
    )
    parser.add_argument("--out", required=True)
    args = parser.parse_args()
    time, force, seen, states = simulate(args.hide, args.seed, args.seconds, args.measured)
    velocity, acceleration = from_encoder(seen) if args.from_encoder else (states[:, 1], states[:, 2])
    given = model(args.hide, velocity, acceleration, args.frictionless)
    force, seen = recorded(args.recorded, force, seen)
    with open(args.out, "w") as out:
        out.write("time_s,force_N,position_m,model_N\n")
        for row in zip(time, force, seen, given):
            out.write("%.3f,%.4f,%.6f,%.4f\n" % row)


if __name__ == "__main__":
    main()
