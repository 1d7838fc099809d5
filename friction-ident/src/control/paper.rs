//! Figures 13 to 17 of the paper: ramps and velocity reversals of the X-Y table under PD, with and
//! without compensation.
//!
//! # How the printed settings are read
//! Sampling time 5 ms, encoder 1 um and `V_cr` = 0.06 cm/s are printed. Of the gains only
//! `K_P = 0.1`, `K_D = 0.1` is printed. Per count and per difference of one sample the two have the ratio
//! `K_D / K_P` = 5 ms, whatever the unit of the force is; it is kept. Read in kgf they are
//! 9.8e5 N/m and 4.9e3 N s/m: unstable for the table's mass alone (spectral radius 1.023), held barely
//! stable (0.987) by its viscous friction ([`super::LinearLoop`]). The gain of D/A converter and amplifier
//! is not printed; [`GAIN`] stands for it. With 0.05 PD sticks and slips at all three speeds, as the paper
//! shows; the same holds for 0.01 to 0.06.
//!
//! The reference of figures 16 and 17 is not printed; it is read as +-0.1 cm/s with a reversal every 2 s.

use crate::closed_loop::Setup;
use crate::model::ModelError;
use crate::paper::{ENCODER, SAMPLE_TIME, table};
use crate::reference::Reference;

use super::compensator::{Compensator, CompensatorError, Settings};
use super::course::Course;
use super::trial::{ControlError, Servo, Trial, run};

/// `V_cr`, m/s.
pub const CRITICAL_VELOCITY: f64 = 6e-4;
/// Share of the gains in kgf that the force at the table is read to have.
pub const GAIN: f64 = 0.05;
/// Printed gain per count in kgf, N/m.
const PER_COUNT: f64 = 0.1 * 9.806_65 / ENCODER;

/// One figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Figure {
    /// `fig13` to `fig17`.
    pub name: &'static str,
    /// What it shows.
    pub title: &'static str,
    /// The reference.
    pub course: Course,
    /// Time that is simulated, s.
    pub duration: f64,
    /// Time that is drawn, s.
    pub drawn: f64,
    /// Whether PD alone is shown.
    pub pd: bool,
    /// Whether PD with compensation is shown.
    pub compensated: bool,
}

const fn ramp(name: &'static str, title: &'static str, speed: f64, drawn: f64) -> Figure {
    let course = Course::Ramp { speed };
    Figure { name, title, course, duration: 10.0, drawn, pd: true, compensated: true }
}

const TURN: Course = Course::Reversal { speed: 1e-3, interval: 2.0 };

const fn turn(name: &'static str, title: &'static str, compensated: bool) -> Figure {
    Figure { name, title, course: TURN, duration: 12.0, drawn: 12.0, pd: !compensated, compensated }
}

/// Figures 13 to 17.
pub const FIGURES: [Figure; 5] = [
    ramp("fig13", "Output responses for a ramp input with the slope of 0.1 cm/s", 1e-3, 2.0),
    ramp("fig14", "Output responses for a ramp input with the slope of 0.05 cm/s", 5e-4, 4.0),
    ramp("fig15", "Output responses for a ramp input with the slope of 0.01 cm/s", 1e-4, 10.0),
    turn("fig16", "Velocity reversal, PD control without friction compensation", false),
    turn("fig17", "Velocity reversal, PD control with friction compensation", true),
];

/// The paper's PD loop with `gain` times the printed gains in kgf.
pub fn servo(gain: f64) -> Servo {
    let proportional = gain * PER_COUNT;
    Servo {
        proportional,
        derivative: proportional * SAMPLE_TIME,
        feedforward: 0.0,
        setup: Setup { encoder_resolution: ENCODER, ..Setup::default() },
    }
}

/// The paper's settings of the compensator.
pub fn settings() -> Settings {
    Settings::new(SAMPLE_TIME, CRITICAL_VELOCITY)
}

/// A figure's runs.
#[derive(Clone, Debug, PartialEq)]
pub struct Shown {
    /// The reference.
    pub reference: Reference,
    /// PD alone.
    pub pd: Trial,
    /// PD with compensation.
    pub compensated: Trial,
    /// The same with the paper's formula to the letter: no pre-sliding in the compensator.
    pub to_the_letter: Trial,
}

/// Why a figure cannot be made.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FigureError {
    /// The table is no model.
    #[error(transparent)]
    Model(#[from] ModelError),
    /// A run fails.
    #[error(transparent)]
    Control(#[from] ControlError),
}

impl From<CompensatorError> for FigureError {
    fn from(error: CompensatorError) -> Self {
        Self::Control(error.into())
    }
}

impl Figure {
    /// Runs the table.
    ///
    /// # Errors
    /// None with the parameters as they stand here.
    pub fn show(&self) -> Result<Shown, FigureError> {
        self.show_with(GAIN)
    }

    /// The same with another gain of converter and amplifier.
    ///
    /// # Errors
    /// The loop runs away.
    pub fn show_with(&self, gain: f64) -> Result<Shown, FigureError> {
        let (table, servo) = (table()?, servo(gain));
        let reference = self.course.sampled(SAMPLE_TIME, self.duration);
        let compensator =
            |presliding| Compensator::new(&table, Settings { presliding, ..settings() });
        let (whole, letter) = (compensator(true)?, compensator(false)?);
        let trial =
            |compensator: Option<&Compensator>| run(&table, &reference, &servo, compensator);
        Ok(Shown {
            pd: trial(None)?,
            compensated: trial(Some(&whole))?,
            to_the_letter: trial(Some(&letter))?,
            reference,
        })
    }
}

/// Share by which compensation cuts the mean standstill at reversals; none without reversals.
pub fn standstill_cut(shown: &Shown) -> Option<f64> {
    let before = shown.pd.measures.mean_standstill()?;
    let after = shown.compensated.measures.mean_standstill()?;
    (before > 0.0).then(|| 1.0 - after / before)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ramps_stick_and_slip_under_pd_and_not_with_compensation() {
        for gain in [0.01, 0.02, 0.03, 0.04, GAIN, 0.06] {
            for figure in &FIGURES[..3] {
                let shown = figure.show_with(gain).unwrap();
                let (pd, with) = (&shown.pd.measures, &shown.compensated.measures);
                let name = figure.name;
                let most = if figure.name == "fig15" { 1 } else { 5 };
                assert!(pd.stick_episodes >= most, "{name} {gain}: {}", pd.stick_episodes);
                assert_eq!((with.stick_episodes, with.limit_cycle), (0, None), "{name} {gain}");
                assert!(with.rms_error < 0.1 * pd.rms_error, "{name} {gain}: {with:?}");
            }
        }
    }

    #[test]
    fn the_formula_to_the_letter_falls_back_into_stick_at_the_slowest_ramp() {
        let episodes = FIGURES.map(|f| f.show().unwrap().to_the_letter.measures.stick_episodes);
        assert_eq!((episodes[0], episodes[1]), (0, 0));
        assert!(episodes[2] > 0);
    }

    #[test]
    fn compensation_cuts_the_standstill_at_reversals_by_nine_tenths() {
        let shown = FIGURES[4].show().unwrap();
        assert_eq!(shown.pd.measures.standstill.len(), 5);
        assert!(shown.pd.measures.standstill.iter().all(|t| *t > 0.1));
        let cut = standstill_cut(&shown).unwrap();
        assert!(cut >= 0.9, "{cut} {:?}", shown.compensated.measures);
    }

    #[test]
    fn the_gains_keep_the_printed_ratio_and_the_loop_is_stable() {
        let (table, servo) = (table().unwrap(), servo(GAIN));
        assert!((servo.derivative / servo.proportional - SAMPLE_TIME).abs() < 1e-15);
        assert!(servo.linear(&table, SAMPLE_TIME).spectral_radius() < 0.97);
    }
}
