//! Lists of effects on the command line: `coulomb,viscous`.

use friction_ident::Library;

use crate::failure::Failure;

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
    let effect = Library::builtin().find(name)?;
    Ok(effect.about().name.to_owned())
}
