//! Ways to begin with a term: its shapes, each with its amplitudes free.

use super::ahead::Trial;
use super::fitted::Fitted;
use super::model_family::ModelFamily;
use super::shapes;
use super::term::Role;

/// The trials that shapes of a term make with its amplitudes.
pub fn trials(
    family: &dyn ModelFamily,
    model: &Fitted,
    term: usize,
    shapes: &[Vec<f64>],
) -> Vec<Trial> {
    let about = &family.terms()[term];
    let first = model.values.len();
    let amplitude = |k: &usize| about.parameters[*k].role == Role::Amplitude;
    let free: Vec<usize> = (0..about.parameters.len()).filter(amplitude).collect();
    shapes
        .iter()
        .map(|shape| Trial {
            model: model.with(term, &shapes::assemble(about, shape, &[])),
            amplitudes: free.iter().map(|k| (first + k, about.parameters[*k].start)).collect(),
        })
        .collect()
}
