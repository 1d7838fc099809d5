//! PD with and without friction compensation, run and told: what `aep control` and the studio show.

use std::path::Path;

use aep_studio::report::plain::{Figure, Part};
use friction_ident::control::{
    self, Compensator, ControlError, LeftOut, Measures, Servo, Settings, Trial,
};
use friction_ident::{Model, Quantity, Reference};
use missing_physics::measurement::quantity::{percent, quantity};
use missing_physics::report::{Curve, Plot};

use crate::failure::Failure;
use crate::steps;

/// How the run without compensation is called.
const PD: &str = "PD";
/// How the other one is.
const COMPENSATED: &str = "PD + compensation";

impl From<ControlError> for Failure {
    fn from(error: ControlError) -> Self {
        match error {
            ControlError::Compensator(error) => Self::from_lines(&error.to_string()),
            other => {
                let text = other.to_string();
                let first = text.lines().next().unwrap_or_default();
                Self::failed(format!("the loop cannot be simulated: {first}"))
                    .with_hint("lower --kp and --kd, or sample faster with --sample-time")
            }
        }
    }
}

/// Everything that is decided before a run.
pub struct Case {
    /// The model behind the compensator.
    pub model: Model,
    /// The simulated plant.
    pub plant: Model,
    /// Controller and hardware.
    pub servo: Servo,
    /// What the compensator needs besides.
    pub settings: Settings,
    /// What is followed.
    pub reference: Reference,
}

/// A model that a loop can be simulated with: it stands in newtons and needs no recording.
pub fn read(path: &Path) -> Result<Model, Failure> {
    let model = steps::read_plant(path)?;
    steps::needs_force(&model, path)?;
    Ok(model)
}

/// The runs.
pub struct Both {
    /// Without compensation.
    pub pd: Trial,
    /// With it.
    pub with: Trial,
    /// What the compensator does not act on.
    left_out: Vec<LeftOut>,
}

impl Both {
    /// What the compensation brings; nothing where the error was none before.
    pub fn said(&self) -> Option<String> {
        let (before, after) = (self.pd.measures.rms_error, self.with.measures.rms_error);
        let words = if after <= before { "less" } else { "MORE" };
        (before > 0.0).then(|| {
            format!("Compensation: {} {words} RMS error", percent((1.0 - after / before).abs()))
        })
    }
}

impl Case {
    /// Runs both.
    pub fn run(&self) -> Result<Both, Failure> {
        let compensator =
            Compensator::new(&self.model, self.settings).map_err(ControlError::Compensator)?;
        let left_out = compensator.left_out().to_vec();
        let run = |with| control::run(&self.plant, &self.reference, &self.servo, with);
        Ok(Both { pd: run(None)?, with: run(Some(&compensator))?, left_out })
    }

    /// The loop, and what is to be known of it.
    fn notes(&self, both: &Both) -> Vec<String> {
        let axis = self.model.axis();
        let (servo, step) = (&self.servo, self.settings.sample_time);
        let radius = servo.linear(&self.plant, step).spectral_radius();
        let of_loop = format!(
            "K_P {:.4e} {}, K_D {:.4e} {}, every {}, encoder {}, stick up to {}",
            servo.proportional,
            axis.unit(Quantity::Stiffness),
            servo.derivative,
            axis.unit(Quantity::Damping),
            quantity(step, "s"),
            quantity(servo.setup.encoder_resolution, axis.unit(Quantity::Length)),
            quantity(self.settings.critical_velocity, axis.unit(Quantity::Velocity)),
        );
        let unstable = (radius >= 1.0).then(|| {
            format!("warning: the loop is unstable even without friction levels (spectral radius {radius:.3})")
        });
        let left = both.left_out.iter();
        let left = left.map(|left| format!("not compensated: {}: {}", left.effect, left.why));
        std::iter::once(of_loop).chain(unstable).chain(left).collect()
    }

    fn rows(&self, both: &Both) -> Vec<Vec<String>> {
        let axis = self.model.axis();
        let (length, force) = (axis.unit(Quantity::Length), axis.unit(Quantity::Force));
        let (pd, with) = (&both.pd.measures, &both.with.measures);
        let row = |name: &str, show: &dyn Fn(&Measures) -> String| {
            vec![name.to_owned(), show(pd), show(with)]
        };
        vec![
            row("RMS tracking error", &|m| quantity(m.rms_error, length)),
            row("peak tracking error", &|m| quantity(m.peak_error, length)),
            row("mean lag", &|m| quantity(m.mean_lag, length)),
            row("time to break away", &|m| quantity(m.breakaway_time, "s")),
            row("stick time", &|m| quantity(m.stick_time, "s")),
            row("stick episodes", &|m| m.stick_episodes.to_string()),
            row("standstill at a reversal, mean", &|m| {
                m.mean_standstill().map_or_else(|| "-".into(), |time| quantity(time, "s"))
            }),
            row("RMS command", &|m| quantity(m.effort_rms, force)),
            row("peak command", &|m| quantity(m.effort_peak, force)),
            row("RMS change of the command", &|m| quantity(m.effort_change, force)),
            row("limit cycle", &|m| match m.limit_cycle {
                None => "none".into(),
                Some(cycle) => format!(
                    "{} every {}",
                    quantity(cycle.amplitude, length),
                    quantity(cycle.period, "s")
                ),
            }),
        ]
    }

    /// The loop, each measure without and with compensation, and tracking error, position and command over time.
    pub fn part(&self, both: &Both) -> Part {
        let axis = self.model.axis();
        let (length, force) = (axis.unit(Quantity::Length), axis.unit(Quantity::Force));
        let reference = &self.reference;
        let time: Vec<f64> =
            (0..reference.position.len()).map(|k| k as f64 * reference.sample_time).collect();
        let curve =
            |label: &str, y: Vec<f64>| Curve { label: label.to_owned(), x: time.clone(), y };
        let of_both = |of: &dyn Fn(&Trial) -> Vec<f64>| {
            vec![curve(PD, of(&both.pd)), curve(COMPENSATED, of(&both.with))]
        };
        let error = |trial: &Trial| -> Vec<f64> {
            reference.position.iter().zip(&trial.run.position).map(|(r, p)| r - p).collect()
        };
        let figure = |title: &str, y_label: String, curves: Vec<Curve>| Figure {
            plot: Plot { title: title.to_owned(), x_label: "time / s".to_owned(), y_label, curves },
            bands: Vec::new(),
        };
        let mut positions = of_both(&|trial| trial.run.position.clone());
        positions.push(curve("reference", reference.position.clone()));
        Part {
            id: "control".to_owned(),
            title: "PD with and without compensation".to_owned(),
            notes: self.notes(both),
            headings: ["", &format!("#{PD}"), &format!("#{COMPENSATED}")]
                .map(str::to_owned)
                .to_vec(),
            rows: self.rows(both),
            figures: vec![
                figure(
                    "Tracking error",
                    format!("reference less position / {length}"),
                    of_both(&error),
                ),
                figure("Position", format!("position / {length}"), positions),
                figure(
                    "Command",
                    format!("command / {force}"),
                    of_both(&|trial| trial.run.command.clone()),
                ),
            ],
        }
    }
}
