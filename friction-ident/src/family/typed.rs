//! A law while it is typed, before it is an effect: what it adds along the recorded motion, and what a model leaves there.

use aep_formula::{Formula, constant};
use missing_physics::report::Law;
use missing_physics::{Fitted, ModelFamily, fit};

use super::FrictionFamily;
use super::law::Along;
use crate::effects::formula;

impl FrictionFamily {
    /// The picture of a law at given values of its parameters: along the position where it names `x`, else along the
    /// velocity. `level` says that it adds to the friction level. What stands beside it is what `model` leaves, so that a law
    /// that fits lies on it.
    ///
    /// # Errors
    /// The first name of the law that is neither a parameter nor known of the motion.
    pub fn typed(
        &self,
        law: &Formula,
        parameter: &dyn Fn(&str) -> Option<f64>,
        level: bool,
        model: &Fitted,
    ) -> Result<Law, String> {
        let track = |name: &str| self.coordinates.iter().find(|c| c.name == name);
        let values = |name: &str| track(name).map_or(&[][..], |c| c.values.as_slice());
        let [x, v, a] = ["position", "velocity", "acceleration"].map(values);
        let of_motion = |name: &str, k: usize| match name {
            "x" => x.get(k).copied(),
            "v" => v.get(k).copied(),
            "a" => a.get(k).copied(),
            "s" => v.get(k).map(|v| v.signum()),
            "t" => self.time.get(k).copied(),
            "F" => self.target.get(k).copied(),
            _ => constant(name),
        };
        // A parameter comes first, as in a file of effects.
        let value = |name: &str, k: usize| parameter(name).or_else(|| of_motion(name, k));
        if let Some(unknown) = law.names().iter().find(|name| value(name, 0).is_none()) {
            return Err(unknown.clone());
        }
        let (mut given, mut stack) = (Vec::new(), Vec::new());
        let part: Vec<f64> = (0..self.time.len())
            .map(|k| {
                given.clear();
                given.extend(law.names().iter().map(|name| value(name, k).unwrap_or(f64::NAN)));
                let value = law.value_on(&given, &mut stack);
                if level { value * v.get(k).map_or(0.0, |v| v.signum()) } else { value }
            })
            .collect();
        let left = fit::residual(self, &fit::predict(self, model));
        let name = if law.names().iter().any(|name| name == "x") { "position" } else { "velocity" };
        let along = track(name).map(Along::of).ok_or_else(|| name.to_owned())?;
        let quantity = self.quantity();
        Ok(Law {
            effect: formula::REFERENCE.to_owned(),
            bins: along.means(&part, &left),
            against_motion: false,
            along: along.name,
            unit: along.unit,
            quantity: [quantity.name, quantity.unit],
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::{Hide, Level, generate};
    use crate::family::Options;

    #[test]
    fn a_law_is_drawn_over_what_it_names_and_lies_on_what_the_model_leaves_where_it_is_right() {
        let made = generate(&Hide::Nothing, 1, Level::Clear).unwrap();
        let family = FrictionFamily::new(&made.recording, &Options::default()).unwrap();
        let mut model = made.truth.model.clone();
        // The model lacks 5 N of its friction level.
        let level = model.get("coulomb.F_C").unwrap();
        model.set("coulomb.F_C", level - 5.0).unwrap();
        let model = family.fitted(&model).unwrap();
        let draw = |text: &str, level: bool| {
            let law = Formula::parse(text).unwrap();
            family.typed(&law, &|name| (name == "h").then_some(5.0), level, &model)
        };
        let drawn = draw("h", true).unwrap();
        assert_eq!((drawn.along.as_str(), drawn.unit.as_str()), ("velocity", "m/s"));
        let fast: Vec<_> = drawn.bins.iter().filter(|bin| bin.at.abs() > 0.02).collect();
        assert!(fast.len() > 10);
        for bin in fast {
            assert!((bin.law.abs() - 5.0).abs() < 0.1, "{bin:?}");
            assert!((bin.data - bin.law).abs() < 1.0, "{bin:?}");
        }
        assert_eq!(draw("h*x", false).unwrap().along, "position");
        assert_eq!(draw("h*x + unknown", false), Err("unknown".to_owned()));
    }
}
