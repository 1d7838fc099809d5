//! Forms of effects one sample ahead: which one is more flexible, and where it begins.

use missing_physics::Fitted;
use missing_physics::family::Trial;
use missing_physics::report::{NamedValue, Refusal};

use super::FrictionFamily;
use crate::effects::{AsFound, Effect, Refused};

/// Share of the mass that a second body begins with.
const SECOND_MASS: f64 = 0.5;
/// Shares of the friction that it is tried with, behind a coupling and behind a gap.
const SHARES: [f64; 2] = [0.35, 0.6];
const BEHIND_GAP: [f64; 3] = [0.35, 0.55, 0.75];
/// Trial frequencies of a coupling, from the lowest, Hz, to this share of the sampling frequency.
const FREQUENCIES: (usize, f64, f64) = (10, 3.0, 0.25);
/// Trial gaps of a backlash, from this many standard deviations of the position to a share of the stroke.
const GAPS: (usize, f64, f64) = (16, 4.0, 0.01);
/// Frequency of the contact at the end of a gap, Hz, and damping of contact and coupling.
const CONTACT: f64 = 150.0;
const DAMPING: (f64, f64) = (0.1, 0.05);

impl FrictionFamily {
    /// Whether a term is a second body with friction of its own.
    pub(super) fn is_second_body(&self, term: usize) -> bool {
        self.terms[term].parameters.iter().any(|p| p.name == "F_L")
            && self.terms[term].name.contains(':')
    }

    /// Whether a term is tried by itself, not only in the place of another form.
    pub(super) fn is_candidate(&self, term: usize) -> bool {
        term.checked_sub(1).is_none_or(|index| !self.effects[index].is_only_flexible())
    }

    /// The model with a term in its more flexible form, beginning where it is.
    pub(super) fn in_flexible_form(&self, model: &Fitted, term: usize) -> Option<Fitted> {
        let name = self.terms[term].name.as_str();
        let to = self.effects[term.checked_sub(1)?].flexible_form()?;
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
        match self.terms[to].name.as_str() {
            "stribeck:free" => {
                let law = |v: f64| hump(name, known("dF"), known("v_s"), known("delta"), v);
                let end = law(self.top_speed);
                for (k, share) in KNOTS.iter().enumerate() {
                    set(&format!("c_{k}"), law(share * self.top_speed) - end);
                }
                self.change(&mut base, "coulomb", "F_C", |level| level + end);
            }
            "presliding:free" => {
                let level = self.value(&base, "coulomb", "F_C").unwrap_or(1.0);
                if let Some(stiffness) = known("k_t") {
                    set("d", 1.5 * level / stiffness);
                }
            }
            "load-friction:both" => {
                set("mu", known("mu").unwrap_or(0.0));
                set("c", known("c").unwrap_or(0.0));
            }
            "actuator-lag:second-order" => set("zeta", 1.0),
            _ => {}
        }
        Some(base.with(to, &values))
    }

    /// Ways to begin with a second body, where the term is one.
    pub(super) fn two_masses(&self, model: &Fitted, term: usize) -> Option<Vec<Trial>> {
        let sampling = 1.0 / self.recording.interval();
        let spread = |(count, low, high): (usize, f64, f64)| -> Vec<f64> {
            let part = |k: usize| k as f64 / (count - 1) as f64;
            (0..count).map(|k| low * (high / low).powf(part(k))).collect()
        };
        let shapes: Vec<Vec<(&str, f64)>> = match self.terms[term].name.as_str() {
            "flexible-coupling:friction" | "flexible-coupling:load" => {
                let (count, low, share) = FREQUENCIES;
                let line = spread((count, low, (share * sampling).max(2.0 * low)));
                line.iter().map(|f| vec![("f", *f), ("zeta", DAMPING.1)]).collect()
            }
            "backlash:two-mass" => {
                let (count, deviations, share) = GAPS;
                let least = deviations * self.position_deviation();
                let most = (share * (self.stroke.1 - self.stroke.0)).max(2.0 * least);
                let line = spread((count, least, most));
                line.iter().map(|b| vec![("b", *b), ("zeta", DAMPING.0)]).collect()
            }
            _ => return None,
        };
        Some(self.second_bodies(model, term, &shapes))
    }

    fn second_bodies(
        &self,
        model: &Fitted,
        term: usize,
        shapes: &[Vec<(&str, f64)>],
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
        let shares =
            if parameters.iter().any(|p| p.name == "b") { &BEHIND_GAP[..] } else { &SHARES };
        for &share in shares {
            for shape in shapes {
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
                    _ => shape.iter().find(|(known, _)| *known == name).map(|(_, value)| *value),
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
        let Some(&term) = model.terms.last().filter(|term| self.is_second_body(**term)) else {
            return Vec::new();
        };
        let name = self.terms[term].name.clone();
        let (length, factors) = if self.place(model, &name, "b").is_some() {
            ("b", [0.75, 0.9, 1.0, 1.12, 1.35])
        } else {
            ("f", [0.75, 0.88, 1.0, 1.14, 1.33])
        };
        let friction = [("F_L", "coulomb", "F_C"), ("d_L", "viscous", "F_v")];
        let mut all = Vec::new();
        for factor in factors {
            for share in std::iter::once(None).chain(BEHIND_GAP.map(Some)) {
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
        let Some(&term) = model.terms.last().filter(|term| self.is_second_body(**term)) else {
            return Vec::new();
        };
        let name = self.terms[term].name.as_str();
        let of = |parameter: &str| self.value(model, name, parameter).unwrap_or(0.0);
        let tau = std::f64::consts::TAU;
        let others: &[&str] = match name {
            "backlash:two-mass" => &["flexible-coupling:friction"],
            "flexible-coupling:friction" => &["backlash:two-mass"],
            _ => &[],
        };
        let each = |other: &&str| {
            let to = self.terms.iter().position(|term| term.name == **other)?;
            let deviation = self.position_deviation();
            let value = |parameter: &str| match parameter {
                "f" => (of("k") / of("m_L").max(f64::MIN_POSITIVE)).sqrt() / tau,
                "k" => of("m_L") * (tau * of("f")).powi(2),
                "b" => GAPS.1 * deviation,
                known => of(known),
            };
            let values = self.terms[to].parameters.iter();
            let values: Vec<f64> = values.map(|p| value(&p.name).clamp(p.lower, p.upper)).collect();
            Some(model.without(self, term).with(to, &values))
        };
        others.iter().filter_map(each).collect()
    }

    /// A term that is no such effect as it was fitted, and why.
    pub(super) fn vanishes(&self, model: &Fitted) -> Option<(usize, Refusal)> {
        let vanished = self.given.as_ref().and_then(|given| given.vanishes(self, model));
        vanished.or_else(|| {
            model.terms.iter().enumerate().find_map(|(place, term)| {
                let effect = self.effects[term.checked_sub(1)?];
                let (values, least) =
                    self.in_full(effect, *term, &model.values[model.range(self, place)]);
                let found = AsFound {
                    values: &values,
                    least: &least,
                    mass: self.mass_of(model),
                    force: self.force(),
                };
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

    /// Values of a term with those that are known from elsewhere, in the order of its effect's table, and the limits of
    /// their search below.
    fn in_full(&self, effect: &dyn Effect, term: usize, fitted: &[f64]) -> (Vec<f64>, Vec<f64>) {
        let parameters = &self.terms[term].parameters;
        let table = effect.about().parameters.iter().filter(|p| !super::limits::is_fixed(p));
        table
            .filter_map(|p| match parameters.iter().position(|free| free.name == p.name) {
                Some(k) => Some((fitted[k], parameters[k].lower)),
                None => Some((self.known_value(effect, p.name)?, 0.0)),
            })
            .unzip()
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

/// Knots of `stribeck:free` in shares of the top speed.
const KNOTS: [f64; 9] = [0.0, 0.001, 0.003, 0.008, 0.016, 0.03, 0.06, 0.12, 0.3];

/// Level of a Stribeck hump of any form at a speed.
fn hump(form: &str, height: Option<f64>, speed: Option<f64>, exponent: Option<f64>, v: f64) -> f64 {
    let ratio = v / speed.unwrap_or(1e-3);
    let share = match form {
        "stribeck:gaussian" => (-ratio * ratio).exp(),
        "stribeck:exponential" => (-ratio.powf(exponent.unwrap_or(1.0))).exp(),
        _ => 1.0 / (1.0 + ratio * ratio),
    };
    height.unwrap_or(0.0) * share
}

#[cfg(test)]
mod tests {
    use missing_physics::{Channel, Recording, TermParameter};

    use super::*;
    use crate::family::Options;

    /// A mass of 20 kg on a sine with counts of 1 um, 20 N (rms) at 1 ms.
    fn family() -> FrictionFamily {
        let time: Vec<f64> = (0..4000).map(|k| f64::from(k) * 1e-3).collect();
        let (w, size) = (2.0 * std::f64::consts::PI, 0.0358);
        let position = time.iter().map(|t| (size * (w * t).sin() / 1e-6).round() * 1e-6);
        let force = time.iter().map(|t| -20.0 * size * w * w * (w * t).sin());
        let channel = |name: &str, unit: &str, values: Vec<f64>| Channel::new(name, unit, values);
        let channels = vec![
            channel("force", "N", force.collect()),
            channel("position", "m", position.collect()),
        ];
        let recording = Recording::new("sine", time.clone(), channels).unwrap();
        FrictionFamily::new(&recording, &Options::default()).unwrap()
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
        let (refused, why) = family.vanishes(&model)?;
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
        }
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
}
