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
    let over_time = |label: &str, y: &[f64]| thinned(label, family.time(), y);
    let over_velocity = |label: &str, y: &[f64]| thinned(label, &velocity, &friction(y));
    let residual = |prediction: &[f64]| missing_physics::fit::residual(family, prediction);
    vec![
        Plot {
            title: "Force along the recording".into(),
            x_label: "time / s".into(),
            y_label: force_axis.clone(),
            curves: vec![over_time("measured", family.target()), over_time("last model", &of_last)],
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
                over_velocity("last model (points)", &of_last),
            ],
        },
    ]
}

fn thinned(label: &str, x: &[f64], y: &[f64]) -> Curve {
    let step = x.len().div_ceil(MOST_POINTS).max(1);
    let thin = |values: &[f64]| values.iter().step_by(step).copied().collect();
    Curve { label: label.to_owned(), x: thin(x), y: thin(y) }
}
