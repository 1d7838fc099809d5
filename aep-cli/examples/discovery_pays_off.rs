//! Discovery pays off in control: a hidden effect spoils the friction compensation, discovery finds it,
//! the model is extended, and the tracking error falls again.
//!
//! ```text
//! cargo run --release -p aep-cli --example discovery_pays_off                    a ripple of the screw
//! cargo run --release -p aep-cli --example discovery_pays_off -- asymmetry plot.svg
//! ```

use std::error::Error;
use std::path::{Path, PathBuf};

use friction_ident::challenge::excitation;
use friction_ident::control::{Compensator, Servo, Settings, Trial, run};
use friction_ident::family::{FrictionFamily, Options};
use friction_ident::{
    Axis, Library, Model, ModelError, Pd, Profile, Reference, Setup, closed_loop,
};
use missing_physics::report::Rung;
use missing_physics::{Fitted, ModelFamily, Recording, Settings as Search, discover, terms};
use plotters::prelude::*;

/// Sampling time of recording and control, s.
const SAMPLE_TIME: f64 = 1e-3;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = std::env::args().skip(1);
    let hidden = arguments.next().unwrap_or_else(|| "ripple".into());
    let plot = arguments
        .next()
        .map_or_else(|| std::env::temp_dir().join("discovery_pays_off.svg"), PathBuf::from);
    let plant = plant(&hidden)?;

    // Record, and look for what the base model lacks.
    let recording = record(&plant)?;
    let options = Options { bandwidth: None, library: Library::builtin(), ..Options::default() };
    let family = FrictionFamily::new(&recording, &options)?;
    let search = Search {
        base: ["coulomb", "viscous", "offset"].map(str::to_owned).to_vec(),
        ..Search::default()
    };
    let discovery = discover(&family, &search, &mut ())?;
    println!("hidden in the plant: {hidden}; found: {}", discovery.added.join(", "));
    let (Some(first), Some(last)) = (discovery.ladder.first(), discovery.ladder.last()) else {
        return Err("the discovery has no model".into());
    };
    let (base, extended) = (model(&family, first)?, model(&family, last)?);

    // Go to and fro over 16 mm, three times, with the compensator of each model.
    let reference =
        Profile::new(SAMPLE_TIME).dwell(0.1).reciprocate(8e-3, 0.4, 3.0).build(0.0, 0.0);
    let mut trials = vec![("PD alone", follow(&plant, &reference, None)?)];
    for (name, model) in [
        ("compensated, base model", &base),
        ("compensated, extended model", &extended),
        ("compensated, the plant itself", &plant),
    ] {
        trials.push((name, follow(&plant, &reference, Some(model))?));
    }
    println!(
        "\n{:30} {:>13} {:>14} {:>12}",
        "", "RMS error, µm", "peak error, µm", "stick time, s"
    );
    for (name, trial) in &trials {
        let measures = &trial.measures;
        let (rms, peak) = (1e6 * measures.rms_error, 1e6 * measures.peak_error);
        println!("{name:30} {rms:13.2} {peak:14.2} {:12.3}", measures.stick_time);
    }
    let error = |k: usize| trials[k].1.measures.rms_error;
    println!(
        "\nThe hidden effect leaves {:.1} µm of error behind the base model's compensator; with what was\n\
         found the error is {:.1} µm, {:.1} times less.",
        1e6 * error(1),
        1e6 * error(2),
        error(1) / error(2)
    );
    draw(&plot, &reference, &trials)?;
    println!("plot: {}", plot.display());
    Ok(())
}

/// A ball-screw table with an effect that the base model lacks.
fn plant(hidden: &str) -> Result<Model, ModelError> {
    let table = Model::new(Axis::Linear, 40.0)?
        .with("coulomb", &[("F_C", 10.0)])?
        .with("viscous", &[("F_v", 220.0)])?;
    match hidden {
        "ripple" => table.with("ripple", &[("a_1", 3.0), ("b_1", 2.0), ("l", 5e-3)]),
        "asymmetry" => table.with("asymmetry", &[("dF_C", 2.0), ("dF_v", 60.0)]),
        other => table.with(other, &[]),
    }
}

/// The recording that discovery sees: a controller on the plant, command and encoder.
fn record(plant: &Model) -> Result<Recording, Box<dyn Error>> {
    let mut pd = Pd::new(5e5, 7e3).with_feedforward(40.0).with_smoothing(0.35);
    let setup = Setup { force_noise: 0.15, seed: 1, ..Setup::default() };
    Ok(closed_loop(plant, &excitation(), &mut pd, &setup)?.recording)
}

/// The model of a rung of the ladder.
fn model(family: &FrictionFamily, rung: &Rung) -> Result<Model, Box<dyn Error>> {
    let indices = terms(family, &rung.effects)?;
    let mut values = Vec::new();
    for term in indices.iter().map(|&index| &family.terms()[index]) {
        for parameter in &term.parameters {
            let estimate = rung.parameters.get(&term.key(parameter));
            values.push(estimate.map_or(parameter.start, |estimate| estimate.value));
        }
    }
    Ok(family.model(&Fitted { terms: indices, values })?)
}

/// A soft loop, so that what the compensator does not know is seen.
fn follow(
    plant: &Model,
    reference: &Reference,
    model: Option<&Model>,
) -> Result<Trial, Box<dyn Error>> {
    let (mass, frequency, damping) = (40.0, 60.0, 0.7);
    let servo = Servo {
        proportional: mass * frequency * frequency,
        derivative: 2.0 * damping * mass * frequency,
        feedforward: mass,
        setup: Setup::default(),
    };
    let settings = Settings::new(SAMPLE_TIME, 2e-3);
    let compensator = model.map(|model| Compensator::new(model, settings)).transpose()?;
    Ok(run(plant, reference, &servo, compensator.as_ref())?)
}

/// Tracking errors over time.
fn draw(
    path: &Path,
    reference: &Reference,
    trials: &[(&str, Trial)],
) -> Result<(), Box<dyn Error>> {
    let area = SVGBackend::new(path, (900, 480)).into_drawing_area();
    area.fill(&WHITE)?;
    let error = |trial: &Trial, k: usize| 1e6 * (reference.position[k] - trial.run.position[k]);
    let samples = reference.position.len();
    let most = (0..samples).map(|k| error(&trials[0].1, k).abs()).fold(1.0, f64::max);
    let end = samples as f64 * SAMPLE_TIME;
    let mut chart = ChartBuilder::on(&area)
        .caption("A hidden effect, found and compensated", ("sans-serif", 18))
        .margin(12)
        .x_label_area_size(42)
        .y_label_area_size(64)
        .build_cartesian_2d(0.0..end, -1.3 * most..1.3 * most)?;
    chart.configure_mesh().x_desc("time, s").y_desc("tracking error, µm").draw()?;
    let colours = [RGBColor(150, 150, 150), RGBColor(214, 39, 40), RGBColor(44, 160, 44)];
    for ((name, trial), colour) in trials.iter().zip(colours) {
        let points = (0..samples).map(|k| (k as f64 * SAMPLE_TIME, error(trial, k)));
        chart
            .draw_series(LineSeries::new(points, colour.stroke_width(2)))?
            .label(*name)
            .legend(move |(x, y)| PathElement::new([(x, y), (x + 18, y)], colour));
    }
    chart
        .configure_series_labels()
        .position(SeriesLabelPosition::UpperRight)
        .background_style(WHITE.mix(0.8))
        .border_style(BLACK)
        .draw()?;
    area.present()?;
    Ok(())
}
