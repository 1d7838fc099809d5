//! Window errors of a challenge: the truth against the base model, and how long they take.

use std::time::Instant;

use friction_ident::challenge::{Hide, Level, generate};
use friction_ident::{WindowOptions, window_errors};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    for hide in ["nothing", "stribeck", "asymmetry", "ripple", "presliding", "position-friction"] {
        let made = generate(&Hide::parse(hide), 1, Level::Clear)?;
        let truth = &made.truth;
        println!(
            "{hide}: {} samples, {:.2} N over {:.2} N",
            made.recording.len(),
            truth.hidden_force,
            truth.noise_force
        );
        for length in [0.1, 0.2, 0.5] {
            let options = WindowOptions::new(length);
            let start = Instant::now();
            let full = window_errors(&truth.model, &made.recording, &options)?;
            let took = start.elapsed().as_secs_f64() * 1e3;
            let base = truth.model.clone().without(hide);
            let base = window_errors(&base, &made.recording, &options)?;
            let um = |x: f64| x * 1e6;
            println!(
                "  {length} s: truth {:.2} um (robust {:.2}), base {:.2} um (robust {:.2}), {took:.0} ms",
                um(full.median()),
                um(full.robust_rms()),
                um(base.median()),
                um(base.robust_rms())
            );
        }
    }
    Ok(())
}
