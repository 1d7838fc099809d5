//! Where a second body begins, and its other valleys.

use missing_physics::Fitted;
use missing_physics::family::Trial;

use crate::effects::{Along, SecondBody};
use crate::family::FrictionFamily;

/// Share of the mass that a second body begins with.
const SECOND_MASS: f64 = 0.5;
/// Frequency of the contact at the end of a gap, Hz.
const CONTACT: f64 = 150.0;
/// Shares of the friction that a second body takes over in other valleys.
const SHARES: [f64; 3] = [0.35, 0.55, 0.75];

impl FrictionFamily {
    /// What a term says of itself as a second body.
    fn second_body(&self, term: usize) -> Option<&'static SecondBody> {
        self.effects[term.checked_sub(1)?].second_body()
    }

    /// Whether a term is a second body whose friction is fitted.
    pub(in crate::family) fn is_second_body(&self, term: usize) -> bool {
        self.second_body(term).is_some()
            && self.terms[term].parameters.iter().any(|p| p.name == "F_L")
    }

    /// Ways to begin with a second body, where the term is one.
    pub(in crate::family) fn two_masses(&self, model: &Fitted, term: usize) -> Option<Vec<Trial>> {
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

    /// The model with its second body, if that is the last term, at other gaps or frequencies and with other shares
    /// of the friction.
    pub(super) fn other_second_bodies(&self, model: &Fitted) -> Vec<Fitted> {
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
    pub(in crate::family) fn related_second_bodies(&self, model: &Fitted) -> Vec<Fitted> {
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

    /// The last term of a model, if it is a second body.
    fn last_second_body(&self, model: &Fitted) -> Option<(usize, &'static SecondBody)> {
        let &term = model.terms.last().filter(|term| self.is_second_body(**term))?;
        Some((term, self.second_body(term)?))
    }
}
