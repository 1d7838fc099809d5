//! References and the sampled loop.

use std::path::{Path, PathBuf};

use aep_data::unit;
use friction_ident::control::{Course, Servo, Settings, from_positions, paper};
use friction_ident::{Axis, Model, Quantity, Reference};

use crate::failure::Failure;

/// What the axis is to follow.
#[derive(clap::Args, Clone, Debug)]
pub struct ReferenceArgs {
    /// What to follow: ramp:0.1cm/s, sine:5mm,0.5Hz, trapezoid:20mm,10mm/s,100mm/s2,
    /// reversal:1mm/s,2s or a CSV file with time and reference
    #[arg(
        long,
        value_name = "REFERENCE",
        default_value = "ramp:0.1cm/s",
        help_heading = "Reference"
    )]
    reference: String,
    /// How long, in s; by default long enough to see what it is for
    #[arg(long, value_name = "S", value_parser = crate::commands::positive, help_heading = "Reference")]
    duration: Option<f64>,
}

/// Controller and hardware.
#[derive(clap::Args, Clone, Debug)]
#[command(next_help_heading = "Loop")]
pub struct LoopArgs {
    /// Sampling time, s
    #[arg(long, value_name = "S", default_value_t = friction_ident::paper::SAMPLE_TIME, value_parser = crate::commands::positive)]
    sample_time: f64,
    /// Proportional gain, N/m or N m/rad; by default from mass and sampling time
    #[arg(long, value_name = "K_P", value_parser = crate::commands::positive)]
    kp: Option<f64>,
    /// Derivative gain on encoder differences, N s/m or N m s/rad; by default from mass and sampling
    /// time
    #[arg(long, value_name = "K_D", value_parser = crate::commands::not_negative)]
    kd: Option<f64>,
    /// Feed forward the mass times the reference's acceleration
    #[arg(long)]
    feedforward: bool,
    /// Resolution of the encoder, m or rad, 0 for none [default: 1e-6 m or 1e-5 rad]
    #[arg(long, value_name = "STEP", value_parser = crate::commands::not_negative)]
    encoder: Option<f64>,
    /// Resolution of the D/A converter, N or N m; 0 for none
    #[arg(long, value_name = "STEP", default_value_t = 0.0, value_parser = crate::commands::not_negative)]
    force_resolution: f64,
    /// Range of the D/A converter: the command is limited to +- this, N or N m
    #[arg(long, value_name = "LIMIT", value_parser = crate::commands::positive)]
    force_limit: Option<f64>,
    /// Measured speed up to which the compensator takes the axis for stuck [default: 6e-4 m/s or
    /// 6e-3 rad/s]
    #[arg(long, value_name = "V_CR", value_parser = crate::commands::positive)]
    critical_velocity: Option<f64>,
    /// Leave pre-sliding out of the compensator, as the paper's formula does
    #[arg(long)]
    no_presliding: bool,
}

impl Default for LoopArgs {
    /// As without flags.
    fn default() -> Self {
        Self {
            sample_time: friction_ident::paper::SAMPLE_TIME,
            kp: None,
            kd: None,
            feedforward: false,
            encoder: None,
            force_resolution: 0.0,
            force_limit: None,
            critical_velocity: None,
            no_presliding: false,
        }
    }
}

impl LoopArgs {
    /// Servo and settings for `model`; gains that are not given are those of `default`, or suit the
    /// model's mass.
    pub fn build(
        &self,
        model: &Model,
        default: Option<Servo>,
    ) -> Result<(Servo, Settings), Failure> {
        let suits = Servo::for_mass(model.mass(), self.sample_time);
        let mut servo = default.unwrap_or(suits);
        if self.kp.is_some() != self.kd.is_some() {
            return Err(Failure::bad_input("one of the gains is given, the other is not")
                .with_hint("give both --kp and --kd, or neither"));
        }
        (servo.proportional, servo.derivative) =
            (self.kp.unwrap_or(servo.proportional), self.kd.unwrap_or(servo.derivative));
        servo.feedforward = if self.feedforward { model.mass() } else { 0.0 };
        let encoder = friction_ident::paper::ENCODER * model.axis().typical(Quantity::Length);
        servo.setup.encoder_resolution = self.encoder.unwrap_or(encoder);
        servo.setup.force_resolution = self.force_resolution;
        servo.setup.force_limit = self.force_limit.unwrap_or(f64::INFINITY);
        let critical = paper::CRITICAL_VELOCITY * model.axis().typical(Quantity::Velocity);
        let critical = self.critical_velocity.unwrap_or(critical);
        let presliding = !self.no_presliding;
        Ok((servo, Settings { presliding, ..Settings::new(self.sample_time, critical) }))
    }
}

/// Longest run, in samples: a slip of a unit should not fill the memory.
const MOST: f64 = 5e6;
/// The same where nobody can end it.
const MOST_SHAPED: f64 = 2e5;
/// Speed of the paper's ramp, m/s.
const SLOW: f64 = 1e-3;

fn sampled(
    course: Course,
    duration: f64,
    sample_time: f64,
    most: f64,
) -> Result<Reference, Failure> {
    if (duration / sample_time).is_nan() || duration / sample_time >= most {
        return Err(Failure::bad_input(format!(
            "{duration:.3e} s at {sample_time} s a sample are too many samples"
        ))
        .with_hint("give a shorter --duration, or check the units of --reference"));
    }
    let reference = course.sampled(sample_time, duration);
    if reference.position.len() < LEAST {
        return Err(too_short(reference.position.len()));
    }
    Ok(reference)
}

impl ReferenceArgs {
    /// The reference, sampled.
    pub fn build(&self, axis: Axis, sample_time: f64) -> Result<Reference, Failure> {
        let is_file = Path::new(&self.reference).extension().is_some_and(|e| e == "csv")
            || Path::new(&self.reference).exists();
        if is_file {
            return self.read_file(Path::new(&self.reference), axis, sample_time);
        }
        let course = course(&self.reference, axis)?;
        let duration = self.duration.unwrap_or_else(|| course.usual_duration());
        sampled(course, duration, sample_time, MOST)
    }

    /// One that is no file, `ramp:0.1cm/s`, over its usual duration; the slow ramp of the paper where none is given.
    pub fn of_shape(
        text: Option<&str>,
        axis: Axis,
        sample_time: f64,
    ) -> Result<Reference, Failure> {
        let slow = Course::Ramp { speed: SLOW * axis.typical(Quantity::Velocity) };
        let course = text.map_or(Ok(slow), |text| course(text, axis))?;
        sampled(course, course.usual_duration(), sample_time, MOST_SHAPED)
    }

    /// A file's positions, linear between its samples.
    fn read_file(&self, path: &Path, axis: Axis, step: f64) -> Result<Reference, Failure> {
        let found = aep_data::read_reference(path)?;
        if found.rotary.is_some_and(|rotary| rotary != (axis == Axis::Rotary)) {
            return Err(Failure::bad_input(
                "the reference does not belong to an axis of this kind",
            )
            .in_file(&PathBuf::from(path))
            .with_hint("lengths for a linear model, angles for a rotary one"));
        }
        let (first, last) = (found.time[0], found.time[found.time.len() - 1]);
        let duration = self.duration.unwrap_or(last - first).min(last - first);
        let samples = (duration / step).floor() + 1.0;
        if samples < LEAST as f64 || samples > MOST {
            return Err(too_short(samples as usize).in_file(&PathBuf::from(path)));
        }
        let mut after = 0;
        let position = (0..samples as usize).map(|k| {
            let t = first + k as f64 * step;
            while after + 2 < found.time.len() && found.time[after + 1] < t {
                after += 1;
            }
            let (a, b) = (after, (after + 1).min(found.time.len() - 1));
            let span = found.time[b] - found.time[a];
            let share = if span > 0.0 { ((t - found.time[a]) / span).clamp(0.0, 1.0) } else { 0.0 };
            found.position[a] + share * (found.position[b] - found.position[a])
        });
        Ok(from_positions(step, position.collect()))
    }
}

/// Fewest samples that make a run.
const LEAST: usize = 20;

fn too_short(samples: usize) -> Failure {
    Failure::bad_input(format!("the reference gives {samples} samples; 20 to 5 million can be run"))
        .with_hint("change --duration or --sample-time")
}

/// `sine:5mm,0.5Hz` and the like.
fn course(text: &str, axis: Axis) -> Result<Course, Failure> {
    let (shape, values) = text.split_once(':').unwrap_or((text, ""));
    let values: Vec<&str> = values.split(',').map(str::trim).filter(|v| !v.is_empty()).collect();
    let value = |index: usize, kind: Kind| kind.read(values[index], axis);
    let wanted = SHAPES.iter().find(|(name, _)| *name == shape);
    let Some((_, parts)) = wanted else {
        return Err(Failure::bad_input(format!("no reference '{shape}'")).with_hint(HINT));
    };
    if values.len() != parts.len() {
        let what = format!("'{shape}' takes {}: {}", parts.len(), parts.join(", "));
        return Err(Failure::bad_input(what).with_hint(HINT));
    }
    let course = match shape {
        "ramp" => Course::Ramp { speed: value(0, Kind::Speed)? },
        "sine" => Course::Sine {
            amplitude: value(0, Kind::Length)?,
            frequency: value(1, Kind::Frequency)?.abs(),
        },
        "trapezoid" => Course::Trapezoid {
            distance: value(0, Kind::Length)?,
            speed: value(1, Kind::Speed)?.abs(),
            acceleration: value(2, Kind::Acceleration)?.abs(),
        },
        _ => Course::Reversal {
            speed: value(0, Kind::Speed)?,
            interval: value(1, Kind::Time)?.abs(),
        },
    };
    Ok(course)
}

const SHAPES: [(&str, &[&str]); 4] = [
    ("ramp", &["speed"]),
    ("sine", &["amplitude", "frequency"]),
    ("trapezoid", &["distance", "speed", "acceleration"]),
    ("reversal", &["speed", "interval"]),
];

const HINT: &str = "ramp:0.1cm/s, sine:5mm,0.5Hz, trapezoid:20mm,10mm/s,100mm/s2, reversal:1mm/s,2s, or a CSV file with time_s,reference_mm";

/// What a number of a reference measures.
#[derive(Clone, Copy)]
enum Kind {
    Length,
    Speed,
    Acceleration,
    Frequency,
    Time,
}

impl Kind {
    /// `5mm` in SI; not 0.
    fn read(self, text: &str, axis: Axis) -> Result<f64, Failure> {
        // The longest beginning that is a number: `1e-3m` is 1e-3 and m.
        let ends = text.char_indices().map(|(at, _)| at).chain([text.len()]).rev();
        let split = ends.filter(|at| text.is_char_boundary(*at)).find_map(|at| {
            let number: f64 = text[..at].trim().parse().ok()?;
            Some((number, text[at..].trim()))
        });
        let Some((number, unit)) = split.filter(|(n, _)| n.is_finite() && *n != 0.0) else {
            return Err(Failure::bad_input(format!(
                "'{text}' is not a number above 0 with a unit"
            ))
            .with_hint(HINT));
        };
        let factor = self.factor(unit, axis).ok_or_else(|| {
            Failure::bad_input(format!("'{unit}' in '{text}' is no unit of {}", self.name(axis)))
                .with_hint(format!("for example {}; without a unit it is SI", self.example(axis)))
        })?;
        Ok(number * factor)
    }

    fn factor(self, text: &str, axis: Axis) -> Option<f64> {
        if text.is_empty() {
            return Some(1.0);
        }
        let si = |text: &str, wanted| {
            unit::find(text).filter(|u| u.quantity == wanted).map(|u| u.factor)
        };
        let rotary = axis == Axis::Rotary;
        match self {
            Self::Length if rotary => si(text, unit::Dimension::Angle),
            Self::Length => si(text, unit::Dimension::Length),
            Self::Speed if rotary => si(text, unit::Dimension::AngularSpeed),
            Self::Speed => si(text, unit::Dimension::Speed),
            Self::Time => si(text, unit::Dimension::Time),
            Self::Frequency => match text {
                "Hz" => Some(1.0),
                "mHz" => Some(1e-3),
                "kHz" => Some(1e3),
                _ => None,
            },
            // A length per s^2: mm/s2, mm/s^2, mm/s/s.
            Self::Acceleration => ["/s2", "/s^2", "/s/s", "/s\u{b2}"]
                .iter()
                .find_map(|ending| text.strip_suffix(ending))
                .and_then(|length| Self::Length.factor(length, axis)),
        }
    }

    fn name(self, axis: Axis) -> &'static str {
        match (self, axis) {
            (Self::Length, Axis::Linear) => "a length",
            (Self::Length, Axis::Rotary) => "an angle",
            (Self::Speed, Axis::Linear) => "a speed",
            (Self::Speed, Axis::Rotary) => "an angular speed",
            (Self::Acceleration, _) => "an acceleration",
            (Self::Frequency, _) => "a frequency",
            (Self::Time, _) => "a time",
        }
    }

    fn example(self, axis: Axis) -> &'static str {
        match (self, axis) {
            (Self::Length, Axis::Linear) => "5mm",
            (Self::Length, Axis::Rotary) => "30deg",
            (Self::Speed, Axis::Linear) => "0.1cm/s",
            (Self::Speed, Axis::Rotary) => "2rpm",
            (Self::Acceleration, Axis::Linear) => "100mm/s2",
            (Self::Acceleration, Axis::Rotary) => "10rad/s2",
            (Self::Frequency, _) => "0.5Hz",
            (Self::Time, _) => "2s",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_carry_their_units() {
        let read = |kind: Kind, text, axis| kind.read(text, axis).unwrap();
        assert!((read(Kind::Speed, "0.1cm/s", Axis::Linear) - 1e-3).abs() < 1e-15);
        assert!((read(Kind::Length, "1e-3m", Axis::Linear) - 1e-3).abs() < 1e-15);
        assert!((read(Kind::Length, "5 mm", Axis::Linear) - 5e-3).abs() < 1e-15);
        assert!((read(Kind::Acceleration, "100mm/s2", Axis::Linear) - 0.1).abs() < 1e-15);
        assert!((read(Kind::Acceleration, "2", Axis::Linear) - 2.0).abs() < 1e-15);
        assert!((read(Kind::Speed, "60rpm", Axis::Rotary) - std::f64::consts::TAU).abs() < 1e-12);
        assert!(Kind::Speed.read("5mm", Axis::Linear).is_err());
        assert!(Kind::Speed.read("1mm/s", Axis::Rotary).is_err());
        assert!(Kind::Length.read("infmm", Axis::Linear).is_err());
        assert!(Kind::Length.read("mm", Axis::Linear).is_err());
    }

    #[test]
    fn shapes_say_what_they_take() {
        let sine = course("sine:5mm,0.5Hz", Axis::Linear).unwrap();
        assert_eq!(sine, Course::Sine { amplitude: 5e-3, frequency: 0.5 });
        let error = course("sine:5mm", Axis::Linear).unwrap_err();
        assert!(error.what.contains("amplitude, frequency"), "{}", error.what);
        assert!(course("jump:5mm", Axis::Linear).unwrap_err().what.contains("jump"));
    }
}
