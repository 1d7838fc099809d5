//! What the residual says by itself: noise or not, periodic or not.

use std::fmt::Write;

use aep_studio::words;
use missing_physics::Discovery;
use missing_physics::measurement::quantity::quantity;
use missing_physics::report::Diagnosis;

use super::style::dim;
use super::table::{Align, Table};

/// Whether the residual is noise, in sentences.
pub fn tests(diagnosis: &Diagnosis) -> String {
    let mut text = String::new();
    for line in words::residual_tests(diagnosis) {
        // Writing to a string cannot fail.
        let _ = writeln!(text, " {line}");
    }
    text
}

/// The lines of the spectra; nothing where there are none.
pub fn lines(discovery: &Discovery, diagnosis: &Diagnosis) -> String {
    if diagnosis.lines.is_empty() {
        return String::new();
    }
    let unit = words::main_unit(discovery);
    let mut table = Table::new(&[
        ("periodic in the residual", Align::Left),
        ("along", Align::Left),
        ("amplitude", Align::Right),
        ("p-value", Align::Right),
        ("", Align::Left),
    ]);
    for line in &diagnosis.lines {
        table.row([
            words::line(line),
            line.along.clone(),
            quantity(line.amplitude, &unit),
            words::p_value(line.p_value),
            words::relation(line),
        ]);
    }
    table.text()
        + &format!(" {}\n", dim("p over all bins of a spectrum, at the full rate of the recording"))
}
