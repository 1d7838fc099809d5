//! What is asked of a search.

use std::collections::BTreeMap;
use std::sync::atomic::AtomicBool;
use std::time::Duration;

use friction_ident::effects::beside::MODEL_FORCE;
use friction_ident::family::{FrictionFamily, Options, PreparationError};
use friction_ident::{Known, Library};
use missing_physics::measurement::looked_at;
use missing_physics::{Event, Observer, Recording, Settings, Thresholds};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use crate::failure::{bad_input, keywords};
use crate::reading::Data;

/// What is asked, and what is known of the drive.
#[derive(FromPyObject)]
pub struct Search {
    pub base: Option<Vec<String>>,
    fit_model_gain: bool,
    exclude: Vec<String>,
    pub seed: u64,
    alpha: f64,
    time_limit: Option<f64>,
    thresholds: BTreeMap<String, f64>,
    bandwidth: Option<f64>,
    fix: BTreeMap<String, f64>,
    bound: BTreeMap<String, (f64, f64)>,
}

impl Search {
    /// The engine's settings for data.
    pub fn settings<'a>(&self, data: &Data, stop: &'a AtomicBool) -> PyResult<Settings<'a>> {
        let base = self.base.clone().unwrap_or_else(|| Library::usual(&data.loaded.recording));
        let mut base = known(&data.library, &base)?;
        if self.fit_model_gain {
            if data.loaded.recording.channel(MODEL_FORCE).is_none() {
                return Err(bad_input(
                    "model_gain is the gain of a model's force, but there is none\n  say its column: model_force=...",
                ));
            }
            if !base.iter().any(|name| name == "model-gain") {
                base.push("model-gain".to_owned());
            }
        }
        let exclude = known(&data.library, &self.exclude)?;
        self.with_names(base, exclude, stop)
    }

    /// The settings for a family with names of its own, where nothing is in the base that is not named.
    pub fn settings_of_names<'a>(
        &self,
        known: &dyn Fn(&String) -> PyResult<()>,
        stop: &'a AtomicBool,
    ) -> PyResult<Settings<'a>> {
        let base = self.base.clone().unwrap_or_default();
        base.iter().chain(&self.exclude).try_for_each(known)?;
        self.with_names(base, self.exclude.clone(), stop)
    }

    fn with_names<'a>(
        &self,
        base: Vec<String>,
        exclude: Vec<String>,
        stop: &'a AtomicBool,
    ) -> PyResult<Settings<'a>> {
        if !(self.alpha > 0.0 && self.alpha < 1.0) {
            let what = format!("alpha is {}\n  it is a probability between 0 and 1", self.alpha);
            return Err(bad_input(what));
        }
        let time_limit = self.time_limit.map(Duration::try_from_secs_f64).transpose();
        let time_limit = time_limit.map_err(|error| bad_input(format!("time_limit: {error}")))?;
        let thresholds = self.thresholds()?;
        Ok(Settings {
            base,
            exclude,
            seed: self.seed,
            alpha: self.alpha,
            most: thresholds.most,
            thresholds,
            stop: Some(stop),
            time_limit,
            ..Settings::default()
        })
    }

    fn thresholds(&self) -> PyResult<Thresholds> {
        let mut thresholds = Thresholds::default();
        for (name, &value) in &self.thresholds {
            let count = || {
                let valid = value >= 0.0 && value.fract() == 0.0 && value < 1e6;
                valid.then_some(value as usize)
            };
            let within = |valid: bool| (valid && value.is_finite()).then_some(value);
            let set = match name.as_str() {
                "better" => within(value > 0.0).map(|value| thresholds.better = value),
                "share" => within((0.0..1.0).contains(&value)).map(|v| thresholds.share = v),
                "complete" => within(value > 0.0).map(|value| thresholds.complete = value),
                "local" => within(value > 0.0).map(|value| thresholds.local = value),
                "chance" => within(value > 0.0 && value < 1.0).map(|v| thresholds.chance = v),
                "beam" => count().filter(|n| *n > 0).map(|count| thresholds.beam = count),
                "fitted" => count().filter(|n| *n > 0).map(|count| thresholds.fitted = count),
                "most" => count().map(|count| thresholds.most = count),
                _ => {
                    let all = "better, share, complete, local, chance, beam, fitted, most";
                    let what = format!("there is no threshold '{name}'\n  there are: {all}");
                    return Err(bad_input(what));
                }
            };
            set.ok_or_else(|| bad_input(format!("the threshold {name} cannot be {value}")))?;
        }
        Ok(thresholds)
    }

    /// How a recording is prepared. What `model_known` says of parameters holds where nothing else is said here.
    pub fn options(&self, data: &Data, model_known: Option<&Known>) -> PyResult<Options> {
        let mut known = Known { fixed: self.fix.clone(), bounds: self.bound.clone() };
        if let Some(address) = known.fixed.keys().find(|name| known.bounds.contains_key(*name)) {
            return Err(bad_input(format!(
                "'{address}' is both fixed and bounded\n  keep one of fix and bound"
            )));
        }
        if let Some(of_model) = model_known {
            known = known.or(of_model);
        }
        if let Some(bandwidth) = self.bandwidth.filter(|hz| !(*hz > 0.0 && hz.is_finite())) {
            return Err(bad_input(format!(
                "bandwidth is {bandwidth}\n  it is a frequency above 0, Hz"
            )));
        }
        Ok(Options { bandwidth: self.bandwidth, library: data.library.clone(), known })
    }
}

/// The model family of data, of a very long recording of pieces of it; nothing is interpolated over long gaps.
pub fn family(data: &Data, options: &Options) -> PyResult<FrictionFamily> {
    prepared(data, |recording| FrictionFamily::new(recording, options))
}

/// The model family in which data are searched; what is shown of it is compared below the bandwidth of `options`.
pub fn searched(data: &Data, options: &Options) -> PyResult<FrictionFamily> {
    prepared(data, |recording| FrictionFamily::to_search(recording, options))
}

fn prepared(
    data: &Data,
    family: impl Fn(&Recording) -> Result<FrictionFamily, PreparationError>,
) -> PyResult<FrictionFamily> {
    let used = looked_at(&data.loaded.recording).map_err(bad_input)?;
    family(&used).map_err(|error| {
        let hint = "record a motion that reverses several times and covers slow and fast speeds";
        bad_input(format!("{}\n  {hint}", keywords(&error.to_string())))
    })
}

/// Names of effects that the library has.
pub fn known(library: &Library, names: &[String]) -> PyResult<Vec<String>> {
    let names = names.iter().map(|name| {
        let found = library.find(&name.to_lowercase()).map_err(bad_input)?;
        Ok(found.about().name.to_owned())
    });
    names.collect()
}

/// What happens in a search, as it is sent to Python.
pub enum Happening {
    BaseFitted { evaluations: usize },
    Screening { rung: usize, candidates: usize },
    Compared { rung: usize, effects: Vec<String>, nats: f64 },
    Concluding,
    Finishing,
}

impl Happening {
    /// A dictionary with `stage` and the numbers of the stage.
    pub fn told<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let facts = PyDict::new(py);
        match self {
            Self::BaseFitted { evaluations } => {
                facts.set_item("stage", "base-fitted")?;
                facts.set_item("evaluations", evaluations)?;
            }
            Self::Screening { rung, candidates } => {
                facts.set_item("stage", "screening")?;
                facts.set_item("rung", rung)?;
                facts.set_item("candidates", candidates)?;
            }
            Self::Compared { rung, effects, nats } => {
                facts.set_item("stage", "compared")?;
                facts.set_item("rung", rung)?;
                facts.set_item("effects", effects)?;
                facts.set_item("nats", nats)?;
            }
            Self::Concluding => facts.set_item("stage", "concluding")?,
            Self::Finishing => facts.set_item("stage", "finishing")?,
        }
        Ok(facts)
    }
}

/// Sends what happens to whoever listens.
pub struct Sends(pub std::sync::mpsc::Sender<Happening>);

impl Observer for Sends {
    fn event(&mut self, event: &Event<'_>) {
        let happening = match *event {
            Event::BaseFitted { evaluations } => Happening::BaseFitted { evaluations },
            Event::Screening { rung, candidates } => Happening::Screening { rung, candidates },
            Event::Compared { rung, effects, nats } => {
                Happening::Compared { rung, effects: effects.to_vec(), nats }
            }
            Event::Concluding => Happening::Concluding,
            Event::Finishing => Happening::Finishing,
            _ => return,
        };
        // Nobody listens any more: the search ends by its stop flag.
        let _ = self.0.send(happening);
    }
}
