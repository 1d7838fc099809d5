//! Models that predict well because they hardly heed the input.
//!
//! Beside a strong effect that is missing, what makes the input matter less predicts better: a mass so large that no force
//! moves it, the process noise doing the rest. From there no effect shows, and what does is none. The balance of forces
//! knows nothing of process noise: where its mass is far from that one the model has gone astray. So it has where hardly any
//! mass is left: then friction alone makes the speed.

use super::scales;
use crate::family::{Fitted, ModelFamily};
use crate::fit;
use crate::report::Astray;

/// Shares of that from which effects are fitted, too: what is missing makes it too large there as well.
const SHARES: [f64; 3] = [1.0, 1.0 / 3.0, 1.0 / 9.0];

/// Other places of what every model has from which effects are fitted: where the base model is far from where it `began`.
pub fn elsewhere(family: &dyn ModelFamily, began: &Fitted, base: &Fitted) -> Vec<Fitted> {
    let known = scales::of(family, base).into_iter().map(|moved| moved.is_known());
    let known: Vec<bool> = known.collect();
    let far = |k: usize| {
        let by = base.values[k] / began.values[k];
        known[k] && !(1.0 / Astray::FAR..=Astray::FAR).contains(&by)
    };
    if !(0..known.len()).any(far) {
        return Vec::new();
    }
    let at = |share: f64| {
        let mut model = began.clone();
        for (value, known) in model.values.iter_mut().zip(&known) {
            *value *= if *known { share } else { 1.0 };
        }
        model.within(family)
    };
    SHARES.map(at).to_vec()
}

/// A start in which what every model has is where a search begins, where the balance makes it as small as it may be: of what
/// it hardly sees it knows nothing, and from there no fit comes back.
pub fn seen(family: &dyn ModelFamily, mut start: Fitted) -> Fitted {
    let moved = scales::of(family, &start);
    let parameters = start.parameters(family).zip(&moved).enumerate();
    let least = parameters.filter_map(|(k, ((_, parameter), moved))| {
        let least = moved.is_known() && moved.is_at_far_limit();
        (least && start.values[k] < parameter.start).then_some((k, parameter.start))
    });
    for (k, begin) in least.collect::<Vec<_>>() {
        start.values[k] = begin;
    }
    start
}

/// What every model has and is far larger in this one than the balance with the same effects makes it, or, asked `either_way`,
/// far smaller or as small as it may be. Noise makes what the balance says too small: what is smaller still is so by more than
/// that. It is asked of what predicts; of residuals the balance is the model itself, and what every model has may be as good as
/// nothing.
pub fn astray(family: &dyn ModelFamily, model: &Fitted, either_way: bool) -> Option<Astray> {
    let near = family.in_part().unwrap_or(family);
    let everywhere = vec![1.0; near.target().len()];
    let balance = fit::refine(near, model.clone().within(near), &everywhere).model;
    let moved = scales::of(family, model);
    let parameters = model.parameters(family).zip(&moved).enumerate();
    let mut known = parameters.filter(|(_, (_, moved))| moved.is_known());
    known.find_map(|(k, ((term, parameter), moved))| {
        let told = Astray {
            parameter: term.key(parameter),
            value: model.values[k],
            balance: balance.values[k],
            unit: parameter.unit.clone(),
        };
        let least = moved.is_at_far_limit() && told.value < parameter.start;
        // What may be negative is no amount that could be too little.
        let amount = parameter.lower >= 0.0;
        let little = either_way && amount && (told.is_too_small() || least);
        (told.is_too_large() || little).then_some(told)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::testing::{DRIVE, Plant, WAVE};

    fn at(drive: f64, wave: f64) -> Fitted {
        let mut model = Plant::model(&[(WAVE, &[wave])]);
        model.values[0] = drive;
        model
    }

    #[test]
    fn effects_are_fitted_from_elsewhere_where_what_every_model_has_changed_by_a_factor() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let drives = |began: f64, ends: f64| -> Vec<f64> {
            let elsewhere = elsewhere(&plant, &at(began, 0.05), &at(ends, 0.05));
            elsewhere.iter().map(|model| model.values[0]).collect()
        };
        for (began, ends) in [(1.0, 4.0), (1.0, 0.2)] {
            assert_eq!(drives(began, ends), [1.0, 1.0 / 3.0, 1.0 / 9.0]);
        }
        assert!(drives(1.0, 2.0).is_empty() && drives(2.0, 1.0).is_empty());
        // An effect of the base may go anywhere.
        assert!(elsewhere(&plant, &at(1.0, 0.01), &at(1.0, 0.5)).is_empty());
    }

    #[test]
    fn what_the_balance_makes_as_small_as_it_may_be_begins_where_searches_do() {
        let plant = Plant::new(1, &[]);
        let drive = plant.terms()[DRIVE].parameters[0].clone();
        let begun = |drive: f64, wave: f64| seen(&plant, at(drive, wave)).values;
        assert_eq!(begun(drive.lower, 0.05), [drive.start, 0.05]);
        assert_eq!(begun(1.0, 0.05), [1.0, 0.05]);
        // Too much is seen, and an effect of the base may be anything.
        assert_eq!(begun(drive.upper, drive.lower), [drive.upper, drive.lower]);
    }

    #[test]
    fn what_every_model_has_is_astray_where_it_is_far_from_what_the_balance_makes_it() {
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let told = astray(&plant, &at(4.0, 0.05), true).unwrap();
        assert_eq!((&*told.parameter, told.value, &*told.unit), ("drive.size", 4.0, "V"));
        assert!((told.balance - 1.0).abs() < 0.01, "{}", told.balance);
        assert_eq!(astray(&plant, &at(2.0, 0.05), true), None);
        assert_eq!(astray(&plant, &at(0.4, 0.05), true), None);
        assert_eq!(astray(&plant, &at(0.3, 0.05), true).unwrap().value, 0.3);
        assert_eq!(astray(&plant, &at(0.3, 0.05), false), None);
        assert_eq!(astray(&plant, &at(1.0, 5.0), true), None);
    }
}
