"""Exported models in the simulators that read them: FMPy (FMU) and MuJoCo (MJCF, URDF).

    python .ci/simulators.py PATH/TO/aep FOLDER

Needs numpy, fmpy and mujoco; .ci/simulators brings them. A recording is simulated, models are identified from it, and each
export runs under its force. Prints how far each motion is from that of `aep simulate` and from the measured one, and
exits with 1 where an export does not follow.
"""

import json
import subprocess
import sys
from pathlib import Path

import numpy as np


def aep(*words):
    """Runs the command; its output."""
    done = subprocess.run([AEP, *map(str, words)], cwd=FOLDER, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"aep {' '.join(map(str, words))}\n{done.stdout}{done.stderr}")
    return done.stdout


def columns(name):
    return np.genfromtxt(FOLDER / name, delimiter=",", names=True)


def rms(x):
    return float(np.sqrt(np.mean(np.square(x))))


def check(what, reference, measured, motion, limit):
    """One line of the table; counts what does not follow."""
    global DONE, FAILED
    DONE += 1
    stroke = np.ptp(reference)
    off = np.max(np.abs(motion - reference)) / stroke
    ok = bool(off <= limit)
    FAILED += not ok
    print(f"{what:42} {off:10.2e} {limit:9.0e} {rms(motion - measured) / stroke:11.3e} "
          f"{rms(reference - measured) / stroke:11.3e}  {'ok' if ok else 'DOES NOT FOLLOW'}")


def follow_fmu(path, time, force, start, hold, unit="force"):
    import fmpy
    from fmpy.validation import validate_fmu

    problems = validate_fmu(str(path))
    if problems:
        sys.exit(f"{path}: {problems}")
    position = "angle" if unit == "torque" else "position"
    speed = "angular_velocity" if unit == "torque" else "velocity"
    step = (time[-1] - time[0]) / (len(time) - 1)
    at_start = {f"{position}_start": start[0], f"{speed}_start": start[1], unit: force[0]}
    if hold == "sampled":
        return linear_between(path, time, force, at_start, unit, position)
    signals = np.array(list(zip(time, force)), dtype=[("time", float), (unit, float)])
    result = fmpy.simulate_fmu(
        str(path), start_time=time[0], stop_time=time[-1], step_size=step, output_interval=step,
        input=signals, output=[position], start_values=at_start)
    return result[position][: len(time)]


def linear_between(path, time, force, at_start, unit, position):
    """Gives the derivative of the input with each step; fmpy.simulate_fmu cannot (0.3.32)."""
    import fmpy
    from fmpy.fmi2 import FMU2Slave

    description = fmpy.read_model_description(str(path))
    number = {v.name: v.valueReference for v in description.modelVariables}
    slave = FMU2Slave(guid=description.guid, unzipDirectory=fmpy.extract(str(path)),
                      modelIdentifier=description.coSimulation.modelIdentifier, instanceName="drive")
    slave.instantiate()
    slave.setupExperiment(startTime=time[0])
    slave.enterInitializationMode()
    for name, value in at_start.items():
        slave.setReal([number[name]], [value])
    slave.exitInitializationMode()
    out = slave.getReal([number[position]])
    for k in range(len(time) - 1):
        step = time[k + 1] - time[k]
        slave.setReal([number[unit]], [force[k]])
        slave.setRealInputDerivatives([number[unit]], [1], [(force[k + 1] - force[k]) / step])
        slave.doStep(currentCommunicationPoint=time[k], communicationStepSize=step)
        out += slave.getReal([number[position]])
    slave.terminate()
    slave.freeInstance()
    return np.array(out)


def follow_mjcf(path, time, force, start):
    import mujoco

    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    data.qpos[:], data.qvel[:] = start[0], start[1]
    if model.na:
        data.act[:] = force[0]
    out = [start[0]]
    shown = model.sensor(f"{path.stem}_position").adr[0]
    for k in range(len(time) - 1):
        data.ctrl[0] = force[k]
        while data.time < time[k + 1] - time[0] - 0.5 * model.opt.timestep:
            mujoco.mj_step(model, data)
        mujoco.mj_forward(model, data)
        out.append(data.sensordata[shown])
    return np.array(out)


def main():
    def model(name, axis, mass, **effects):
        listed = [{"effect": effect.replace("__", ":").replace("_", "-"), "parameters": p} for effect, p in effects.items()]
        (FOLDER / name).write_text(json.dumps({"axis": axis, "mass": mass, "effects": listed}))

    # 1. A recording with a hidden effect; a model with it for the FMU, one that MuJoCo can say for MJCF.
    aep("challenge", "--hide", "stribeck", "--seed", 7, "-o", "riddle", "--quiet")
    aep("identify", "riddle/recording.csv", "--effects", "coulomb,viscous,offset,stribeck,presliding", "-o", "full.json", "--quiet")
    aep("identify", "riddle/recording.csv", "--effects", "coulomb,viscous,offset", "-o", "plain.json", "--quiet")
    print(f"{'':42} {'from aep':>10} {'allowed':>9} {'from data':>11} {'aep, data':>11}")
    data = columns("riddle/recording.csv")
    time, force, measured = data["time_s"], data["force_N"], data["position_m"]
    for name in ("full", "plain"):
        for hold in ("zero-order", "sampled"):
            aep("simulate", "--model", f"{name}.json", "--input", "riddle/recording.csv", "--hold", hold, "-o", "motion.csv", "--quiet")
            motion = columns("motion.csv")
            aep("export", "--model", f"{name}.json", "--to", "fmu", f"{name}.fmu", "--quiet")
            start = (motion["position_m"][0], motion["velocity_m_s"][0])
            check(f"FMU, {name} model, {hold}", motion["position_m"], measured,
                  follow_fmu(FOLDER / f"{name}.fmu", time, force, start, hold), 1e-7)
    aep("simulate", "--model", "plain.json", "--input", "riddle/recording.csv", "--hold", "zero-order", "-o", "motion.csv", "--quiet")
    motion = columns("motion.csv")
    start = (motion["position_m"][0], motion["velocity_m_s"][0])
    aep("export", "--model", "plain.json", "--to", "mjcf", "plain.xml", "--quiet")
    check("MuJoCo, plain model", motion["position_m"], measured,
          follow_mjcf(FOLDER / "plain.xml", time, force, start), 5e-3)

    # 2. What else MuJoCo can say: a pendulum, a spring, a lag and a limit of the drive, a second body.
    time = np.arange(0.0, 5.0, 1e-3)
    swing = np.sin(2 * np.pi * 0.7 * time) + 0.4 * np.sin(2 * np.pi * 3.1 * time)
    for name, axis, mass, scale, effects in (
        ("pendulum", "rotary", 0.02, 1.5, {"coulomb": {"F_C": 0.05}, "viscous": {"F_v": 0.02}, "gravity_pendulum": {"M": 0.8, "q_0": 0.3}}),
        ("sprung", "linear", 3.0, 20.0, {"coulomb": {"F_C": 2.0}, "viscous": {"F_v": 15.0}, "offset": {"F_0": 1.0}, "spring": {"k": 200.0, "x_0": 0.01},
                                         "motor_gain": {"g": 1.1}, "saturation": {"u_max": 18.0}, "actuator_lag": {"tau": 0.004}}),
        ("coupled", "linear", 3.0, 20.0, {"coulomb": {"F_C": 2.0}, "viscous": {"F_v": 25.0},
                                          "flexible_coupling__load": {"m_L": 2.0, "f": 9.0, "zeta": 0.05, "F_L": 1.0, "d_L": 4.0}}),
    ):
        model(f"{name}.json", axis, mass, **effects)
        unit, length = ("torque", "angle_rad") if axis == "rotary" else ("force", "position_m")
        head = f"time_s,{unit}_{'Nm' if axis == 'rotary' else 'N'},{length}"
        rows = np.column_stack([time, scale * swing, np.zeros_like(time)])
        np.savetxt(FOLDER / f"{name}.csv", rows, delimiter=",", header=head, comments="", fmt="%.17g")
        aep("simulate", "--model", f"{name}.json", "--input", f"{name}.csv", "--hold", "zero-order", "-o", "motion.csv", "--quiet")
        exact = columns("motion.csv")
        exact = exact[length]
        aep("export", "--model", f"{name}.json", "--to", "fmu", f"{name}.fmu", "--quiet")
        check(f"FMU, {name}", exact, exact, follow_fmu(FOLDER / f"{name}.fmu", time, scale * swing, (0.0, 0.0), "zero-order", unit), 1e-7)
        aep("export", "--model", f"{name}.json", "--to", "mjcf", f"{name}.xml", "--max-step", 1e-4, "--quiet")
        check(f"MuJoCo, {name}, steps of 0.1 ms", exact, exact, follow_mjcf(FOLDER / f"{name}.xml", time, scale * swing, (0.0, 0.0)), 5e-3)

    # 3. URDF: MuJoCo reads it, too.
    import mujoco

    for name in ("plain", "pendulum"):
        aep("export", "--model", f"{name}.json", "--to", "urdf", f"{name}.urdf", "--quiet")
        read = mujoco.MjModel.from_xml_path(str(FOLDER / f"{name}.urdf"))
        data = mujoco.MjData(read)
        mujoco.mj_forward(read, data)
        full = np.zeros((read.nv, read.nv))
        try:
            mujoco.mj_fullM(read, full, data.qM)
        except (TypeError, AttributeError):
            mujoco.mj_fullM(read, data, full)
        exact = json.loads((FOLDER / f"{name}.json").read_text())["mass"]
        check(f"URDF, {name}: mass, as MuJoCo reads it", np.array([0.0, exact]), np.array([0.0, exact]), np.array([0.0, full[0, 0]]), 1e-6)
    print(f"{DONE - FAILED} of {DONE} follow")
    sys.exit(1 if FAILED else 0)


AEP = str(Path(sys.argv[1]).resolve())
FOLDER = Path(sys.argv[2]).resolve()
DONE = FAILED = 0
main()
