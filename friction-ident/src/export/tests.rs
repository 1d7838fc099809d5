use std::fmt::Write as _;
use std::process::Command;

use missing_physics::Hold;

use super::testing::{Folder, compiler};
use super::*;
use crate::axis::{Axis, Effort};
use crate::effects::{ALL, Effect, Slot};
use crate::simulator::{Input, Start, simulate};

/// Reads `time,force` from a file and prints the motion of the plant, `time,position,velocity`.
const PROGRAM: &str = r#"
#include <math.h>
#include <stdio.h>
#include "plant.h"

int main(int argc, char **argv)
{
    Plant plant;
    Start start;
    double time, force, last = 0.0, before = 0.0;
    int first = 1;
    FILE *file = fopen(argv[1], "r");
    (void)argc;
    plant_defaults(&plant);
    while (fscanf(file, "%lf,%lf", &time, &force) == 2) {
        if (first) {
            start.time = time;
            start.x = 0.01;
            start.v = 0.02;
            start.used = 0.0;
            start.command = force;
            if (!plant_start(&plant, &start)) return 1;
        } else {
            const double steps = fmax(ceil((time - last) / 1e-3 - 1e-6), 1.0), length = (time - last) / steps;
            int k;
            for (k = 0; k < (int)steps; k++) {
                const double middle = ((double)k + 0.5) / steps;
                const double mean = argv[2][0] == 'z' ? before : before + middle * (force - before);
                if (!plant_step(&plant, length, mean)) return 1;
            }
        }
        printf("%.17g %.17g\n", plant_shown(&plant), plant.v);
        first = 0;
        last = time;
        before = force;
    }
    plant_free(&plant);
    return 0;
}
"#;

/// A command with reversals, rests and a quick part, unevenly sampled.
fn command() -> (Vec<f64>, Vec<f64>) {
    let (mut time, mut force) = (Vec::new(), Vec::new());
    let mut t: f64 = 0.3;
    for k in 0..1500 {
        let swing = 14.0 * (5.0 * t).sin() + 6.0 * (31.0 * t).sin() + 1.5;
        time.push(t);
        force.push(if (500..700).contains(&k) { 1.0 } else { swing });
        t += if k % 7 == 0 { 2.3e-3 } else { 1e-3 };
    }
    (time, force)
}

fn base() -> Model {
    Model::new(Axis::Linear, 2.0)
        .and_then(|m| m.with("coulomb", &[("F_C", 5.0)]))
        .and_then(|m| m.with("viscous", &[("F_v", 12.0)]))
        .and_then(|m| m.with("offset", &[("F_0", 0.7)]))
        .unwrap()
}

/// The motion of the exported plant.
fn in_c(compiler: &str, model: &Model, hold: Hold, name: &str) -> Vec<(f64, f64)> {
    let exported = to_fmu(model, "drive", 1e-3).unwrap();
    let folder = Folder::new(name);
    for file in exported.files.iter().filter(|file| file.name.starts_with("sources/plant")) {
        let path = folder.path().join(file.name.trim_start_matches("sources/"));
        std::fs::write(path, &file.text).unwrap();
    }
    std::fs::write(folder.path().join("main.c"), PROGRAM).unwrap();
    let (time, force) = command();
    let mut rows = String::new();
    for (time, force) in time.iter().zip(force) {
        writeln!(rows, "{time:e},{force:e}").unwrap();
    }
    std::fs::write(folder.path().join("input.csv"), rows).unwrap();
    let built = Command::new(compiler)
        .current_dir(folder.path())
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-Wno-unused-function", "-pedantic"])
        .args(["-ffp-contract=off", "-O1", "plant.c", "main.c", "-o", "run", "-lm"])
        .output()
        .unwrap();
    assert!(built.status.success(), "{name}: {}", String::from_utf8_lossy(&built.stderr));
    let way = if hold == Hold::ZeroOrder { "z" } else { "s" };
    let ran = Command::new(folder.path().join("run"))
        .current_dir(folder.path())
        .args(["input.csv", way])
        .output()
        .unwrap();
    assert!(ran.status.success(), "{name}");
    let text = String::from_utf8(ran.stdout).unwrap();
    text.lines()
        .map(|line| {
            let (x, v) = line.split_once(' ').unwrap();
            (x.parse().unwrap(), v.parse().unwrap())
        })
        .collect()
}

/// How far the exported plant is from the simulator, as a share of how far the axis moves.
fn deviation(compiler: &str, model: &Model, hold: Hold, name: &str) -> f64 {
    let (time, force) = command();
    let input = Input::new(&time, &force, hold);
    let start = Start { position: 0.01, velocity: 0.02, command: force[0], ..Start::default() };
    let motion = simulate(model, &input, &start).unwrap();
    let exported = in_c(compiler, model, hold, name);
    assert_eq!(exported.len(), motion.position.len(), "{name}");
    let moved = motion.position.iter().fold(0.0f64, |most, x| most.max((x - 0.01).abs()));
    assert!(moved > 1e-4, "{name}: the axis does not move, {moved}");
    let pairs = exported.iter().zip(&motion.position);
    pairs.fold(0.0f64, |most, ((x, _), exact)| most.max((x - exact).abs())) / moved
}

/// `base` with an effect at its typical values; a level where it needs one.
fn with(effect: &'static dyn Effect) -> Option<Model> {
    let about = effect.about();
    let mut model = base().without(about.name);
    if about.name == "rising-static-friction:bond" {
        model = model.with("stribeck", &[("dF", 2.0), ("v_s", 4e-3)]).unwrap();
    }
    let mut model = model.with_effect(effect).ok()?;
    for parameter in about.parameters {
        let address = format!("{}.{}", about.name, parameter.name);
        let value = match (about.name, parameter.name) {
            ("saturation", "u_max") => 12.0,
            ("motor-gain", "g") => 0.9,
            (_, "k_t") => 2e5,
            (_, "m_L") => 0.8,
            (_, "F_L") => 1.5,
            (_, "F_r") => 1.2,
            ("backlash:two-mass", "b") => 4e-4,
            ("backlash:two-mass", "k") => 1e5,
            ("input-delay", "T_d") => 3.4e-3,
            ("spring:stiffening", "start") => -0.3,
            (_, "q_0") => 0.2,
            _ if model.get(&address).unwrap() == 0.0 => 0.3,
            _ => continue,
        };
        model.set(&address, value).ok()?;
    }
    Some(model)
}

fn all() -> impl Iterator<Item = &'static dyn Effect> {
    ALL.iter().flat_map(|e| std::iter::once(e).chain(e.forms())).copied()
}

#[test]
fn every_exported_effect_moves_in_c_as_in_the_simulator() {
    let Some(compiler) = compiler() else { return };
    let mut refused = Vec::new();
    let mut worst = Vec::new();
    for effect in all() {
        let name = effect.about().name;
        let Some(model) = with(effect) else { panic!("{name} has no model") };
        match to_fmu(&model, "drive", 1e-3) {
            Err(ExportError::NoLaw(names)) => refused.extend(names),
            Err(error) => panic!("{name}: {error}"),
            Ok(_) => {
                let hold = if name.len() % 2 == 0 { Hold::ZeroOrder } else { Hold::Sampled };
                let off = deviation(&compiler, &model, hold, &name.replace(':', "-"));
                worst.push((name, off));
            }
        }
    }
    let bad: Vec<_> = worst.iter().filter(|(_, off)| off.is_nan() || *off > 1e-9).collect();
    assert!(bad.is_empty(), "{bad:?}");
    assert_eq!(refused, ["presliding:free"]);
}

#[test]
fn effects_together_move_in_c_as_in_the_simulator() {
    let Some(compiler) = compiler() else { return };
    let sets: [&[&str]; 4] = [
        &[
            "stribeck",
            "frictional-memory",
            "presliding:static",
            "rising-static-friction:bond",
            "ripple",
        ],
        &[
            "actuator-lag",
            "saturation",
            "input-delay",
            "flexible-coupling:friction",
            "reversal-decay",
        ],
        &["presliding", "flexible-coupling", "encoder", "asymmetry", "load-friction"],
        &["presliding:lugre", "stribeck:gaussian", "drift", "backlash", "motor-gain"],
    ];
    for (k, set) in sets.iter().enumerate() {
        let mut model = base();
        for name in *set {
            model = model.with_effect(crate::effects::find(name).unwrap()).unwrap();
        }
        if model.acts_on(Slot::Contact) {
            let contact = set.iter().find(|name| name.starts_with("presliding")).unwrap();
            model.set(&format!("{contact}.k_t"), 3e5).unwrap();
        }
        for hold in [Hold::ZeroOrder, Hold::Sampled] {
            let off = deviation(&compiler, &model, hold, &format!("set-{k}-{hold:?}"));
            assert!(off < 1e-9, "{set:?}: {off}");
        }
    }
}

#[test]
fn an_fmu_describes_every_parameter_with_its_unit() {
    let model = base().with("stribeck", &[("dF", 2.0), ("v_s", 1e-3)]).unwrap();
    let exported = to_fmu(&model, "x_axis", 1e-3).unwrap();
    let text = &exported.files[0].text;
    for needed in [
        "modelIdentifier=\"x_axis\"",
        "name=\"stribeck.v_s\" valueReference=\"13\"",
        "<Unit name=\"N s/m\"><BaseUnit kg=\"1\" s=\"-1\"/></Unit>",
        "<File name=\"plant.c\"/>",
    ] {
        assert!(text.contains(needed), "{needed}\n{text}");
    }
    assert!(!text.contains("contact_start"));
    let volts = to_fmu(&base().with_effort(Effort::Volt), "x_axis", 1e-3).unwrap();
    assert!(volts.files[0].text.contains("name=\"effort\""));
    assert!(!volts.files[0].text.contains("unit=\"N"), "volts are volts");
    assert_ne!(guid(&exported), guid(&volts));
}

fn guid(exported: &Exported) -> String {
    let text = &exported.files[0].text;
    let from = text.find("guid=\"").unwrap();
    text[from..from + 44].to_owned()
}

#[test]
fn what_a_target_cannot_say_is_listed_in_the_file_and_beside_it() {
    for effect in all() {
        let model = with(effect).unwrap();
        for exported in [
            to_mjcf(&model, "axis", 1e-3).unwrap(),
            to_urdf(&model, "axis").unwrap(),
            to_modelica(&model, "axis").unwrap(),
        ] {
            let text = &exported.files[0].text;
            for name in model.effects() {
                let expressed = exported.expressed.iter().any(|e| e == name);
                let left = exported.left_out.iter().any(|left| left.what == name);
                assert!(expressed != left, "{name}");
                assert!(!left || text.contains(&format!("Left out: {name}:")), "{name}");
            }
        }
    }
}

#[test]
fn a_scene_has_the_numbers_of_the_model() {
    let model = base()
        .with("motor-gain", &[("g", 2.0)])
        .and_then(|m| m.with("saturation", &[("u_max", 30.0)]))
        .and_then(|m| m.with("actuator-lag", &[("tau", 2e-3)]))
        .and_then(|m| m.with("flexible-coupling:load", &[("m_L", 1.0), ("f", 10.0)]))
        .unwrap_or_else(|error| panic!("{error}"));
    let text = &to_mjcf(&model, "axis", 1e-3).unwrap().files[0].text;
    for needed in [
        "type=\"slide\"",
        "damping=\"12\" frictionloss=\"5\"",
        "gainprm=\"2\" biastype=\"affine\" biasprm=\"-0.7 0 0\" dyntype=\"filterexact\" dynprm=\"0.002\"",
        "ctrlrange=\"-15 15\"",
        "joint=\"axis_load\" coef=\"-1\"",
        "<jointpos name=\"axis_position\" joint=\"axis_load\"/>",
    ] {
        assert!(text.contains(needed), "{needed}\n{text}");
    }
}

#[test]
fn what_cannot_be_exported_says_how_to_mend_it() {
    let volts = base().with_effort(Effort::Volt);
    let error = to_mjcf(&volts, "axis", 1e-3).unwrap_err().to_string();
    assert!(error.contains("in V") && error.contains("--force-gain"), "{error}");
    let free = base().with_effect(crate::effects::find("presliding:free").unwrap()).unwrap();
    let error = to_fmu(&free, "axis", 1e-3).unwrap_err().to_string();
    assert!(error.contains("'presliding:free' is not written in C"), "{error}");
    assert_eq!(to_fmu(&base(), "x-axis", 1e-3), Err(ExportError::Name("x-axis".to_owned())));
    assert!(matches!(to_mjcf(&base(), "x", 0.0), Err(ExportError::Step(_))));
}

/// Words of Modelica that its equations use, and functions.
const MODELICA: [&str; 26] = [
    "der", "pre", "delay", "reinit", "abs", "sign", "max", "min", "sin", "cos", "exp", "log",
    "sqrt", "tanh", "if", "then", "elseif", "elsewhen", "else", "when", "end", "and", "or", "not",
    "time", "pi",
];

/// The names that `equations` use and `declared` does not know.
fn unknown<'a>(declared: &str, equations: &'a str) -> Vec<&'a str> {
    let letter = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let code = declared.lines().map(|line| line.split_once(" \"").map_or(line, |(code, _)| code));
    let known: Vec<&str> = code.flat_map(|line| line.split(|c: char| !letter(c))).collect();
    equations
        .split(|c: char| !letter(c) && c != '.')
        .filter(|word| word.starts_with(|c: char| c.is_ascii_alphabetic()))
        .filter(|word| !MODELICA.contains(word) && !known.contains(word))
        .collect()
}

#[test]
fn a_modelica_model_declares_every_name_and_ends_every_clause() {
    let mut left = Vec::new();
    for effect in all() {
        let exported = to_modelica(&with(effect).unwrap(), "axis").unwrap();
        left.extend(exported.left_out.iter().map(|left| left.what.clone()));
        let text = &exported.files[0].text;
        let (declared, rest) = text.split_once("\nequation\n").unwrap();
        let equations = rest.split_once("  annotation(Icon").unwrap().0;
        let names = unknown(declared, equations);
        assert!(names.is_empty(), "{}: {names:?} not declared\n{text}", effect.about().name);
        assert_eq!(equations.matches('(').count(), equations.matches(')').count(), "{text}");
        let begun = equations.lines().filter(|line| line.starts_with("  when ")).count();
        assert_eq!(begun, equations.matches("end when;").count(), "{text}");
        assert!(!text.contains('@'), "{text}");
        // What its equations do not use is no parameter of it.
        for address in with(effect).unwrap().addresses() {
            let name = address.replace(['.', ':', '-'], "_");
            let used = !unknown(&declared.replace(&format!("{name}("), ""), rest).is_empty();
            let of_left = exported.left_out.iter().any(|left| address.starts_with(&left.what));
            let initial =
                declared.split_once("initial equation").is_some_and(|(_, i)| i.contains(&name));
            assert!(used || of_left || initial, "{name}\n{text}");
        }
    }
    assert_eq!(left, ["presliding:free"]);
}

#[test]
fn a_modelica_model_has_the_numbers_and_units_of_the_model_and_sticks_by_events() {
    let model = base().with("actuator-lag", &[("tau", 2e-3)]).unwrap();
    let text = &to_modelica(&model, "Drive").unwrap().files[0].text;
    for needed in [
        "parameter Real viscous_F_v(unit=\"N.s/m\") = 12.0 \"damping\";",
        "Input force(unit=\"N\")",
        "actuator_lag_tau*der(actuator_lag_force) = force - actuator_lag_force;",
        "level = max(0, coulomb_F_C);",
        "when pre(direction) == 0 and (applied > level or applied < -level) then",
        "reinit(v, 0);",
    ] {
        assert!(text.contains(needed), "{needed}\n{text}");
    }
    let volts = base().with_effort(Effort::Volt);
    let text = &to_modelica(&volts, "Drive").unwrap().files[0].text;
    assert!(text.contains("mass(unit=\"V.s2/m\")") && text.contains("Input effort"), "{text}");
}

#[test]
fn what_jumps_while_an_elastic_contact_holds_is_left_out_of_modelica() {
    let mut model = base();
    for name in ["presliding:lugre", "reversal-decay", "load-friction:inertia"] {
        model = model.with_effect(crate::effects::find(name).unwrap()).unwrap();
    }
    let exported = to_modelica(&model, "Drive").unwrap();
    let left: Vec<&str> = exported.left_out.iter().map(|left| left.what.as_str()).collect();
    assert_eq!(left, ["reversal-decay", "load-friction:inertia"]);
    assert!(!exported.files[0].text.contains("reversal_decay_"));
    let asymmetric = base()
        .with_effect(crate::effects::find("presliding").unwrap())
        .and_then(|model| model.with_effect(crate::effects::find("asymmetry").unwrap()))
        .unwrap();
    let exported = to_modelica(&asymmetric, "Drive").unwrap();
    assert_eq!(exported.left_out[0].what, "asymmetry while the contact holds");
    assert!(exported.expressed.iter().any(|name| name == "asymmetry"));
}

#[test]
fn a_word_of_modelica_names_no_model() {
    let error = to_modelica(&base(), "model").unwrap_err().to_string();
    assert!(error.contains("'model'") && error.contains("--name"), "{error}");
}
