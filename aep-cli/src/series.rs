//! Results point by point: a table with a row for every sample.

use std::path::Path;

use aep_data::{Format, Values, save_series};
use friction_ident::family::{Decides, FrictionFamily, PointValues};
use missing_physics::Fitted;

use crate::failure::Failure;
use crate::output::written;

/// Writes what `models`, each with its name, predict at every sample; returns what to tell the user.
pub fn save(
    path: &Path,
    family: &FrictionFamily,
    models: &[(String, Fitted)],
    decides: Decides,
) -> Result<String, Failure> {
    let columns = family.columns_of_points(models, decides);
    let columns: Vec<(String, Values<'_>)> = (columns.iter())
        .map(|(name, values)| {
            let values = match values {
                PointValues::Numbers(values) => Values::Numbers(values),
                PointValues::Whole(values) => Values::Whole(values.clone()),
                PointValues::Texts(values) => Values::Texts(values.clone()),
            };
            (name.clone(), values)
        })
        .collect();
    save_series(path, Format::of(path).unwrap_or(Format::Csv), &columns)?;
    Ok(written("series", path))
}
