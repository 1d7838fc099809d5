//! URDF, as ROS reads it: a joint with friction and damping, and what is limited.

use super::pendulum::Pendulum;
use super::xml::comment;
use super::{ExportError, Exported, File, LeftOut, check_name};
use crate::axis::Axis;
use crate::effects::Slot;
use crate::model::Model;

/// Limits of what has none, m or rad, m/s or rad/s, N or N m: URDF wants some.
const FAR: f64 = 1e6;

/// A robot with one joint called `name`.
///
/// Expressed: mass, `coulomb`, `viscous`, `gravity-pendulum` (rotary), and `saturation` where nothing else is in the
/// drive. Everything else is left out, and listed.
///
/// # Errors
/// A model whose forces are in V or A, or without a mass of its own; a name that is none.
pub fn to_urdf(model: &Model, name: &str) -> Result<Exported, ExportError> {
    check_name(name)?;
    super::check_si(model, "URDF")?;
    let (mut friction, mut damping, mut effort) = (0.0, 0.0, FAR);
    let mut body = Pendulum::new(model.mass(), 0.0, 0.0);
    let (mut expressed, mut left_out) = (vec!["mass".to_owned()], Vec::new());
    let drives = model.terms().iter().filter(|t| t.effect().about().acts_on(Slot::Drive)).count();
    for term in model.terms() {
        let p = term.values();
        match term.name() {
            "coulomb" if p[0] >= 0.0 => friction = p[0],
            "viscous" if p[0] >= 0.0 => damping = p[0],
            "gravity-pendulum" if model.axis() == Axis::Rotary => {
                body = Pendulum::new(model.mass(), p[0], p[1]);
            }
            "saturation" if drives == 1 => effort = p[0],
            other => {
                let why =
                    "a URDF joint has Coulomb and viscous friction and a limit of the effort only";
                left_out.push(LeftOut { what: other.to_owned(), why });
                continue;
            }
        }
        expressed.push(term.name().to_owned());
    }
    let unit = if model.axis() == Axis::Linear { "N" } else { "N m" };
    let mut about = vec![
        format!("Written by aep export. Effort of the joint: {unit}."),
        format!("As in the model: {}.", expressed.join(", ")),
        format!("Limits of {FAR:e} stand where none is known."),
    ];
    about.extend(super::listed(&left_out, "URDF"));
    let [x, z] = body.place;
    let (kind, axis, mass, range) = match model.axis() {
        Axis::Linear => {
            ("prismatic", "1 0 0", body.inertia, format!("lower=\"-{FAR}\" upper=\"{FAR}\" "))
        }
        Axis::Rotary => ("continuous", "0 1 0", body.mass, String::new()),
    };
    let inertia = body.inertia;
    let text = format!(
        "<?xml version=\"1.0\"?>\n{}<robot name=\"{name}\">\n  <link name=\"base\"/>\n  \
         <joint name=\"{name}\" type=\"{kind}\">\n    <parent link=\"base\"/>\n    <child link=\"moving\"/>\n    \
         <axis xyz=\"{axis}\"/>\n    <limit {range}effort=\"{effort}\" velocity=\"{FAR}\"/>\n    \
         <dynamics damping=\"{damping}\" friction=\"{friction}\"/>\n  </joint>\n  <link name=\"moving\">\n    \
         <inertial>\n      <origin xyz=\"{x} 0 {z}\"/>\n      <mass value=\"{mass}\"/>\n      \
         <inertia ixx=\"{inertia}\" ixy=\"0\" ixz=\"0\" iyy=\"{inertia}\" iyz=\"0\" izz=\"{inertia}\"/>\n    \
         </inertial>\n  </link>\n</robot>\n",
        comment(&about)
    );
    Ok(Exported { files: vec![File { name: format!("{name}.urdf"), text }], expressed, left_out })
}
