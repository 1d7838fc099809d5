//! What a term adds to a prediction, by differences of two predictions.

use super::fitted::Fitted;
use super::model_family::ModelFamily;
use super::shapes::{amplitudes, assemble};
use super::term::TermParameter;

/// The default of [`ModelFamily::columns`]: differences of two predictions.
pub fn columns<F: ModelFamily + ?Sized>(
    family: &F,
    model: &Fitted,
    prediction: &[f64],
    term: usize,
    shape: &[f64],
) -> Vec<Vec<f64>> {
    let about = &family.terms()[term];
    let sizes: Vec<f64> = amplitudes(about).iter().map(|parameter| unit(parameter)).collect();
    let difference = |amplitude: &[f64], size: f64| {
        let mut column = vec![0.0; prediction.len()];
        family.predict(&model.with(term, &assemble(about, shape, amplitude)), &mut column);
        column.iter_mut().zip(prediction).for_each(|(new, old)| *new = (*new - old) / size);
        column
    };
    if sizes.is_empty() {
        return vec![difference(&[], 1.0)];
    }
    (0..sizes.len())
        .map(|k| {
            let mut amplitude = vec![0.0; sizes.len()];
            amplitude[k] = sizes[k];
            difference(&amplitude, sizes[k])
        })
        .collect()
}

/// A size of an amplitude that is neither nothing nor out of bounds.
fn unit(parameter: &TermParameter) -> f64 {
    if parameter.start == 0.0 { 1.0 } else { parameter.start }
}
