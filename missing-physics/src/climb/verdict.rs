//! What the data say in the end, and how sure that is.

use std::fmt::Write;

use crate::climb::grounds::{CONTRADICTION, Grounds};
use crate::climb::ladder::Ladder;
use crate::climb::limits::limits;
use crate::diagnosis::{self, generic, noise, where_it_fails};
use crate::family::ModelFamily;
use crate::fit::Fit;
use crate::report::{Disagreement, Discovery, NamedError, Rung, Verdict, Where, floor_key};
use crate::statistics::split::Split;

/// A residual that depends on a coordinate with at most this p-value may be structure.
const STRUCTURE: f64 = 0.005;
/// It is, where its share of the squared error, times the share of that which is not noise, is at least
/// this. Along time the floor does not count: what changes with time is part of it.
const SHARE: f64 = 0.08;
/// Effects are only named where they remove at least this share of what is not noise, or
/// leave no structure.
const MOST: f64 = 0.5;

/// Where the held-out blocks err by this factor more than the fitted ones, something acts there that hardly
/// acts in the others.
const UNEVEN: f64 = 2.0;

/// The place at which structure stands out of the noise, if any.
fn structure<'a, F: ModelFamily + ?Sized>(
    family: &F,
    places: &'a [Where],
    left: f64,
    floor: f64,
) -> Option<&'a Where> {
    let is_time = |place: &Where| {
        let named = family.coordinates().iter().find(|c| c.name == place.coordinate);
        named.is_some_and(where_it_fails::only_grows)
    };
    let above = 1.0 - (floor / left).powi(2).min(1.0);
    places.iter().find(|place| {
        let above = if is_time(place) { 1.0 } else { above };
        place.p_value <= STRUCTURE && place.share * above >= SHARE
    })
}

/// Whether what has been added removes little of what is not noise and leaves structure: then the nearest
/// effects of the library are not the cause.
pub fn explains_little<F: ModelFamily + ?Sized>(
    family: &F,
    split: &Split,
    evidence: &Grounds<'_>,
) -> bool {
    let floor = noise::floor_of(family, &evidence.last.residual);
    let rms = |fit: &Fit| split.rms(&fit.residual).validation;
    let (before, left) = (rms(evidence.base), rms(evidence.last));
    let excess = |rms: f64| (rms * rms - floor * floor).max(0.0);
    structure(family, &evidence.where_last, left, floor).is_some()
        && excess(left) > (1.0 - MOST) * excess(before)
}

/// Effects with which another view than that of `quantity` grows, on fitted and held-out data alike, though
/// the error of `quantity` fell by more.
fn contradictions(rungs: &[Rung], quantity: &str) -> Vec<Disagreement> {
    let mut found = Vec::new();
    for pair in rungs.windows(2).filter(|pair| !pair[1].added.is_empty()) {
        for (key, after) in pair[1].error.iter().filter(|(_, error)| error.quantity != quantity) {
            let grown = |before: &&NamedError| {
                after.fit > CONTRADICTION * before.fit
                    && after.validation > CONTRADICTION * before.validation
            };
            let Some(before) = pair[0].error.get(key).filter(grown) else { continue };
            found.push(Disagreement {
                added: pair[1].added.clone(),
                compared: quantity.to_owned(),
                view: after.quantity.clone(),
                unit: after.unit.clone(),
                before: before.validation,
                after: after.validation,
            });
        }
    }
    found
}

/// The report, but for seed and time.
pub fn report<F: ModelFamily + ?Sized>(
    family: &F,
    ladder: Ladder<'_, F>,
    evidence: &Grounds<'_>,
) -> Discovery {
    let ambiguous = ladder.ambiguous();
    let (rungs, ranking, added, split) = ladder.into_parts();
    let quantity = family.quantity();
    let floor = noise::floor_of(family, &evidence.last.residual);
    let mut noise_floor = family.noise();
    noise_floor.insert(floor_key(&quantity.name, &quantity.unit), floor);

    let error = split.rms(&evidence.last.residual);
    let left = error.validation;
    let uneven = error.fit > 0.0 && left > UNEVEN * error.fit;
    let structure = structure(family, &evidence.where_last, left, floor);
    let moves = structure.is_some() && evidence.within_noise.is_empty();
    let verdict = match (added.is_empty(), moves || uneven) {
        (true, false) => Verdict::NothingMissing,
        (true, true) => Verdict::Unexplained,
        (false, _) if ambiguous.is_empty() => Verdict::EffectsFound,
        (false, _) => Verdict::Ambiguous,
    };
    let relative = |rung: usize| {
        rungs[rung]
            .error
            .get(&diagnosis::relative_key(family))
            .map_or(0.0, |e| 100.0 * e.validation)
    };
    let mut summary = match verdict {
        Verdict::NothingMissing => format!(
            "Nothing is missing: the base model leaves {:.2} % of the {}, and no effect of the \
             library removes more of it than chance does.",
            relative(0),
            quantity.name
        ),
        Verdict::Unexplained => format!(
            "The model leaves {:.2} % of the {}, and no effect of the library explains it.",
            relative(0),
            quantity.name
        ),
        Verdict::EffectsFound | Verdict::Ambiguous | Verdict::Stopped => format!(
            "Missing: {}. With it the held-out error falls from {:.2} % to {:.2} % of the {}.",
            added.join(", "),
            relative(0),
            relative(rungs.len() - 1),
            quantity.name
        ),
    };
    if let Some(place) = structure {
        let _ = write!(
            summary,
            " What remains still depends on {} ({:.0} % of it; {}).",
            place.coordinate,
            100.0 * place.share,
            place.in_words()
        );
        if !evidence.within_noise.is_empty() {
            summary.push_str(" The motion shows none of it: that may be the sensor's own.");
        }
    }
    if uneven {
        let place = evidence.where_last.first().filter(|place| place.p_value <= evidence.alpha);
        let place = place.map_or(String::new(), |place| format!(": {}", place.in_words()));
        let _ = write!(
            summary,
            " The held-out part errs {:.1} times as much as the fitted one: something acts there that \
             hardly acts in the rest{place}.",
            left / error.fit
        );
    }
    for choice in &ambiguous {
        let _ = write!(
            summary,
            " This data cannot tell {} apart: {}",
            choice.effects.join(" from "),
            choice.experiment
        );
    }
    let generic_term = structure.and_then(|place| {
        let coordinate = family.coordinates().iter().find(|c| c.name == place.coordinate)?;
        family.generic_term(coordinate, &generic::shape(coordinate, &evidence.last.residual))
    });
    let disagreements = contradictions(&rungs, &quantity.name);
    Discovery {
        verdict,
        summary,
        added,
        ladder: rungs,
        ranking,
        where_it_fails: evidence.where_last.clone(),
        where_base: evidence.where_base.clone(),
        regimes: where_it_fails::regimes(family, &evidence.last.residual),
        regimes_base: where_it_fails::regimes(family, &evidence.base.residual),
        missing_force: None,
        missing_force_base: None,
        ambiguous,
        generic_term,
        noise_floor,
        detection_limits: limits(family, &split, evidence),
        decisions: Vec::new(),
        budget: None,
        untried: Vec::new(),
        seed: 0,
        wall_s: 0.0,
        notes: Vec::new(),
        stopped: evidence.interrupted,
        disagreements,
        diagnosis: None,
        diagnosis_base: None,
        views: Vec::new(),
        confirmation: None,
        surrogates: None,
        plots: family.plots(&evidence.base.model, &evidence.last.model),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::SplitError;

    /// A rung with these errors of the force and of a window, the same on fitted and held-out data.
    fn rung(added: &[&str], force: f64, window: (f64, f64)) -> Rung {
        let both = |fit: f64, validation: f64| SplitError { fit, validation };
        let errors = [
            NamedError::absolute("force", "N", both(force, force)),
            NamedError::absolute("window", "m", both(window.0, window.1)),
        ];
        Rung {
            added: added.iter().map(|name| (*name).to_owned()).collect(),
            effects: Vec::new(),
            parameters: std::collections::BTreeMap::new(),
            error: errors.into_iter().map(|error| (error.key(), error)).collect(),
            p_value: None,
            metrics: None,
            likelihood_gain: None,
            budget: None,
        }
    }

    #[test]
    fn a_view_contradicts_where_it_grows_on_fitted_and_on_held_out_data() {
        let base = rung(&[], 2.0, (1e-6, 1e-6));
        let grown =
            |window| contradictions(&[base.clone(), rung(&["drift"], 1.0, window)], "force");
        let found = grown((1.2e-6, 1.1e-6));
        assert_eq!((found[0].added[0].as_str(), found[0].view.as_str()), ("drift", "window"));
        assert_eq!((found[0].before, found[0].after), (1e-6, 1.1e-6));
        // A few windows, or a few per cent, are no contradiction.
        assert!(grown((1.2e-6, 1e-6)).is_empty() && grown((1e-6, 1.2e-6)).is_empty());
        assert!(grown((1.04e-6, 1.04e-6)).is_empty());
    }

    #[test]
    fn the_compared_error_itself_is_no_other_view_and_without_an_effect_nothing_contradicts() {
        let (base, window) = (rung(&[], 1.0, (1e-6, 1e-6)), (2e-6, 2e-6));
        let worse = rung(&["drift"], 3.0, (1e-6, 1e-6));
        assert!(contradictions(&[base.clone(), worse], "force").is_empty());
        assert!(contradictions(&[base, rung(&[], 1.0, window)], "force").is_empty());
    }
}
