//! A model for other simulators: as an FMU, for `MuJoCo`, as URDF, in Modelica.
//!
//! One target a file. What a target cannot express is said: an FMU simulates every effect as the simulator of this crate
//! does or is refused; the others leave effects out and list them, see [`Exported`].
//!
//! ```
//! use friction_ident::{Axis, Model, export};
//!
//! let model = Model::new(Axis::Linear, 30.0)?
//!     .with("coulomb", &[("F_C", 8.0)])?
//!     .with("stribeck", &[("dF", 2.0), ("v_s", 1e-3)])?;
//! let scene = export::to_mjcf(&model, "table", 1e-3)?;
//! assert!(scene.files[0].text.contains("frictionloss=\"8\""));
//! assert_eq!(scene.left_out[0].what, "stribeck");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

pub(crate) mod constants;
mod dynamics;
mod fmu;
mod mjcf;
mod modelica;
mod pendulum;
mod plant;
mod urdf;
mod xml;

use crate::axis::Quantity;
use crate::model::Model;

pub use fmu::to_fmu;
pub use mjcf::to_mjcf;
pub use modelica::to_modelica;
pub use urdf::to_urdf;

/// A file of an export.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct File {
    /// Its name, with folders in it (`sources/plant.c`).
    pub name: String,
    /// Its text.
    pub text: String,
}

/// Something of a model that a target cannot express.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct LeftOut {
    /// The effect, or the parameter of one.
    pub what: String,
    /// Why.
    pub why: &'static str,
}

/// A model as another simulator reads it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Exported {
    /// Files; the first one is what the other simulator opens.
    pub files: Vec<File>,
    /// What is said exactly as in the model.
    pub expressed: Vec<String>,
    /// What is not there.
    pub left_out: Vec<LeftOut>,
}

/// Why a model cannot be exported.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum ExportError {
    /// Effects that are not written in C.
    #[error("{} not written in C, so that an FMU would simulate another machine\nexport a model without {}, or with another form of it ('aep effects' lists them)",
        are(.0), it(.0))]
    NoLaw(Vec<String>),
    /// No mass of its own.
    #[error(
        "the model stands beside a force that another model gives: it has no mass and cannot be simulated\nexport a model of its own: 'aep identify DATA --effects coulomb,viscous,offset -o MODEL.json'"
    )]
    NoPlant,
    /// A format that knows SI units only.
    #[error(
        "the forces of the model are in {unit}: its mass is no mass in {target}, which reads kg and N\nidentify it with the gain of the drive: --force-gain G; an FMU takes any unit"
    )]
    Unit {
        /// Unit of its forces.
        unit: &'static str,
        /// The format.
        target: &'static str,
    },
    /// A name that the format does not take.
    #[error("'{0}' is no name in C and XML\nuse letters, digits and underscores, a letter first")]
    Name(String),
    /// A word of the format.
    #[error("'{0}' is a word of Modelica and names no model\ngive it another name: --name NAME")]
    Keyword(String),
    /// A time step that is none.
    #[error("the step is {0} s\nit must be above 0")]
    Step(String),
}

fn are(names: &[String]) -> String {
    let list = names.iter().map(|name| format!("'{name}'")).collect::<Vec<String>>().join(", ");
    format!("{list} {}", if names.len() == 1 { "is" } else { "are" })
}

fn it(names: &[String]) -> &'static str {
    if names.len() == 1 { "it" } else { "them" }
}

fn check_name(name: &str) -> Result<(), ExportError> {
    let first = name.chars().next().is_some_and(|c| c.is_ascii_alphabetic());
    if first && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_') {
        return Ok(());
    }
    Err(ExportError::Name(name.to_owned()))
}

fn check_step(step: f64) -> Result<(), ExportError> {
    if step > 0.0 && step.is_finite() {
        return Ok(());
    }
    Err(ExportError::Step(step.to_string()))
}

/// Refuses what formats of rigid bodies would take for kg and N.
fn check_si(model: &Model, target: &'static str) -> Result<(), ExportError> {
    if model.timing().is_some() {
        return Err(ExportError::NoPlant);
    }
    if model.effort().is_si() {
        return Ok(());
    }
    let unit = model.effort().unit(model.axis(), Quantity::Force);
    Err(ExportError::Unit { unit, target })
}

/// What is left out, line by line.
fn listed(left_out: &[LeftOut], target: &str) -> Vec<String> {
    if left_out.is_empty() {
        return vec![format!("{target} expresses all of the model.")];
    }
    let line = |left: &LeftOut| format!("Left out: {}: {}.", left.what, left.why);
    left_out.iter().map(line).collect()
}

#[cfg(test)]
pub(crate) mod testing;
#[cfg(test)]
mod tests;
