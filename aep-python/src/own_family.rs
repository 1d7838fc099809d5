//! A model family that a user writes in Python: any simulator is the model.

use std::sync::atomic::AtomicBool;
use std::sync::{Arc, Mutex, PoisonError};

use missing_physics::measurement::check::check;
use missing_physics::{
    Channel, ComparedQuantity, Coordinate, Discovery, FnFamily, Given, ModelFamily, Recording,
    Role, Term, TermParameter, discover, model_of,
};
use numpy::{PyArray1, PyReadonlyArray1};
use pyo3::prelude::*;
use pyo3::types::PyDict;

use aep_core::Scale;
use aep_studio::Source;

use crate::failure::bad_input;
use crate::search::{Happening, Search, Sends};
use crate::watched::watched;

/// A term as Python describes it.
#[derive(FromPyObject)]
struct OwnTerm {
    name: String,
    title: String,
    equation: String,
    always: bool,
    /// Name, unit, whether it is an amplitude, limits, whether it is searched by its logarithm, start.
    parameters: Vec<(String, String, bool, f64, f64, bool, f64)>,
}

impl OwnTerm {
    fn term(self) -> Term {
        let mut term = Term::new(&self.name, &self.title, &self.equation);
        let parameters = self.parameters.into_iter();
        let parameters =
            parameters.map(|(name, unit, amplitude, lower, upper, log, start)| TermParameter {
                name,
                unit,
                role: if amplitude { Role::Amplitude } else { Role::Shape },
                lower,
                upper,
                scale: if log { Scale::Log } else { Scale::Linear },
                start,
            });
        term.parameters = parameters.collect();
        term.always = self.always;
        term
    }
}

/// What Python says of a family.
#[derive(FromPyObject)]
pub struct Subject {
    terms: Vec<OwnTerm>,
    quantity: (String, String),
    time: Vec<f64>,
    measured: Vec<f64>,
    coordinates: Vec<(String, String, Vec<f64>)>,
    /// Standard deviation of the measurement's noise, where it is known.
    noise: Option<f64>,
    /// `prediction(model)`, the model as a dictionary of terms, each with a dictionary of its values.
    prediction: Py<PyAny>,
}

/// Predictions that failed, and how the first one did.
type Failures = Arc<Mutex<(u64, Option<PyErr>)>>;

type OwnFamily = FnFamily<Box<dyn Fn(&Given<'_>, &mut [f64]) + Send + Sync>>;

impl Subject {
    fn family(self, failures: &Failures) -> OwnFamily {
        // Predictions are made one at a time: a simulator of the user's need not bear two.
        let prediction = Mutex::new(self.prediction);
        let failures = Arc::clone(failures);
        let predict = move |given: &Given<'_>, out: &mut [f64]| {
            // First the turn, then the interpreter: the other way round whoever has the one would wait for the other.
            let prediction = prediction.lock().unwrap_or_else(PoisonError::into_inner);
            let failed = Python::attach(|py| predicted(py, &prediction, given, out));
            if let Err(error) = failed {
                out.fill(f64::NAN);
                let mut failures = failures.lock().unwrap_or_else(PoisonError::into_inner);
                failures.0 += 1;
                failures.1.get_or_insert(error);
            }
        };
        let terms = self.terms.into_iter().map(OwnTerm::term).collect();
        let family: OwnFamily =
            FnFamily::new(terms, self.time, self.measured, Box::new(predict) as Box<_>)
                .predicting(&self.quantity.0, &self.quantity.1);
        let along = |family: OwnFamily, (name, unit, values): (String, String, Vec<f64>)| {
            family.along(Coordinate::of_state(&name, &unit, values))
        };
        let family = self.coordinates.into_iter().fold(family, along);
        match self.noise {
            Some(sd) => family.with_noise(sd),
            None => family,
        }
    }
}

fn predicted(
    py: Python<'_>,
    prediction: &Py<PyAny>,
    model: &Given<'_>,
    out: &mut [f64],
) -> PyResult<()> {
    let given = PyDict::new(py);
    for (term, values) in model.terms() {
        let of_term = PyDict::new(py);
        for (parameter, value) in term.parameters.iter().zip(values) {
            of_term.set_item(&parameter.name, value)?;
        }
        given.set_item(&term.name, of_term)?;
    }
    let answer = prediction.call1(py, (given,))?;
    let answer: PyReadonlyArray1<'_, f64> = answer.extract(py)?;
    for (out, value) in out.iter_mut().zip(answer.as_array()) {
        *out = *value;
    }
    Ok(())
}

/// What was found of a family of the user's own.
#[pyclass(frozen, module = "aep._aep")]
pub struct OwnFound {
    family: OwnFamily,
    recording: Recording,
    discovery: Discovery,
    thresholds: missing_physics::Thresholds,
}

/// Searches for what the base model of a family lacks. Returns what was found, how many predictions failed with the first
/// error, and what ended the search early.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "three things that Python takes apart at once")]
pub fn discover_own(
    py: Python<'_>,
    subject: Subject,
    search: Search,
    callback: Option<Py<PyAny>>,
) -> PyResult<(OwnFound, (u64, Option<PyErr>), Option<PyErr>)> {
    let stop = Arc::new(AtomicBool::new(false));
    let failures = Failures::default();
    let family = subject.family(&failures);
    let known = |name: &String| {
        let all: Vec<&str> = family.terms().iter().map(|term| term.name.as_str()).collect();
        let what =
            || bad_input(format!("there is no term '{name}'\n  there are: {}", all.join(", ")));
        all.contains(&name.as_str()).then_some(()).ok_or_else(what)
    };
    let settings = search.settings_of_names(&known, &stop)?;
    let ComparedQuantity { name, unit } = family.quantity();
    let channel = Channel::new(name, unit, family.target().to_vec());
    let recording =
        Recording::new("measured", family.time().to_vec(), vec![channel]).map_err(bad_input)?;
    let work = |events| discover(&family, &settings, &mut Sends(events)).map_err(bad_input);
    let hear = |py: Python<'_>, happening: Happening| match &callback {
        Some(callback) => callback.call1(py, (happening.told(py)?,)).map(drop),
        None => Ok(()),
    };
    let (discovery, raised) = watched(py, &stop, work, hear)?;
    let discovery = discovery?;
    let failures = {
        let mut failures = failures.lock().unwrap_or_else(PoisonError::into_inner);
        (failures.0, failures.1.take())
    };
    let thresholds = settings.thresholds;
    Ok((OwnFound { family, recording, discovery, thresholds }, failures, raised))
}

#[pymethods]
impl OwnFound {
    /// The discovery by the published schema.
    fn json(&self) -> PyResult<String> {
        Ok(aep_studio::json::json(&self.discovery).map_err(bad_input)?.to_string())
    }

    /// The report page; `command` says how it is made again.
    fn html(&self, py: Python<'_>, command: String) -> String {
        py.detach(|| {
            let name = self.recording.name().to_owned();
            let source = Source { name, command, thresholds: self.thresholds, ..Source::default() };
            aep_studio::report::html(&self.discovery, &source, &check(&self.recording))
        })
    }

    /// Every sample: what was measured, and prediction and residual of every rung.
    fn series<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let array = |values: Vec<f64>| PyArray1::from_vec(py, values).into_any();
        let ComparedQuantity { name, unit } = self.family.quantity();
        let measured = self.family.target();
        let mut columns = vec![
            ("time_s".to_owned(), array(self.family.time().to_vec())),
            (format!("compared_{name}_{unit}"), array(measured.to_vec())),
        ];
        for (number, rung) in self.discovery.ladder.iter().enumerate() {
            let model = model_of(&self.family, rung).map_err(bad_input)?;
            let mut predicted = vec![0.0; measured.len()];
            py.detach(|| self.family.predict(&model, &mut predicted));
            let residual = measured.iter().zip(&predicted).map(|(m, p)| m - p).collect();
            let label = rung.label(number);
            columns.push((format!("{label}.{name}_{unit}"), array(predicted)));
            columns.push((format!("{label}.residual_{name}_{unit}"), array(residual)));
        }
        Ok(columns)
    }
}
