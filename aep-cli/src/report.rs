//! The files of a run: JSON by the contract, and the page.

use aep_data::Loaded;
use aep_studio::Source;
use aep_studio::report::Explained;
use friction_ident::family::mistaken_for;
use missing_physics::measurement::check::DataCheck;
use missing_physics::report::{Combinations, Samples};
use missing_physics::{Discovery, Thresholds};
use serde_json::{Value, json};

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
            effects: explained(),
            ..source(self.loaded)
        };
        match self.kind {
            Kind::Discovery => aep_studio::report::html(self.discovery, &source, self.check),
            Kind::Comparison => aep_studio::report::comparison(self.discovery, &source, self.check),
        }
    }

    /// The discovery or comparison by the contract.
    pub fn json(&self) -> Result<Value, Failure> {
        let broken =
            |error: serde_json::Error| Failure::failed(format!("cannot write JSON: {error}"));
        let mut json = match self.kind {
            Kind::Discovery => aep_studio::json::json(self.discovery).map_err(broken)?,
            Kind::Comparison => comparison(self.discovery).map_err(broken)?,
        };
        for (key, value) in &self.more {
            json[*key] = value.clone();
        }
        if !self.together.quantities.is_empty() {
            json["friction"] = serde_json::to_value(&self.together).map_err(broken)?;
        }
        json["recording"] = json!(self.loaded.recording.name());
        json["data"] = aep_studio::json::data(self.check).map_err(broken)?;
        let left_out = &self.loaded.left_out;
        json["data"]["rows_left_out"] =
            json!({ "without_number": left_out.missing, "time_repeated": left_out.repeated });
        Ok(json)
    }
}

/// The last rung with where it fails.
fn comparison(discovery: &Discovery) -> serde_json::Result<Value> {
    let last = discovery.ladder.last();
    let diagnosis = discovery.diagnosis.as_ref().map(aep_studio::json::diagnosis).transpose()?;
    Ok(json!({
        "effects": last.map(|rung| &rung.effects),
        "parameters": last.map(|rung| &rung.parameters),
        "error": last.map(|rung| &rung.error),
        "where": discovery.where_it_fails,
        "regimes": discovery.regimes,
        "noise_floor": discovery.noise_floor,
        "metrics": last.and_then(|rung| rung.metrics),
        "views": discovery.views,
        "diagnosis": diagnosis,
        "notes": aep_studio::words::notes(discovery),
        "ladder": discovery.ladder,
        "seed": discovery.seed,
    }))
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

/// What is known of every effect.
fn explained() -> Vec<Explained> {
    let library = library();
    let each = library.effects().iter().flat_map(|effect| {
        let forms = effect.forms().iter().map(|form| form.about());
        std::iter::once(effect.about()).chain(forms).collect::<Vec<_>>()
    });
    let explained = each.map(|about| Explained {
        name: about.name.to_owned(),
        title: about.title.to_owned(),
        equation: about.equation.to_owned(),
        shows: about.shows.to_owned(),
        reference: about.reference.to_owned(),
        parameters: (about.parameters.iter())
            .map(|parameter| [parameter.name.to_owned(), parameter.meaning.to_owned()])
            .collect(),
        mistaken_for: (mistaken_for(library.effects(), about.name).into_iter())
            .map(|alike| [alike.effects.join(", "), alike.experiment.to_owned()])
            .collect(),
    });
    explained.collect()
}

/// How the page is made again, as a shell takes it.
pub fn command() -> String {
    let words = std::env::args().skip(1).map(|word| quoted(&word));
    format!("aep {}", words.collect::<Vec<String>>().join(" "))
}
