//! A discovery as JSON: its numbers, and beside them the sentences that people read.

use missing_physics::Discovery;
use missing_physics::measurement::check::DataCheck;
use missing_physics::report::{Combinations, Diagnosis, View};
use serde_json::{Value, json};

use crate::words;

/// The discovery by the published schema ([`missing_physics::report::SCHEMA`]): what
/// [`Discovery`] holds, with `summary`, `notes`, the reason of a decision, name and note of a line and the experiment of
/// an ambiguity in words. Curves of the page are left out.
///
/// # Errors
/// A value that JSON cannot hold.
pub fn json(discovery: &Discovery) -> serde_json::Result<Value> {
    let bare = Discovery { plots: Vec::new(), ..discovery.clone() };
    let mut json = serde_json::to_value(bare)?;
    json["summary"] = json!(words::summary(discovery));
    json["notes"] = json!(words::notes(discovery));
    for (k, decision) in discovery.decisions.iter().enumerate() {
        if let Some(reason) = words::reason(decision) {
            json["decisions"][k]["reason"] = json!(reason);
        }
    }
    for (k, choice) in discovery.ambiguous.iter().enumerate() {
        json["ambiguous"][k]["experiment"] = json!(words::experiment(choice));
    }
    for (key, of) in
        [("diagnosis", &discovery.diagnosis), ("diagnosis_base", &discovery.diagnosis_base)]
    {
        if let Some(of) = of {
            lines(&mut json[key], of);
        }
    }
    Ok(json)
}

/// What is to be known of the data, with severity and sentence (`text`) beside each finding.
///
/// # Errors
/// As [`json()`].
fn data(check: &DataCheck) -> serde_json::Result<Value> {
    let mut json = serde_json::to_value(check)?;
    for (k, finding) in check.findings.iter().enumerate() {
        json["findings"][k]["severity"] = json!(finding.severity());
        json["findings"][k]["text"] = json!(words::finding(finding));
    }
    Ok(json)
}

/// The last rung of a comparison with where it fails: no verdict.
///
/// # Errors
/// As [`json()`].
pub fn comparison(discovery: &Discovery) -> serde_json::Result<Value> {
    let last = discovery.ladder.last();
    let diagnosis = discovery.diagnosis.as_ref().map(diagnosis).transpose()?;
    Ok(json!({
        "effects": last.map(|rung| &rung.effects),
        "parameters": last.map(|rung| &rung.parameters),
        "error": last.map(|rung| &rung.error),
        "where": discovery.where_it_fails,
        "regimes": discovery.regimes,
        "noise_floor": discovery.noise_floor,
        "metrics": last.and_then(|rung| rung.metrics),
        "views": views(&discovery.views)?,
        "diagnosis": diagnosis,
        "notes": words::notes(discovery),
        "ladder": discovery.ladder,
        "seed": discovery.seed,
    }))
}

/// Views with what they compare and why their numbers must not be taken as they are, in words.
///
/// # Errors
/// As [`json()`].
pub fn views(views: &[View]) -> serde_json::Result<Value> {
    let mut json = serde_json::to_value(views)?;
    for (k, view) in views.iter().enumerate() {
        json[k]["about"] = json!(words::compares(view));
        json[k]["warnings"] = json!(words::caveat(view).into_iter().collect::<Vec<_>>());
    }
    Ok(json)
}

/// What stands in the JSON beside what was found.
#[derive(Clone, Copy, Debug)]
pub struct Beside<'a> {
    /// Name of the recording.
    pub recording: &'a str,
    /// What was seen in the data.
    pub check: &'a DataCheck,
    /// Rows left out because they have no number.
    pub without_number: usize,
    /// Rows left out because they have the time of the row before.
    pub time_repeated: usize,
    /// What parameters of the last model make together.
    pub together: &'a Combinations,
}

impl Beside<'_> {
    /// Adds it to the JSON of a discovery or a comparison.
    ///
    /// # Errors
    /// As [`json()`].
    pub fn add_to(&self, json: &mut Value) -> serde_json::Result<()> {
        if !self.together.quantities.is_empty() {
            json["friction"] = serde_json::to_value(self.together)?;
        }
        json["recording"] = json!(self.recording);
        json["data"] = data(self.check)?;
        json["data"]["rows_left_out"] =
            json!({ "without_number": self.without_number, "time_repeated": self.time_repeated });
        Ok(())
    }
}

/// What the residual of a model says, with the names of its lines.
///
/// # Errors
/// As [`json()`].
pub fn diagnosis(diagnosis: &Diagnosis) -> serde_json::Result<Value> {
    let mut json = serde_json::to_value(diagnosis)?;
    lines(&mut json, diagnosis);
    Ok(json)
}

fn lines(json: &mut Value, diagnosis: &Diagnosis) {
    for (k, line) in diagnosis.lines.iter().enumerate() {
        json["lines"][k]["name"] = json!(words::line(line));
        json["lines"][k]["note"] = json!(words::relation(line));
    }
}

#[cfg(test)]
mod tests {
    use missing_physics::measurement::check::check;
    use missing_physics::{Channel, Recording};

    use super::*;

    #[test]
    fn a_finding_has_numbers_and_the_sentence_that_people_read() {
        let time = (0..100).map(f64::from).collect();
        let rest = Channel::new("position", "m", vec![0.0; 100]);
        let json = data(&check(&Recording::new("rest", time, vec![rest]).unwrap())).unwrap();
        let constant =
            json["findings"].as_array().unwrap().iter().find(|f| f["kind"] == "constant");
        let constant = constant.unwrap();
        assert_eq!((&constant["severity"], &constant["value"]), (&json!("serious"), &json!(0.0)));
        assert_eq!(constant["text"], "the position is 0 m in every sample");
    }
}
