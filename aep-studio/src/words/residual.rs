//! Whether a residual is noise.

use missing_physics::measurement::quantity::quantity;
use missing_physics::report::{Diagnosis, Whiteness};

use super::{CHANCE, p_value};

/// Whether a residual is noise, as sentences.
pub fn residual_tests(diagnosis: &Diagnosis) -> Vec<String> {
    diagnosis.whiteness.iter().map(whiteness).chain(independence(diagnosis)).collect()
}

/// Whether a residual resembles itself.
pub(crate) fn whiteness(test: &Whiteness) -> String {
    if test.p_value > CHANCE {
        return format!("The residual is white (p = {}).", p_value(test.p_value));
    }
    let memory = match test.memory_s {
        Some(memory) if memory > 0.0 => {
            format!("it resembles itself for about {}", quantity(memory, "s"))
        }
        Some(_) => "it resembles itself at longer lags".to_owned(),
        None => format!(
            "it resembles itself for more than {}",
            quantity(test.interval_s * test.autocorrelation.len() as f64, "s")
        ),
    };
    format!("The residual is not white (p {}): {memory}.", at(test.p_value))
}

fn independence(diagnosis: &Diagnosis) -> Option<String> {
    let all = &diagnosis.independence;
    if all.is_empty() {
        return None;
    }
    // One of several tests is below its level more often than a single one.
    let level = CHANCE / all.len() as f64;
    let follows: Vec<String> = all
        .iter()
        .filter(|test| test.p_value <= level.max(1.0 / 200.0))
        .map(|test| {
            let side = if test.worst_lag_s < 0.0 { "before" } else { "after" };
            let lag = quantity(test.worst_lag_s.abs(), "s");
            format!("{} (correlation {:.2}, {lag} {side} it)", test.input, test.worst)
        })
        .collect();
    Some(if follows.is_empty() {
        let names: Vec<&str> = all.iter().map(|test| test.input.as_str()).collect();
        format!("It does not follow {}.", names.join(", "))
    } else {
        format!("It follows {}.", follows.join(", "))
    })
}

/// A p-value within a sentence: `= 0.012`, `< 0.001`.
fn at(value: f64) -> String {
    let text = p_value(value);
    if text.starts_with('<') { text } else { format!("= {text}") }
}
