//! A measurement and how it was read.

use std::path::PathBuf;

use aep_data::{DataError, Loaded, Mapping, Part, of_columns, part, read_all};
use friction_ident::Library;
use friction_ident::effects::formula;
use missing_physics::measurement::check::{DataCheck, check};
use numpy::PyReadonlyArray1;
use pyo3::prelude::*;

use crate::failure::{bad_input, data};

/// A recording with what was seen in it, and the effects that it can be searched for.
#[pyclass(frozen, module = "aep._aep")]
pub struct Data {
    pub loaded: Loaded,
    pub check: DataCheck,
    pub library: Library,
}

/// How data are read: the content of a `DATA.toml` as JSON, laws of the user as TOML, and the part that is used.
#[derive(FromPyObject)]
pub struct Reading {
    mapping: String,
    effects: Vec<String>,
    from: Option<f64>,
    to: Option<f64>,
    every: Option<usize>,
}

impl Reading {
    fn library(&self) -> PyResult<Library> {
        let mut library = Library::builtin();
        for text in &self.effects {
            library = library.with(formula::read(text).map_err(bad_input)?);
        }
        Ok(library)
    }

    fn read(&self, open: impl FnOnce(&Mapping) -> Result<Loaded, DataError>) -> PyResult<Data> {
        let library = self.library()?;
        let mut mapping: Mapping = serde_json::from_str(&self.mapping).map_err(bad_input)?;
        let laws = library.effects().iter().flat_map(|effect| effect.columns());
        mapping.columns = laws.cloned().collect();
        let mut loaded = open(&mapping).map_err(|error| data(&error))?;
        let wanted = Part { from: self.from, to: self.to, every: self.every };
        if !wanted.is_all() {
            let time = loaded.recording.time();
            let (first, last) = (time[0], time[time.len() - 1]);
            loaded.recording = part(&loaded.recording, &wanted).map_err(|error| {
                let within = format!("the recording goes from {first} s to {last} s");
                bad_input(format!("t_from, t_to and every leave too little: {error}\n  {within}"))
            })?;
        }
        let library = library.with_regressors(&loaded.recording).map_err(bad_input)?;
        let check = check(&loaded.recording);
        Ok(Data { loaded, check, library })
    }
}

#[pymethods]
impl Data {
    /// The pieces of one measurement, from files.
    #[staticmethod]
    fn of_files(py: Python<'_>, paths: Vec<PathBuf>, reading: Reading) -> PyResult<Self> {
        py.detach(|| reading.read(|mapping| read_all(&paths, mapping)))
    }

    /// A measurement in memory.
    #[staticmethod]
    fn of_columns(
        name: &str,
        columns: Vec<(String, PyReadonlyArray1<'_, f64>)>,
        reading: Reading,
    ) -> PyResult<Self> {
        // Lent: of a wide frame only what is read is copied. So that nobody writes meanwhile the lock is kept.
        let columns = columns.iter().map(|(name, values)| Ok((name.clone(), values.as_slice()?)));
        let columns = columns.collect::<PyResult<Vec<_>>>()?;
        reading.read(|mapping| of_columns(name, columns, mapping))
    }

    #[getter]
    fn name(&self) -> &str {
        self.loaded.recording.name()
    }

    /// Number of samples.
    #[getter]
    fn samples(&self) -> usize {
        self.loaded.recording.len()
    }

    /// Which column each quantity was read from: channel, column, SI unit.
    #[getter]
    fn columns(&self) -> Vec<(&'static str, String, &'static str)> {
        let origins = self.loaded.origins.iter();
        origins.map(|origin| (origin.channel, origin.column.clone(), origin.unit)).collect()
    }
}
