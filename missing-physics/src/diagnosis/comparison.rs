//! A given model on a recording: its errors and where it fails. Nothing is looked for.

use super::where_it_fails::{Look, coordinates, regimes};
use super::{attach, errors, noise};
use crate::family::ModelFamily;
use crate::fit::{Fit, uncertainty};
use crate::report::{Discovery, Rung, SplitMetrics, Verdict, floor_key};
use crate::statistics::split::Split;
use crate::statistics::weights;

/// What of a family's data is fitted and what is held out.
fn split(family: &dyn ModelFamily) -> Split {
    Split::new(family.target().len(), family.blocks())
}

/// 1 on grid points of blocks that are fitted, 0 on those held out.
pub fn fitted_blocks(family: &dyn ModelFamily) -> Vec<f64> {
    let fitted = split(family).fit(family.target().len());
    fitted.into_iter().map(|fit| f64::from(u8::from(fit))).collect()
}

/// A fit as a rung: its parameters and errors.
pub fn rung(family: &dyn ModelFamily, fit: &Fit, added: &[String]) -> Rung {
    let (split, fitted) = (split(family), fitted_blocks(family));
    let effects = fit.model.terms.iter().map(|&term| &family.terms()[term]);
    Rung {
        added: added.to_vec(),
        effects: effects.filter(|term| !term.always).map(|term| term.name.clone()).collect(),
        parameters: uncertainty::estimates(family, fit, &fitted),
        error: errors(family, fit, &split),
        p_value: None,
        metrics: Some(SplitMetrics::of(&fit.residual, family.target(), &split)),
        likelihood_gain: None,
        budget: None,
    }
}

/// What a fit looks like on this data, as a discovery that looks for nothing: errors, where it
/// fails, noise, curves. Once `is_over` the parts that take long are left out.
pub fn comparison(
    family: &dyn ModelFamily,
    (base, last): (&Fit, &Fit),
    rungs: Vec<Rung>,
    seed: u64,
    is_over: &dyn Fn() -> bool,
) -> Discovery {
    let motion = family.motion();
    let view = |fit: &Fit| {
        if is_over() {
            return Vec::new();
        }
        let weights = weights(family.doubt(), &fit.residual);
        let view = Look { residual: &fit.residual, weights: &weights, motion: &motion, seed };
        coordinates(family, &view)
    };
    let quantity = family.quantity();
    let mut noise_floor = family.noise();
    let floor = noise::floor_of(family, &last.residual);
    noise_floor.insert(floor_key(&quantity.name, &quantity.unit), floor);
    let mut discovery = Discovery {
        verdict: Verdict::NothingMissing,
        added: rungs.iter().flat_map(|rung| rung.added.clone()).collect(),
        ladder: rungs,
        ranking: Vec::new(),
        where_it_fails: view(last),
        where_base: view(base),
        regimes: regimes(family, &last.residual),
        regimes_base: regimes(family, &base.residual),
        missing_force: None,
        missing_force_base: None,
        ambiguous: Vec::new(),
        generic_term: None,
        noise_floor,
        detection_limits: std::collections::BTreeMap::new(),
        decisions: Vec::new(),
        budget: None,
        untried: Vec::new(),
        stopped: false,
        seed,
        wall_s: 0.0,
        remains: Vec::new(),
        most_likely: None,
        remarks: Vec::new(),
        notes: Vec::new(),
        diagnosis: None,
        diagnosis_base: None,
        views: Vec::new(),
        confirmation: None,
        surrogates: None,
        plots: family.plots(&base.model, &last.model),
    };
    if !is_over() {
        attach(family, base, last, seed, &mut discovery);
    }
    if is_over() {
        discovery.stopped = true;
    }
    discovery
}
