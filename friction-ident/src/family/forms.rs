//! Forms of effects one sample ahead: which one is more flexible, and where it begins.

mod instead;
mod none;
mod second_bodies;

use missing_physics::{Fitted, ModelFamily};

use super::FrictionFamily;
use crate::effects::{Before, Effect};

impl FrictionFamily {
    /// Whether a term is tried by itself, not only in the place of another form.
    pub(super) fn is_candidate(&self, term: usize) -> bool {
        term.checked_sub(1).is_none_or(|index| !self.effects[index].is_only_flexible())
    }

    /// The model with a term in its more flexible form, beginning where it is.
    pub(super) fn in_flexible_form(&self, model: &Fitted, term: usize) -> Option<Fitted> {
        let effect = self.effects[term.checked_sub(1)?];
        let to = effect.flexible_form()?;
        let to = self.terms.iter().position(|term| term.name == to)?;
        let position = model.terms.iter().position(|t| *t == term)?;
        let old = &model.values[model.range(self, position)];
        let known = |name: &str| {
            let parameters = &self.terms[term].parameters;
            parameters.iter().position(|p| p.name == name).map(|k| old[k])
        };
        let mut base = model.without(self, term);
        let parameters = &self.terms[to].parameters;
        let mut values: Vec<f64> = parameters
            .iter()
            .map(|p| known(&p.name).unwrap_or(if p.lower < 0.0 { 0.0 } else { p.start }))
            .collect();
        let mut set = |name: &str, value: f64| {
            if let Some(k) = parameters.iter().position(|p| p.name == name) {
                values[k] = value.clamp(parameters[k].lower, parameters[k].upper);
            }
        };
        let level = self.value(&base, "coulomb", "F_C");
        let before = Before { value: &known, level, top_speed: self.top_speed };
        let begin = effect.begins_flexible(&before);
        begin.values.iter().for_each(|(name, value)| set(name, *value));
        self.change(&mut base, "coulomb", "F_C", |level| level + begin.level);
        Some(base.with(to, &values))
    }

    /// The model in other valleys of its last term, if those are narrow.
    pub(super) fn beside(&self, model: &Fitted) -> Vec<Fitted> {
        let Some(last) = model.terms.len().checked_sub(1) else { return Vec::new() };
        let (term, range) = (model.terms[last], model.range(self, last));
        let valleys = |effect: &dyn Effect| effect.other_valleys(&model.values[range.clone()]);
        let valleys = self.effect(term).map(valleys).unwrap_or_default();
        if valleys.is_empty() {
            return self.other_second_bodies(model);
        }
        let parameters = &self.terms[term].parameters;
        let within = |values: &Vec<f64>| {
            values.len() == parameters.len()
                && values.iter().zip(parameters).all(|(v, p)| (p.lower..=p.upper).contains(v))
        };
        let at = |values: Vec<f64>| {
            let mut other = model.clone();
            other.values[range.clone()].copy_from_slice(&values);
            other
        };
        valleys.into_iter().filter(within).map(at).collect()
    }

    /// The effect that a term is a form of.
    fn main_of(&self, term: usize) -> usize {
        self.form_of(term).unwrap_or(term)
    }

    /// Values of a term with those that are known from elsewhere, in the order of its effect's table, and the limits of
    /// their search below and above.
    fn in_full(&self, effect: &dyn Effect, term: usize, fitted: &[f64]) -> Vec<[f64; 3]> {
        let parameters = &self.terms[term].parameters;
        let table = effect.about().parameters.iter().filter(|p| !super::limits::is_fixed(p));
        let free = |name: &str| parameters.iter().position(|free| free.name == name);
        let each = table.filter_map(|p| match free(p.name) {
            Some(k) => Some([fitted[k], parameters[k].lower, parameters[k].upper]),
            None => Some([self.known_value(effect, p.name)?, 0.0, f64::INFINITY]),
        });
        each.collect()
    }

    /// All values of the effect at a place of a model, known ones among them.
    pub(super) fn values_in_full(&self, model: &Fitted, place: usize) -> Option<Vec<f64>> {
        let term = model.terms[place];
        let full = self.in_full(self.effect(term)?, term, &model.values[model.range(self, place)]);
        Some(full.iter().map(|of| of[0]).collect())
    }

    /// By how much the effect at a place of a model makes the force late, s; nothing where it is no such effect.
    pub(super) fn lateness(&self, model: &Fitted, place: usize) -> Option<f64> {
        self.effect(model.terms[place])?.lateness(&self.values_in_full(model, place)?)
    }

    /// Index of a parameter of a term in a model's values.
    fn place(&self, model: &Fitted, term: &str, parameter: &str) -> Option<usize> {
        let position = model.terms.iter().position(|t| self.terms[*t].name == term)?;
        let parameters = &self.terms[model.terms[position]].parameters;
        let k = parameters.iter().position(|p| p.name == parameter)?;
        Some(model.range(self, position).start + k)
    }

    fn value(&self, model: &Fitted, term: &str, parameter: &str) -> Option<f64> {
        self.place(model, term, parameter).map(|k| model.values[k])
    }

    fn change(&self, model: &mut Fitted, term: &str, parameter: &str, by: impl Fn(f64) -> f64) {
        if let Some(k) = self.place(model, term, parameter) {
            model.values[k] = by(model.values[k]);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Quantity;
    use crate::effects::{About, Along, Begin, Library, Parameter, SecondBody};
    use crate::family::Options;
    use crate::family::testing::recording;

    /// A user's second body, which a user's hump may take the place of.
    struct Own;
    static OWN_ABOUT: About = About {
        name: "own-body",
        title: "a body of the user's",
        equation: "m_L x_L'' = ...",
        parameters: &[
            Parameter::level("m_L", "mass", Quantity::Mass, 1e3, 10.0),
            Parameter::shape("f", "frequency", Quantity::Frequency, (1.0, 500.0), 50.0),
            Parameter::level("F_L", "friction", Quantity::Force, 200.0, 4.0),
        ],
        slots: &[],
        shows: "",
        reference: "a test",
    };
    static OWN_BODY: SecondBody = SecondBody {
        along: Along::Frequency { count: 4, low: 5.0, share: 0.04 },
        damping: 0.1,
        shares: &[0.2, 0.4],
        factors: &[0.5, 1.0],
        related: None,
    };

    impl Effect for Own {
        fn about(&self) -> &'static About {
            &OWN_ABOUT
        }

        fn second_body(&self) -> Option<&'static SecondBody> {
            Some(&OWN_BODY)
        }

        fn flexible_form(&self) -> Option<&'static str> {
            Some("stribeck")
        }

        fn begins_flexible(&self, before: &Before<'_>) -> Begin {
            let level = (before.value)("F_L").unwrap_or(0.0);
            Begin { level: 1.5, ..Begin::at([("dF", 0.5 * level)]) }
        }
    }

    #[test]
    fn an_effect_of_the_user_says_where_its_fits_and_its_flexible_form_begin() {
        let library = Library::default().with(&Own);
        let options = Options { library, ..Options::default() };
        let family = FrictionFamily::new(&recording(), &options).unwrap();
        let of = |name: &str| family.terms.iter().position(|term| term.name == name).unwrap();
        let (own, coulomb) = (of("own-body"), of("coulomb"));
        let base = Fitted { terms: vec![0, coulomb], values: vec![20.0, 8.0] };
        let trials = family.two_masses(&base, own).unwrap();
        assert_eq!(trials.len(), 8);
        let at = |k: usize, parameter: &str| {
            family.value(&trials[k].model, "own-body", parameter).unwrap()
        };
        // 5 Hz to a twenty-fifth of 1 kHz, half of the mass, a fifth of the friction.
        assert!((at(0, "f") - 5.0).abs() < 1e-9 && (at(3, "f") - 40.0).abs() < 1e-9);
        assert_eq!((at(0, "m_L"), at(0, "F_L"), at(4, "F_L")), (10.0, 1.6, 3.2));
        assert_eq!(family.value(&trials[0].model, "coulomb", "F_C"), Some(6.4));
        let model = base.with(own, &[10.0, 50.0, 6.0]);
        // A half and the whole of the frequency with four choices of the friction, less the fit itself.
        assert_eq!(family.beside(&model).len(), 7);
        let hump = family.in_flexible_form(&model, own).unwrap();
        assert_eq!(hump.terms, [0, coulomb, of("stribeck")]);
        assert_eq!(family.value(&hump, "stribeck", "dF"), Some(3.0));
        assert_eq!(family.value(&hump, "coulomb", "F_C"), Some(9.5));
    }

    #[test]
    fn valleys_within_the_limits_of_the_search_are_looked_at_and_those_beyond_are_not() {
        let family = FrictionFamily::new(&recording(), &Options::default()).unwrap();
        let of = |name: &str| family.terms.iter().position(|term| term.name == name).unwrap();
        let (coulomb, encoder) = (of("coulomb"), of("encoder:harmonics"));
        let base = Fitted { terms: vec![0, coulomb], values: vec![20.0, 8.0] };
        let longest = family.terms[encoder].parameters.last().unwrap().upper;
        let valleys = |period: f64| {
            let fitted = base.with(encoder, &[2e-5, 1e-5, 3e-6, -1e-6, period]);
            family.beside(&fitted).into_iter().map(|model| model.values).collect::<Vec<_>>()
        };
        let half = vec![20.0, 8.0, 3e-6, -1e-6, 0.0, 0.0, 0.35 * longest];
        assert_eq!(valleys(0.7 * longest), [half]);
        assert_eq!(valleys(0.4 * longest)[0], [20.0, 8.0, 0.0, 0.0, 2e-5, 1e-5, 0.8 * longest]);
        assert!(family.beside(&base).is_empty() && family.beside(&Fitted::default()).is_empty());
    }
}
