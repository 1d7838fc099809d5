//! Several searches, each to the bottom of its valley: several valleys may fit as well.

use std::collections::BTreeMap;

use aep_core::{Budget, Method, Refined};
use serde::{Serialize, Serializer};

use super::{Free, Identification, IdentifyError, Interval, intervals_over};
use crate::model::Model;

/// Searches from the same start with other seeds.
const SEARCHES: u64 = 3;

/// A free parameter as it was found.
pub struct FoundParameter<'a> {
    /// Its address and the limits of its search.
    pub free: &'a Free,
    /// Its value, SI.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// Its 95 % interval; nothing where the identification was stopped before.
    pub interval: Option<&'a Interval>,
}

/// What several searches found.
pub struct Searched {
    /// What was searched.
    pub free: Vec<Free>,
    /// The best model.
    pub model: Model,
    /// Values of its free parameters.
    pub position: Vec<f64>,
    /// Their 95 % intervals, over all valleys that fit as well; nothing where it was stopped before.
    pub intervals: Option<Vec<Interval>>,
    /// Position error of the best model, m or rad rms.
    pub rms: f64,
    /// Searches that were made.
    pub searches: usize,
}

impl Identification<'_> {
    /// Searches several times and takes the best; once it is stopped what there is.
    ///
    /// # Errors
    /// The method does not fit the task, or nothing could be evaluated.
    pub fn from_several_starts(
        &self,
        method: &dyn Method,
        budget: &Budget,
        seed: u64,
    ) -> Result<Searched, IdentifyError> {
        let mut found: Vec<Refined> = Vec::new();
        for search in 0..SEARCHES {
            if search > 0 && self.is_stopped() {
                break;
            }
            let end = self.run_from(&[self.start()], method, budget.clone(), seed + search)?;
            // Nothing was evaluated where there was no time at all.
            let from = if end.position.is_empty() { self.start() } else { end.position };
            found.push(self.refine_around(&from));
        }
        found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        // The first search is always made.
        let position = found[0].position.clone();
        let optima: Vec<Vec<f64>> = found.iter().map(|found| found.position.clone()).collect();
        // Intervals are refits as well; whoever stops wants to go.
        let intervals = (!self.is_stopped()).then(|| intervals_over(self, &optima));
        let errors = self.errors(&position);
        let rms = (errors.iter().map(|e| e * e).sum::<f64>() / errors.len().max(1) as f64).sqrt();
        let model = self.model(&position)?;
        let free = self.free().to_vec();
        Ok(Searched { free, model, position, intervals, rms, searches: found.len() })
    }
}

impl Searched {
    /// Its free parameters.
    pub fn parameters(&self) -> impl Iterator<Item = FoundParameter<'_>> {
        self.free.iter().zip(&self.position).enumerate().map(|(k, (free, value))| FoundParameter {
            free,
            value: *value,
            unit: self.model.unit(&free.address).unwrap_or_default(),
            interval: self.intervals.as_ref().and_then(|intervals| intervals.get(k)),
        })
    }
}

#[derive(Serialize)]
struct Told {
    parameters: BTreeMap<String, ToldParameter>,
    position_rms: f64,
    searches: usize,
}

#[derive(Serialize)]
struct ToldParameter {
    value: f64,
    low: Option<f64>,
    high: Option<f64>,
    unit: &'static str,
    identifiable: Option<bool>,
}

impl Serialize for Searched {
    /// Parameters by address, the position error and the number of searches; the model is a file of its own.
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let told = |found: FoundParameter<'_>| {
            let interval = found.interval;
            let parameter = ToldParameter {
                value: found.value,
                low: interval.map(|i| i.low),
                high: interval.map(|i| i.high),
                unit: found.unit,
                identifiable: interval.map(|i| i.identifiable),
            };
            (found.free.address.clone(), parameter)
        };
        let parameters = self.parameters().map(told).collect();
        let told = Told { parameters, position_rms: self.rms, searches: self.searches };
        told.serialize(serializer)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Axis;

    #[test]
    fn a_parameter_without_an_interval_is_told_without_one() {
        let model = Model::new(Axis::Linear, 3.0).and_then(|m| m.with("coulomb", &[("F_C", 5.0)]));
        let found = Searched {
            free: vec![Free::log("mass.m", 1.0, 9.0), Free::linear("coulomb.F_C", 0.0, 9.0)],
            model: model.unwrap(),
            position: vec![3.0, 5.0],
            intervals: None,
            rms: 1e-6,
            searches: 1,
        };
        let json = serde_json::to_value(&found).unwrap();
        let coulomb = &json["parameters"]["coulomb.F_C"];
        assert_eq!((&coulomb["value"], &coulomb["unit"]), (&5.0.into(), &"N".into()));
        assert!(coulomb["low"].is_null() && coulomb["identifiable"].is_null());
        let interval =
            |value| Interval { value, low: value - 1.0, high: value + 1.0, identifiable: true };
        let whole = Searched { intervals: Some(vec![interval(3.0), interval(5.0)]), ..found };
        let json = serde_json::to_value(&whole).unwrap();
        assert_eq!(json["parameters"]["mass.m"]["high"], 4.0);
        assert_eq!((&json["position_rms"], &json["searches"]), (&1e-6.into(), &1.into()));
    }
}
