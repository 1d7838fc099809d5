//! Forms of effects one sample ahead: which one is more flexible, and where it begins.

use missing_physics::family::Trial;
use missing_physics::report::{NamedValue, Refusal};
use missing_physics::{Fitted, ModelFamily};

use super::FrictionFamily;
use crate::axis::Quantity;
use crate::effects::{Along, AsFound, Before, Effect, Refused, SecondBody};

/// Share of the mass that a second body begins with.
const SECOND_MASS: f64 = 0.5;
/// Frequency of the contact at the end of a gap, Hz.
const CONTACT: f64 = 150.0;
/// Shares of the friction that a second body takes over in other valleys.
const SHARES: [f64; 3] = [0.35, 0.55, 0.75];
/// Share of a friction level that a spring begins with in the place of a contact that hardly slides.
const LITTLE: f64 = 0.1;

impl FrictionFamily {
    /// What a term says of itself as a second body.
    fn second_body(&self, term: usize) -> Option<&'static SecondBody> {
        self.effects[term.checked_sub(1)?].second_body()
    }

    /// Whether a term is a second body whose friction is fitted.
    pub(super) fn is_second_body(&self, term: usize) -> bool {
        self.second_body(term).is_some()
            && self.terms[term].parameters.iter().any(|p| p.name == "F_L")
    }

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

    /// Ways to begin with a second body, where the term is one.
    pub(super) fn two_masses(&self, model: &Fitted, term: usize) -> Option<Vec<Trial>> {
        let body = self.second_body(term)?;
        let (count, low, high) = match body.along {
            Along::Frequency { count, low, share } => {
                (count, low, (share / self.recording.interval()).max(2.0 * low))
            }
            Along::Gap { count, deviations, share } => {
                let least = deviations * self.position_deviation();
                (count, least, (share * (self.stroke.1 - self.stroke.0)).max(2.0 * least))
            }
        };
        let part = |k: usize| k as f64 / (count - 1) as f64;
        let line: Vec<f64> = (0..count).map(|k| low * (high / low).powf(part(k))).collect();
        Some(self.second_bodies(model, (term, body), &line))
    }

    fn second_bodies(
        &self,
        model: &Fitted,
        (term, body): (usize, &SecondBody),
        line: &[f64],
    ) -> Vec<Trial> {
        let parameters = &self.terms[term].parameters;
        let mass = self.mass_of(model);
        let own = |term: &str, name: &str| self.value(model, term, name).unwrap_or(0.0);
        let (level, damping) = match &self.given {
            Some(given) => (given.level, given.damping),
            None => (own("coulomb", "F_C"), own("viscous", "F_v")),
        };
        let reduced = mass * SECOND_MASS * (1.0 - SECOND_MASS);
        let stiffness = (std::f64::consts::TAU * CONTACT).powi(2) * reduced;
        let mut trials = Vec::new();
        for &share in body.shares {
            for &at in line {
                let mut base = model.clone();
                if self.given.is_none() && !self.terms[0].parameters.is_empty() {
                    base.values[0] = mass * (1.0 - SECOND_MASS);
                }
                if self.given.is_none() {
                    self.change(&mut base, "coulomb", "F_C", |level| level * (1.0 - share));
                    self.change(&mut base, "viscous", "F_v", |damping| damping * (1.0 - share));
                }
                let value = |name: &str| match name {
                    "m_L" => Some(mass * SECOND_MASS),
                    "F_L" => Some(level * share),
                    "d_L" => Some(damping * share),
                    "k" => Some(stiffness),
                    "zeta" => Some(body.damping),
                    _ => (name == body.along.parameter()).then_some(at),
                };
                let values = parameters
                    .iter()
                    .map(|p| value(&p.name).unwrap_or(p.start).clamp(p.lower, p.upper));
                let values: Vec<f64> = values.collect();
                trials.push(Trial { model: base.with(term, &values), amplitudes: Vec::new() });
            }
        }
        trials
    }

    /// The model in other valleys of its last term, if those are narrow.
    pub(super) fn beside(&self, model: &Fitted) -> Vec<Fitted> {
        let leaps = |term: usize| Some((&self.terms[term].name, self.effect(term)?.leaps()?));
        let Some((name, (parameter, distances))) = model.terms.last().and_then(|t| leaps(*t))
        else {
            return self.other_second_bodies(model);
        };
        let at = |distance: &f64| {
            let mut other = model.clone();
            self.change(&mut other, name, parameter, |value| value + distance);
            other
        };
        distances.iter().map(at).collect()
    }

    /// The model with its second body, if that is the last term, at other gaps or frequencies and with other shares
    /// of the friction.
    fn other_second_bodies(&self, model: &Fitted) -> Vec<Fitted> {
        let Some((term, body)) = self.last_second_body(model) else { return Vec::new() };
        let name = self.terms[term].name.clone();
        let (length, factors) = (body.along.parameter(), body.factors);
        let friction = [("F_L", "coulomb", "F_C"), ("d_L", "viscous", "F_v")];
        let mut all = Vec::new();
        for &factor in factors {
            for share in std::iter::once(None).chain(SHARES.map(Some)) {
                if factor == 1.0 && share.is_none() {
                    continue;
                }
                let mut other = model.clone();
                self.change(&mut other, &name, length, |value| value * factor);
                for (load, base, level) in friction.iter().filter(|_| share.is_some()) {
                    let of = |term: &str, name: &str| self.value(model, term, name).unwrap_or(0.0);
                    let fixed = match &self.given {
                        Some(given) if *base == "coulomb" => given.level,
                        Some(given) => given.damping,
                        None => of(&name, load) + of(base, level),
                    };
                    let (total, share) = (fixed, share.unwrap_or(0.0));
                    self.change(&mut other, &name, load, |_| total * share);
                    if self.given.is_none() {
                        self.change(&mut other, base, level, |_| total * (1.0 - share));
                    }
                }
                all.push(other);
            }
        }
        all
    }

    /// The model with its second body, if that is the last term, behind a coupling in place of a gap, or the other way
    /// round: a gap that is nearly closed is a coupling.
    pub(super) fn related_second_bodies(&self, model: &Fitted) -> Vec<Fitted> {
        let Some((term, body)) = self.last_second_body(model) else { return Vec::new() };
        let name = self.terms[term].name.as_str();
        let of = |parameter: &str| self.value(model, name, parameter).unwrap_or(0.0);
        let tau = std::f64::consts::TAU;
        let to = body.related.and_then(|to| self.terms.iter().position(|term| term.name == to));
        let open = to.filter(|to| !model.terms.contains(to));
        let Some((to, other)) = open.and_then(|to| Some((to, self.second_body(to)?))) else {
            return Vec::new();
        };
        let value = |parameter: &str| match (parameter, other.along) {
            ("f", _) => (of("k") / of("m_L").max(f64::MIN_POSITIVE)).sqrt() / tau,
            ("k", _) => of("m_L") * (tau * of("f")).powi(2),
            ("b", Along::Gap { deviations, .. }) => deviations * self.position_deviation(),
            (known, _) => of(known),
        };
        let values = self.terms[to].parameters.iter();
        let values: Vec<f64> = values.map(|p| value(&p.name).clamp(p.lower, p.upper)).collect();
        vec![model.without(self, term).with(to, &values)]
    }

    /// The same with what the last term acts on in its other forms, where it acts on another one: which form it has was seen
    /// without this term.
    pub(super) fn other_forms_of_companion(&self, model: &Fitted) -> Vec<Fitted> {
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
    pub(super) fn other_lateness(&self, model: &Fitted) -> Vec<Fitted> {
        let others = || {
            let place = model.terms.len().checked_sub(1)?;
            let last = model.terms[place];
            let late = self.effect(last)?.lateness(&self.values_in_full(model, place)?)?;
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
    pub(super) fn what_draws_back(&self, model: &Fitted) -> Vec<Fitted> {
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

    /// How far a contact may give: from one side to the other and as far again fit into the stroke.
    fn longest_give(&self) -> f64 {
        0.25 * (self.stroke.1 - self.stroke.0)
    }

    /// The effect that a term is a form of.
    fn main_of(&self, term: usize) -> usize {
        self.form_of(term).unwrap_or(term)
    }

    /// The last term of a model, if it is a second body.
    fn last_second_body(&self, model: &Fitted) -> Option<(usize, &'static SecondBody)> {
        let &term = model.terms.last().filter(|term| self.is_second_body(**term))?;
        Some((term, self.second_body(term)?))
    }

    /// A term beyond those of a base model that is no such effect as it was fitted, and why.
    pub(super) fn vanishes(&self, model: &Fitted, base: &Fitted) -> Option<(usize, Refusal)> {
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
                    count: self.position_deviation() * 12.0f64.sqrt(),
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

    /// How far the contact of a model gives before it slides; 0 without one.
    fn give(&self, model: &Fitted) -> f64 {
        let level = self.value(model, "coulomb", "F_C").unwrap_or(0.0);
        let gives = model.terms.iter().enumerate().find_map(|(place, term)| {
            self.effect(*term)?.gives(&self.values_in_full(model, place)?, level)
        });
        gives.unwrap_or(0.0)
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

    /// Rms of the recorded force.
    fn force(&self) -> f64 {
        let force = &self.prepared.force;
        (force.iter().map(|f| f * f).sum::<f64>() / force.len().max(1) as f64).sqrt()
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
    use missing_physics::{Channel, Hold, Recording, TermParameter};

    use super::*;
    use crate::effects::{About, Begin, Library, Parameter};
    use crate::family::Options;
    use crate::family::hold::HoldChoice;

    /// A mass of 20 kg on a sine with counts of 1 um, 20 N (rms) at 1 ms.
    fn recording() -> Recording {
        moved("N", "m")
    }

    /// The same of an axis with these units.
    fn moved(force_unit: &str, position_unit: &str) -> Recording {
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
        let (w, size) = (2.0 * std::f64::consts::PI, 0.0358);
        let position = time.iter().map(|t| (size * (w * t).sin() / 1e-6).round() * 1e-6);
        let force = time.iter().map(|t| -20.0 * size * w * w * (w * t).sin());
        let channel = |name: &str, unit: &str, values: Vec<f64>| Channel::new(name, unit, values);
        let channels = vec![
            channel("force", force_unit, force.collect()),
            channel("position", position_unit, position.collect()),
        ];
        Recording::new("sine", time.clone(), channels).unwrap()
    }

    fn family() -> FrictionFamily {
        of_axis("N", "m")
    }

    fn of_axis(force_unit: &str, position_unit: &str) -> FrictionFamily {
        FrictionFamily::new(&moved(force_unit, position_unit), &Options::default()).unwrap()
    }

    /// A model of so many terms, those with `values` in the place of where they begin.
    fn model(family: &FrictionFamily, terms: &[&str], values: &[(&str, f64)]) -> Fitted {
        let place = |name: &str| family.terms.iter().position(|term| term.name == name).unwrap();
        let begin = Fitted { terms: Vec::new(), values: Vec::new() };
        terms.iter().map(|name| place(name)).fold(begin, |model, term| {
            let parameters = family.terms[term].parameters.iter();
            let value = |p: &TermParameter| {
                values.iter().find(|(name, _)| *name == p.name).map_or(p.start, |(_, value)| *value)
            };
            model.with(term, &parameters.map(value).collect::<Vec<f64>>())
        })
    }

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
    fn a_lag_within_half_a_sample_is_how_an_unstated_force_acts_between_samples() {
        let mut family = family();
        let base = model(&family, &["mass", "coulomb"], &[]);
        let mut refused = |hold: Option<Hold>, name: &str, values: &[(&str, f64)]| {
            family.hold = hold.map(|hold| HoldChoice { hold, nats: 1.0, by_search: true });
            let lagging = model(&family, &["mass", "coulomb", name], values);
            family.within_a_sample(&lagging, &base).is_some()
        };
        // A sample takes 1 ms.
        for (late, told) in [(0.2e-3, false), (0.5e-3, false), (0.6e-3, true), (3e-3, true)] {
            let delay = |hold| refused(hold, "input-delay", &[("T_d", late)]);
            let [sampled, held, stated] =
                [Some(Hold::Sampled), Some(Hold::ZeroOrder), None].map(delay);
            assert_eq!((sampled, held, stated), (!told, false, false), "{late}");
            assert_eq!(refused(Some(Hold::Sampled), "actuator-lag", &[("tau", late)]), !told);
            let second = [("tau", late), ("zeta", 0.5)];
            assert_eq!(refused(Some(Hold::Sampled), "actuator-lag:second-order", &second), !told);
        }
        assert!(!refused(Some(Hold::Sampled), "stribeck", &[]));
    }

    #[test]
    fn a_friction_by_the_force_of_inertia_is_less_than_the_mass_and_a_coupling_rings() {
        let family = family();
        let limit = |name: &str, parameter: &str, values: &[(&str, f64)]| {
            let all = [values, &[("m", 20.0)]].concat();
            let model = model(&family, &["mass", "coulomb", name], &all);
            let term = *model.terms.last().unwrap();
            let parameters = &family.terms[term].parameters;
            let k = parameters.iter().position(|p| p.name == parameter).unwrap();
            let mass = model.values[0];
            (family.limits(&model, term, k).1, parameters[k].upper, mass)
        };
        let (most, _, mass) = limit("load-friction:both", "c", &[]);
        assert_eq!(most, 0.9 * mass);
        let (most, searched, _) = limit("load-friction:both", "mu", &[]);
        assert_eq!(most, searched);
        // A drift without end is a level where the model has no other.
        let (beside_level, searched, _) = limit("drift", "tau", &[]);
        assert_eq!(beside_level, searched);
        let alone = model(&family, &["mass", "viscous", "drift"], &[("m", 20.0)]);
        let time = family.recording.time();
        let duration = time[time.len() - 1] - time[0];
        assert_eq!(family.limits(&alone, alone.terms[2], 2).1, duration);
        let level = &family.terms[alone.terms[2]].parameters[0];
        assert_eq!(family.limits(&alone, alone.terms[2], 0).1, level.upper);
        // Both bodies swing against each other, the lighter the more: what is behind damps more than it seems.
        let (alone, ..) = limit("flexible-coupling", "zeta", &[("m_L", 1e-9)]);
        assert!((alone - 0.383).abs() < 1e-6);
        let (behind, _, mass) = limit("flexible-coupling", "zeta", &[("m_L", 10.0)]);
        assert!((behind / (0.383 / (1.0 + 10.0 / mass).sqrt()) - 1.0).abs() < 1e-12);
    }

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

    #[test]
    fn what_neither_counts_nor_samples_show_is_none() {
        let family = family();
        let count = 12.0f64.sqrt() * family.position_deviation();
        let gap = |b: f64| said(&family, "backlash:two-mass", &[("k", 1e9), ("b", b)]);
        assert_eq!(gap(2.1 * count), None);
        assert!(matches!(gap(1.9 * count), Some(Refusal::NotThatEffect { limit, meaning, .. })
            if meaning.contains("two counts") && (limit / count - 2.0).abs() < 1e-9));
        let term = family.terms.iter().find(|term| term.name == "flexible-coupling").unwrap();
        let most = term.parameters.iter().find(|p| p.name == "f").unwrap().upper;
        let coupling = |f: f64| said(&family, "flexible-coupling", &[("f", f)]);
        assert_eq!(coupling(0.9 * most), None);
        assert!(matches!(coupling(most), Some(Refusal::NotThatEffect { meaning, .. })
            if meaning.contains("as fast as it may")));
    }
}
