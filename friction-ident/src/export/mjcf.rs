//! MJCF, the format of `MuJoCo`: a joint with friction, damping and a spring, a drive, and a second body.

use std::fmt::Write as _;

use super::pendulum::{GRAVITY, Pendulum};
use super::xml::comment;
use super::{ExportError, Exported, File, LeftOut, check_name, check_step};
use crate::axis::Axis;
use crate::effects::Slot;
use crate::model::{Model, ModelEffect};

const RIGID: &str = "the friction of a MuJoCo joint holds rigidly until it slides";
const JOINT: &str = "a MuJoCo joint has Coulomb and viscous friction and a linear spring only";

/// A scene for `MuJoCo` with one joint called `name`, and its drive. The step of the integration is `step`, s, or less
/// where a second body swings faster.
///
/// Expressed: mass, `coulomb`, `viscous`, `offset`, `spring`, `gravity-pendulum` (rotary), `motor-gain`, `saturation`,
/// `actuator-lag`, all forms of `flexible-coupling`, and `backlash:two-mass` without the damping of its contact.
/// Everything else is left out, and listed.
///
/// # Errors
/// A model whose forces are in V or A, or without a mass of its own; a name that is none; a step that is not above 0.
pub fn to_mjcf(model: &Model, name: &str, step: f64) -> Result<Exported, ExportError> {
    check_name(name)?;
    check_step(step)?;
    super::check_si(model, "MJCF")?;
    let mut scene = Scene::new(model, step);
    for term in model.terms() {
        scene.take(term);
    }
    scene.finish();
    let text = scene.text(name);
    let Scene { expressed, left_out, .. } = scene;
    Ok(Exported { files: vec![File { name: format!("{name}.xml"), text }], expressed, left_out })
}

/// The body behind a coupling or a gap.
struct Load {
    mass: f64,
    friction: f64,
    damping: f64,
    stiffness: f64,
    coupling: f64,
    gap: f64,
    shown: bool,
}

struct Scene<'a> {
    model: &'a Model,
    step: f64,
    friction: f64,
    damping: f64,
    offset: f64,
    stiffness: f64,
    rest: f64,
    weight: Option<(f64, f64)>,
    gain: f64,
    /// Largest command in front of a lag.
    command: Option<f64>,
    /// Largest force behind a lag.
    force: Option<f64>,
    lag: Option<f64>,
    load: Option<Load>,
    expressed: Vec<String>,
    left_out: Vec<LeftOut>,
}

impl<'a> Scene<'a> {
    fn new(model: &'a Model, step: f64) -> Self {
        Self {
            model,
            step,
            friction: 0.0,
            damping: 0.0,
            offset: 0.0,
            stiffness: 0.0,
            rest: 0.0,
            weight: None,
            gain: 1.0,
            command: None,
            force: None,
            lag: None,
            load: None,
            expressed: vec!["mass".to_owned()],
            left_out: Vec::new(),
        }
    }

    fn take(&mut self, term: &ModelEffect) {
        let p = term.values();
        match term.name() {
            "coulomb" if p[0] >= 0.0 => self.friction = p[0],
            "viscous" if p[0] >= 0.0 => self.damping = p[0],
            "offset" => self.offset = p[0],
            "spring" if p[0] >= 0.0 => (self.stiffness, self.rest) = (p[0], p[1]),
            "gravity-pendulum" if self.model.axis() == Axis::Rotary => {
                self.weight = Some((p[0], p[1]));
            }
            "motor-gain" => self.gain *= p[0],
            "saturation" if self.lag.is_none() => self.command = Some(p[0] / self.gain),
            "saturation" => self.force = Some(p[0]),
            "actuator-lag" => self.lag = Some(p[0]),
            "flexible-coupling" => self.load = Some(coupled(p, 0.0, 0.0, false)),
            "flexible-coupling:friction" => self.load = Some(coupled(p, p[3], p[4], false)),
            "flexible-coupling:load" => self.load = Some(coupled(p, p[3], p[4], true)),
            "backlash:two-mass" => {
                self.load = Some(Load {
                    mass: p[0],
                    friction: p[1],
                    damping: p[2],
                    stiffness: p[4],
                    coupling: 0.0,
                    gap: p[3],
                    shown: false,
                });
                self.left_out.push(LeftOut {
                    what: "backlash:two-mass.zeta".to_owned(),
                    why: "a tendon's damper would act inside the gap, too",
                });
            }
            name => {
                self.left_out.push(LeftOut { what: name.to_owned(), why: why(term) });
                return;
            }
        }
        self.expressed.push(term.name().to_owned());
    }

    /// What only shows once all effects are known.
    fn finish(&mut self) {
        if self.force.is_some() && self.offset != 0.0 {
            self.force = None;
            self.expressed.retain(|name| name != "saturation");
            self.left_out.push(LeftOut {
                what: "saturation".to_owned(),
                why: "behind the lag, MuJoCo would limit drive and constant force together",
            });
        }
        if let Some(load) = &self.load {
            // Springs are integrated explicitly: a tenth of the period over 2 pi is well within what is stable.
            let inverse = 1.0 / self.model.mass() + 1.0 / load.mass.max(f64::MIN_POSITIVE);
            let frequency = (load.stiffness * inverse).sqrt();
            if frequency.is_finite() && frequency > 0.0 {
                self.step = self.step.min(0.1 / frequency);
            }
        }
    }

    fn text(&self, name: &str) -> String {
        let mut text = comment(&self.about());
        let _ = write!(
            text,
            "<mujoco model=\"{name}\">\n  <compiler angle=\"radian\"/>\n  \
             <option timestep=\"{}\" integrator=\"implicitfast\" gravity=\"0 0 -{GRAVITY}\"/>\n  <worldbody>\n",
            self.step
        );
        let body = self.weight.map_or_else(
            || Pendulum::new(self.model.mass(), 0.0, 0.0),
            |(torque, zero)| Pendulum::new(self.model.mass(), torque, zero),
        );
        let friction = friction(self.friction, self.step);
        let spring = if self.stiffness == 0.0 {
            String::new()
        } else {
            format!(" stiffness=\"{}\" springref=\"{}\"", self.stiffness, self.rest)
        };
        text += &self.body(name, &format!("damping=\"{}\"{friction}{spring}", self.damping), body);
        if let Some(load) = &self.load {
            let joint =
                format!("damping=\"{}\"{}", load.damping, self::friction(load.friction, self.step));
            text += &self.body(&format!("{name}_load"), &joint, Pendulum::new(load.mass, 0.0, 0.0));
        }
        text += "  </worldbody>\n";
        if let Some(load) = &self.load {
            let half = 0.5 * load.gap;
            let _ = write!(
                text,
                "  <tendon>\n    <fixed name=\"{name}_coupling\" stiffness=\"{}\" damping=\"{}\" \
                 springlength=\"{} {half}\">\n      <joint joint=\"{name}\" coef=\"1\"/>\n      \
                 <joint joint=\"{name}_load\" coef=\"-1\"/>\n    </fixed>\n  </tendon>\n",
                load.stiffness, load.coupling, -half
            );
        }
        text + &self.drive(name)
    }

    fn body(&self, name: &str, joint: &str, body: Pendulum) -> String {
        let Pendulum { mass, place: [x, z], inertia } = body;
        let (kind, axis, mass, inertia) = match self.model.axis() {
            // The moments of inertia of what only slides are of no consequence.
            Axis::Linear => ("slide", "1 0 0", inertia, inertia),
            Axis::Rotary => ("hinge", "0 1 0", mass, inertia),
        };
        format!(
            "    <body name=\"{name}\">\n      <joint name=\"{name}\" type=\"{kind}\" axis=\"{axis}\" {joint}/>\n      \
             <inertial pos=\"{x} 0 {z}\" mass=\"{mass}\" diaginertia=\"{inertia} {inertia} {inertia}\"/>\n    </body>\n"
        )
    }

    fn drive(&self, name: &str) -> String {
        let shown = if self.load.as_ref().is_some_and(|load| load.shown) {
            format!("{name}_load")
        } else {
            name.to_owned()
        };
        let mut drive = format!("gainprm=\"{}\"", self.gain);
        if self.offset != 0.0 {
            let _ = write!(drive, " biastype=\"affine\" biasprm=\"{} 0 0\"", -self.offset);
        }
        if let Some(lag) = self.lag.filter(|lag| *lag > 0.0) {
            let _ = write!(drive, " dyntype=\"filterexact\" dynprm=\"{lag}\"");
        }
        if let Some(most) = self.command {
            let _ = write!(drive, " ctrllimited=\"true\" ctrlrange=\"{} {most}\"", -most);
        }
        if let Some(most) = self.force {
            let _ = write!(drive, " forcelimited=\"true\" forcerange=\"{} {most}\"", -most);
        }
        format!(
            "  <actuator>\n    <general name=\"{name}\" joint=\"{name}\" {drive}/>\n  </actuator>\n  <sensor>\n    \
             <jointpos name=\"{name}_position\" joint=\"{shown}\"/>\n    \
             <jointvel name=\"{name}_velocity\" joint=\"{name}\"/>\n  </sensor>\n</mujoco>\n"
        )
    }

    fn about(&self) -> Vec<String> {
        let unit = if self.model.axis() == Axis::Linear { "N" } else { "N m" };
        let mut lines = vec![
            format!(
                "Written by aep export. Control: the command of the drive, {unit}, held between steps."
            ),
            format!("As in the model: {}.", self.expressed.join(", ")),
            "Friction that holds creeps a little here: MuJoCo's constraints are soft.".to_owned(),
        ];
        lines.extend(super::listed(&self.left_out, "MJCF"));
        lines
    }
}

fn coupled(p: &[f64], friction: f64, damping: f64, shown: bool) -> Load {
    let w = std::f64::consts::TAU * p[1];
    Load {
        mass: p[0],
        friction,
        damping,
        stiffness: p[0] * w * w,
        coupling: 2.0 * p[2] * p[0] * w,
        gap: 0.0,
        shown,
    }
}

/// Coulomb friction as stiff as the step allows.
fn friction(level: f64, step: f64) -> String {
    if level == 0.0 {
        return String::new();
    }
    format!(
        " frictionloss=\"{level}\" solreffriction=\"{} 1\" solimpfriction=\"0.9999 0.9999 0.001 0.5 2\"",
        2.0 * step
    )
}

fn why(term: &ModelEffect) -> &'static str {
    let about = term.effect().about();
    match about.slots.first() {
        Some(Slot::Contact) => RIGID,
        Some(Slot::Drive) => "MuJoCo's drives have a gain, a limit and a first-order lag",
        Some(Slot::Attached) => "MuJoCo has no such connection",
        Some(Slot::Sensor) => "MuJoCo's sensors have no periodic error",
        Some(Slot::Memory) => "the friction of a MuJoCo joint remembers nothing",
        Some(Slot::SmoothForce | Slot::FrictionLevel) | None => JOINT,
    }
}
