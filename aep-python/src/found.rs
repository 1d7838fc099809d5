//! What was found, to be told: as JSON, as a page, point by point.

use aep_studio::Source;
use aep_studio::json::Beside;
use friction_ident::family::{Decides, FrictionFamily, PointValues, explained};
use missing_physics::report::{Combinations, Discovery, Rung};
use missing_physics::{Fitted, Thresholds, model_of};
use numpy::PyArray1;
use pyo3::prelude::*;

use crate::failure::bad_input;
use crate::reading::Data;

/// A discovery or, where `decides` is a force, a comparison.
#[pyclass(frozen, module = "aep._aep")]
pub struct Found {
    data: Py<Data>,
    family: FrictionFamily,
    discovery: Discovery,
    models: Vec<(String, Fitted)>,
    together: Combinations,
    thresholds: Thresholds,
    is_comparison: bool,
    decides: Decides,
}

impl Found {
    /// What a search found.
    pub fn discovery(
        data: Py<Data>,
        family: FrictionFamily,
        discovery: Discovery,
        thresholds: Thresholds,
    ) -> PyResult<Self> {
        let models = discovery
            .ladder
            .iter()
            .enumerate()
            .map(|(k, rung)| Ok((rung.label(k), model_of(&family, rung).map_err(bad_input)?)));
        let models = models.collect::<PyResult<Vec<_>>>()?;
        let together = models.last().map_or_else(Combinations::default, |(_, last)| {
            family.friction(last, Decides::Prediction)
        });
        let (is_comparison, decides) = (false, Decides::Prediction);
        Ok(Self { data, family, discovery, models, together, thresholds, is_comparison, decides })
    }

    /// Models beside one another, nothing searched.
    pub fn comparison(
        data: Py<Data>,
        family: FrictionFamily,
        discovery: Discovery,
        models: Vec<(String, Fitted)>,
        decides: Decides,
    ) -> Self {
        let (together, thresholds) = (Combinations::default(), Thresholds::default());
        let is_comparison = true;
        Self { data, family, discovery, models, together, thresholds, is_comparison, decides }
    }
}

#[pymethods]
impl Found {
    /// As `aep discover --json` or `aep compare --json` writes it.
    fn json(&self) -> PyResult<String> {
        let mut json = if self.is_comparison {
            aep_studio::json::comparison(&self.discovery)
        } else {
            aep_studio::json::json(&self.discovery)
        }
        .map_err(bad_input)?;
        let Data { loaded, check, .. } = self.data.get();
        let beside = Beside {
            recording: loaded.recording.name(),
            check,
            without_number: loaded.left_out.missing,
            time_repeated: loaded.left_out.repeated,
            together: &self.together,
        };
        beside.add_to(&mut json).map_err(bad_input)?;
        Ok(json.to_string())
    }

    /// The page of `aep discover --html`; `command` says how it is made again.
    fn html(&self, py: Python<'_>, command: String) -> String {
        let Data { loaded, check, library } = self.data.get();
        py.detach(|| {
            let columns = loaded.origins.iter();
            let columns =
                columns.map(|o| [o.channel.to_owned(), o.column.clone(), o.unit.to_owned()]);
            let models: Vec<Fitted> = self.models.iter().map(|(_, model)| model.clone()).collect();
            let source = Source {
                name: loaded.recording.name().to_owned(),
                columns: columns.collect(),
                command,
                thresholds: self.thresholds,
                together: self.together.clone(),
                samples: self.family.samples(&models, self.decides),
                effects: explained(library),
            };
            if self.is_comparison {
                aep_studio::report::comparison(&self.discovery, &source, check)
            } else {
                aep_studio::report::html(&self.discovery, &source, check)
            }
        })
    }

    /// Every sample: the columns of `aep discover --series`.
    fn series<'py>(&self, py: Python<'py>) -> PyResult<Vec<(String, Bound<'py, PyAny>)>> {
        let columns = py.detach(|| self.family.columns_of_points(&self.models, self.decides));
        let columns = columns.into_iter().map(|(name, values)| {
            let values = match values {
                PointValues::Numbers(values) => PyArray1::from_vec(py, values).into_any(),
                PointValues::Whole(values) => PyArray1::from_vec(py, values).into_any(),
                PointValues::Texts(values) => values.into_pyobject(py)?.into_any(),
            };
            Ok((name, values))
        });
        columns.collect()
    }

    /// The model of a rung as a model file has it.
    fn model(&self, rung: usize) -> PyResult<String> {
        let found = self.discovery.ladder.get(rung);
        let rung: &Rung = found.ok_or_else(|| bad_input(format!("there is no rung {rung}")))?;
        self.family.plant(rung).map_err(bad_input)?.to_json().map_err(bad_input)
    }
}
