//! Effects that are none as they were fitted.

use missing_physics::Fitted;
use missing_physics::report::{NamedValue, Refusal};

use crate::axis::Quantity;
use crate::effects::{AsFound, Effect, Refused};
use crate::family::FrictionFamily;

impl FrictionFamily {
    /// A term beyond those of a base model that is no such effect as it was fitted, and why.
    pub(in crate::family) fn vanishes(
        &self,
        model: &Fitted,
        base: &Fitted,
    ) -> Option<(usize, Refusal)> {
        let vanished = self.given.as_ref().and_then(|given| given.vanishes(self, model));
        vanished.or_else(|| {
            let mut added = model.terms.iter().enumerate().filter(|(_, t)| !base.terms.contains(t));
            added.find_map(|(place, term)| {
                let effect = self.effects[term.checked_sub(1)?];
                let full = self.in_full(effect, *term, &model.values[model.range(self, place)]);
                let of = |k: usize| full.iter().map(|of| of[k]).collect::<Vec<f64>>();
                let found = AsFound {
                    values: &of(0),
                    least: &of(1),
                    most: &of(2),
                    mass: self.mass_of(model),
                    force: self.force(),
                    count: self.count(),
                    give: self.give(model),
                };
                if effect.gives(found.values, 0.0).is_some()
                    && let Some(refusal) = self.no_contact(effect, &found)
                {
                    return Some((*term, refusal));
                }
                let Refused { name, value, limit, unit_of, meaning } = effect.refused(&found)?;
                let unit = effect.about().parameter(unit_of).map_or("", |k| {
                    self.effort.unit(self.axis, effect.about().parameters[k].quantity)
                });
                let refusal = Refusal::NotThatEffect {
                    effect: effect.about().name.to_owned(),
                    value: NamedValue { name: name.to_owned(), value, unit: unit.to_owned() },
                    limit,
                    meaning: meaning.to_owned(),
                };
                Some((*term, refusal))
            })
        })
    }

    /// Why a contact is none that gives no more than a count, as it is turned around over twice that, within the half counts on
    /// either side of the readings at both ends; or so far that it hardly slides: what draws the axis back to one place is no
    /// friction.
    fn no_contact(&self, effect: &dyn Effect, found: &AsFound<'_>) -> Option<Refusal> {
        let (limit, meaning) = if found.give <= found.count {
            (found.count, "it gives no more than a count of the position before it slides")
        } else if found.give >= self.longest_give() {
            let meaning =
                "it hardly slides within the stroke: a spring or a weight draws the axis back";
            (self.longest_give(), meaning)
        } else {
            return None;
        };
        let unit = self.axis.unit(Quantity::Length).to_owned();
        Some(Refusal::NotThatEffect {
            effect: effect.about().name.to_owned(),
            value: NamedValue { name: "give".into(), value: found.give, unit },
            limit,
            meaning: meaning.into(),
        })
    }

    /// Whether a model has a contact beyond a base that gives no more than a count.
    pub(in crate::family) fn gives_unseen(&self, model: &Fitted, base: &Fitted) -> bool {
        let gives = |term: &usize| {
            let values = self.values_in_full(model, model.terms.iter().position(|t| t == term)?)?;
            self.effect(*term)?.gives(&values, 0.0)
        };
        let mut added = model.terms.iter().filter(|term| !base.terms.contains(term));
        added.find_map(gives).is_some() && self.give(model) <= self.count()
    }

    /// The most general contact.
    pub(in crate::family) fn contact(&self) -> Option<usize> {
        self.terms.iter().position(|term| term.name == "presliding:free")
    }

    /// How far a contact may give: from one side to the other and as far again fit into the stroke.
    pub(super) fn longest_give(&self) -> f64 {
        0.25 * (self.stroke.1 - self.stroke.0)
    }

    /// How far the contact of a model gives before it slides; 0 without one.
    fn give(&self, model: &Fitted) -> f64 {
        let level = self.value(model, "coulomb", "F_C").unwrap_or(0.0);
        let gives = model.terms.iter().enumerate().find_map(|(place, term)| {
            self.effect(*term)?.gives(&self.values_in_full(model, place)?, level)
        });
        gives.unwrap_or(0.0)
    }

    /// The count of a position whose rounding errs as much as the recorded one.
    fn count(&self) -> f64 {
        self.position_deviation() * 12.0f64.sqrt()
    }

    /// Rms of the recorded force.
    fn force(&self) -> f64 {
        let force = &self.prepared.force;
        (force.iter().map(|f| f * f).sum::<f64>() / force.len().max(1) as f64).sqrt()
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{PI, TAU};

    use crate::family::testing::{family, model};
    use missing_physics::TermParameter;

    use super::*;

    /// Why a second body of 10 kg behind 20 kg is none, with these values in the place of sensible ones.
    fn said(family: &FrictionFamily, name: &str, values: &[(&str, f64)]) -> Option<Refusal> {
        let term = family.terms.iter().position(|term| term.name == name).unwrap();
        let value = |p: &TermParameter| {
            let given = values.iter().find(|(name, _)| *name == p.name).map(|(_, value)| *value);
            given.unwrap_or(if p.name == "m_L" { 10.0 } else { p.start })
        };
        let values: Vec<f64> = family.terms[term].parameters.iter().map(value).collect();
        let model = Fitted { terms: vec![0], values: vec![20.0] }.with(term, &values);
        let (refused, why) = family.vanishes(&model, &Fitted::default())?;
        assert_eq!(refused, term);
        Some(why)
    }

    #[test]
    fn a_coupling_must_ring() {
        let family = family();
        for name in ["flexible-coupling", "flexible-coupling:friction", "flexible-coupling:load"] {
            assert_eq!(said(&family, name, &[("zeta", 0.3)]), None, "{name}");
            let Some(Refusal::NotThatEffect { effect, value, meaning, .. }) =
                said(&family, name, &[("zeta", 0.5)])
            else {
                panic!("{name} rings")
            };
            assert_eq!((effect.as_str(), meaning.as_str()), (name, "nothing rings"));
            assert_eq!((value.name.as_str(), value.value, value.unit.as_str()), ("zeta", 0.5, "1"));
            // Both bodies against each other ring less the lighter the mass in front is.
            assert!(said(&family, name, &[("zeta", 0.3), ("m_L", 1e3)]).is_some(), "{name}");
            let Some(Refusal::NotThatEffect { value, meaning, .. }) =
                said(&family, name, &[("f", 1.0), ("zeta", 0.05)])
            else {
                panic!("{name} swings at the limit")
            };
            assert_eq!((value.name.as_str(), value.value, value.unit.as_str()), ("f", 1.0, "Hz"));
            assert_eq!(meaning, "it swings as slowly as it may");
            let Some(Refusal::NotThatEffect { meaning, .. }) =
                said(&family, name, &[("zeta", 5e-3)])
            else {
                panic!("{name} swings on")
            };
            assert_eq!(meaning, "it swings on as long as it may");
            assert_eq!(said(&family, name, &[("zeta", 6e-3)]), None, "{name}");
        }
    }

    #[test]
    fn what_thins_at_the_lowest_speed_is_a_friction_level() {
        let family = family();
        let term = family.terms.iter().find(|term| term.name == "shear-thinning").unwrap();
        let least = term.parameters.iter().find(|p| p.name == "v_n").unwrap().lower;
        let refused = |v_n: f64| said(&family, "shear-thinning", &[("v_n", v_n)]);
        assert_eq!(refused(1.1 * least), None);
        let Some(Refusal::NotThatEffect { value, meaning, .. }) = refused(least) else {
            panic!("a level is shear thinning")
        };
        assert_eq!((value.value, value.unit.as_str()), (least, "m/s"));
        assert!(meaning.ends_with("a friction level"), "{meaning}");
    }

    #[test]
    fn a_gap_must_be_wider_than_its_contact_gives() {
        // A third of the force bends the contact: 7 N.
        let family = family();
        let gap = |k: f64, b: f64| match said(&family, "backlash:two-mass", &[("k", k), ("b", b)])?
        {
            Refusal::NotThatEffect { value, limit, meaning, .. } => {
                assert_eq!(value.unit, "m");
                Some((value.value, limit, meaning))
            }
            other => panic!("{other:?}"),
        };
        assert_eq!(gap(1e7, 3e-5), None);
        assert_eq!(gap(1e6, 3e-5), None);
        let (gives, half, meaning) = gap(3e5, 3e-5).unwrap();
        assert!(meaning.ends_with("gives more than its gap is wide"), "{meaning}");
        assert!(gives > half && (half - 1.5e-5).abs() < 1e-12, "{gives} {half}");
        let least = family.terms.iter().find(|term| term.name == "backlash:two-mass").unwrap();
        let least = least.parameters.iter().find(|p| p.name == "b").unwrap().lower;
        assert!(gap(1e9, least).unwrap().2.contains("as narrow as it may be"));
    }

    #[test]
    fn a_constant_force_of_next_to_nothing_is_none_unless_the_base_has_it() {
        let family = family();
        let most = 1e-4 * family.force();
        for sign in [1.0, -1.0] {
            assert_eq!(said(&family, "offset", &[("F_0", 1.01 * sign * most)]), None);
            let Some(Refusal::NotThatEffect { value, limit, .. }) =
                said(&family, "offset", &[("F_0", 0.99 * sign * most)])
            else {
                panic!("nothing is a constant force")
            };
            assert_eq!((value.name.as_str(), value.unit.as_str(), limit), ("F_0", "N", most));
        }
        let offset = family.terms.iter().position(|term| term.name == "offset").unwrap();
        let base = Fitted { terms: vec![0], values: vec![20.0] }.with(offset, &[0.0]);
        assert_eq!(family.vanishes(&base, &base), None);
    }

    #[test]
    fn a_wave_of_the_force_that_moves_the_axis_by_a_part_of_a_count_is_none() {
        let family = family();
        let (period, swings) = (4e-3, family.count() / PI);
        let least = 20.0 * (TAU / period).powi(2) * swings;
        let refused = |a: f64| said(&family, "force-wave", &[("a", a), ("P", period)]);
        assert_eq!(refused(1.01 * least), None);
        let Some(Refusal::NotThatEffect { value, limit, .. }) = refused(-0.99 * least) else {
            panic!("a beat of counts is a wave of the force")
        };
        assert_eq!(value.unit, "N");
        assert!((limit / least - 1.0).abs() < 1e-9, "{limit} {least}");
    }

    #[test]
    fn a_gap_must_be_wider_than_friction_turns_over_anyway() {
        let family = family();
        let of = |name: &str| family.terms.iter().position(|term| term.name == name).unwrap();
        let base = Fitted { terms: vec![0], values: vec![20.0] }.with(of("coulomb"), &[8.0]);
        let refused = |contact: Option<(&str, &[f64])>, b: f64| {
            let with = contact.map(|(name, values)| base.clone().with(of(name), values));
            let model = with.unwrap_or(base.clone()).with(of("backlash"), &[4.0, b]);
            family.vanishes(&model, &base)
        };
        // Each gives 8e-4 m: a spring, and five elements with a fifth of the level each.
        let free = [8e-4 / 0.666, 0.0, 0.0, 0.0, 0.0, 1e3];
        let contacts: [(&str, &[f64]); 4] = [
            ("presliding", &[1e4]),
            ("presliding:dahl", &[1e4]),
            ("presliding:maxwell-slip", &[1e4, 2.5]),
            ("presliding:free", &free),
        ];
        for contact in contacts {
            assert_eq!(refused(Some(contact), 1.65e-3), None, "{}", contact.0);
            let Some((_, Refusal::NotThatEffect { value, limit, meaning, .. })) =
                refused(Some(contact), 1.55e-3)
            else {
                panic!("{} is no contact", contact.0)
            };
            assert_eq!((value.name.as_str(), value.unit.as_str()), ("b", "m"));
            assert!((limit / 1.6e-3 - 1.0).abs() < 1e-9, "{} {limit}", contact.0);
            assert!(meaning.contains("without the gap"), "{meaning}");
        }
        assert_eq!(refused(None, 1.55e-3), None);
    }

    #[test]
    fn a_contact_that_hardly_slides_within_the_stroke_is_what_draws_the_axis_back() {
        let family = family();
        let longest = 0.25 * (family.stroke.1 - family.stroke.0);
        let with = |form: &str, give: f64| {
            let values = [("F_C", 8.0), ("k_t", 8.0 / give), ("mass", 20.0)];
            model(&family, &["mass", "coulomb", form], &values)
        };
        let base = model(&family, &["mass", "coulomb"], &[("F_C", 8.0), ("mass", 20.0)]);
        for form in ["presliding", "presliding:static", "presliding:dahl"] {
            let (slides, holds) = (with(form, 0.9 * longest), with(form, 1.1 * longest));
            assert_eq!(family.vanishes(&slides, &base), None, "{form}");
            let told = family.vanishes(&holds, &base);
            assert!(
                matches!(&told, Some((_, Refusal::NotThatEffect { meaning, .. })) if meaning.contains("spring")),
                "{form}: {told:?}"
            );
            assert!(family.what_draws_back(&slides).is_empty());
            let [spring] = &family.what_draws_back(&holds)[..] else { panic!("{form}") };
            let of = |term: &str, name: &str| family.value(spring, term, name).unwrap();
            assert!((of("spring", "k") * 1.1 * longest / 8.0 - 1.0).abs() < 1e-9);
            assert!((of("coulomb", "F_C") - 0.8).abs() < 1e-9);
        }
    }

    #[test]
    fn what_neither_counts_nor_samples_show_is_none() {
        let family = family();
        let count = 12.0f64.sqrt() * family.position_deviation();
        let gap = |b: f64| said(&family, "backlash:two-mass", &[("k", 1e9), ("b", b)]);
        assert_eq!(gap(2.1 * count), None);
        assert!(matches!(gap(1.9 * count), Some(Refusal::NotThatEffect { limit, meaning, .. })
            if meaning.contains("two counts") && (limit / count - 2.0).abs() < 1e-9));
        for form in ["", ":hysteresis", ":bouc-wen"] {
            let name = format!("reversal-decay{form}");
            assert_eq!(said(&family, &name, &[("l", 1.1 * count)]), None, "{name}");
            assert!(
                matches!(said(&family, &name, &[("l", 0.9 * count)]), Some(Refusal::NotThatEffect { limit, meaning, .. })
                if meaning.contains("within a count") && (limit / count - 1.0).abs() < 1e-9)
            );
        }
        let term = family.terms.iter().find(|term| term.name == "flexible-coupling").unwrap();
        let most = term.parameters.iter().find(|p| p.name == "f").unwrap().upper;
        let coupling = |f: f64| said(&family, "flexible-coupling", &[("f", f)]);
        assert_eq!(coupling(0.9 * most), None);
        assert!(matches!(coupling(most), Some(Refusal::NotThatEffect { meaning, .. })
            if meaning.contains("as fast as it may")));
    }
}
