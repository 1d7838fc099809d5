//! Where the paper's friction compensation holds and where not: stick episodes of the X-Y table on the
//! ramps of figures 13 to 15 in 10 s, and the standstill at the reversals of figures 16 and 17, for
//! several gains of D/A converter and amplifier (1 is the printed gains in kgf).

use std::fmt::Write as _;

use friction_ident::control::Trial;
use friction_ident::control::paper::{FIGURES, FigureError, servo, standstill_cut};
use friction_ident::paper::{SAMPLE_TIME, table};

fn main() -> Result<(), FigureError> {
    let table = table()?;
    println!("stick episodes: PD / with compensation / the same without pre-sliding");
    println!(
        "{:>5} {:>9} {:>8} | {:>14} | {:>14} | {:>14} | standstill cut",
        "gain", "K_P, N/m", "radius", "0.1 cm/s", "0.05 cm/s", "0.01 cm/s"
    );
    for gain in [0.01, 0.02, 0.03, 0.05, 0.06, 0.08, 0.1, 0.2, 0.4, 0.6, 0.8, 1.0] {
        let loop_gain = servo(gain);
        let radius = loop_gain.linear(&table, SAMPLE_TIME).spectral_radius();
        let mut line = format!("{gain:5} {:9.3e} {radius:8.3}", loop_gain.proportional);
        for figure in &FIGURES[..3] {
            let shown = figure.show_with(gain)?;
            let episodes = |trial: &Trial| trial.measures.stick_episodes;
            let (pd, with) = (episodes(&shown.pd), episodes(&shown.compensated));
            // Writing to a string cannot fail.
            let _ = write!(line, " | {pd:4}{with:5}{:5}", episodes(&shown.to_the_letter));
        }
        let cut = standstill_cut(&FIGURES[4].show_with(gain)?);
        println!("{line} | {:5.1} %", 100.0 * cut.unwrap_or(0.0));
    }
    Ok(())
}
