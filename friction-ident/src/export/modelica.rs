//! Modelica: one self-contained model with signals as connectors, whose friction really sticks.

mod contact;
mod part;
mod text;

use self::contact::{Friction, Levels};
use self::part::Part;
use self::text::{indented, is_taken, number, quoted, unit};
use super::{ExportError, Exported, File, LeftOut, check_name};
use crate::axis::{Axis, Quantity};
use crate::model::Model;

/// A Modelica model (language 3.4, no library) called `name`, in a file of its own.
///
/// Input: force (N), torque (N m), or a voltage or current where the model is in one; outputs: position (m or rad) as the
/// sensor shows it, velocity of the mass, force of the drive on it; all are signal connectors, which those of
/// `Modelica.Blocks` connect to. Parameters: all of the model with unit and meaning, position and velocity at the start,
/// and, with an elastic contact, its utilisation then. Rigid friction is a state machine of events: what sticks does not
/// creep, and no speed regularises anything; an elastic contact follows a level that falls within 1 microsecond. Simulated
/// to a small tolerance it is what [`crate::simulate`] comes to as its steps become short.
///
/// Expressed: every effect that an FMU simulates, but, beside an elastic contact, those whose level jumps while it holds or
/// depends on the acceleration. What is left out (those, laws of one's own, signals, free curves of the contact) is listed.
///
/// # Errors
/// A model without a mass of its own; a name that is none in Modelica.
pub fn to_modelica(model: &Model, name: &str) -> Result<Exported, ExportError> {
    check_name(name)?;
    if is_taken(name) {
        return Err(ExportError::Keyword(name.to_owned()));
    }
    if model.timing().is_some() {
        return Err(ExportError::NoPlant);
    }
    let drive = Drive::new(model);
    let text = drive.text(name);
    let Drive { expressed, left_out, .. } = drive;
    Ok(Exported { files: vec![File { name: format!("{name}.mo"), text }], expressed, left_out })
}

/// The drive as equations.
struct Drive<'a> {
    model: &'a Model,
    /// What the terms that are expressed add.
    parts: Vec<Part>,
    expressed: Vec<String>,
    left_out: Vec<LeftOut>,
}

impl<'a> Drive<'a> {
    fn new(model: &'a Model) -> Self {
        let (mut parts, mut expressed, mut left_out) =
            (Vec::new(), vec!["mass".to_owned()], Vec::new());
        let contact = model.terms().iter().find_map(|term| Part::of(term).ok()?.contact);
        for term in model.terms() {
            match Part::of(term).and_then(|part| part.beside(contact)) {
                Ok(part) => {
                    if contact.is_some() && part.has_direction() {
                        left_out.push(LeftOut {
                            what: format!("{} while the contact holds", term.name()),
                            why: "its level is that of the side to which the contact is bent, not of the velocity",
                        });
                    }
                    parts.push(part);
                    expressed.push(term.name().to_owned());
                }
                Err(why) => left_out.push(LeftOut { what: term.name().to_owned(), why }),
            }
        }
        Self { model, parts, expressed, left_out }
    }

    fn unit(&self, quantity: Quantity) -> String {
        unit(self.model.effort().unit(self.model.axis(), quantity))
    }

    /// Names of input, position, velocity.
    fn names(&self) -> [&'static str; 3] {
        let position = match self.model.axis() {
            Axis::Linear => ["position", "velocity"],
            Axis::Rotary => ["angle", "angular_velocity"],
        };
        let input = match (self.model.effort().is_si(), self.model.axis()) {
            (true, Axis::Linear) => "force",
            (true, Axis::Rotary) => "torque",
            (false, _) => "effort",
        };
        [input, position[0], position[1]]
    }

    fn variable(&self, name: &str, quantity: Quantity, about: &str) -> String {
        format!("Real {name}(unit={}) {};", quoted(&self.unit(quantity)), quoted(about))
    }

    /// What all parts add to it.
    fn sum(&self, of: impl Fn(&Part) -> &str) -> String {
        let parts: Vec<&str> = self.parts.iter().map(of).filter(|text| !text.is_empty()).collect();
        parts.join(" + ")
    }

    fn parameters(&self) -> Vec<String> {
        let parameter = |name: &str, unit: &str, value: f64, about: &str| {
            format!(
                "parameter Real {name}(unit={}) = {} {};",
                quoted(unit),
                number(value),
                quoted(about)
            )
        };
        let [_, position, velocity] = self.names();
        let mut lines = Vec::new();
        for (address, value) in self.model.addresses().iter().zip(self.model.values()) {
            let unit = unit(self.model.unit(address).unwrap_or("1"));
            let effect = address.rsplit_once('.').map_or("mass", |(effect, _)| effect);
            if !self.expressed.iter().any(|name| name == effect) {
                continue;
            }
            let about =
                self.model.parameter(address).map_or("moving mass or inertia", |p| p.meaning);
            lines.push(parameter(&text::identifier(address), &unit, value, about));
        }
        let about = "of the mass at the start";
        lines.push(parameter(
            &format!("{position}_start"),
            &self.unit(Quantity::Length),
            0.0,
            &format!("{position} {about}"),
        ));
        lines.push(parameter(
            &format!("{velocity}_start"),
            &self.unit(Quantity::Velocity),
            0.0,
            &format!("velocity {about}"),
        ));
        if self.parts.iter().any(|part| part.contact.is_some()) {
            let about = "utilisation of the elastic contact at the start, -1..1";
            lines.push(parameter("contact_start", "1", 0.0, about));
        }
        lines
    }

    fn friction(&self) -> Friction {
        let contact = self.parts.iter().find_map(|part| Some((part.contact?, part.prefix.clone())));
        // The last hump and the last velocity count, as in the simulator.
        let last = |of: fn(&Part) -> &str| {
            self.parts.iter().rev().map(of).find(|text| !text.is_empty()).unwrap_or_default()
        };
        Friction {
            contact,
            levels: Levels {
                sum: self.sum(|part| &part.level),
                at_start: self.sum(|part| part.level_at_start.unwrap_or(&part.level)),
                velocity: last(|part| &part.level_velocity).to_owned(),
                bond: last(|part| &part.bond).to_owned(),
                hump: last(|part| &part.hump).to_owned(),
            },
            carried: self.sum(|part| &part.carried),
            dwells: self.parts.iter().any(|part| part.reads_dwell),
            slides: self.parts.iter().any(|part| part.reads_dwell || part.reads_sliding),
        }
    }

    /// What comes out of the drive, and what the sensor shows, of what goes in.
    fn chain(&self, begin: &str, of: impl Fn(&Part) -> &str) -> String {
        let steps = self.parts.iter().map(of).filter(|text| !text.is_empty());
        steps.fold(begin.to_owned(), |so_far, step| step.replace("@in", &so_far))
    }

    /// The equations of all parts, whose drives see what comes in.
    fn equations(&self, friction: &Friction, input: &str) -> (Vec<String>, Vec<String>) {
        let (mut initial, mut equations) = (Vec::new(), Vec::new());
        let mut force = input.to_owned();
        for part in &self.parts {
            let filled = |line: &String| {
                friction.filled(&line.replace("@in", &force).replace("@command", input))
            };
            initial.extend(part.initial.iter().map(filled));
            equations.extend(part.equations.iter().map(filled));
            if !part.drive.is_empty() {
                force = part.drive.replace("@in", &force);
            }
        }
        (initial, equations)
    }

    /// The variables of every model.
    fn variables(&self) -> Vec<String> {
        let [_, position, velocity] = self.names();
        let state = |name: &str, quantity, start: &str, about: &str| {
            let start = format!("(start={start}_start, fixed=true, ");
            self.variable(name, quantity, about).replacen('(', &start, 1)
        };
        vec![
            state("x", Quantity::Length, position, "position of the mass"),
            state("v", Quantity::Velocity, velocity, "velocity of the mass"),
            "Real a \"acceleration of the mass\";".to_owned(),
            self.variable("drive", Quantity::Force, "force of the drive on the mass"),
            self.variable("smooth", Quantity::Force, "forces that resist, without friction levels"),
            self.variable("pull", Quantity::Force, "force on other bodies"),
            self.variable("applied", Quantity::Force, "on the mass without friction levels"),
            self.variable("friction", Quantity::Force, "of what slides or sticks"),
        ]
    }

    /// The balance of forces on the mass.
    fn balance(&self, input: &str) -> Vec<String> {
        let zero = |sum: String| if sum.is_empty() { "0".to_owned() } else { sum };
        vec![
            format!("drive = {};", self.chain(input, |part| &part.drive)),
            format!("smooth = {};", zero(self.sum(|part| &part.smooth))),
            format!("pull = {};", zero(self.sum(|part| &part.pull))),
            "applied = drive - smooth - pull;".to_owned(),
            "der(x) = v;".to_owned(),
            "der(v) = a;".to_owned(),
        ]
    }

    fn outputs(&self) -> Vec<String> {
        let [input, position, velocity] = self.names();
        // What the encoder is on, then the encoder.
        let (bodies, sensors): (Vec<&Part>, Vec<&Part>) =
            self.parts.iter().partition(|part| !part.pull.is_empty());
        let shown = bodies.into_iter().chain(sensors).map(|part| part.shown.as_str());
        let shown = shown
            .filter(|text| !text.is_empty())
            .fold("x".to_owned(), |so_far, step| step.replace("@in", &so_far));
        vec![
            format!("{position} = {shown};"),
            format!("{velocity} = v;"),
            format!("drive_{input} = drive;"),
        ]
    }

    fn text(&self, name: &str) -> String {
        let [input, _, velocity] = self.names();
        let friction = self.friction();
        let at_start = format!("{velocity}_start");
        let mut declared = self.variables();
        let of_parts = self.parts.iter().flat_map(|part| &part.declared);
        declared.extend(of_parts.map(|line| line.replace("@velocity", &at_start)));
        declared.extend(friction.declared());
        let (mut initial, of_parts) = self.equations(&friction, input);
        let drive = self.chain(input, |part| part.drive_at_start.unwrap_or(&part.drive));
        let applied = format!("({} - smooth - pull)", drive.replace("@command", input));
        initial.extend(friction.initial(&at_start, &applied));
        let mut equations = self.balance(input);
        equations.extend(friction.equations());
        equations.extend(of_parts);
        equations.extend(self.outputs());
        let mut body = indented(&declared);
        if !initial.is_empty() {
            body += "initial equation\n";
            body += &indented(&initial);
        }
        body += "equation\n";
        body += &indented(&equations);
        // The constant of a circle only where it turns up.
        let circle = format!("  constant Real pi = {:?};\n", std::f64::consts::PI);
        let pi = if body.contains("pi*") { circle.as_str() } else { "" };
        let about = quoted(&self.expressed.join(", "));
        let (head, interface) = (self.head(), self.interface());
        format!("{head}model {name} {about}\n{interface}\n{pi}{body}{ICON}end {name};\n")
    }

    fn head(&self) -> String {
        let mut lines = vec![
            format!("Written by aep export {}.", env!("CARGO_PKG_VERSION")),
            format!("As in the model: {}.", self.expressed.join(", ")),
        ];
        lines.extend(super::listed(&self.left_out, "Modelica"));
        format!("// {}\n", lines.join("\n// "))
    }

    /// Connectors that those of Modelica.Blocks fit, and the parameters.
    fn interface(&self) -> String {
        let [input, position, velocity] = self.names();
        let place = |x: i32, y: i32, size: i32| {
            format!(
                "annotation(Placement(transformation(origin={{{x},{y}}}, extent={{{{-{size},-{size}}},{{{size},{size}}}}})))"
            )
        };
        let signal = |kind: &str, name: &str, quantity, about: &str, place: String| {
            format!(
                "{kind} {name}(unit={}) {}\n  {place};",
                quoted(&self.unit(quantity)),
                quoted(about)
            )
        };
        let mut lines = vec![INPUT.to_owned(), OUTPUT.to_owned()];
        lines.extend(self.parameters());
        lines.extend([
            signal("Input", input, Quantity::Force, "command of the drive", place(-120, 0, 20)),
            signal(
                "Output",
                position,
                Quantity::Length,
                "as the sensor shows it",
                place(110, 60, 10),
            ),
            signal("Output", velocity, Quantity::Velocity, "of the mass", place(110, 0, 10)),
            signal(
                "Output",
                &format!("drive_{input}"),
                Quantity::Force,
                "of the drive on the mass",
                place(110, -60, 10),
            ),
        ]);
        indented(&lines).trim_end().to_owned()
    }
}

const INPUT: &str = "connector Input = input Real \"signal\"
  annotation(Icon(graphics={Polygon(points={{-100,100},{100,0},{-100,-100}}, fillPattern=FillPattern.Solid, fillColor={0,0,127})}));";
const OUTPUT: &str = "connector Output = output Real \"signal\"
  annotation(Icon(graphics={Polygon(points={{-100,100},{100,0},{-100,-100}}, fillPattern=FillPattern.Solid, fillColor={255,255,255})}));";
const ICON: &str = "  annotation(Icon(graphics={Rectangle(extent={{-100,-100},{100,100}}), Text(extent={{-100,40},{100,-40}}, textString=\"%name\")}));\n";
