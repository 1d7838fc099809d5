//! What several parameters make together.

use missing_physics::measurement::quantity::number;
use missing_physics::report::Combinations;

use super::interval;

/// A row for each quantity: name, what it is, value, unit, interval.
pub fn combinations(told: &Combinations) -> Vec<[String; 5]> {
    let row = |of: &missing_physics::report::Combination| {
        let estimate = &of.estimate;
        let (value, unit) = (number(estimate.value), estimate.unit.clone());
        [of.name.clone(), of.title.clone(), value, unit, interval(estimate)]
    };
    told.quantities.iter().map(row).collect()
}

/// Which parameters are not determined one by one, though what they make together is.
pub fn not_alone(told: &Combinations) -> Option<String> {
    let known: Vec<&str> = told
        .quantities
        .iter()
        .filter(|of| of.estimate.identifiable)
        .map(|of| of.name.as_str())
        .collect();
    if told.not_alone.len() < 2 || known.is_empty() {
        return None;
    }
    let (last, others) = told.not_alone.split_last()?;
    Some(format!(
        "{} and {last} are not determined one by one; what they make together is: {}",
        others.join(", "),
        known.join(", ")
    ))
}
