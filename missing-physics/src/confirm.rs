//! Whether what was found on one measurement holds on another one of the same plant.

mod own;

use crate::ahead::compare::Comparison;
use crate::ahead::fit;
use crate::ahead::node::Node;
use crate::diagnosis;
use crate::discover::suggest;
use crate::family::{Ahead, Fitted, ModelFamily, Own};
use crate::fit::as_given;
use crate::report::{Candidate, Confirmation, NamedError, NamedValue, Rung};
use crate::statistics::split::Split;
use crate::task::{DiscoverError, Settings, model_of};

/// Steps of a fit on these recordings.
const STEPS: usize = 10;
/// Another view contradicts an effect where its error grows by more than this factor.
const CONTRADICTION: f64 = 1.05;

/// Every rung of `ladder`, found on another family of the same terms, on `family`; `settings` are those
/// that found it.
///
/// # Errors
/// An effect of the ladder is not among the family's terms.
pub fn confirm<F: ModelFamily + ?Sized>(
    family: &F,
    ladder: &[Rung],
    settings: &Settings<'_>,
) -> Result<Vec<Confirmation>, DiscoverError> {
    if let Some(ahead) = family.ahead() {
        return one_ahead(family, &*ahead, ladder, settings);
    }
    let key = diagnosis::relative_key(family);
    let mut all: Vec<Confirmation> = Vec::new();
    for (k, rung) in ladder.iter().enumerate() {
        let mut here = as_found(family, rung)?;
        if let (false, Some(below)) = (rung.added.is_empty(), k.checked_sub(1)) {
            let grown = |key: &String| here.error[key] / all[below].error[key];
            let less = grown(&key).powi(2) <= 1.0 - settings.least_gain;
            let contradicted = here.error.keys().any(|key| grown(key) > CONTRADICTION);
            here.holds = Some(less && !contradicted);
            anew(family, &ladder[below].effects, &rung.added, settings, &mut here)?;
        }
        all.push(here);
    }
    Ok(all)
}

/// Every rung by its prediction errors: as it was found but for what belongs to a recording, and with all parameters
/// fitted here.
fn one_ahead<F: ModelFamily + ?Sized>(
    family: &F,
    ahead: &dyn Ahead,
    ladder: &[Rung],
    settings: &Settings<'_>,
) -> Result<Vec<Confirmation>, DiscoverError> {
    let comparison = Comparison::new(family, ahead);
    let mut all: Vec<Confirmation> = Vec::new();
    let mut below: Option<(Node, Node)> = None;
    for rung in ladder {
        let model = model_of(family, rung)?;
        let setting = fit::best_setting(ahead, &model);
        let (model, own) = own::adapted(ahead, &model, setting);
        let mut here = as_given_here(family, rung, model.clone());
        let named = |(own, value): (Own, f64)| NamedValue {
            name: own.name.to_owned(),
            value,
            unit: own.unit,
        };
        here.own = own.into_iter().map(named).collect();
        let setting = fit::best_setting(ahead, &model);
        let found = fit::evaluated(ahead, model.clone(), setting);
        let anew = fit::Fitter::new(family, ahead).refit(model, setting, STEPS);
        if let Some((before, before_anew)) = below.filter(|_| !rung.added.is_empty()) {
            let by = comparison.unfitted(&before, &found);
            let gain = comparison.compare(&before_anew, &anew);
            let points = anew.errors.len() as f64 / anew.correlation();
            here.gain = Some(1.0 - (-2.0 * gain.nats / points.max(1.0)).exp());
            here.p_value = Some(by.p_value());
            here.nats = Some(by.nats);
            let seen = by.nats > 0.0 && by.p_value() <= settings.alpha;
            here.holds = Some(seen && gain.nats > settings.thresholds.better);
        }
        below = Some((found, anew));
        all.push(here);
    }
    Ok(all)
}

/// The errors of a rung with the parameters that it has.
fn as_found<F: ModelFamily + ?Sized>(
    family: &F,
    rung: &Rung,
) -> Result<Confirmation, DiscoverError> {
    Ok(as_given_here(family, rung, model_of(family, rung)?))
}

/// The errors of a rung with the parameters of `model`.
fn as_given_here<F: ModelFamily + ?Sized>(family: &F, rung: &Rung, model: Fitted) -> Confirmation {
    let fit = as_given(family, model);
    let points = family.target().len();
    let split = Split::new(points, family.blocks());
    let fitted = split.fit(points).iter().filter(|fit| **fit).count() as f64 / points as f64;
    // No part had a part in the fit; together they are all there is.
    let whole = |error: NamedError| {
        (fitted * error.fit.powi(2) + (1.0 - fitted) * error.validation.powi(2)).sqrt()
    };
    let errors = diagnosis::errors(family, &fit, &split).into_iter();
    Confirmation {
        added: rung.added.clone(),
        effects: rung.effects.clone(),
        error: errors.map(|(name, error)| (name, whole(error))).collect(),
        holds: None,
        gain: None,
        p_value: None,
        nats: None,
        place: None,
        own: Vec::new(),
    }
}

/// What `added` gains on a model of `effects` that is identified on these recordings.
fn anew<F: ModelFamily + ?Sized>(
    family: &F,
    effects: &[String],
    added: &[String],
    settings: &Settings<'_>,
    here: &mut Confirmation,
) -> Result<(), DiscoverError> {
    let base = effects.to_vec();
    let once = Settings { base, most: 0, ..settings.clone() };
    let found = suggest(family, &once, &mut ())?;
    let candidates = found.ranking.first().map_or(&[][..], Vec::as_slice);
    // Another form of the effect may be the one that shows more here.
    let main = |name: &str| {
        let term = family.terms().iter().position(|term| term.name == name)?;
        Some(family.form_of(term).unwrap_or(term))
    };
    // Several that were added together have no single candidate.
    let [added] = added else { return Ok(()) };
    let added = main(added);
    let is_added = |candidate: &&Candidate| added.is_some() && main(&candidate.effect) == added;
    let Some(candidate) = candidates.iter().find(is_added) else { return Ok(()) };
    here.gain = Some(candidate.gain);
    here.p_value = Some(candidate.p_value);
    let likely = candidates.iter().filter(|c| c.p_value <= settings.alpha && c.gain > 0.0);
    here.place = likely.clone().position(|c| is_added(&c)).map(|before| before + 1);
    Ok(())
}
