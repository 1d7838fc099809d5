//! What a drive's model lacks.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use friction_ident::family::FrictionFamily;
use missing_physics::report::Confirmed;
use missing_physics::{Discovery, confirm};
use pyo3::prelude::*;

use crate::failure::bad_input;
use crate::found::Found;
use crate::reading::Data;
use crate::search::{Happening, Search, Sends, searched};
use crate::watched::watched;

/// Searches data for what the base model lacks; `validate` are recordings to confirm it on, `surrogates` how many surrogates
/// are searched for false alarms. Returns what was found and what ended it early, if anything did.
#[pyfunction]
pub fn discover(
    py: Python<'_>,
    data: Py<Data>,
    search: Search,
    validate: Option<Py<Data>>,
    surrogates: usize,
    callback: Option<Py<PyAny>>,
) -> PyResult<(Found, Option<PyErr>)> {
    let stop = Arc::new(AtomicBool::new(false));
    let given = data.get();
    let settings = search.settings(given, &stop)?;
    let options = search.options(given, None)?;
    let work = |events| -> PyResult<(FrictionFamily, Discovery)> {
        let family = searched(given, &options)?;
        if surrogates > 0 && family.is_beside() {
            return Err(bad_input(
                "surrogates are simulated, but beside model_force there is no mass of ours\n  leave surrogates out",
            ));
        }
        let mut discovery =
            missing_physics::discover(&family, &settings, &mut Sends(events)).map_err(bad_input)?;
        let go_on = || !stop.load(Ordering::Relaxed);
        if let Some(other) = validate.as_ref().filter(|_| go_on()) {
            let recording = other.get().loaded.recording.name().to_owned();
            let other = searched(other.get(), &options)?.with_stroke_of(&family);
            if (family.axis(), family.effort()) != (other.axis(), other.effort()) {
                return Err(bad_input(
                    "the recordings are not of one kind of axis, or their forces not in one unit\n  \
                     give validate recordings of the same drive",
                ));
            }
            let rungs = confirm(&other, &discovery.ladder, &settings).map_err(bad_input)?;
            discovery.confirmation = Some(Confirmed { recording, rungs });
        }
        if let Some(last) = discovery.ladder.last().filter(|_| surrogates > 0 && go_on()) {
            let model = family.plant(last).map_err(bad_input)?;
            let found = family
                .false_alarms(&model, (&settings, &options), surrogates, |_| go_on())
                .map_err(bad_input)?;
            discovery.surrogates = Some(found);
        }
        Ok((family, discovery))
    };
    let hear = |py: Python<'_>, happening: Happening| match &callback {
        Some(callback) => callback.call1(py, (happening.told(py)?,)).map(drop),
        None => Ok(()),
    };
    let (found, raised) = watched(py, &stop, work, hear)?;
    let (family, discovery) = found?;
    let found = py.detach(|| {
        Found::discovery(data, family.on_view().clone(), discovery, settings.thresholds)
    })?;
    Ok((found, raised))
}
