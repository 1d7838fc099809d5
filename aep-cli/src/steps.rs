//! The steps of the loop that several commands share, as calls of the engine.

use std::path::Path;

use aep_core::{Aep, MetaEp, Method};
use friction_ident::Model;
use friction_ident::family::{FrictionFamily, Options};
use missing_physics::diagnosis::where_it_fails::{View, coordinates, regimes};
use missing_physics::diagnosis::{self, errors, noise};
use missing_physics::fit::{self, Fit, uncertainty};
use missing_physics::measurement::check::cut_at_gaps;
use missing_physics::report::{Rung, SplitMetrics, Verdict, floor_key};
use missing_physics::statistics::split::Split;
use missing_physics::statistics::weights;
use missing_physics::{Coordinate, Discovery, Fitted, ModelFamily, Recording, terms};

use crate::args::library;
use crate::failure::Failure;
use crate::stop::Watch;

mod in_time;
mod stoppable;

pub use in_time::identify_in_time;

use stoppable::Stoppable;

/// A name and what makes the optimizer.
type NamedMethod = (&'static str, fn() -> Box<dyn Method<f64>>);

/// Optimizers by name.
pub const ALGORITHMS: &[NamedMethod] =
    &[("aep", || Box::new(Aep::practical())), ("meta-ep", || Box::new(MetaEp::practical()))];

/// The model family of a recording; nothing is interpolated over its long gaps.
pub fn family(recording: &Recording, bandwidth: Option<f64>) -> Result<FrictionFamily, Failure> {
    let whole = cut_at_gaps(recording).map_err(|error| Failure::bad_input(error.to_string()))?;
    Ok(FrictionFamily::new(&whole, &options(bandwidth))?)
}

/// How a recording is prepared.
pub fn options(bandwidth: Option<f64>) -> Options {
    Options { bandwidth, library: library() }
}

/// Reads MODEL.json.
pub fn read_model(path: &Path) -> Result<Model, Failure> {
    let text = std::fs::read_to_string(path).map_err(|error| {
        Failure::bad_input(format!("cannot read the model: {error}")).in_file(path).with_hint(
            "'aep identify DATA --effects coulomb,viscous,offset -o MODEL.json' makes one",
        )
    })?;
    Model::from_json(&text, &library()).map_err(|error| Failure::from(error).in_file(path))
}

/// The blocks of a family that are fitted, as weights, and the split they come from.
fn split(family: &FrictionFamily) -> (Split, Vec<f64>) {
    let points = family.target().len();
    let split = Split::new(points, family.blocks());
    let fitted = split.fit(points).into_iter().map(|fit| f64::from(u8::from(fit))).collect();
    (split, fitted)
}

/// Identifies a model of these effects on the fitted blocks; once `watch` is over the best one so far is
/// taken.
pub fn identify(
    family: &FrictionFamily,
    effects: &[String],
    (method, seed): (&dyn Method<f64>, u64),
    watch: Watch,
) -> Result<(Fit, usize), Failure> {
    let terms = terms(family, effects)?;
    let (_, fitted) = split(family);
    let method = Stoppable { method, watch };
    let found = fit::identify_by(family, &terms, &fitted, seed, &method);
    Ok((found.fit, found.evaluations))
}

/// The optimizer of this name.
pub fn method(name: &str) -> Result<Box<dyn Method<f64>>, Failure> {
    let known = ALGORITHMS.iter().find(|(known, _)| *known == name);
    let known = known.ok_or_else(|| Failure::bad_input(format!("unknown algorithm '{name}'")))?;
    Ok(known.1())
}

/// A given model on this data, nothing fitted.
pub fn as_given(family: &FrictionFamily, model: &Model) -> Result<Fit, Failure> {
    same_axis(family, model)?;
    Ok(fit::as_given(family, family.fitted(model)?))
}

/// Refuses a model of a linear axis for rotary data and the other way round.
pub fn same_axis(family: &FrictionFamily, model: &Model) -> Result<(), Failure> {
    if model.axis() == family.axis() {
        return Ok(());
    }
    Err(other_axis())
}

/// Refuses recordings of a linear axis next to those of a rotary one.
pub fn same_axes(family: &FrictionFamily, other: &FrictionFamily) -> Result<(), Failure> {
    if family.axis() == other.axis() {
        return Ok(());
    }
    let what = "one of the recordings is of a linear axis, the other of a rotary one";
    Err(Failure::bad_input(what).with_hint("give --validate recordings of the same drive"))
}

/// The failure of a model and data that do not belong together.
pub fn other_axis() -> Failure {
    let what = "one of model and data is of a linear axis, the other of a rotary one";
    Failure::bad_input(what).with_hint("identify a model on this data with 'aep identify'")
}

/// A fit as a rung: its parameters and errors.
pub fn rung(family: &FrictionFamily, fit: &Fit, added: &[String]) -> Rung {
    let (split, fitted) = split(family);
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
/// fails, noise, curves. Once `watch` is over the parts that take long are left out.
pub fn comparison(
    family: &FrictionFamily,
    (base, last): (&Fit, &Fit),
    rungs: Vec<Rung>,
    seed: u64,
    watch: Watch,
) -> Discovery {
    let motion = family.motion();
    let view = |fit: &Fit| {
        if watch.is_over() {
            return Vec::new();
        }
        let weights = weights(family.doubt(), &fit.residual);
        coordinates(
            family,
            &View { residual: &fit.residual, weights: &weights, motion: &motion, seed },
        )
    };
    let quantity = family.quantity();
    let state: Vec<Coordinate> = family.coordinates().iter().filter(|c| c.state).cloned().collect();
    let mut noise_floor = family.noise();
    let floor = noise::floor(&last.residual, &state);
    noise_floor.insert(floor_key(&quantity.name, &quantity.unit), floor);
    let mut discovery = Discovery {
        verdict: Verdict::NothingMissing,
        summary: String::new(),
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
        disagreements: Vec::new(),
        seed,
        wall_s: 0.0,
        notes: Vec::new(),
        diagnosis: None,
        diagnosis_base: None,
        views: Vec::new(),
        confirmation: None,
        surrogates: None,
        plots: family.plots(&base.model, &last.model),
    };
    if !watch.is_over() {
        diagnosis::attach(family, base, last, seed, &mut discovery);
    }
    if watch.is_over() {
        discovery.stopped = true;
    }
    discovery
}

/// The plant that a rung describes.
pub fn model(family: &FrictionFamily, rung: &Rung) -> Result<Model, Failure> {
    let indices = terms(family, &rung.effects)?;
    let values = indices.iter().flat_map(|&index| {
        let term = &family.terms()[index];
        term.parameters.iter().map(|parameter| {
            let start = parameter.start;
            rung.parameters.get(&term.key(parameter)).map_or(start, |estimate| estimate.value)
        })
    });
    let values = values.collect();
    Ok(family.model(&Fitted { terms: indices, values })?)
}
