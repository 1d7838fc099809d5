//! Whether what was found on one measurement holds on another one of the same plant.

mod own;

use crate::ahead::Residuals;
use crate::ahead::compare::Comparison;
use crate::ahead::fit;
use crate::ahead::node::Node;
use crate::diagnosis;
use crate::family::{Ahead, Fitted, ModelFamily, Own, on_view};
use crate::fit::as_given;
use crate::report::{Confirmation, NamedError, NamedValue, Rung};
use crate::statistics::split::Split;
use crate::task::{DiscoverError, Settings, model_of};

/// Steps of a fit on these recordings.
const STEPS: usize = 10;

/// Every rung of `ladder`, found on another family of the same terms, on `family`; `settings` are those
/// that found it.
///
/// # Errors
/// An effect of the ladder is not among the family's terms.
pub fn confirm(
    family: &dyn ModelFamily,
    ladder: &[Rung],
    settings: &Settings<'_>,
) -> Result<Vec<Confirmation>, DiscoverError> {
    if let Some(ahead) = family.ahead() {
        return one_ahead(family, &*ahead, ladder, settings);
    }
    // What the last model leaves here shows the noise.
    let Some(last) = ladder.last() else { return Ok(Vec::new()) };
    let ahead = Residuals::new(family, &model_of(family, last)?);
    one_ahead(family, &ahead, ladder, settings)
}

/// Every rung by its prediction errors: as it was found but for what belongs to a recording, and with all parameters
/// fitted here.
fn one_ahead(
    family: &dyn ModelFamily,
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
        let mut here = as_it_is(family, rung, model.clone());
        let named = |(own, value): (Own, f64)| NamedValue {
            name: own.name.to_owned(),
            value,
            unit: own.unit,
        };
        let setting = if own.is_empty() { setting } else { fit::best_setting(ahead, &model) };
        here.own = own.into_iter().map(named).collect();
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
            let better = settings.thresholds.in_part(ahead.asked()).better;
            here.holds = Some(seen && gain.nats > better);
        }
        below = Some((found, anew));
        all.push(here);
    }
    Ok(all)
}

/// The errors of a rung with the parameters of `model`.
fn as_it_is(family: &dyn ModelFamily, rung: &Rung, model: Fitted) -> Confirmation {
    let family = on_view(family);
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
        own: Vec::new(),
    }
}
