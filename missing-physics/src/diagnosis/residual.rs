//! Everything that the residual of a model says by itself: is it noise, does it follow an input, where
//! along the coordinates does it lie, what in it is periodic.

use rayon::prelude::*;

use crate::diagnosis::{residual_map, spectrum};
use crate::family::ModelFamily;
use crate::fit::Fit;
use crate::report::{Diagnosis, Discovery, Independence, Plot};
use crate::statistics::residual_tests;

/// Looks at the residual of `fit`; the spectra come beside, as plots.
pub fn diagnose(family: &dyn ModelFamily, fit: &Fit, seed: u64) -> (Diagnosis, Vec<Plot>) {
    let (time, residual) = (family.time(), fit.residual.as_slice());
    let (motion, quantity) = (family.motion(), family.quantity());
    // A model that never was a plant may predict anything.
    if !residual.iter().all(|value| value.is_finite()) {
        return Default::default();
    }
    let inputs: Vec<_> = family.coordinates().iter().filter(|c| c.state).collect();
    let mut independence: Vec<Independence> = inputs
        .par_iter()
        .filter_map(|c| {
            residual_tests::independence(&c.name, &c.values, residual, time, &motion, seed)
        })
        .collect();
    independence.sort_by(|a, b| a.p_value.total_cmp(&b.p_value));
    let maps = family
        .coordinates()
        .par_iter()
        .map(|coordinate| residual_map::map(coordinate, residual, time))
        .collect();
    let full = spectrum::full_rate(family, &fit.model, residual);
    let (lines, plots) = spectrum::lines(&full, &quantity.name, &quantity.unit);
    let whiteness = residual_tests::whiteness(residual, time, &family.colour(), 0);
    (Diagnosis { whiteness, independence, maps, lines }, plots)
}

/// Adds the diagnoses of base and last model, and the spectra of the last one, to a report.
pub fn attach(
    family: &dyn ModelFamily,
    base: &Fit,
    last: &Fit,
    seed: u64,
    discovery: &mut Discovery,
) {
    if base.model != last.model {
        discovery.diagnosis_base = Some(diagnose(family, base, seed).0);
    }
    let (diagnosis, spectra) = diagnose(family, last, seed);
    discovery.diagnosis = Some(diagnosis);
    discovery.plots.extend(spectra);
}
