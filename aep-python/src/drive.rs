//! The loop by hand: a model held against data, what it may lack, one effect more, what to run next.

use std::sync::atomic::AtomicBool;

use aep_studio::words;
use friction_ident::challenge::{Hide, Level, generate};
use friction_ident::family::{Decides, ForeignModel, FrictionFamily, GivenModels, explained};
use friction_ident::simulator::free_run;
use friction_ident::{Library, Model};
use missing_physics::fit::{Fit, Until};
use missing_physics::{Discovery, Extended};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::failure::{bad_input, keywords};
use crate::found::Found;
use crate::reading::Data;
use crate::search::{Happening, Search, Sends, family, known, searched};
use crate::watched::watched;

/// Digits of a recorded number: far below noise and counts.
const DIGITS: usize = 8;

fn read_model(data: &Data, text: &str) -> PyResult<Model> {
    Model::from_json(text, &data.library).map_err(|error| bad_input(keywords(&error.to_string())))
}

/// Why a model and data do not belong together, and how to mend it.
fn foreign(error: &ForeignModel) -> PyErr {
    let hint = match error {
        ForeignModel::Axis => "use a model that was made from these data",
        ForeignModel::Effort { .. } => {
            "read both in one unit: force_unit='V', or a gain: force_gain=..."
        }
        ForeignModel::WithMass | ForeignModel::Beside => {
            "give model_force=... where the model was made with it, and only there"
        }
        other => return bad_input(keywords(&other.to_string())),
    };
    bad_input(format!("{error}\n  {hint}"))
}

/// Runs `work` where Ctrl-C ends it.
fn stoppable<R: Send>(
    py: Python<'_>,
    work: impl FnOnce(Until<'_>) -> PyResult<R> + Send,
) -> PyResult<(R, Option<PyErr>)> {
    let stop = AtomicBool::new(false);
    let (result, raised) = watched(
        py,
        &stop,
        |_: std::sync::mpsc::Sender<()>| work(Until::stopped(&stop)),
        |_, ()| Ok(()),
    )?;
    Ok((result?, raised))
}

/// The family, what is told of the models, and every model as it is.
type Comparing = (FrictionFamily, GivenModels, Vec<(String, Fit)>);

/// Models, each with its name, on data, nothing fitted: everything is told of the first one, the views of each. Returns it, the
/// views as JSON, and what ended it early.
#[pyfunction]
pub fn compare(
    py: Python<'_>,
    data: Py<Data>,
    models: Vec<(String, String)>,
    search: Search,
) -> PyResult<(Found, String, Option<PyErr>)> {
    let given = data.get();
    let options = search.options(given, None)?;
    let read = models.iter().map(|(name, text)| Ok((name.clone(), read_model(given, text)?)));
    let read: Vec<(String, Model)> = read.collect::<PyResult<_>>()?;
    let work = |until: Until<'_>| -> PyResult<Comparing> {
        let family = family(given, &options)?;
        let fit = |(name, model): &(String, Model)| {
            Ok((name.clone(), family.as_given(model).map_err(|error| foreign(&error))?))
        };
        let fits: Vec<(String, Fit)> = read.iter().map(fit).collect::<PyResult<_>>()?;
        let compared = family.compared(&fits, search.seed, until).map_err(bad_input)?;
        Ok((family, compared.ok_or_else(|| bad_input("a model is needed"))?, fits))
    };
    let ((family, compared, fits), raised) = stoppable(py, work)?;
    let GivenModels { mut discovery, models, between, missing } = compared;
    let missing = missing.iter().map(ToString::to_string);
    discovery.notes = between.iter().map(words::disagreement).chain(missing).collect();
    let fits = fits.into_iter().map(|(name, fit)| (name, fit.model)).collect();
    let views = models.iter().map(|(_, views)| aep_studio::json::views(views));
    let views =
        views.collect::<serde_json::Result<serde_json::Value>>().map_err(bad_input)?.to_string();
    Ok((Found::comparison(data, family, discovery, fits, Decides::Force), views, raised))
}

/// Which effect a model lacks, without adding it.
#[pyfunction]
pub fn suggest(
    py: Python<'_>,
    data: Py<Data>,
    model: String,
    mut search: Search,
    callback: Option<Py<PyAny>>,
) -> PyResult<(Found, Option<PyErr>)> {
    let stop = AtomicBool::new(false);
    let given = data.get();
    let model = read_model(given, &model)?;
    search.base = Some(model.effects().iter().map(|name| (*name).to_owned()).collect());
    let settings = search.settings(given, &stop)?;
    let options = search.options(given, Some(model.known()))?;
    let work = |events| -> PyResult<(FrictionFamily, Discovery)> {
        let family = searched(given, &options)?;
        family.belongs(&model).map_err(|error| foreign(&error))?;
        let found = missing_physics::suggest(&family, &settings, &mut Sends(events));
        Ok((family, found.map_err(bad_input)?))
    };
    let hear = |py: Python<'_>, happening: Happening| match &callback {
        Some(callback) => callback.call1(py, (happening.told(py)?,)).map(drop),
        None => Ok(()),
    };
    let (found, raised) = watched(py, &stop, work, hear)?;
    let (family, discovery) = found?;
    Ok((Found::discovery(data, family.on_view().clone(), discovery, settings.thresholds)?, raised))
}

/// A model with one effect more, refitted: before and after.
#[pyfunction]
pub fn extend(
    py: Python<'_>,
    data: Py<Data>,
    model: String,
    add: String,
    search: Search,
) -> PyResult<(Found, Option<PyErr>)> {
    let given = data.get();
    let model = read_model(given, &model)?;
    let added = known(&given.library, &[add])?;
    if model.effects().contains(&added[0].as_str()) {
        return Err(bad_input(format!(
            "the model has '{}' already\n  suggest tells which other effect would help",
            added[0]
        )));
    }
    let options = search.options(given, Some(model.known()))?;
    let work = |until: Until<'_>| -> PyResult<(FrictionFamily, Fit, Extended)> {
        let family = family(given, &options)?;
        let before = family.as_given(&model).map_err(|error| foreign(&error))?;
        let after = missing_physics::extend(&family, &before, &added[0], search.seed, until);
        Ok((family, before, after.map_err(bad_input)?))
    };
    let ((family, before, after), raised) = stoppable(py, work)?;
    let models = vec![("before".to_owned(), before.model), ("after".to_owned(), after.fit.model)];
    Ok((Found::comparison(data, family, after.comparison, models, Decides::FittedForce), raised))
}

/// The motion that tells rivals apart, each of them on top of the effects `below`: what is known of it as JSON, and time and
/// position.
#[pyfunction]
#[expect(clippy::type_complexity, reason = "four things that Python takes apart at once")]
pub fn experiment(
    py: Python<'_>,
    data: Py<Data>,
    below: Vec<String>,
    rivals: Vec<String>,
    search: Search,
) -> PyResult<(String, Bound<'_, PyArray1<f64>>, Bound<'_, PyArray1<f64>>, Option<PyErr>)> {
    let given = data.get();
    let options = search.options(given, None)?;
    let (below, rivals) = (known(&given.library, &below)?, known(&given.library, &rivals)?);
    let work = |_: Until<'_>| {
        let family = family(given, &options)?;
        if family.is_beside() {
            return Err(bad_input(
                "beside model_force there is no mass of ours: its motion cannot be simulated\n  leave model_force out",
            ));
        }
        family.experiment_between(&below, &rivals, search.seed).map_err(bad_input)
    };
    let (found, raised) = stoppable(py, work)?;
    let motion = found.recording().map_err(bad_input)?;
    let position = motion.require("position").map_err(bad_input)?.to_vec();
    let mut json = serde_json::to_value(&found).map_err(bad_input)?;
    json["is_worth_running"] = found.is_worth_running().into();
    let time = motion.time().to_vec();
    Ok((json.to_string(), PyArray1::from_vec(py, time), PyArray1::from_vec(py, position), raised))
}

/// The motion of a model under the recorded force, as columns.
#[pyfunction]
pub fn simulate(
    py: Python<'_>,
    data: Py<Data>,
    model: String,
) -> PyResult<Vec<(String, Bound<'_, PyArray1<f64>>)>> {
    let given = data.get();
    let model = read_model(given, &model)?;
    if model.timing().is_some()
        || model.terms().iter().any(|term| !term.effect().columns().is_empty())
    {
        return Err(bad_input(
            "the model has no mass of its own, or reads columns of a recording: it cannot be simulated\n  \
             use a model of discover without model_force and without such effects",
        ));
    }
    let (motion, _) =
        stoppable(py, |_| free_run(&model, &given.loaded.recording).map_err(bad_input))?;
    let channels = motion.channels().iter();
    let columns = channels.map(|channel| {
        let name = format!("{}_{}", channel.name, channel.unit);
        (name, PyArray1::from_slice(py, &channel.values))
    });
    let time = ("time_s".to_owned(), PyArray1::from_slice(py, motion.time()));
    Ok(std::iter::once(time).chain(columns).collect())
}

/// A simulated drive with an effect hidden in it: the recording as CSV, how it is read as TOML, the truth as JSON.
#[pyfunction]
pub fn challenge(hide: &str, size: &str, seed: u64) -> PyResult<(String, String, String)> {
    let level: Level = serde_json::from_value(size.into()).map_err(|_| {
        bad_input(format!("size is '{size}'\n  it is 'faint', 'moderate' or 'clear'"))
    })?;
    let made = generate(&Hide::parse(&hide.to_lowercase()), seed, level).map_err(bad_input)?;
    let truth = serde_json::to_string_pretty(&made.truth).map_err(bad_input)?;
    let recording = &made.recording;
    Ok((aep_data::to_csv_rounded(recording, DIGITS), aep_data::to_toml(recording), truth))
}

/// Every effect of the library and its forms: name, what it is, equation.
#[pyfunction]
pub fn effects() -> Vec<(String, String, String)> {
    let all = explained(&Library::builtin()).into_iter();
    all.map(|effect| (effect.name, effect.title, effect.equation)).collect()
}
