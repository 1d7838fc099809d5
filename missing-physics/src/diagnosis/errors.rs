//! Every error of a model.

use std::collections::BTreeMap;

use crate::family::ModelFamily;
use crate::fit::Fit;
use crate::report::{NamedError, SplitError};
use crate::statistics::split::Split;

/// Every error of a model: of the compared quantity, absolute and relative, and in the family's
/// other views.
pub fn errors(family: &dyn ModelFamily, fit: &Fit, split: &Split) -> BTreeMap<String, NamedError> {
    let quantity = family.quantity();
    let rms = split.rms(&fit.residual);
    let size = split.rms(family.target());
    let part = |error: f64, of: f64| if of > 0.0 { error / of } else { 0.0 };
    let relative = SplitError {
        fit: part(rms.fit, size.fit),
        validation: part(rms.validation, size.validation),
    };
    let mut errors = family.views(&fit.model, split);
    errors.push(NamedError::absolute(&quantity.name, &quantity.unit, rms));
    errors.push(NamedError::relative(&quantity.name, relative));
    errors.into_iter().map(|error| (error.key(), error)).collect()
}

/// Key of the relative error.
pub fn relative_key(family: &dyn ModelFamily) -> String {
    crate::report::relative_key(&family.quantity().name)
}
