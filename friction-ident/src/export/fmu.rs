//! FMI 2.0 for co-simulation: `modelDescription.xml` and the C source of the plant.

use std::fmt::Write as _;

use super::constants::number;
use super::plant::Plant;
use super::xml::{comment, escaped};
use super::{ExportError, Exported, File, check_name, check_step};
use crate::axis::{Axis, Quantity};
use crate::model::Model;

const FMI_HEADER: &str = include_str!("c/fmi2.h");
const FMI_SOURCE: &str = include_str!("c/fmi2.c");

/// Value references before the parameters of the model, see `c/fmi2.c`.
const FIRST_PARAMETER: usize = 8;

/// The files of an FMU (to be packed into a zip archive) that is called `name` and simulates `model` with steps of at
/// most `max_step`, s: the same law and the same step as [`crate::simulate`], whose motion it repeats up to rounding.
///
/// Input: force (N), torque (N m), or a voltage or current where the model is in one; held between two communication
/// points, or linear where the master gives its derivative. Outputs: position (m or rad) as the sensor shows it,
/// velocity of the mass, mean force of the drive. Parameters: all of the model, `position_start`, `velocity_start`,
/// `max_step` and, with an elastic contact, `contact_start` (utilisation, -1..1).
///
/// # Errors
/// [`ExportError::NoLaw`] for effects that are not written in C (formulas of a user, free curves of the contact), a
/// model without a mass of its own, a name that C does not take, a step that is not above 0.
pub fn to_fmu(model: &Model, name: &str, max_step: f64) -> Result<Exported, ExportError> {
    check_name(name)?;
    check_step(max_step)?;
    let plant = Plant::new(model)?;
    let about = vec![format!("Model {name}: {}.", summary(model))];
    let header = plant.header();
    let source = plant.source(&about);
    let guid = guid(&[&header, &source, FMI_SOURCE, name, &number(max_step)]);
    let fmi = FMI_SOURCE.replace("@GUID@", &guid).replace("@MAX_STEP@", &number(max_step));
    let description = describe(model, name, max_step, &guid, plant.has_contact());
    let file = |name: &str, text: String| File { name: name.to_owned(), text };
    let mut expressed = vec!["mass".to_owned()];
    expressed.extend(model.effects().into_iter().map(str::to_owned));
    Ok(Exported {
        files: vec![
            file("modelDescription.xml", description),
            file("sources/fmi2.c", fmi),
            file("sources/fmi2.h", FMI_HEADER.to_owned()),
            file("sources/plant.c", source),
            file("sources/plant.h", header),
        ],
        expressed,
        left_out: Vec::new(),
    })
}

fn summary(model: &Model) -> String {
    let effects = model.effects();
    if effects.is_empty() { "a mass".to_owned() } else { format!("a mass; {}", effects.join(", ")) }
}

/// A name of its own for the contents: FNV-1a over them, twice.
fn guid(texts: &[&str]) -> String {
    let hash = |basis: u64| {
        texts
            .iter()
            .flat_map(|text| text.bytes())
            .fold(basis, |hash, byte| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3))
    };
    let (a, b) = (hash(0xcbf2_9ce4_8422_2325), hash(0x8422_2325_cbf2_9ce4));
    let hex = format!("{a:016x}{b:016x}");
    format!("{{{}-{}-{}-{}-{}}}", &hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..])
}

/// A scalar variable of the description.
struct Variable {
    name: String,
    reference: usize,
    kind: &'static str,
    about: String,
    unit: &'static str,
    start: Option<f64>,
}

fn variables(model: &Model, max_step: f64, contact: bool) -> Vec<Variable> {
    let (axis, effort) = (model.axis(), model.effort());
    let unit = |quantity| effort.unit(axis, quantity);
    let (input, position, velocity) = match (axis, effort.is_si()) {
        (Axis::Linear, true) => ("force", "position", "velocity"),
        (Axis::Rotary, true) => ("torque", "angle", "angular_velocity"),
        (Axis::Linear, false) => ("effort", "position", "velocity"),
        (Axis::Rotary, false) => ("effort", "angle", "angular_velocity"),
    };
    let of = |name: &str, reference, kind, about: &str, unit, start| Variable {
        name: name.to_owned(),
        reference,
        kind,
        about: about.to_owned(),
        unit,
        start,
    };
    let parameter = "causality=\"parameter\" variability=\"fixed\" initial=\"exact\"";
    let output = "causality=\"output\" variability=\"continuous\" initial=\"calculated\"";
    let (force, length, speed) =
        (unit(Quantity::Force), unit(Quantity::Length), unit(Quantity::Velocity));
    let drive = format!("drive_{input}");
    let mut all = vec![
        of(
            input,
            0,
            "causality=\"input\" variability=\"continuous\"",
            "command of the drive",
            force,
            Some(0.0),
        ),
        of(position, 1, output, "as the sensor shows it", length, None),
        of(velocity, 2, output, "of the mass", speed, None),
        of(&drive, 3, output, "mean of the drive on the mass in the last step", force, None),
        of(
            &format!("{position}_start"),
            4,
            parameter,
            "of the mass at the start",
            length,
            Some(0.0),
        ),
        of(
            &format!("{velocity}_start"),
            5,
            parameter,
            "of the mass at the start",
            speed,
            Some(0.0),
        ),
    ];
    if contact {
        let about = "utilisation of the elastic contact at the start, -1..1";
        all.push(of("contact_start", 6, parameter, about, "1", Some(0.0)));
    }
    all.push(of("max_step", 7, parameter, "longest step of the integration", "s", Some(max_step)));
    for (k, (address, value)) in model.addresses().iter().zip(model.values()).enumerate() {
        let about = model.parameter(address).map_or("moving mass or inertia", |p| p.meaning);
        let unit = model.unit(address).unwrap_or("1");
        all.push(of(address, FIRST_PARAMETER + k, parameter, about, unit, Some(value)));
    }
    all
}

/// Exponents of kg, m, s, A and rad of the units there are.
fn base(unit: &str) -> Option<[i32; 5]> {
    let mut sum = [0; 5];
    let (over, under) = unit.split_once('/').unwrap_or((unit, ""));
    for (part, sign) in [(over, 1), (under, -1)] {
        for factor in part.split_whitespace().filter(|factor| *factor != "1") {
            let (symbol, power) = factor.split_once('^').unwrap_or((factor, "1"));
            let of = match symbol {
                "N" => [1, 1, -2, 0, 0],
                "V" => [1, 2, -3, -1, 0],
                "kg" => [1, 0, 0, 0, 0],
                "m" => [0, 1, 0, 0, 0],
                "s" => [0, 0, 1, 0, 0],
                "A" => [0, 0, 0, 1, 0],
                "rad" => [0, 0, 0, 0, 1],
                "Hz" => [0, 0, -1, 0, 0],
                _ => return None,
            };
            let power: i32 = power.parse().ok()?;
            sum.iter_mut().zip(of).for_each(|(sum, of)| *sum += sign * power * of);
        }
    }
    Some(sum)
}

fn describe(model: &Model, name: &str, max_step: f64, guid: &str, contact: bool) -> String {
    let variables = variables(model, max_step, contact);
    let mut units: Vec<&str> = variables.iter().map(|variable| variable.unit).collect();
    units.sort_unstable();
    units.dedup();
    let mut text = format!(
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{}\
         <fmiModelDescription fmiVersion=\"2.0\" modelName=\"{name}\" guid=\"{guid}\" description=\"{}\" \
         generationTool=\"aep {}\" variableNamingConvention=\"flat\" numberOfEventIndicators=\"0\">\n\
         \x20 <CoSimulation modelIdentifier=\"{name}\" canHandleVariableCommunicationStepSize=\"true\" \
         canInterpolateInputs=\"true\" canNotUseMemoryManagementFunctions=\"true\">\n\
         \x20   <SourceFiles>\n      <File name=\"fmi2.c\"/>\n      <File name=\"plant.c\"/>\n    </SourceFiles>\n\
         \x20 </CoSimulation>\n  <UnitDefinitions>\n",
        comment(&[
            "Written by aep export. Every effect of the model is simulated; nothing is left out."
                .to_owned()
        ]),
        escaped(&summary(model)),
        env!("CARGO_PKG_VERSION"),
    );
    for unit in units {
        let _ = write!(text, "    <Unit name=\"{unit}\">");
        if let Some(exponents) = base(unit) {
            let names = ["kg", "m", "s", "A", "rad"];
            let stated = names.iter().zip(exponents).filter(|(_, exponent)| *exponent != 0);
            let stated: Vec<String> =
                stated.map(|(name, exponent)| format!(" {name}=\"{exponent}\"")).collect();
            let _ = write!(text, "<BaseUnit{}/>", stated.concat());
        }
        text.push_str("</Unit>\n");
    }
    let step = max_step;
    let _ = write!(
        text,
        "  </UnitDefinitions>\n  <LogCategories>\n    <Category name=\"logStatusError\"/>\n  </LogCategories>\n  \
         <DefaultExperiment startTime=\"0\" stopTime=\"1\" stepSize=\"{step}\"/>\n  <ModelVariables>\n"
    );
    for variable in &variables {
        let start = variable.start.map_or(String::new(), |start| format!(" start=\"{start:e}\""));
        let _ = writeln!(
            text,
            "    <ScalarVariable name=\"{}\" valueReference=\"{}\" description=\"{}\" {}>\n      \
             <Real unit=\"{}\"{start}/>\n    </ScalarVariable>",
            escaped(&variable.name),
            variable.reference,
            escaped(&variable.about),
            variable.kind,
            variable.unit,
        );
    }
    // Numbers of the outputs among the variables, from 1.
    let unknowns = [2, 3, 4].map(|k| format!("      <Unknown index=\"{k}\"/>\n")).concat();
    let _ = write!(
        text,
        "  </ModelVariables>\n  <ModelStructure>\n    <Outputs>\n{unknowns}    </Outputs>\n    \
         <InitialUnknowns>\n{unknowns}    </InitialUnknowns>\n  </ModelStructure>\n</fmiModelDescription>\n"
    );
    text
}
