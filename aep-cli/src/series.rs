//! Results point by point: a table with a row for every sample.

use std::path::Path;

use aep_data::{Format, Values, save_series};
use friction_ident::Axis;
use friction_ident::family::{Decides, FrictionFamily};
use missing_physics::{Fitted, ModelFamily, Recording};

use crate::failure::Failure;
use crate::output::written;

/// Writes what `models`, each with its name, predict at every sample; returns what to tell the user.
pub fn save(
    path: &Path,
    (recording, family): (&Recording, &FrictionFamily),
    models: &[(String, Fitted)],
    decides: Decides,
) -> Result<String, Failure> {
    let fitted: Vec<Fitted> = models.iter().map(|(_, model)| model.clone()).collect();
    let points = family.points(&fitted, decides);
    let (position, force) = (recording.require("position"), recording.require("force"));
    let (Ok(position), Ok(force)) = (position, force) else {
        return Err(Failure::failed("the recording has neither force nor position"));
    };
    let quantity = family.quantity();
    let force_name = format!("{}_{}", quantity.name, quantity.unit);
    let position_name = match family.axis() {
        Axis::Linear => "position_m",
        Axis::Rotary => "angle_rad",
    };
    let residuals = |measured: &[f64], predicted: &[f64]| -> Vec<f64> {
        measured.iter().zip(predicted).map(|(measured, predicted)| measured - predicted).collect()
    };
    let left: Vec<[Vec<f64>; 2]> = (points.models.iter())
        .map(|model| {
            let ahead = residuals(position, &model.position);
            [ahead, residuals(&points.compared_force, &model.force)]
        })
        .collect();
    let took_part = points.left_out.iter().map(|why| i64::from(why.is_none())).collect();
    let why_not = points.left_out.iter().map(|why| why.unwrap_or("")).collect();
    let mut columns = vec![
        ("time_s".to_owned(), Values::Numbers(recording.time())),
        ("piece".to_owned(), Values::Whole(points.piece.clone())),
        ("regime".to_owned(), Values::Texts(points.regime.clone())),
        ("took_part".to_owned(), Values::Whole(took_part)),
        ("why_not".to_owned(), Values::Texts(why_not)),
        (position_name.to_owned(), Values::Numbers(position)),
        (force_name.clone(), Values::Numbers(force)),
        (format!("compared_{force_name}"), Values::Numbers(&points.compared_force)),
    ];
    for (((name, _), model), [ahead, along]) in models.iter().zip(&points.models).zip(&left) {
        if !model.position.is_empty() {
            columns.push((format!("{name}.{position_name}"), Values::Numbers(&model.position)));
            columns.push((format!("{name}.residual_{position_name}"), Values::Numbers(ahead)));
        }
        columns.push((format!("{name}.{force_name}"), Values::Numbers(&model.force)));
        columns.push((format!("{name}.residual_{force_name}"), Values::Numbers(along)));
    }
    save_series(path, Format::of(path).unwrap_or(Format::Csv), &columns)?;
    Ok(written("series", path))
}

/// Names of the rungs of a ladder: `base`, `1_stribeck`, `2_ripple`.
pub fn rung(number: usize, added: &[String]) -> String {
    if number == 0 { "base".to_owned() } else { format!("{number}_{}", added.join("+")) }
}
