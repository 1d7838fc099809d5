//! Errors of the ladder, their names and units.

use missing_physics::measurement::quantity::{percent, quantity};
use missing_physics::report::{Discovery, NamedError, Rung, floor_key};

/// What an error of a rung is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ErrorName {
    /// Its key in the JSON, e.g. `force_rms_N`.
    pub key: String,
    /// What is compared, e.g. `force`.
    pub quantity: String,
    /// SI unit; nothing for a fraction of the quantity's own size.
    pub unit: Option<String>,
}

impl ErrorName {
    /// The name of an error.
    pub fn of(error: &NamedError) -> Self {
        let NamedError { quantity, unit, .. } = error;
        Self { key: error.key(), quantity: quantity.clone(), unit: unit.clone() }
    }

    /// Whether it is a fraction of the quantity's own size.
    pub fn is_relative(&self) -> bool {
        self.unit.is_none()
    }

    /// Heading of a column: `force error`, `window error`.
    pub fn heading(&self) -> String {
        if self.is_relative() {
            format!("{} error, relative", self.quantity)
        } else {
            format!("{} error", self.quantity)
        }
    }

    /// A value of it with its unit.
    pub fn value(&self, value: f64) -> String {
        in_unit(value, self.unit.as_deref())
    }
}

/// A number in its unit, or in per cent where it is a fraction.
fn in_unit(value: f64, unit: Option<&str>) -> String {
    unit.map_or_else(|| percent(value), |unit| quantity(value, unit))
}

/// The errors of the ladder: those relative first, then absolute ones of the same quantity, then
/// the other views.
pub fn errors(discovery: &Discovery) -> Vec<ErrorName> {
    discovery.ladder.first().map(errors_of).unwrap_or_default()
}

/// The errors of one model, in the same order.
pub fn errors_of(rung: &Rung) -> Vec<ErrorName> {
    let mut names: Vec<ErrorName> = rung.error.values().map(ErrorName::of).collect();
    let main = names.iter().find(|name| name.is_relative()).map(|name| name.quantity.clone());
    names.sort_by_key(|name| (!name.is_relative(), Some(&name.quantity) != main.as_ref()));
    names
}

/// The error that the ladder is judged by: the first of [`errors`].
pub fn main_error(discovery: &Discovery) -> Option<ErrorName> {
    errors(discovery).into_iter().next()
}

/// The noise floor in the measure of `name`, where it is known.
pub fn floor(discovery: &Discovery, name: &ErrorName) -> Option<f64> {
    let floor = |unit: &str| discovery.noise_floor.get(&floor_key(&name.quantity, unit)).copied();
    if let Some(unit) = &name.unit {
        return floor(unit);
    }
    // A fraction of the quantity's size, which is the absolute error over the relative one.
    let base = discovery.ladder.first()?;
    let relative = base.error.get(&name.key)?.validation;
    let same = |error: &&NamedError| error.quantity == name.quantity && error.unit.is_some();
    let absolute = base.error.values().find(same)?;
    let floor = floor(absolute.unit.as_deref()?)?;
    (absolute.validation > 0.0).then(|| floor * relative / absolute.validation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::report::SplitError;

    #[test]
    fn errors_have_headings_and_values_in_their_unit() {
        let error = SplitError { fit: 1.0, validation: 2.0 };
        let relative = ErrorName::of(&NamedError::relative("force", error));
        assert_eq!(
            (relative.key.as_str(), relative.heading().as_str(), relative.value(0.0408)),
            ("force_relative", "force error, relative", "4.08 %".into())
        );
        let window = ErrorName::of(&NamedError::absolute("window", "m", error));
        assert_eq!(
            (window.key.as_str(), window.heading().as_str(), window.value(2e-6)),
            ("window_rms_m", "window error", "2.00 µm".into())
        );
    }

    #[test]
    fn the_floor_of_a_fraction_is_a_fraction() {
        let both = |value: f64| SplitError { fit: value, validation: value };
        let errors = [
            NamedError::relative("force", both(0.05)),
            NamedError::absolute("force", "N", both(0.5)),
            NamedError::absolute("window", "m", both(1e-6)),
        ];
        let json = serde_json::json!({"added": [], "effects": [], "parameters": {}, "error": {}, "p_value": null});
        let mut rung: Rung = serde_json::from_value(json).unwrap();
        rung.error = errors.iter().map(|error| (error.key(), error.clone())).collect();
        let json = serde_json::json!({
            "verdict": "effects_found", "added": ["stribeck"], "ladder": [], "ranking": [], "where": [], "ambiguous": [],
            "noise_floor": {}, "seed": 1, "wall_s": 1.0,
        });
        let mut found: Discovery = serde_json::from_value(json).unwrap();
        found.ladder = vec![rung];
        found.noise_floor = [("force_N".to_owned(), 0.1), ("position_m".to_owned(), 1e-7)].into();
        let floors: Vec<Option<f64>> =
            errors.iter().map(|error| floor(&found, &ErrorName::of(error))).collect();
        assert_eq!(floors, [Some(0.1 * 0.05 / 0.5), Some(0.1), None]);
    }
}
