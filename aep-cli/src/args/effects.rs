//! Lists of effects on the command line: `coulomb,viscous`.

use std::path::PathBuf;
use std::sync::{PoisonError, RwLock};

use friction_ident::Library;
use friction_ident::effects::formula;
use missing_physics::Recording;

use super::shell::flag;
use crate::failure::Failure;

/// The library, once effects of the user have joined it.
static LIBRARY: RwLock<Option<Library>> = RwLock::new(None);

/// The effects that this run of the program knows: those built in, those of `--effects-file`, and regressors.
pub fn library() -> Library {
    let library = LIBRARY.read().unwrap_or_else(PoisonError::into_inner);
    library.clone().unwrap_or_else(Library::builtin)
}

fn set_library(library: Library) {
    *LIBRARY.write().unwrap_or_else(PoisonError::into_inner) = Some(library);
}

/// The files of effects that were given.
static FILES: RwLock<Vec<PathBuf>> = RwLock::new(Vec::new());

/// ` --effects-file FILE` for every file of effects that was given.
pub fn files_words() -> String {
    let files = FILES.read().unwrap_or_else(PoisonError::into_inner);
    files.iter().map(|file| flag("effects-file", Some(file.display()))).collect()
}

/// Lets the effects in these files join the library. To be called before a command runs.
pub fn add_files(files: &[PathBuf]) -> Result<(), Failure> {
    let mut library = Library::builtin();
    for path in files {
        let text = std::fs::read_to_string(path).map_err(|error| {
            Failure::bad_input(format!("cannot read the effect: {error}")).in_file(path)
        })?;
        let effect = formula::read(&text)
            .map_err(|error| Failure::from_lines(&error.to_string()).in_file(path))?;
        library = library.with(effect);
    }
    set_library(library);
    *FILES.write().unwrap_or_else(PoisonError::into_inner) = files.to_vec();
    Ok(())
}

/// Lets the regressors of a recording join the library.
pub fn add_regressors(recording: &Recording) -> Result<(), Failure> {
    let library = library().with_regressors(recording);
    set_library(library.map_err(|error| Failure::from_lines(&error.to_string()))?);
    Ok(())
}

/// Names of effects, separated by commas.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct EffectNames(pub Vec<String>);

impl std::str::FromStr for EffectNames {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let names = text.split([',', '+']).map(str::trim).filter(|name| !name.is_empty());
        Ok(Self(names.map(str::to_lowercase).collect()))
    }
}

impl EffectNames {
    /// The names, each of them one that the library has.
    pub fn checked(&self) -> Result<Vec<String>, Failure> {
        self.0.iter().map(|name| known(name)).collect()
    }
}

/// The name of an effect that the library has.
pub fn known(name: &str) -> Result<String, Failure> {
    let effect = library().find(name)?;
    Ok(effect.about().name.to_owned())
}
