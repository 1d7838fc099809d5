//! Lists of effects on the command line: `coulomb,viscous`.

use std::path::PathBuf;
use std::sync::OnceLock;

use friction_ident::Library;
use friction_ident::effects::formula;

use crate::failure::Failure;

/// The library, once files of the user have joined it.
static LIBRARY: OnceLock<Library> = OnceLock::new();

/// The effects that this run of the program knows: those built in, and those of `--effects-file`.
pub fn library() -> Library {
    LIBRARY.get().cloned().unwrap_or_else(Library::builtin)
}

/// Lets the effects in these files join the library. To be called once, before a command runs.
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
    // It is set nowhere else.
    let _ = LIBRARY.set(library);
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
