//! Terms that describe structure without explaining it, as text that [`crate::effects::formula`] reads.

use std::fmt::Write;

use missing_physics::Coordinate;
use missing_physics::family::Generic;
use missing_physics::statistics::in_time::Structure;

/// Bumps that make up a profile over the whole range.
const BUMPS: usize = 8;

/// The effect file of a term of this shape along `coordinate`; nothing for a coordinate that a formula
/// does not know.
pub fn effect(coordinate: &Coordinate, shape: &Generic, unit: &str) -> Option<String> {
    let variable = match coordinate.name.as_str() {
        "time" | "time (against motion)" => "t",
        "position" | "position (against motion)" => "x",
        "velocity" => "v",
        "speed" => "abs(v)",
        "load" => "abs(F)",
        _ => return None,
    };
    let name = match shape {
        Generic::InTime(Structure::Step { .. }) => "step-in-time",
        Generic::InTime(Structure::Sine { .. }) => "swing-in-time",
        Generic::Bump { .. } => "local",
        Generic::Profile { .. } => "profile",
    };
    let mut parameters = String::new();
    let mut amplitude = |name: &str, size: f64| {
        let limit = 10.0 * size.abs().max(1e-3);
        let _ = writeln!(
            parameters,
            "{name} = {{ unit = \"{unit}\", low = -{0}, high = {0}, default = {1}, linear = true }}",
            plain(limit),
            plain(size)
        );
    };
    let law = match *shape {
        Generic::InTime(Structure::Step { time, height }) => {
            amplitude("a", height);
            shape_parameter(&mut parameters, "t_0", "s", [0.8 * time, 1.2 * time, time]);
            format!("a*(0.5 + 0.5*tanh(({variable} - t_0)/0.01))")
        }
        Generic::InTime(Structure::Sine { period, amplitude: size }) => {
            amplitude("a", size);
            amplitude("b", size);
            let range = [0.9 * period, 1.1 * period, period];
            shape_parameter(&mut parameters, "T", "s", range);
            format!("a*sin(2*pi*{variable}/T) + b*cos(2*pi*{variable}/T)")
        }
        Generic::Bump { place, height, range } => {
            amplitude("a", height);
            let around = [place - 0.02 * range, place + 0.02 * range, place];
            shape_parameter(&mut parameters, "c", &coordinate.unit, around);
            let width = [0.002 * range, 0.1 * range, 0.01 * range];
            shape_parameter(&mut parameters, "w", &coordinate.unit, width);
            format!("a*exp(-1*(({variable} - c)/w)^2)")
        }
        Generic::Profile { low, high } => {
            let step = (high - low) / (BUMPS - 1) as f64;
            let bump = |k: usize| {
                amplitude(&format!("c_{}", k + 1), 1.0);
                let centre = low + k as f64 * step;
                let (centre, step) = (plain(centre), plain(step));
                format!("c_{}*exp(-1*(({variable} - ({centre}))/{step})^2)", k + 1)
            };
            (0..BUMPS).map(bump).collect::<Vec<_>>().join(" + ")
        }
    };
    let slot = if coordinate.parity.is_some() { "level" } else { "force" };
    Some(format!("name = \"{name}\"\n{slot} = \"{law}\"\n\n[parameters]\n{parameters}"))
}

/// A number with four digits and without an exponent, which formulas do not read.
fn plain(value: f64) -> String {
    format!("{value:.3e}").parse::<f64>().unwrap_or(value).to_string()
}

fn shape_parameter(text: &mut String, name: &str, unit: &str, [low, high, default]: [f64; 3]) {
    let [low, high, default] = [low, high, default].map(plain);
    let _ = writeln!(
        text,
        "{name} = {{ unit = \"{unit}\", low = {low}, high = {high}, default = {default} }}"
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::formula;

    #[test]
    fn every_shape_is_an_effect_that_can_be_read() {
        let coordinate = |name: &str, unit: &str, opposes: bool| Coordinate {
            name: name.to_owned(),
            unit: unit.to_owned(),
            values: Vec::new(),
            parity: opposes.then(Vec::new),
            state: true,
        };
        let step = Generic::InTime(Structure::Step { time: 4.0, height: 1.5 });
        let sine = Generic::InTime(Structure::Sine { period: 0.7, amplitude: 0.5 });
        let bump = Generic::Bump { place: 0.03, height: -2.0, range: 0.12 };
        let profile = Generic::Profile { low: -0.1, high: 0.2 };
        for (coordinate, shape) in [
            (coordinate("time (against motion)", "s", true), step),
            (coordinate("time", "s", false), sine),
            (coordinate("position", "m", false), bump),
            (coordinate("speed", "m/s", true), profile),
        ] {
            for unit in ["N", "N m", "V", "A"] {
                let text = effect(&coordinate, &shape, unit).unwrap();
                assert!(text.contains(&format!("{{ unit = \"{unit}\", low = -")), "{text}");
                let read = formula::read(&text);
                assert!(read.is_ok(), "{text}\n{:?}", read.err());
            }
        }
        assert!(effect(&coordinate("acceleration", "m/s^2", false), &sine, "N").is_none());
    }
}
