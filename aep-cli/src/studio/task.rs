//! What can be asked of the studio that takes time. A task is a file while it runs: what a killed server left is done again.

use serde::{Deserialize, Serialize};

/// What can be written to take away.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Form {
    /// The report of a model and all before it.
    Report,
    /// Prediction and residual at every sample.
    Series,
    /// The compensator in C.
    C,
    /// The model as a functional mock-up unit.
    Fmu,
    /// The model in Modelica.
    Modelica,
    /// The model as a scene that `MuJoCo` reads.
    Mjcf,
    /// The model as a robot description.
    Urdf,
}

impl Form {
    /// In words.
    pub fn said(self) -> &'static str {
        match self {
            Self::Report => "the report",
            Self::Series => "the series",
            Self::C => "the compensator in C",
            Self::Fmu => "the FMU",
            Self::Modelica => "the Modelica model",
            Self::Mjcf => "the scene for MuJoCo",
            Self::Urdf => "the robot description",
        }
    }
}

/// Something to do; numbers are those of models.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "task", rename_all = "snake_case", deny_unknown_fields)]
pub enum Task {
    /// Fits a base model of these effects.
    Base {
        /// Their names; those that a drive usually has where none are given.
        #[serde(default)]
        effects: Option<Vec<String>>,
    },
    /// Adds an effect to a model and fits all of it.
    Add {
        /// The model.
        from: u32,
        /// The effect.
        effect: String,
    },
    /// Takes an effect away and fits what is left.
    Remove {
        /// The model.
        from: u32,
        /// The effect.
        effect: String,
    },
    /// Fixes a parameter at a value, or frees it, and fits the others.
    Fix {
        /// The model.
        from: u32,
        /// `mass` or `EFFECT.PARAMETER`.
        parameter: String,
        /// SI; nothing to free it.
        value: Option<f64>,
    },
    /// Tries every effect beside a model and adds none.
    Suggest {
        /// The model.
        from: u32,
    },
    /// Searches all that a model lacks.
    Discover {
        /// The model.
        from: u32,
    },
    /// Looks for the motion that tells effects apart.
    Experiment {
        /// The model.
        from: u32,
        /// At least two effects.
        effects: Vec<String>,
    },
    /// Simulates PD control without and with the compensator of a model.
    Control {
        /// The model behind the compensator.
        from: u32,
        /// The simulated plant; the same model where none is given.
        #[serde(default)]
        plant: Option<u32>,
        /// What is followed: `sine:5mm,0.5Hz`; a slow ramp where none is given.
        #[serde(default)]
        reference: Option<String>,
    },
    /// Writes a file to take away.
    Export {
        /// The model.
        from: u32,
        /// What is written.
        form: Form,
    },
}

impl Task {
    /// Whether it gives way to whatever is asked for next.
    pub fn yields(&self) -> bool {
        matches!(self, Self::Suggest { .. })
    }

    /// What is being done, in words.
    pub fn said(&self) -> String {
        match self {
            Self::Base { .. } => "fitting the base model".to_owned(),
            Self::Add { effect, .. } => format!("adding {effect}"),
            Self::Remove { effect, .. } => format!("fitting without {effect}"),
            Self::Fix { parameter, value: Some(_), .. } => {
                format!("fitting with {parameter} fixed")
            }
            Self::Fix { parameter, value: None, .. } => format!("fitting with {parameter} free"),
            Self::Suggest { .. } => "trying every effect beside the model".to_owned(),
            Self::Discover { .. } => "searching all that the model lacks".to_owned(),
            Self::Experiment { effects, .. } => {
                format!("looking for a motion that tells {} apart", effects.join(" from "))
            }
            Self::Control { .. } => "simulating the compensator".to_owned(),
            Self::Export { form, .. } => format!("writing {}", form.said()),
        }
    }
}
