//! `aep control`: PD with and without friction compensation.

use std::fmt::Write as _;
use std::path::PathBuf;

use aep_studio::report::plain::{self, Part};
use friction_ident::control::{Deviation, Trial, paper, robustness};
use friction_ident::{Axis, Quantity};
use missing_physics::measurement::quantity::quantity;
use serde_json::json;

use crate::app::Global;
use crate::args::{LoopArgs, ReferenceArgs};
use crate::compensation::{self, Case};
use crate::curve_plot::{self, Axes, Curve};
use crate::failure::Failure;
use crate::output::{self, Table, heading, written};
use crate::outputs;
use crate::report::command;

/// Simulate PD control with and without friction compensation
///
/// The compensator is built from --model: it adds the friction that the model has along the desired
/// motion. The plant is the same model unless --plant gives another one, which may have effects that the
/// compensator does not know. Without --model, both are the X-Y table of the AEP paper with the paper's
/// gains.
#[derive(clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Args {
    /// The model behind the compensator, as written by identify, extend or discover
    #[arg(long, value_name = "MODEL.json")]
    model: Option<PathBuf>,
    /// The simulated plant; by default the model
    #[arg(long, value_name = "MODEL.json")]
    plant: Option<PathBuf>,
    #[command(flatten)]
    reference: ReferenceArgs,
    #[command(flatten)]
    servo: LoopArgs,
    /// Change every parameter of the compensator by +- this many per cent and say what happens
    #[arg(long, value_name = "PERCENT", num_args = 0..=1, default_missing_value = "20", value_parser = super::positive)]
    robustness: Option<f64>,
    /// Write the signals of both runs as CSV
    #[arg(short, long, value_name = "FILE.csv", help_heading = "Results")]
    output: Option<PathBuf>,
    /// Write a plot of position and error
    #[arg(long, value_name = "FILE.svg", help_heading = "Results")]
    plot: Option<PathBuf>,
    /// Write the measures as JSON; `-` for the terminal
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    json: Option<PathBuf>,
    /// Write measures and plots as one HTML file that loads nothing from elsewhere; `-` for the terminal
    #[arg(long, value_name = "FILE", help_heading = "Results")]
    html: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  aep control --reference ramp:0.1cm/s                       the paper's table, figure 13
  aep control --model model.json --reference sine:5mm,0.5Hz -o run.csv --plot run.svg
  aep control --model model.json --plant truth.json --reference trapezoid:20mm,10mm/s,100mm/s2
  aep control --model model.json --reference reversal:1mm/s,2s --robustness
  aep control --model model.json --reference path.csv        columns time_s,reference_mm

References: ramp:SPEED  sine:AMPLITUDE,FREQUENCY  trapezoid:DISTANCE,SPEED,ACCELERATION
            reversal:SPEED,INTERVAL  FILE.csv; numbers without unit are SI.";

/// Runs the command.
pub fn run(args: &Args, global: Global) -> Result<(), Failure> {
    let read: Vec<PathBuf> = args.model.iter().chain(&args.plant).cloned().collect();
    outputs::check(
        &read,
        &[
            ("--output", args.output.as_deref()),
            ("--plot", args.plot.as_deref()),
            ("--json", args.json.as_deref()),
            ("--html", args.html.as_deref()),
        ],
    )?;
    let case = case(args)?;
    let both = case.run()?;
    let (pd, with) = (&both.pd, &both.with);
    let deviations = match args.robustness {
        None => Vec::new(),
        Some(percent) => {
            let off = percent / 100.0;
            if off >= 1.0 {
                return Err(Failure::bad_input("--robustness must be below 100 %")
                    .with_hint("for example --robustness 20"));
            }
            let factors = [1.0 - off, 1.0 + off];
            robustness(
                &case.plant,
                &case.model,
                &case.reference,
                &case.servo,
                case.settings,
                &factors,
            )?
        }
    };
    let mut files = String::new();
    if let Some(path) = &args.output {
        output::save(path, &csv(&case, pd, with))?;
        files += &written("signals", path);
    }
    if let Some(path) = &args.plot {
        output::save(path, &plot(&case, pd, with)?)?;
        files += &written("plot", path);
    }
    if let Some(path) = &args.json {
        output::save_json(path, &in_json(&case, pd, with, &deviations))?;
        if path.as_os_str() != "-" {
            files += &written("measures", path);
        }
    }
    let said = both.said();
    let parts: Vec<Part> =
        std::iter::once(case.part(&both)).chain(deviations_part(&case, &deviations)).collect();
    if let Some(path) = &args.html {
        let summary = said.as_deref().unwrap_or_default();
        output::save(path, &plain::page("Friction compensation, simulated", summary, &parts, &command()))?;
        files += &written("report", path);
    }
    let own_stdout = [&args.output, &args.plot, &args.json, &args.html]
        .into_iter()
        .flatten()
        .any(|path| path.as_os_str() == "-");
    if global.quiet || own_stdout {
        return Ok(());
    }
    output::print(&(report(&parts, said.as_deref()) + &files))
}

fn case(args: &Args) -> Result<Case, Failure> {
    let read = |path: &Option<PathBuf>| path.as_deref().map(compensation::read).transpose();
    let (model, plant) = (read(&args.model)?, read(&args.plant)?);
    let of_the_paper = model.is_none();
    let model = match model {
        Some(model) => model,
        None => friction_ident::paper::table()?,
    };
    let plant = plant.unwrap_or_else(|| model.clone());
    if plant.axis() != model.axis() {
        return Err(Failure::bad_input(
            "one of --model and --plant is of a linear axis, the other of a rotary one",
        )
        .with_hint("give two models of the same axis"));
    }
    let default = of_the_paper.then(|| paper::servo(paper::GAIN));
    let (servo, settings) = args.servo.build(&model, default)?;
    let reference = args.reference.build(model.axis(), settings.sample_time)?;
    Ok(Case { model, plant, servo, settings, reference })
}

fn deviations_part(case: &Case, deviations: &[Deviation]) -> Option<Part> {
    let exact = deviations.first()?;
    let length = case.model.axis().unit(Quantity::Length);
    let row = |deviation: &Deviation| {
        let rms = deviation.measures.rms_error;
        let words: Vec<&str> = deviation.behaviour.iter().map(|b| b.words()).collect();
        vec![
            deviation.parameter.clone(),
            format!("{:+.0} %", 100.0 * (deviation.factor - 1.0)),
            quantity(rms, length),
            format!("x {:.2}", rms / exact.measures.rms_error.max(f64::MIN_POSITIVE)),
            deviation.measures.stick_episodes.to_string(),
            words.join(", "),
        ]
    };
    let headings = ["parameter", "#off by", "#RMS error", "#factor", "#sticks", "what happens"];
    Some(Part {
        id: "robustness".to_owned(),
        title: "Compensation with a wrong model".to_owned(),
        headings: headings.map(str::to_owned).to_vec(),
        rows: deviations.iter().map(row).collect(),
        ..Part::default()
    })
}

fn report(parts: &[Part], said: Option<&str>) -> String {
    let mut text = heading("The loop");
    for note in parts.iter().flat_map(|part| &part.notes) {
        let _ = writeln!(text, " {note}");
    }
    for (k, part) in parts.iter().enumerate() {
        text += &Table::of(part);
        if let Some(said) = said.filter(|_| k == 0) {
            let _ = writeln!(text, "\n {said}");
        }
    }
    text
}

fn csv(case: &Case, pd: &Trial, with: &Trial) -> String {
    let (length, force) = match case.model.axis() {
        Axis::Linear => ("m", "N"),
        Axis::Rotary => ("rad", "Nm"),
    };
    let mut text = format!(
        "time_s,reference_{length},pd_position_{length},pd_force_{force},pd_stuck,compensated_position_{length},compensated_force_{force},compensation_{force},compensated_stuck\n"
    );
    for k in 0..case.reference.position.len() {
        let _ = writeln!(
            text,
            "{:.6},{:.9e},{:.9e},{:.6e},{},{:.9e},{:.6e},{:.6e},{}",
            k as f64 * case.reference.sample_time,
            case.reference.position[k],
            pd.run.position[k],
            pd.run.command[k],
            pd.run.stuck[k],
            with.run.position[k],
            with.run.command[k],
            with.compensation[k],
            with.run.stuck[k],
        );
    }
    text
}

/// Tracking errors over time: in a plot of positions they would hide behind the line's width.
fn plot(case: &Case, pd: &Trial, with: &Trial) -> Result<String, Failure> {
    let (scale, unit) = match case.model.axis() {
        Axis::Linear => (1e6, "µm"),
        Axis::Rotary => (1e3, "mrad"),
    };
    let curve = |label: &str, trial: &Trial| Curve {
        label: label.to_owned(),
        points: (0..trial.run.position.len())
            .map(|k| {
                let error = case.reference.position[k] - trial.run.position[k];
                (k as f64 * case.reference.sample_time, scale * error)
            })
            .collect(),
        band: Vec::new(),
    };
    let y = format!("tracking error, {unit}");
    let axes =
        Axes { title: "PD with and without compensation", x: "time, s", y: &y, logarithmic: false };
    curve_plot::svg(axes, &[curve("PD", pd), curve("PD + compensation", with)])
}

fn in_json(case: &Case, pd: &Trial, with: &Trial, deviations: &[Deviation]) -> serde_json::Value {
    let servo = &case.servo;
    json!({
        "units": "SI",
        "model": case.model,
        "plant": case.plant,
        "loop": {
            "proportional": servo.proportional,
            "derivative": servo.derivative,
            "feedforward": servo.feedforward,
            "sample_time_s": case.settings.sample_time,
            "encoder_resolution": servo.setup.encoder_resolution,
            "force_resolution": servo.setup.force_resolution,
            "force_limit": servo.setup.force_limit.is_finite().then_some(servo.setup.force_limit),
            "critical_velocity": case.settings.critical_velocity,
            "presliding": case.settings.presliding,
            "spectral_radius": servo.linear(&case.plant, case.settings.sample_time).spectral_radius(),
        },
        "pd": pd.measures,
        "compensated": with.measures,
        "robustness": deviations,
    })
}
