//! Figures 2 to 6: AEP against meta-EP on test functions.

use std::fmt::Write;
use std::path::Path;

use aep_core::trials::Trials;
use aep_problems::paper::{self, POPULATION, Reading};

use super::reproduce_figure::{Conditions, Figure, Made, quote};
use crate::curve_plot::{Axes, Curve};
use crate::failure::Failure;

/// The figures on test functions, one entry each.
pub const FIGURES: &[Figure] = &[
    Figure { name: "fig2", title: "AEP and EP on f1", make },
    Figure { name: "fig3", title: "AEP and EP on f2", make },
    Figure { name: "fig4", title: "AEP and EP on f3", make },
    Figure { name: "fig5", title: "AEP and EP on f4", make },
    Figure { name: "fig6", title: "AEP and EP on f5", make },
];

/// Points of a curve in the plot; the CSV has every generation.
const POINTS: u64 = 400;

fn make(name: &'static str, conditions: &Conditions) -> Result<Made, Failure> {
    let figure = paper::find(name).ok_or_else(|| Failure::failed(format!("no figure {name}")))?;
    let failed = |error: aep_core::RunError| Failure::failed(error.to_string());
    let measured = figure.measure(conditions.trials, conditions.seed).map_err(failed)?;
    let mut made = Made { claims: measured.claims, ..Made::default() };
    let path = |suffix: &str| conditions.directory.join(format!("{name}{suffix}"));
    made.keep(&path(".csv"), &csv(figure, &measured.lines))?;
    draw(&mut made, &path(".svg"), figure, &measured.lines)?;
    if conditions.readings {
        let readings = figure.readings(conditions.trials, conditions.seed).map_err(failed)?;
        made.keep(&path("-readings.csv"), &readings_csv(&readings))?;
    }
    Ok(made)
}

/// Generation `g` has used as many evaluations as this.
fn evaluations(generation: u64) -> u64 {
    (generation + 1) * POPULATION
}

fn csv(figure: &paper::Figure, lines: &[Trials]) -> String {
    let mut text = String::from("line,generation,mean,median,first_quartile,third_quartile\n");
    for (line, trials) in figure.lines.iter().zip(lines) {
        for generation in 0..=figure.generations {
            let point = trials.after(evaluations(generation));
            let label = quote(line.label);
            let (mean, median, low, high) = (point.mean, point.median, point.low, point.high);
            let _ = writeln!(text, "{label},{generation},{mean:e},{median:e},{low:e},{high:e}");
        }
    }
    text
}

fn draw(
    made: &mut Made,
    path: &Path,
    figure: &paper::Figure,
    lines: &[Trials],
) -> Result<(), Failure> {
    let step = (figure.generations / POINTS).max(1);
    let curve = |(line, trials): (&paper::Line, &Trials)| Curve {
        label: line.label.to_owned(),
        points: (0..=figure.generations / step)
            .map(|i| (i * step) as f64)
            .map(|generation| (generation, trials.after(evaluations(generation as u64)).mean))
            .collect(),
        band: Vec::new(),
    };
    let curves: Vec<Curve> = figure.lines.iter().zip(lines).map(curve).collect();
    let logarithmic = !matches!(figure.name, "fig4" | "fig6");
    let axes = Axes { title: figure.title, x: "generation", y: "mean best cost", logarithmic };
    made.draw(path, axes, (&curves, &[]))
}

fn readings_csv(readings: &[Reading]) -> String {
    let columns = "line,reading,default,mean,median,best,worst,found,trials,paper,ours,verdict\n";
    let mut text = String::from(columns);
    for reading in readings {
        let (summary, claim) = (&reading.summary, &reading.claim);
        let (best, worst) = summary.range;
        let _ = writeln!(
            text,
            "{},{},{},{:e},{:e},{best:e},{worst:e},{},{},{},{},{}",
            quote(&claim.about),
            quote(&reading.reading),
            reading.default,
            summary.mean,
            summary.median,
            summary.successes,
            summary.trials,
            quote(&claim.paper),
            quote(&claim.ours),
            claim.verdict,
        );
    }
    text
}
