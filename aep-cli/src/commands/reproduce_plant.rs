//! Figures 8, 11 and 12: friction of the X-Y table, training data, identification.

use std::fmt::Write;
use std::path::PathBuf;

use aep_core::trials::Trials;
use aep_core::{Aep, MetaEp, Problem};
use aep_problems::paper::{Claim, Verdict};
use friction_ident::identify::Interval;
use friction_ident::paper::{self, KGF, PARAMETERS, POPULATION, SAMPLE_TIME};
use friction_ident::{Identification, Model, intervals, intervals_over};
use missing_physics::Recording;
use missing_physics::measurement::quantity::number;

use super::reproduce_figure::{Conditions, Figure, Made};
use crate::curve_plot::{Axes, Curve};
use crate::failure::Failure;

/// The figures of the plant, one entry each.
pub const FIGURES: &[Figure] = &[
    Figure { name: "fig8", title: "The Stribeck effect", make: friction },
    Figure { name: "fig11", title: "Training data", make: training },
    Figure { name: "fig12", title: "Identification: AEP and EP", make: identification },
];

/// Most trials of an identification: the number that the statements are counted over.
const MOST: usize = 20;
/// Share of the trials that must find the table.
const SHARE: f64 = 0.9;
/// Noise of the force of that plant, N.
const NOISE: f64 = 0.05;
/// Searches on its data: who fits as well counts.
const SEARCHES: usize = 4;
/// An interval wider than this factor does not tell a value.
const CLOSE: f64 = 1.5;
/// Longest step of a plant that is simulated more finely than its model, s.
const FINE: f64 = 2.5e-4;

fn failed(error: impl std::fmt::Display) -> Failure {
    Failure::failed(error.to_string())
}

fn table() -> Result<Model, Failure> {
    paper::table().map_err(failed)
}

/// Velocities on either side of 0, m/s, dense where friction changes.
fn velocities() -> Vec<f64> {
    let up: Vec<f64> = (0..=200).map(|k| 1e-7 * 10f64.powf(f64::from(k) / 50.0)).collect();
    up.iter().rev().map(|v| -v).chain(up.iter().copied()).collect()
}

fn friction(name: &'static str, conditions: &Conditions) -> Result<Made, Failure> {
    let velocities = velocities();
    let force = paper::steady_friction(&table()?, &velocities).map_err(failed)?;
    let mut csv = String::from("velocity_cm_s,friction_kgf\n");
    let points: Vec<(f64, f64)> =
        velocities.iter().zip(&force).map(|(v, f)| (v * 1e2, f / KGF)).collect();
    for (v, f) in &points {
        let _ = writeln!(csv, "{v:e},{f}");
    }
    let mut made = Made::default();
    made.keep(&conditions.directory.join(format!("{name}.csv")), &csv)?;
    // Only the low speeds show the effect; axes in units of the plot's labels.
    let near = points.iter().filter(|(v, _)| v.abs() <= 2e-3).map(|(v, f)| (v * 1e4, *f));
    let curve = Curve { label: "identified friction".into(), points: near.collect(), band: vec![] };
    let axes = Axes {
        title: "Fig. 8: friction against velocity",
        x: "velocity in µm/s",
        y: "friction in kgf",
        logarithmic: false,
    };
    made.draw(&conditions.directory.join(format!("{name}.svg")), axes, (&[curve], &[]))?;
    let (first, least, least_at) = fall(&points);
    let claim = Claim::new(
        "friction at low velocity",
        "decreases with increasing velocity",
        format!("from {first:.3} kgf near rest to {least:.3} kgf at {} cm/s", number(least_at)),
        least < first,
    );
    made.claims.push(claim);
    Ok(made)
}

/// Friction at the lowest positive velocity, the least one, and where that is.
fn fall(points: &[(f64, f64)]) -> (f64, f64, f64) {
    let sliding = || points.iter().filter(|(v, _)| *v > 0.0);
    let first = sliding().next().map_or(f64::NAN, |(_, f)| *f);
    let least = sliding().min_by(|a, b| a.1.total_cmp(&b.1));
    least.map_or((first, first, 0.0), |(v, f)| (first, *f, *v))
}

fn channel<'a>(data: &'a Recording, name: &str) -> Result<&'a [f64], Failure> {
    data.require(name).map_err(failed)
}

fn training(name: &'static str, conditions: &Conditions) -> Result<Made, Failure> {
    let data = paper::training_data(&table()?, SAMPLE_TIME).map_err(failed)?;
    let mut made = Made::default();
    let path = |suffix: &str| conditions.directory.join(format!("{name}{suffix}"));
    made.keep(&path(".csv"), &aep_data::to_csv(&data))?;
    let curve = |channel: &[f64], unit: f64, label: &str| {
        let points = data.time().iter().zip(channel).map(|(t, x)| (*t, x / unit));
        Curve { label: label.into(), points: points.collect(), band: vec![] }
    };
    let axes =
        |title, y| Axes { title, x: "time in s (four blocks of 10 s)", y, logarithmic: false };
    let input = [curve(channel(&data, "force")?, KGF, "control input")];
    let force = axes("Fig. 11: control input", "force in kgf");
    made.draw(&path("-input.svg"), force, (&input, &[]))?;
    let output = [
        curve(channel(&data, "reference")?, 1e-2, "reference"),
        curve(channel(&data, "position")?, 1e-2, "output"),
    ];
    let position = axes("Fig. 11: output", "position in cm");
    made.draw(&path("-output.svg"), position, (&output, &[]))?;
    made.claims = training_claims(&data)?;
    Ok(made)
}

fn training_claims(data: &Recording) -> Result<Vec<Claim>, Failure> {
    let count = data.len();
    let mut claims = vec![Claim::new(
        "samples",
        "8,000 every 5 msec in four blocks",
        format!("{count} every {} ms in {} blocks", SAMPLE_TIME * 1e3, data.segments().len()),
        count == 8000 && data.segments().len() == 4,
    )];
    let position = channel(data, "position")?;
    let standing: Vec<f64> = data
        .segments()
        .iter()
        .map(|segment| {
            let x = &position[segment.clone()];
            x.windows(10).filter(|w| w[0] == w[9]).count() as f64 / x.len() as f64
        })
        .collect();
    let text: Vec<String> = standing.iter().map(|s| format!("{:.0} %", s * 100.0)).collect();
    claims.push(
        Claim::new(
            "blocks 1 to 3",
            "stick-slip motion",
            format!("standing for {} of the time", text[..3].join(", ")),
            standing[..3].iter().all(|s| *s > 0.02 && *s < 0.98),
        )
        .because("the references and gains that were used are not printed"),
    );
    Ok(claims)
}

fn identification(name: &'static str, conditions: &Conditions) -> Result<Made, Failure> {
    let data = paper::training_data(&table()?, SAMPLE_TIME).map_err(failed)?;
    let task = paper::task(&data, SAMPLE_TIME).map_err(failed)?;
    let count = conditions.trials.min(MOST);
    let seed = conditions.seed;
    let evolve =
        |method: &dyn aep_core::Method| paper::trials(&task, method, count, seed).map_err(failed);
    let lines = [
        ("AEP", evolve(&Aep::paper())?),
        ("MetaLN EP", evolve(&MetaEp::paper())?),
        ("practical AEP", evolve(&Aep::practical())?),
    ];
    let refined = paper::refined(&task, count, seed).map_err(failed)?;
    let found: Vec<(f64, Vec<f64>)> =
        refined.into_iter().map(|refined| (refined.cost, refined.position)).collect();

    let mut made = Made::default();
    let path = |suffix: &str| conditions.directory.join(format!("{name}{suffix}"));
    made.keep(&path("-trials.csv"), &trials_csv(&lines, &found))?;
    convergence(&lines, &path, &mut made)?;
    outputs(&task, &data, &lines, &found, &path, &mut made)?;
    made.claims = search_claims(&task, &lines, &found);
    made.claims.extend(parameter_claims(&task, &found, seed)?);
    Ok(made)
}

fn trials_csv(lines: &[(&str, Trials)], found: &[(f64, Vec<f64>)]) -> String {
    let symbols: Vec<&str> = PARAMETERS.iter().map(|parameter| parameter.symbol).collect();
    let mut text = format!("method,trial,cost,{}\n", symbols.join(","));
    let mut row = |method: &str, k: usize, cost: f64, x: &[f64]| {
        let values: Vec<String> = x.iter().map(|x| format!("{x:e}")).collect();
        let _ = writeln!(text, "{method},{},{cost:e},{}", k + 1, values.join(","));
    };
    for (method, trials) in lines {
        trials.trials.iter().enumerate().for_each(|(k, t)| row(method, k, t.cost, &t.position));
    }
    found.iter().enumerate().for_each(|(k, (cost, x))| row("practical AEP refined", k, *cost, x));
    text
}

fn convergence(
    lines: &[(&str, Trials)],
    path: &dyn Fn(&str) -> PathBuf,
    made: &mut Made,
) -> Result<(), Failure> {
    let mut csv = String::from("method,generation,median,first_quartile,third_quartile\n");
    let mut curves = Vec::new();
    for (method, trials) in lines {
        let at = |generation: u64| trials.after((generation + 1) * POPULATION as u64);
        for generation in 0..=paper::GENERATIONS {
            let point = at(generation);
            let _ = writeln!(
                csv,
                "{method},{generation},{:e},{:e},{:e}",
                point.median, point.low, point.high
            );
        }
        let generations = || 0..=paper::GENERATIONS;
        curves.push(Curve {
            label: format!("{method}, median and quartiles"),
            points: generations().map(|g| (g as f64, at(g).median)).collect(),
            band: generations().map(|g| (g as f64, at(g).low, at(g).high)).collect(),
        });
    }
    let axes = Axes {
        title: "Fig. 12: identification of the X-Y table",
        x: "generation",
        y: "mean square error over that of the motion",
        logarithmic: true,
    };
    made.keep(&path("-convergence.csv"), &csv)?;
    made.draw(&path("-convergence.svg"), axes, (&curves, &[]))
}

/// Outputs of the table and of the models that the median trial of each kind found.
fn outputs(
    task: &Identification<'_>,
    data: &Recording,
    lines: &[(&str, Trials)],
    found: &[(f64, Vec<f64>)],
    path: &dyn Fn(&str) -> PathBuf,
    made: &mut Made,
) -> Result<(), Failure> {
    let position = channel(data, "position")?;
    let pairs = |trials: &Trials| -> Vec<(f64, Vec<f64>)> {
        trials.trials.iter().map(|trial| (trial.cost, trial.position.clone())).collect()
    };
    let models = [
        ("identified by AEP", median(found)),
        ("AEP by the paper's rules", median(&pairs(&lines[0].1))),
        ("MetaLN EP", median(&pairs(&lines[1].1))),
    ];
    let measured: Vec<(f64, f64)> =
        data.time().iter().zip(position).map(|(t, x)| (*t, x * 1e2)).collect();
    let mut curves = vec![Curve { label: "X-Y table".into(), points: measured, band: vec![] }];
    for (label, x) in models {
        let errors = task.errors(&x);
        let simulated = data.time().iter().zip(position).zip(&errors);
        let points = simulated.map(|((t, x), e)| (*t, (x - e) * 1e2)).collect();
        curves.push(Curve { label: label.into(), points, band: vec![] });
    }
    let mut csv = String::from("time_s,table_cm,refined_cm,aep_cm,meta_ep_cm\n");
    for k in 0..data.len() {
        let values: Vec<String> =
            curves.iter().map(|curve| format!("{:.6}", curve.points[k].1)).collect();
        let _ = writeln!(csv, "{},{}", data.time()[k], values.join(","));
    }
    made.keep(&path(".csv"), &csv)?;
    let axes = Axes {
        title: "Fig. 12: outputs of the X-Y table and of identified models",
        x: "time in s (four blocks of 10 s)",
        y: "position in cm",
        logarithmic: false,
    };
    made.draw(&path(".svg"), axes, (&curves, &[]))?;
    // Beside the fast block the slow ones cannot be seen.
    let fast = 3.0 * paper::BLOCK as f64 * SAMPLE_TIME;
    for curve in &mut curves {
        curve.points.retain(|(t, _)| *t < fast);
    }
    let axes = Axes { title: "Fig. 12: the three slow blocks", ..axes };
    made.draw(&path("-slow.svg"), axes, (&curves, &[]))
}

/// The position whose cost is the median one.
fn median(trials: &[(f64, Vec<f64>)]) -> Vec<f64> {
    let mut sorted: Vec<&(f64, Vec<f64>)> = trials.iter().collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    sorted.get(sorted.len() / 2).map(|trial| trial.1.clone()).unwrap_or_default()
}

/// Does EP get stuck where AEP does not?
fn search_claims(
    task: &Identification<'_>,
    lines: &[(&str, Trials)],
    found: &[(f64, Vec<f64>)],
) -> Vec<Claim> {
    let truth = task.evaluate(&task.start());
    let says = |costs: &[(f64, bool)]| {
        let mut sorted: Vec<f64> = costs.iter().map(|(cost, _)| *cost).collect();
        sorted.sort_by(f64::total_cmp);
        let found = costs.iter().filter(|(_, found)| *found).count();
        let text = format!(
            "the table found in {found} of {}, median cost {:.0e} (truth {truth:.0e})",
            costs.len(),
            sorted[sorted.len() / 2]
        );
        (text, found as f64 / costs.len() as f64)
    };
    let of = |trials: &Trials| -> Vec<(f64, bool)> {
        trials.trials.iter().map(|t| (t.cost, paper::is_found(&t.position))).collect()
    };
    let (aep, aep_share) = says(&of(&lines[0].1));
    let (ep, ep_share) = says(&of(&lines[1].1));
    let (practical, practical_share) = says(&of(&lines[2].1));
    let refined: Vec<(f64, bool)> =
        found.iter().map(|(cost, x)| (*cost, paper::is_found(x))).collect();
    let (refined, share) = says(&refined);
    let finds = "finds the parameters after 250 generations";
    vec![
        Claim::new("MetaLN EP", "only local minima in many trials", ep, ep_share < 0.5),
        Claim::new("AEP, the paper's rules", finds, aep, aep_share >= SHARE)
            .because("data, bounds and number of trials are not printed; ours are simulated"),
        Claim::new("AEP, practical", finds, practical, practical_share >= SHARE).because(format!(
            "within its tolerance by itself: {}; 250 generations reach the neighbourhood of the table, where \
             motions that stick make many valleys; least squares from there, in the next line, tell them apart",
            each_found(&lines[2].1)
        )),
        Claim::new("AEP, practical, then least squares", finds, refined, share >= SHARE),
    ]
}

/// In how many trials each parameter that can be known was found.
fn each_found(trials: &Trials) -> String {
    let count = trials.trials.len();
    let told = PARAMETERS.iter().enumerate().filter(|(_, p)| p.tolerance.is_some());
    let found = told.map(|(k, parameter)| {
        let hits = trials.trials.iter().filter(|t| parameter.accepts(t.position[k])).count();
        format!("{} in {hits} of {count}", parameter.symbol)
    });
    found.collect::<Vec<String>>().join(", ")
}

/// True, printed and found values.
fn parameter_claims(
    task: &Identification<'_>,
    found: &[(f64, Vec<f64>)],
    seed: u64,
) -> Result<Vec<Claim>, Failure> {
    let matched = intervals(task, &median(found));
    // The same table simulated more finely than its model, with noise: what real data would say.
    let fine = paper::training_data_with_noise(&table()?, FINE, NOISE).map_err(failed)?;
    let task = paper::task(&fine, SAMPLE_TIME).map_err(failed)?;
    let searched = paper::refined(&task, SEARCHES.min(found.len()), seed).map_err(failed)?;
    let searched: Vec<Vec<f64>> = searched.into_iter().map(|refined| refined.position).collect();
    let other = intervals_over(&task, &searched);
    let claim = |(k, parameter): (usize, &paper::Printed)| {
        let mut values: Vec<f64> = found.iter().map(|(_, x)| x[k] / parameter.unit).collect();
        values.sort_by(f64::total_cmp);
        let middle = values[values.len() / 2];
        let unit = parameter.printed.split_once(' ').map_or("", |(_, unit)| unit);
        let (matched, other) = (matched.get(k), other.get(k));
        let known = |interval: Option<&Interval>| {
            interval.is_some_and(|i| i.identifiable && i.high <= CLOSE * i.low)
        };
        let hits = found.iter().filter(|(_, x)| parameter.accepts(x[k])).count();
        let count = found.len();
        let ours = match parameter.tolerance {
            Some(t) => {
                format!("{middle:.4} {unit}; within {:.0} % in {hits} of {count}", t * 100.0)
            }
            None => format!("{} .. {} {unit}", number(values[0]), number(values[values.len() - 1])),
        };
        let about =
            format!("{} (true {})", parameter.symbol, number(parameter.value / parameter.unit));
        if parameter.tolerance.is_some() {
            return Claim::new(about, parameter.printed, ours, hits as f64 >= SHARE * count as f64);
        }
        let verdict = if known(matched) && known(other) {
            Verdict::from(
                values.iter().all(|v| (v * parameter.unit / parameter.value - 1.0).abs() < 0.1),
            )
        } else {
            Verdict::CannotBeKnown
        };
        let range = |interval: Option<&Interval>| {
            interval.map_or_else(String::new, |i| {
                let (low, high) = (number(i.low / parameter.unit), number(i.high / parameter.unit));
                format!(
                    "{low} .. {high}{}",
                    if i.identifiable { "" } else { " (not identifiable)" }
                )
            })
        };
        Claim::new(about, parameter.printed, ours, verdict).because(format!(
            "95 % interval {}; on a table simulated with {} ms steps and {NOISE} N of noise {}",
            range(matched),
            FINE * 1e3,
            range(other)
        ))
    };
    Ok(PARAMETERS.iter().enumerate().map(claim).collect())
}
