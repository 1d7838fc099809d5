//! Curves for the report: force over time, friction over velocity.

use missing_physics::report::{Curve, Plot};
use missing_physics::{Fitted, ModelFamily};

use super::FrictionFamily;

/// Most points of a curve.
const MOST_POINTS: usize = 1200;

/// Measured and modelled force along time, and friction (force without inertia) along velocity.
pub fn plots(family: &FrictionFamily, base: &Fitted, last: &Fitted) -> Vec<Plot> {
    let quantity = family.quantity();
    let predict = |model: &Fitted| missing_physics::fit::predict(family, model);
    let (of_base, of_last) = (predict(base), predict(last));
    let inertia: Vec<f64> = family
        .prepared
        .compare(&family.prepared.acceleration)
        .iter()
        .map(|a| a * family.mass_of(last))
        .collect();
    let velocity = family.prepared.sample(&family.prepared.velocity);
    let friction = |force: &[f64]| -> Vec<f64> {
        force.iter().zip(&inertia).map(|(force, inertia)| force - inertia).collect()
    };
    let force_axis = format!("{} / {}", quantity.name, quantity.unit);
    let (time, gaps) = with_gaps(family.time());
    let over_time = |label: &str, y: &[f64]| thinned(label, &time, &broken(y, &gaps));
    let over_velocity = |label: &str, y: &[f64]| thinned(label, &velocity, &friction(y));
    let residual = |prediction: &[f64]| missing_physics::fit::residual(family, prediction);
    vec![
        Plot {
            title: "Force along the recording".into(),
            x_label: "time / s".into(),
            y_label: force_axis.clone(),
            curves: vec![
                over_time("measured", family.target()),
                over_time("base model", &of_base),
                over_time("last model", &of_last),
            ],
        },
        Plot {
            title: "What the model leaves".into(),
            x_label: "time / s".into(),
            y_label: format!("{} residual / {}", quantity.name, quantity.unit),
            curves: vec![
                over_time("base model", &residual(&of_base)),
                over_time("last model", &residual(&of_last)),
            ],
        },
        Plot {
            title: "Friction against velocity".into(),
            x_label: format!("velocity / {}", family.axis.unit(crate::axis::Quantity::Velocity)),
            y_label: format!("{} without inertia / {}", quantity.name, quantity.unit),
            curves: vec![
                over_velocity("measured (points)", family.target()),
                over_velocity("base model (points)", &of_base),
                over_velocity("last model (points)", &of_last),
            ],
        },
    ]
}

/// Steps of the grid this many times as long as most of them have samples between them that are not compared.
const GAP: f64 = 1.5;

/// Instants with one more inside each gap, and the places of these.
fn with_gaps(time: &[f64]) -> (Vec<f64>, Vec<usize>) {
    let mut steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
    steps.sort_unstable_by(f64::total_cmp);
    let most = GAP * steps.get(steps.len() / 2).copied().unwrap_or(0.0);
    let (mut all, mut gaps) = (Vec::with_capacity(time.len()), Vec::new());
    for (k, instant) in time.iter().enumerate() {
        if k > 0 && instant - time[k - 1] > most {
            gaps.push(all.len());
            all.push(f64::midpoint(time[k - 1], *instant));
        }
        all.push(*instant);
    }
    (all, gaps)
}

/// Values at such instants: no number inside a gap.
fn broken(values: &[f64], gaps: &[usize]) -> Vec<f64> {
    let mut all = Vec::with_capacity(values.len() + gaps.len());
    let mut gaps = gaps.iter().peekable();
    for value in values {
        while gaps.next_if(|gap| **gap == all.len()).is_some() {
            all.push(f64::NAN);
        }
        all.push(*value);
    }
    all
}

/// Evenly chosen points, and every one that is no number, so that a gap stays one.
fn thinned(label: &str, x: &[f64], y: &[f64]) -> Curve {
    let step = x.len().div_ceil(MOST_POINTS).max(1);
    let kept = (0..x.len()).filter(|k| k % step == 0 || y[*k].is_nan());
    let (x, y) = kept.map(|k| (x[k], y[k])).unzip();
    Curve { label: label.to_owned(), x, y }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_ends_where_samples_are_left_out() {
        let grid: Vec<f64> =
            (0..4000).filter(|k| !(1000..2000).contains(k)).map(f64::from).collect();
        let (time, gaps) = with_gaps(&grid);
        assert_eq!(gaps, [1000]);
        let curve = thinned("a", &time, &broken(&grid, &gaps));
        assert!(curve.x.len() <= MOST_POINTS + gaps.len());
        let ends = curve.y.iter().position(|y| y.is_nan()).unwrap();
        assert!((curve.x[ends] - 1499.5).abs() < 1e-9 && curve.x[ends + 1] >= 2000.0);
        assert_eq!(curve.y.iter().filter(|y| y.is_nan()).count(), 1);
    }
}
