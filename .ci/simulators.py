"""Exported models in the simulators that read them: FMPy (FMU), MuJoCo (MJCF, URDF) and Rumoca (Modelica).

    python .ci/simulators.py PATH/TO/aep FOLDER

Needs numpy, fmpy, mujoco and, for Modelica, rumoca; .ci/simulators brings them. A recording is simulated, models are identified from it, and each
export runs under its force. Prints how far each motion is from that of `aep simulate` and from the measured one, and
exits with 1 where an export does not follow.
"""

import importlib.util
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


def follow_modelica(path, time, source, start=(0.0, 0.0), before="", unit="force"):
    """Compiles a model and integrates it; `source` is its force in Modelica, `before` what that needs.

    The solver looks for events at the ends of its steps: a swing keeps them short where everything rests.
    """
    import rumoca

    position, speed = ("angle", "angular_velocity") if unit == "torque" else ("position", "velocity")
    bench = f"""{before}
model Bench
  {path.stem} drive({position}_start={float(start[0])!r}, {speed}_start={float(start[1])!r});
  Real swing(start=0, fixed=true);
equation
  der(swing) = cos(300*time);
  drive.{unit} = {source};
end Bench;
"""
    model = rumoca.Session().loads(path.read_text() + bench, model="Bench")
    settings = rumoca.SimConfig(solver="bdf", rtol=1e-8, atol=1e-11, max_wall_seconds=300)
    step = (time[-1] - time[0]) / (len(time) - 1)
    result = model.simulate(t=(time[0], time[-1]), dt=step, config=settings)
    return np.interp(time, np.array(result.time), np.array(result[f"drive.{position}"]))


def recorded(time, force):
    """Samples as a function in Modelica, linear between them: Rumoca takes no input over time (0.10.2)."""
    step = float(time[-1] - time[0]) / (len(time) - 1)
    samples = ",".join(repr(float(f)) for f in force)
    return f"""
function recorded
  input Real t;
  output Real u;
protected
  constant Real samples[{len(force)}] = {{{samples}}};
  Integer k;
  Real s;
algorithm
  s := min(max((t - {float(time[0])!r})/{step!r}, 0), {len(force) - 1.000001});
  k := integer(floor(s));
  u := samples[k + 1] + (samples[k + 2] - samples[k + 1])*(s - k);
end recorded;
"""


# Beside Coulomb 5 N, viscous 12 N s/m and 0.7 N on 2 kg, in Modelica: what is added.
IN_MODELICA = (
    {"coulomb": {"F_C": 8.0}},
    {"stribeck": {"dF": 2.0, "v_s": 4e-3}},
    {"stribeck:gaussian": {"dF": 4.0, "v_s": 2e-3}},
    {"stribeck:exponential": {"dF": 4.0, "v_s": 2e-3, "delta": 1.0}},
    {"asymmetry": {"dF_C": 1.0, "dF_v": 30.0}, "spring": {"k": 100.0, "x_0": 0.1}},
    {"quadratic-drag": {"c": 20.0}, "shear-thinning": {"dF": 4.0, "v_n": 0.01}},
    {"quadratic-drag:power": {"c": 20.0, "n": 1.7, "v_high": 0.4}},
    {"shear-thinning:eyring": {"dF": 1.0, "v_n": 0.01}},
    {"shear-thinning:cross": {"dF": 4.0, "v_n": 0.01, "m": 0.7}},
    {"drift": {"dF_C": 1.0, "dF_v": 30.0, "tau": 1.0}, "load-friction": {"mu": 0.05}},
    {"drift:linear": {"dF_C": -2.0, "dF_v": -8.0, "begin": 0.0, "finish": 4.0}},
    {"load-friction:both": {"mu": 0.05, "c": 0.5}},
    {"ripple": {"a_1": 1.0, "b_1": 0.3, "a_2": 0.3, "b_2": 0.3, "l": 0.02}},
    {"ripple:direction": {"a_p": 1.0, "b_p": 0.3, "a_m": 0.5, "b_m": 0.3, "l": 0.02}},
    {"viscous-stroke": {**{f"c_{k}": 3.0 / k for k in range(1, 7)}, "start": -0.05, "end": 0.4}},
    {"position-friction": {**{f"c_{k}": 1.0 / k for k in range(1, 7)}, "start": -0.05, "end": 0.4}},
    {"stribeck": {"dF": 2.0, "v_s": 4e-3}, "frictional-memory": {"tau_L": 0.01}},
    {"stribeck": {"dF": 2.0, "v_s": 4e-3}, "frictional-memory:lag": {"tau_L": 0.01}},
    {"stribeck": {"dF": 2.0, "v_s": 4e-3}, "frictional-memory:whole": {"tau_L": 0.01, "F_w": 5.0}},
    {"rising-static-friction": {"dF": 2.0, "gamma": 0.1, "v_s": 1e-2}},
    {"stribeck": {"dF": 2.0, "v_s": 4e-3}, "rising-static-friction:bond": {"gamma": 0.1}},
    {"rising-static-friction:ageing": {"B": 0.5, "D_c": 1e-4, "v_c": 1e-2}},
    {"rising-static-friction:healing": {"dF": 1.5, "gamma": 0.1, "D_c": 1e-3, "h_0": 0.5}},
    {"spring:stiffening": {"k": 50.0, "F_2": 1.0, "F_3": 2.0, "start": -0.05, "end": 0.4}},
    {"reversal-decay": {"F_r": 1.2, "l": 1e-2}},
    {"reversal-decay:hysteresis": {"F_h": 1.2, "l": 1e-2}},
    {"reversal-decay:bouc-wen": {"F_h": 1.2, "l": 1e-2, "n": 2.0, "beta": 0.5}},
    {"backlash": {"F_L": 1.5, "b": 1e-3}},
    {"motor-gain": {"g": 0.9}, "saturation": {"u_max": 12.0}, "actuator-lag": {"tau": 4e-3}},
    {"motor-gain:direction": {"dg": 0.1}},
    {"motor-gain:current": {"c": 0.01}},
    {"motor-gain:knee": {"c": 0.03, "n": 2.5}},
    {"saturation:soft": {"u_max": 12.0, "n": 8.0}},
    {"saturation:speed": {"u_max": 14.0, "kappa": 0.5, "v_high": 0.3}},
    {"motor-gain:ripple": {"a": 0.1, "b": 0.05, "l": 0.05}},
    {"motor-gain:stroke": {**{f"c_{k}": 0.1 / k for k in range(1, 7)}, "start": -0.05, "end": 0.4}},
    {"actuator-lag:second-order": {"tau": 4e-3, "zeta": 0.4}, "encoder": {"a": 1e-4, "b": 1e-4, "p": 5e-3}},
    {"encoder:harmonics": {"a": 1e-4, "b": 1e-4, "a_2": 5e-5, "b_2": -3e-5, "p": 5e-3}},
    {"input-delay": {"T_d": 3.4e-3}},
    {"flexible-coupling": {"m_L": 0.8, "f": 15.0, "zeta": 0.05}},
    {"flexible-coupling:friction": {"m_L": 0.8, "f": 15.0, "zeta": 0.05, "F_L": 1.5, "d_L": 2.0}},
    {"flexible-coupling:load": {"m_L": 0.8, "f": 15.0, "zeta": 0.05, "F_L": 1.5, "d_L": 2.0}},
    {"backlash:two-mass": {"m_L": 0.8, "F_L": 1.5, "d_L": 2.0, "b": 4e-4, "k": 1e5, "zeta": 0.1}},
    {"presliding": {"k_t": 2e5}, "stribeck": {"dF": 2.0, "v_s": 4e-3}},
    {"presliding:static": {"k_t": 2e5}, "stribeck": {"dF": 2.0, "v_s": 4e-3}},
    {"presliding:dahl": {"k_t": 2e5}},
    {"presliding:lugre": {"k_t": 2e5, "sigma_1": 1e3}, "stribeck": {"dF": 2.0, "v_s": 4e-3}},
    {"presliding:maxwell-slip": {"k_t": 2e5, "spread": 2.5}},
)


def modelica(data):
    """The recording, every effect under a force in closed form, a rotary axis.

    Modelica is integrated to a tolerance, `aep simulate` by steps no longer than the samples: these are 50 us apart.
    """
    time, force, measured = data["time_s"][:3000], data["force_N"][:3000], data["position_m"][:3000]
    between = time[0] + 5e-5 * np.arange(20 * (len(time) - 1) + 1)
    rows = np.column_stack([between, np.interp(between, time, force), np.interp(between, time, measured)])
    np.savetxt(FOLDER / "piece.csv", rows, delimiter=",", header="time_s,force_N,position_m", comments="", fmt="%.17g")
    for name in ("plain", "full"):
        aep("simulate", "--model", f"{name}.json", "--input", "piece.csv", "--hold", "sampled", "-o", "motion.csv", "--quiet")
        motion = columns("motion.csv")[::20]
        aep("export", "--model", f"{name}.json", "--to", "modelica", f"{name}.mo", "--quiet")
        start = (motion["position_m"][0], motion["velocity_m_s"][0])
        check(f"Modelica, {name} model, 3 s", motion["position_m"], measured,
              follow_modelica(FOLDER / f"{name}.mo", time, "recorded(time)", start, recorded(time, force)), 5e-3)
    fine = np.arange(0.0, 2.0, 5e-5)
    source = "14*sin(5*time) + 6*sin(31*time) + 1.5"
    swing = 14 * np.sin(5 * fine) + 6 * np.sin(31 * fine) + 1.5
    for k, added in enumerate(IN_MODELICA):
        rows = np.column_stack([fine, swing, 0 * fine])
        np.savetxt(FOLDER / "fine.csv", rows, delimiter=",", header="time_s,force_N,position_m", comments="", fmt="%.17g")
        effects = {"coulomb": {"F_C": 5.0}, "viscous": {"F_v": 12.0}, "offset": {"F_0": 0.7}, **added}
        listed = [{"effect": effect, "parameters": p} for effect, p in effects.items()]
        (FOLDER / f"M{k}.json").write_text(json.dumps({"axis": "linear", "mass": 2.0, "effects": listed}))
        aep("simulate", "--model", f"M{k}.json", "--input", "fine.csv", "--hold", "sampled", "-o", "motion.csv", "--quiet")
        exact = columns("motion.csv")["position_m"][::20]
        aep("export", "--model", f"M{k}.json", "--to", "modelica", f"M{k}.mo", "--quiet")
        check("Modelica, " + ", ".join(added), exact, exact,
              follow_modelica(FOLDER / f"M{k}.mo", fine[::20], source), 5e-4)
    torque = np.column_stack([fine, 0.1 * swing, 0 * fine])
    np.savetxt(FOLDER / "torque.csv", torque, delimiter=",", header="time_s,torque_Nm,angle_rad", comments="", fmt="%.17g")
    aep("simulate", "--model", "pendulum.json", "--input", "torque.csv", "--hold", "sampled", "-o", "motion.csv", "--quiet")
    exact = columns("motion.csv")["angle_rad"][::20]
    aep("export", "--model", "pendulum.json", "--to", "modelica", "pendulum.mo", "--quiet")
    check("Modelica, pendulum", exact, exact,
          follow_modelica(FOLDER / "pendulum.mo", fine[::20], f"0.1*({source})", unit="torque"), 5e-4)


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

    # 3. Modelica, where there is a compiler.
    if importlib.util.find_spec("rumoca"):
        modelica(data)
    else:
        print("SKIPPED: there is no rumoca; exported Modelica models were not compiled")

    # 4. URDF: MuJoCo reads it, too.
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
