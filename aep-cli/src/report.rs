//! The files of a run: JSON by the contract, and the page.

use aep_data::Loaded;
use aep_studio::Source;
use aep_studio::json::Beside;
use friction_ident::family::explained;
use missing_physics::measurement::check::DataCheck;
use missing_physics::report::{Combinations, Samples};
use missing_physics::{Discovery, Thresholds};
use serde_json::Value;

use crate::args::{OutputArgs, library, quoted};
use crate::failure::Failure;
use crate::output::{save, save_json, written};

/// What was asked.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// What is missing: a verdict.
    Discovery,
    /// How well a model fits: no verdict.
    Comparison,
}

/// All that a report tells.
pub struct Report<'a> {
    /// What was asked.
    pub kind: Kind,
    /// What was found.
    pub discovery: &'a Discovery,
    /// The recording and how it was read.
    pub loaded: &'a Loaded,
    /// What was seen in the data.
    pub check: &'a DataCheck,
    /// What an effect had to gain, where that was asked.
    pub thresholds: Thresholds,
    /// What parameters of the last model make together.
    pub together: Combinations,
    /// The recording and its models sample by sample, where a page is asked for.
    pub samples: Samples,
    /// Further entries of the JSON.
    pub more: Vec<(&'static str, Value)>,
}

impl Report<'_> {
    /// Writes the files that were asked for; returns what to tell the user.
    pub fn save(&self, args: &OutputArgs) -> Result<String, Failure> {
        let mut said = String::new();
        if let Some(path) = &args.json {
            save_json(path, &self.json()?)?;
            said += &written("results", path);
        }
        if let Some(path) = &args.html {
            save(path, &self.page())?;
            said += &written("report", path);
        }
        Ok(said)
    }

    fn page(&self) -> String {
        let together = self.together.clone();
        let samples = self.samples.clone();
        let source = Source {
            thresholds: self.thresholds,
            together,
            samples,
            effects: explained(&library()),
            ..source(self.loaded)
        };
        match self.kind {
            Kind::Discovery => aep_studio::report::html(self.discovery, &source, self.check),
            Kind::Comparison => aep_studio::report::comparison(self.discovery, &source, self.check),
        }
    }

    /// The discovery or comparison by the contract.
    pub fn json(&self) -> Result<Value, Failure> {
        let mut json = match self.kind {
            Kind::Discovery => aep_studio::json::json(self.discovery)?,
            Kind::Comparison => aep_studio::json::comparison(self.discovery)?,
        };
        for (key, value) in &self.more {
            json[*key] = value.clone();
        }
        let beside = Beside {
            recording: self.loaded.recording.name(),
            check: self.check,
            without_number: self.loaded.left_out.missing,
            time_repeated: self.loaded.left_out.repeated,
            together: &self.together,
        };
        beside.add_to(&mut json)?;
        Ok(json)
    }
}

/// How a recording was read, for the page.
pub fn source(loaded: &Loaded) -> Source {
    let columns = loaded.origins.iter();
    let columns = columns.map(|o| [o.channel.to_owned(), o.column.clone(), o.unit.to_owned()]);
    Source {
        name: loaded.recording.name().to_owned(),
        columns: columns.collect(),
        command: command(),
        thresholds: Thresholds::default(),
        together: Combinations::default(),
        samples: Samples::default(),
        effects: Vec::new(),
    }
}

/// How the page is made again, as a shell takes it.
pub fn command() -> String {
    let words = std::env::args().skip(1).map(|word| quoted(&word));
    format!("aep {}", words.collect::<Vec<String>>().join(" "))
}
