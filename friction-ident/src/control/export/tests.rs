use super::super::course::Course;
use super::super::trial::{Servo, run, samples};
use super::super::{Settings, paper as figures};
use super::*;
use crate::effects::{ALL, ParameterRole};
use crate::export::testing::{Folder, compiler};
use crate::model::Model;
use crate::paper;
use std::path::Path;
use std::process::Command;

/// Compiles the files and runs the vectors; gives what the program says.
fn built_and_run(compiler: &str, files: &[File], name: &str) -> String {
    let folder = Folder::new(name);
    for file in files {
        std::fs::write(folder.path().join(&file.name), &file.text).unwrap();
    }
    let in_folder = |program: &Path| {
        let mut command = Command::new(program);
        command.current_dir(folder.path());
        command
    };
    let built = in_folder(Path::new(compiler))
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-Wshadow", "-Wconversion"])
        .args(["-ffp-contract=off", "-O2"])
        .args([&format!("{name}.c"), &format!("{name}_test.c"), "-o", "run", "-lm"])
        .output()
        .unwrap();
    let source = || files.iter().find(|f| f.name == format!("{name}.c")).map(|f| f.text.clone());
    let errors = String::from_utf8_lossy(&built.stderr).into_owned();
    assert!(built.status.success(), "{errors}\n{}", source().unwrap_or_default());
    let program = folder.path().join("run");
    let ran = in_folder(&program).arg(format!("{name}_vectors.csv")).output().unwrap();
    let said = String::from_utf8_lossy(&ran.stdout).into_owned();
    assert!(ran.status.success(), "{name}: {said}\n{}", source().unwrap_or_default());
    said
}

/// The compensator of `model` along a closed loop of that model, as C.
fn exported(model: &Model, settings: Settings, course: Course, name: &str) -> Vec<File> {
    let compensator = Compensator::new(model, settings).unwrap();
    let servo = Servo::for_mass(model.mass(), settings.sample_time);
    let reference = course.sampled(settings.sample_time, 3.0);
    let trial = run(model, &reference, &servo, Some(&compensator)).unwrap();
    let samples = samples(&trial.run, &reference);
    to_c(&compensator, model.axis(), name, &samples).unwrap()
}

#[test]
fn the_papers_compensator_agrees_in_c_along_every_figure() {
    let Some(compiler) = compiler() else { return };
    let table = paper::table().unwrap();
    for figure in &figures::FIGURES {
        let compensator = Compensator::new(&table, figures::settings()).unwrap();
        let shown = figure.show().unwrap();
        let samples = samples(&shown.compensated.run, &shown.reference);
        let files = to_c(&compensator, table.axis(), figure.name, &samples).unwrap();
        let said = built_and_run(&compiler, &files, figure.name);
        assert!(said.starts_with(&format!("{} rows", samples.len())), "{said}");
    }
}

#[test]
fn every_effect_that_is_compensated_agrees_in_c() {
    let Some(compiler) = compiler() else { return };
    let course = Course::Sine { amplitude: 0.02, frequency: 0.7 };
    for effect in ALL.iter().flat_map(|e| std::iter::once(e).chain(e.forms())) {
        let about = effect.about();
        let axis = if effect.suits(Axis::Linear) { Axis::Linear } else { Axis::Rotary };
        let mut model = Model::new(axis, 30.0 * axis.typical(Quantity::Mass)).unwrap();
        for companion in ["coulomb", "viscous", "stribeck"] {
            model = model.with(companion, &[]).unwrap();
        }
        let stem = about.name.split(':').next().unwrap();
        for name in model.effects() {
            if name == stem {
                model = model.without(name);
            }
        }
        let mut model = model.with_effect(*effect).unwrap();
        // Nothing stays at 0, where a wrong law would not show.
        for (k, parameter) in about.parameters.iter().enumerate() {
            let address = crate::model::address(*effect, parameter.name);
            if parameter.role != ParameterRole::Fixed && model.get(&address).unwrap() == 0.0 {
                let size = 0.1 * (k + 1) as f64 * axis.typical(parameter.quantity);
                model.set(&address, size).unwrap();
            }
        }
        for presliding in [true, false] {
            let settings = Settings { presliding, ..Settings::new(2e-3, 1e-3) };
            let compensator = Compensator::new(&model, settings).unwrap();
            let acts = compensator.terms().iter().any(|term| term.name() == about.name);
            match to_c(&compensator, axis, "compensator", &[]) {
                Ok(_) if acts || compensator.contact().is_some() => {
                    let files = exported(&model, settings, course, "compensator");
                    built_and_run(&compiler, &files, "compensator");
                }
                Ok(_) => assert!(compensator.left_out().iter().any(|l| l.effect == about.name)),
                Err(error) => {
                    assert_eq!(error, ExportError::Contact(about.name.to_owned()), "{error}");
                }
            }
        }
    }
}

#[test]
fn memories_of_both_kinds_and_a_changed_vector_are_told_apart() {
    let Some(compiler) = compiler() else { return };
    let model = |memory: &str| {
        Model::new(Axis::Linear, 30.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 6.0)]))
            .and_then(|m| m.with("stribeck:gaussian", &[("dF", 4.0), ("v_s", 2e-3)]))
            .and_then(|m| m.with(memory, &[("tau_L", 0.0123)]))
            .and_then(|m| m.with("rising-static-friction:bond", &[("gamma", 0.05)]))
            .and_then(|m| m.with("presliding:static", &[("k_t", 3e6)]))
            .unwrap()
    };
    let course = Course::Trapezoid { distance: 2e-3, speed: 4e-3, acceleration: 0.05 };
    for memory in ["frictional-memory", "frictional-memory:lag"] {
        let mut files = exported(&model(memory), Settings::new(2e-3, 5e-4), course, "memory");
        built_and_run(&compiler, &files, "memory");
        // One force off by a billionth must fail: the program compares.
        let vectors = files.iter_mut().find(|f| f.name.contains("_vectors")).unwrap();
        let rows: Vec<&str> = vectors.text.lines().collect();
        let (middle, cells) = (rows.len() / 2, rows[rows.len() / 2].split(',').collect::<Vec<_>>());
        let off: f64 = cells[3].parse::<f64>().unwrap() * (1.0 + 1e-9) + 1e-9;
        let row = format!("{},{},{},{off:e}", cells[0], cells[1], cells[2]);
        vectors.text = [&rows[..middle], &[row.as_str()], &rows[middle + 1..]].concat().join("\n");
        let failed = std::panic::catch_unwind(|| built_and_run(&compiler, &files, "memory"));
        assert!(failed.is_err());
    }
}

#[test]
fn what_has_no_c_code_is_said() {
    let lugre = Model::new(Axis::Linear, 1.0)
        .and_then(|m| m.with("coulomb", &[]))
        .and_then(|m| m.with("presliding:lugre", &[]))
        .unwrap();
    let compensator = Compensator::new(&lugre, Settings::new(1e-3, 1e-3)).unwrap();
    let error = to_c(&compensator, Axis::Linear, "c", &[]).unwrap_err();
    assert!(error.to_string().contains("--no-presliding"), "{error}");
    let error = to_c(&compensator, Axis::Linear, "2nd-axis", &[]).unwrap_err();
    assert_eq!(error, ExportError::Name("2nd-axis".into()));
}
