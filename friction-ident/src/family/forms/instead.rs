//! What does nearly the same as the last effect of a model, beginning where that is.

use missing_physics::{Fitted, ModelFamily};

use crate::family::FrictionFamily;

/// Share of a friction level that a spring begins with in the place of a contact that hardly slides.
const LITTLE: f64 = 0.1;

impl FrictionFamily {
    /// The same with what the last term acts on in its other forms, where it acts on another one: which form it has was seen
    /// without this term.
    pub(in crate::family) fn other_forms_of_companion(&self, model: &Fitted) -> Vec<Fitted> {
        let others = || {
            let acts_on = self.effect(self.main_of(*model.terms.last()?))?.companion()?;
            let main = self.terms.iter().position(|term| term.name == acts_on)?;
            let of_main = |term: usize| self.main_of(term) == main;
            let place =
                model.terms.iter().position(|term| of_main(*term) && self.is_candidate(*term))?;
            let (now, old) = (model.terms[place], &model.values[model.range(self, place)]);
            let value = |name: &str| {
                let k = self.terms[now].parameters.iter().position(|p| p.name == name)?;
                Some(old[k])
            };
            let forms = (1..self.terms.len())
                .filter(|term| of_main(*term) && *term != now && self.is_candidate(*term));
            let with = |term: usize| {
                let parameters = self.terms[term].parameters.iter();
                let values: Vec<f64> =
                    parameters.map(|p| value(&p.name).unwrap_or(p.start)).collect();
                model.without(self, now).with(term, &values)
            };
            Some(forms.map(with).collect::<Vec<Fitted>>())
        };
        others().unwrap_or_default()
    }

    /// The same with another effect that makes the force as late, where the last term does: the first order hardly tells
    /// what a delay of several samples would do from what a lag does.
    pub(in crate::family) fn other_lateness(&self, model: &Fitted) -> Vec<Fitted> {
        let others = || {
            let place = model.terms.len().checked_sub(1)?;
            let last = model.terms[place];
            let late = self.lateness(model, place)?;
            // A delay or a time constant alone; what has a second one is a form of that.
            let is_other = |term: &usize| {
                let one = self.terms[*term].parameters.len() == 1;
                let effect =
                    self.effect(*term).filter(|_| one && self.main_of(*term) != self.main_of(last));
                effect.is_some_and(|effect| effect.lateness(&[late]).is_some())
            };
            let without = model.without(self, last);
            let others = (1..self.terms.len()).filter(is_other);
            let others = others.filter(|term| self.joins(&without, *term));
            Some(others.map(|term| without.with(term, &[late])).collect())
        };
        others().unwrap_or_default()
    }

    /// The same with what else draws back as the last term does: a pendulum in the place of a spring, at rest where the spring
    /// is and as stiff; a spring and a pendulum in that of a contact that hardly slides, the friction then much smaller.
    pub(in crate::family) fn what_draws_back(&self, model: &Fitted) -> Vec<Fitted> {
        let others = || {
            let place = model.terms.len().checked_sub(1)?;
            let last = model.terms[place];
            let mut base = model.without(self, last);
            let open = |name: &str| {
                let term = self.terms.iter().position(|term| term.name == name)?;
                self.joins(&base, term).then_some(term)
            };
            let (spring, pendulum) = (open("spring"), open("gravity-pendulum"));
            let is_spring = self.terms[self.main_of(last)].name == "spring";
            let mut others = Vec::new();
            let stiffness = if is_spring {
                self.value(model, &self.terms[last].name, "k")?
            } else {
                let level = self.value(model, "coulomb", "F_C")?;
                let give = self.effect(last)?.gives(&self.values_in_full(model, place)?, level)?;
                if give < self.longest_give() {
                    return None;
                }
                self.change(&mut base, "coulomb", "F_C", |level| LITTLE * level);
                others.extend(spring.map(|spring| base.with(spring, &[level / give])));
                level / give
            };
            let force = self.value(model, "offset", "F_0").unwrap_or(0.0);
            self.change(&mut base, "offset", "F_0", |_| 0.0);
            let at_rest = -force / stiffness;
            others.extend(pendulum.map(|pendulum| base.with(pendulum, &[stiffness, at_rest])));
            Some(others)
        };
        let others = others().unwrap_or_default();
        others.into_iter().map(|other| other.within(self)).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::testing::{family, model, of_axis};

    #[test]
    fn a_memory_is_tried_beside_the_other_forms_of_the_curve_that_it_acts_on() {
        let family = family();
        let values = [("dF", 3.0), ("v_s", 2e-3), ("tau_L", 0.03)];
        let of = |terms: &[&str]| -> Vec<(Vec<String>, f64)> {
            let others = family.other_forms_of_companion(&model(&family, terms, &values));
            let names = |other: &Fitted| {
                other.terms.iter().map(|term| family.terms[*term].name.clone()).collect()
            };
            let height =
                |other: &Fitted| other.values[other.range(&family, other.terms.len() - 1).start];
            others.iter().map(|other| (names(other), height(other))).collect()
        };
        let others = of(&["mass", "coulomb", "stribeck", "frictional-memory:lag"]);
        let last: Vec<&str> = others.iter().map(|(names, _)| names[3].as_str()).collect();
        assert_eq!(last, ["stribeck:gaussian", "stribeck:exponential"]);
        assert!(others.iter().all(|(names, height)| {
            names[..3] == ["mass", "coulomb", "frictional-memory:lag"] && *height == 3.0
        }));
        // What acts on nothing, and what acts on nothing that is there.
        assert!(of(&["mass", "stribeck", "coulomb"]).is_empty());
        assert!(of(&["mass", "coulomb", "frictional-memory"]).is_empty());
    }

    #[test]
    fn a_lag_is_tried_as_a_delay_that_comes_as_late_and_the_other_way_round() {
        let family = family();
        let others = |last: &str, values: &[(&str, f64)]| -> Vec<(String, f64)> {
            let model = model(&family, &["mass", "coulomb", last], values);
            let named = |other: Fitted| {
                assert_eq!(other.terms[..2], model.terms[..2]);
                let [.., term] = other.terms[..] else { panic!() };
                (family.terms[term].name.clone(), other.values[other.values.len() - 1])
            };
            family.other_lateness(&model).into_iter().map(named).collect()
        };
        let delay = |late| vec![("input-delay".to_owned(), late)];
        assert_eq!(others("actuator-lag", &[("tau", 4e-3)]), delay(4e-3));
        let second = [("tau", 3e-3), ("zeta", 0.75)];
        assert_eq!(others("actuator-lag:second-order", &second), delay(2.0 * 0.75 * 3e-3));
        let lag = vec![("actuator-lag".to_owned(), 5e-3)];
        assert_eq!(others("input-delay", &[("T_d", 5e-3)]), lag);
        assert!(others("stribeck", &[]).is_empty());
    }

    #[test]
    fn a_pendulum_begins_where_a_spring_is_at_rest() {
        let family = of_axis("Nm", "rad");
        let values = [("k", 3.0), ("F_0", 1.5), ("k_t", 1e9)];
        let sprung = model(&family, &["mass", "coulomb", "offset", "spring"], &values);
        let [pendulum] = &family.what_draws_back(&sprung)[..] else { panic!() };
        let of = |term: &str, name: &str| family.value(pendulum, term, name).unwrap();
        assert_eq!((of("gravity-pendulum", "M"), of("gravity-pendulum", "q_0")), (3.0, -0.5));
        assert_eq!((of("offset", "F_0"), family.value(pendulum, "spring", "k")), (0.0, None));
        let both = model(&family, &["mass", "coulomb", "gravity-pendulum", "spring"], &values);
        assert!(family.what_draws_back(&both).is_empty());
        let contact = model(&family, &["mass", "coulomb", "presliding"], &values);
        assert!(family.what_draws_back(&contact).is_empty());
    }
}
