//! What the force does between two samples, decided by what predicts better.
//!
//! A command that is held from sample to sample and read as if it were sampled shows half a sample of delay, which
//! is no physics of the drive.

use missing_physics::ahead::beam::{Search, Thresholds};
use missing_physics::ahead::{node::Node, statistics};
use missing_physics::{Hold, ModelFamily, Recording, discover, search};

use super::{FrictionFamily, Options, PreparationError};

/// Effects of the model by which it is decided.
const SIMPLE: [&str; 3] = ["coulomb", "viscous", "offset"];
/// Degrees of freedom of the errors.
const FREEDOM: f64 = 2.0;

/// What was decided about the force between samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HoldChoice {
    /// What predicts better.
    pub hold: Hold,
    /// Log-likelihood over that of the other, nats.
    pub nats: f64,
}

/// The family of a recording whose hold nobody stated, with the one that predicts better.
pub(super) fn decided(
    recording: &Recording,
    options: &Options,
) -> Result<FrictionFamily, PreparationError> {
    let with = |hold: Hold| FrictionFamily::as_recorded(&recording.clone().with_hold(hold), options);
    let (sampled, held) = (with(Hold::Sampled)?, with(Hold::ZeroOrder)?);
    let (Some(a), Some(b)) = (simple(&sampled), simple(&held)) else { return Ok(sampled) };
    // An effect that the simple model lacks makes large errors at some moments, whatever the hold: errors of
    // Student's distribution let the many calm moments decide.
    let scale = statistics::spread(&a.errors).min(statistics::spread(&b.errors));
    let loss = |node: &Node| -> f64 {
        let each = node.errors.iter().map(|e| (e / scale).powi(2) / FREEDOM);
        0.5 * (FREEDOM + 1.0) * each.map(f64::ln_1p).sum::<f64>() / node.correlation()
    };
    let nats = loss(&a) - loss(&b);
    let (hold, mut family) =
        if nats > 0.0 { (Hold::ZeroOrder, held) } else { (Hold::Sampled, sampled) };
    family.hold = Some(HoldChoice { hold, nats: nats.abs() });
    Ok(family)
}

/// The simplest model at its best.
fn simple(family: &FrictionFamily) -> Option<Node> {
    let part = family.ahead_in_part();
    let whole = family.ahead()?;
    let ahead = part.as_deref().unwrap_or(&*whole);
    let known = |name: &&&str| family.terms().iter().any(|term| term.name == ***name);
    let names: Vec<String> = SIMPLE.iter().filter(known).map(|name| (*name).to_owned()).collect();
    let terms = discover::terms(family, &names).ok()?;
    let everywhere = vec![1.0; family.target().len()];
    let start = search::identify(family, &terms, &everywhere, 1).fit.model;
    let mut observer = ();
    let search =
        Search::new(family, ahead, Thresholds::default(), Vec::new(), &|| false, &mut observer);
    Some(search.base(start))
}
