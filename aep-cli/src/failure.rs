//! What the user is told when something goes wrong: what, where, how to mend it, and an exit code.

use std::path::Path;

use aep_data::{DataError, SaveError};
use friction_ident::ModelError;
use friction_ident::effects::UnknownEffect;
use friction_ident::family::{ForeignModel, PreparationError};
use friction_ident::identify::IdentifyError;
use missing_physics::DiscoverError;

/// Exit code of wrong usage and bad input.
pub const BAD_INPUT: u8 = 2;
/// Exit code of what Ctrl-C ended.
pub const INTERRUPTED: u8 = 130;
/// Exit code of everything else that fails.
pub const FAILED: u8 = 1;

/// Why a command ends without a result.
#[derive(Clone, Debug)]
pub struct Failure {
    /// What is wrong.
    pub what: String,
    /// Where it is: file, line, column.
    pub place: Option<String>,
    /// How to mend it.
    pub hint: Option<String>,
    /// Exit code.
    pub code: u8,
}

impl Failure {
    /// Something wrong with what the user gave.
    pub fn bad_input(what: impl Into<String>) -> Self {
        Self { what: what.into(), place: None, hint: None, code: BAD_INPUT }
    }

    /// Something else.
    pub fn failed(what: impl Into<String>) -> Self {
        Self { code: FAILED, ..Self::bad_input(what) }
    }

    /// Ended by Ctrl-C.
    pub fn interrupted(what: &str) -> Self {
        Self { code: INTERRUPTED, ..Self::failed(format!("interrupted: {what}")) }
    }

    /// The same with a way to mend it.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    /// The same with a way to mend it where it has none yet.
    #[must_use]
    pub fn with_hint_unless_given(self, hint: &str) -> Self {
        if self.hint.is_some() { self } else { self.with_hint(hint) }
    }

    /// The same with the file it is in.
    #[must_use]
    pub fn in_file(mut self, path: &Path) -> Self {
        self.place = Some(path.display().to_string());
        self
    }

    /// The first line says what, the others how to mend it.
    pub fn from_lines(text: &str) -> Self {
        let (what, hint) = text.split_once('\n').unwrap_or((text, ""));
        let failure = Self::bad_input(what);
        if hint.is_empty() { failure } else { failure.with_hint(hint) }
    }
}

impl From<DataError> for Failure {
    fn from(error: DataError) -> Self {
        Self {
            what: error.problem.to_string(),
            place: Some(error.place()),
            hint: error.hint(),
            code: BAD_INPUT,
        }
    }
}

impl From<SaveError> for Failure {
    fn from(error: SaveError) -> Self {
        Self::bad_input(format!("cannot write the file: {}", error.source))
            .in_file(&error.path)
            .with_hint("check that the folder is there, may be written to, and has room")
    }
}

impl From<ModelError> for Failure {
    fn from(error: ModelError) -> Self {
        Self::from_lines(&error.to_string())
    }
}

impl From<IdentifyError> for Failure {
    fn from(error: IdentifyError) -> Self {
        match error {
            IdentifyError::Term(error) => error.into(),
            error => Self::from_lines(&error.to_string()),
        }
    }
}

impl From<serde_json::Error> for Failure {
    fn from(error: serde_json::Error) -> Self {
        Self::failed(format!("cannot write JSON: {error}"))
    }
}

impl From<UnknownEffect> for Failure {
    fn from(error: UnknownEffect) -> Self {
        Self::from_lines(&error.to_string())
    }
}

impl From<DiscoverError> for Failure {
    fn from(error: DiscoverError) -> Self {
        Self::bad_input(error.to_string()).with_hint("'aep effects' lists them with equations")
    }
}

impl From<ForeignModel> for Failure {
    fn from(error: ForeignModel) -> Self {
        let hint = match error {
            ForeignModel::Axis => "identify a model on this data with 'aep identify'",
            ForeignModel::Effort { .. } => {
                "read both in one unit: --force-unit V, or a gain: --force-gain G"
            }
            ForeignModel::WithMass => {
                "leave --model-force out, or make a model beside it: 'aep identify DATA --model-force COLUMN --effects offset'"
            }
            ForeignModel::Beside => "say the column of that force: --model-force COLUMN",
            ForeignModel::Law(error) => return error.into(),
            ForeignModel::Term(error) => return error.into(),
            ForeignModel::Model(error) => return error.into(),
            other => return Self::from_lines(&other.to_string()),
        };
        Self::bad_input(error.to_string()).with_hint(hint)
    }
}

impl From<PreparationError> for Failure {
    fn from(error: PreparationError) -> Self {
        let hint = match error {
            PreparationError::Slow { .. } => {
                "say the unit of the time: --time-unit ms, or the interval: --interval S"
            }
            _ => "record a motion that reverses several times and covers slow and fast speeds",
        };
        Self::bad_input(error.to_string()).with_hint(hint)
    }
}
