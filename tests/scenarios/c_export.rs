//! A compensator in C along a closed loop, with an effect of a user's own in it.

use std::path::Path;
use std::process::{Command, Output};

use friction_ident::control::export::{File, to_c};
use friction_ident::control::{Compensator, Course, Servo, Settings, run, samples};
use friction_ident::effects::{About, CLaw, Effect, Motion, Parameter, Parameters, Slot};
use friction_ident::{Axis, Quantity};

use super::table::plain;

/// `dF exp(-x / l) s`: the drag of a cable chain.
struct CableChain;

static ABOUT: About = About {
    name: "cable-chain",
    title: "drag of the cable chain",
    equation: "dF exp(-x/l) s",
    parameters: &[
        Parameter::level("dF", "drag at the origin", Quantity::Force, 50.0, 2.0),
        Parameter::shape("l", "length over which it decays", Quantity::Length, (0.01, 1.0), 0.05),
    ],
    slots: &[Slot::FrictionLevel],
    shows: "(residual x sign of velocity) against position",
    reference: "this machine's drawing",
};

impl Effect for CableChain {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        for (i, level) in level.iter_mut().enumerate() {
            *level += p.get(0)[i] * (-m.position[i] / p.get(1)[i]).exp();
        }
    }

    fn c_law(&self) -> Option<CLaw> {
        Some(CLaw::level("level += {dF} * exp(-x / {l});"))
    }
}

/// The same law without its hook.
struct WithoutC;

impl Effect for WithoutC {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        CableChain.friction_level(p, m, level);
    }
}

/// The compensator of a table with the effect, along a closed loop of that table which it takes part in.
fn exported(effect: &'static dyn Effect) -> Result<Vec<File>, String> {
    let model = plain().with("stribeck", &[]).unwrap().with_effect(effect).unwrap();
    let settings = Settings::new(2e-3, 1e-3);
    let compensator = Compensator::new(&model, settings).unwrap();
    let servo = Servo::for_mass(model.mass(), settings.sample_time);
    let course = Course::Sine { amplitude: 0.02, frequency: 0.7 };
    let reference = course.sampled(settings.sample_time, 3.0);
    let trial = run(&model, &reference, &servo, Some(&compensator)).unwrap();
    let samples = samples(&trial.run, &reference);
    to_c(&compensator, Axis::Linear, "drive", &samples).map_err(|error| error.to_string())
}

/// Compiles the files in `folder` and runs the vectors of the closed loop through them.
fn met(compiler: &str, folder: &Path, files: &[File]) -> Output {
    for file in files {
        std::fs::write(folder.join(&file.name), &file.text).unwrap();
    }
    let built = Command::new(compiler)
        .current_dir(folder)
        .args(["-std=c99", "-Wall", "-Wextra", "-Werror", "-pedantic", "-ffp-contract=off"])
        .args(["drive.c", "drive_test.c", "-o", "met", "-lm"])
        .output()
        .unwrap();
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    Command::new(folder.join("met")).arg("drive_vectors.csv").current_dir(folder).output().unwrap()
}

#[test]
fn an_effect_of_a_user_with_a_law_in_c_agrees_with_the_closed_loop() {
    let files = exported(&CableChain).unwrap();
    let rows =
        files.iter().find(|f| f.name == "drive_vectors.csv").unwrap().text.lines().count() - 1;
    assert!(rows > 1000, "{rows}");
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    let there = Command::new(&compiler).arg("--version").output();
    if !there.is_ok_and(|out| out.status.success()) {
        eprintln!(
            "SKIPPED: there is no C compiler '{compiler}', so that the exported C code was not compiled"
        );
        return;
    }
    let folder = tempfile::tempdir().unwrap();
    let said = met(&compiler, folder.path(), &files);
    let text = String::from_utf8_lossy(&said.stdout).into_owned();
    assert!(said.status.success() && text.starts_with(&format!("{rows} rows")), "{text}");
    // A law with another sign is noticed.
    let mut wrong = files;
    let source = wrong.iter_mut().find(|f| f.name == "drive.c").unwrap();
    assert!(source.text.contains("exp(-x / "), "{}", source.text);
    source.text = source.text.replace("exp(-x / ", "exp(x / ");
    assert!(!met(&compiler, folder.path(), &wrong).status.success());
}

#[test]
fn an_effect_without_a_law_in_c_is_refused_by_its_name() {
    let error = exported(&WithoutC).unwrap_err();
    assert!(error.contains("'cable-chain' has no law in C"), "{error}");
}
