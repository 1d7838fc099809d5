//! Bounds, starts and trial values of parameters, from what the recording can show.

use aep_core::Scale;
use missing_physics::{Role, Term, TermParameter};

use super::preparation::Prepared;
use crate::axis::{Axis, Effort, Quantity};
use crate::effects::{self, About, Effect, Periodic, Repeats, Slot, Trials};
use crate::signal::quantile;

/// Most trial periods of a wave: down to 1/280 of the stroke or the recording. Finer ones are not looked for.
const MOST_PERIODS: usize = 700;
/// Spacing of trial periods in frequency times stroke or recording. A line is 1
/// wide, one of the second harmonic half as much.
pub const LINE_WIDTH: f64 = 0.4;

/// Largest share of the time in which a drive is at its limit.
const SATURATED: f64 = 0.2;
/// A limit that falls with the speed is looked for up to this multiple of the largest force.
const MORE_AT_REST: f64 = 3.0;
/// Typical error of an encoder, in standard deviations of the noise of the position.
const NOISES: f64 = 10.0;

/// Sizes of the recording.
pub struct Limits {
    axis: Axis,
    effort: Effort,
    interval: f64,
    force: Size,
    /// Size of the force that is exceeded in [`SATURATED`] of the time.
    usual_force: f64,
    speed: Size,
    acceleration: Size,
    stroke: f64,
    rest_speed: f64,
    position_noise: f64,
}

#[derive(Clone, Copy)]
struct Size {
    rms: f64,
    most: f64,
}

impl Size {
    fn of(values: &[f64]) -> Self {
        let square: f64 = values.iter().map(|value| value * value).sum();
        Self {
            rms: (square / values.len().max(1) as f64).sqrt().max(f64::MIN_POSITIVE),
            most: values.iter().fold(f64::MIN_POSITIVE, |most, value| most.max(value.abs())),
        }
    }
}

impl Limits {
    pub fn of(prepared: &Prepared, (axis, effort): (Axis, Effort), stroke: (f64, f64)) -> Self {
        Self {
            axis,
            effort,
            interval: prepared.interval,
            force: Size::of(&prepared.force),
            usual_force: quantile(&prepared.force, 1.0 - SATURATED),
            speed: Size::of(&prepared.velocity),
            // Of coarse counts that follow each other quickly the smoothed position has an acceleration that is all noise.
            acceleration: Size::of(&prepared.compare(&prepared.acceleration)),
            stroke: (stroke.1 - stroke.0).max(f64::MIN_POSITIVE),
            rest_speed: prepared.rest_speed,
            position_noise: prepared.position_noise,
        }
    }

    /// The mass: part of every model.
    pub fn mass(&self) -> Term {
        let typical = self.force.rms / self.acceleration.rms;
        let parameter = TermParameter {
            name: "mass".into(),
            unit: self.effort.unit(self.axis, Quantity::Mass).into(),
            role: Role::Amplitude,
            lower: 1e-6 * typical,
            upper: 20.0 * typical,
            scale: Scale::Linear,
            start: 0.5 * typical,
        };
        Term {
            name: "mass".into(),
            title: "inertia".into(),
            equation: "m a".into(),
            parameters: vec![parameter],
            always: true,
        }
    }

    /// How much earlier than the recorded force a given one is: part of every model beside it.
    pub fn timing(&self) -> Term {
        let most = super::given::MOST_SHIFT * self.interval;
        let parameter = TermParameter {
            name: "shift".into(),
            unit: "s".into(),
            role: Role::Amplitude,
            lower: -most,
            upper: most,
            scale: Scale::Linear,
            start: 0.5 * self.interval,
        };
        let square = self.interval * self.interval;
        let smoothing = TermParameter {
            name: "smoothing".into(),
            unit: "s^2".into(),
            // Less than none is noise; it must be possible, so that none is no limit.
            lower: -4.0 * square,
            upper: super::given::MOST_SMOOTHING * square,
            start: 10.0 * square,
            ..parameter.clone()
        };
        Term {
            name: "timing".into(),
            title: "shift in time of the given force, and how much it was smoothed".into(),
            equation: "F_model(t + shift) - 1/2 smoothing F_model''(t + shift)".into(),
            parameters: vec![parameter, smoothing],
            always: true,
        }
    }

    /// An effect as a term; parameters that are not fitted are left out.
    pub fn term(&self, about: &About) -> Term {
        let fitted = about.parameters.iter().filter(|parameter| !is_fixed(parameter));
        Term {
            name: about.name.into(),
            title: about.title.into(),
            equation: about.equation.into(),
            parameters: fitted.map(|parameter| self.parameter(parameter, about)).collect(),
            always: false,
        }
    }

    fn parameter(&self, parameter: &effects::Parameter, about: &About) -> TermParameter {
        let amplitude = is_amplitude(about, parameter);
        let (lower, upper, start) = if amplitude {
            self.amplitude(parameter)
        } else if about.is_limit_of_drive(parameter) {
            self.limit_of_drive(about)
        } else {
            self.shape(parameter)
        };
        TermParameter {
            name: parameter.name.into(),
            unit: self.effort.unit(self.axis, parameter.quantity).into(),
            role: if amplitude { Role::Amplitude } else { Role::Shape },
            lower,
            upper,
            scale: parameter.scale,
            start,
        }
    }

    /// An amplitude that could make up twice the whole force; it starts at a tenth of the force.
    fn amplitude(&self, parameter: &effects::Parameter) -> (f64, f64, f64) {
        let per = match parameter.quantity {
            Quantity::Damping => self.speed,
            Quantity::Drag => Size {
                rms: self.speed.rms * self.speed.rms,
                most: self.speed.most * self.speed.rms,
            },
            Quantity::Stiffness => Size { rms: self.stroke, most: self.stroke },
            Quantity::Mass => self.acceleration,
            Quantity::Force => Size { rms: 1.0, most: 1.0 },
            // A motor that loses more than a third of the largest force is none that goes on pulling.
            Quantity::PerForce => return (0.0, 0.5 / self.force.most, 0.1 / self.force.most),
            Quantity::Time => return (0.0, parameter.high, self.interval),
            // What an encoder errs shows from a few counts on.
            Quantity::Length => {
                let (low, high) = parameter.range(self.axis);
                return (low, high, (NOISES * self.position_noise).clamp(1e-6 * high, high));
            }
            _ => {
                let (low, high) = parameter.range(self.axis);
                let typical = parameter.typical(self.axis);
                // A fit measures its steps by it.
                return (low, high, if typical == 0.0 { 0.1 * high } else { typical });
            }
        };
        // From the middle of a stroke its ends are half of it away.
        let reach = if parameter.quantity == Quantity::Stiffness { 0.5 } else { 1.0 };
        let upper = 2.0 * self.force.most / (reach * per.rms);
        let lower = if parameter.low < 0.0 { -upper } else { 0.0 };
        (lower, upper, 0.1 * self.force.rms / per.rms)
    }

    /// A limit of the drive that was reached, but not most of the time.
    fn limit_of_drive(&self, about: &About) -> (f64, f64, f64) {
        let most = self.force.most;
        let lower = self.usual_force.clamp(1e-3 * most, 0.99 * most);
        // One that falls with the speed may be reached where hardly anything is left of it.
        let upper = if about.acts_on(Slot::Drive) { most } else { MORE_AT_REST * most };
        (lower, upper, (lower * most).sqrt())
    }

    /// A shape within what the motion covers; never empty.
    fn shape(&self, parameter: &effects::Parameter) -> (f64, f64, f64) {
        let (low, high) = parameter.range(self.axis);
        let (from, to) = match parameter.quantity {
            Quantity::Velocity => (0.5 * self.rest_speed, 0.5 * self.speed.most),
            Quantity::Length => (self.position_noise, self.stroke),
            Quantity::Stiffness => (
                0.05 * self.force.rms / (0.1 * self.stroke),
                // Many small errors together see what one of them does not.
                10.0 * self.force.rms / self.position_noise.max(1e-6 * self.stroke),
            ),
            // A resonance that the sampling cannot follow is only a little more mass; nearer to half of the sampling
            // frequency it would explain how the counts of an even motion beat with the samples.
            Quantity::Frequency => (low, 0.25 / self.interval),
            // One over a force that is reached, or would be with ten times as much.
            Quantity::PerForce => (0.1 / self.force.most, 1.0 / self.force.most),
            // What settles within two samples cannot be told from what is there at once.
            Quantity::Time => (2.0 * self.interval, f64::INFINITY),
            _ => (low, high),
        };
        let linear = parameter.scale == Scale::Linear;
        let lower = if linear { low } else { from.max(low.min(to)) };
        let upper = to.min(high).max(lower * 1.01);
        let middle = if linear { 0.5 * (lower + upper) } else { (lower * upper).sqrt() };
        // A number that begins at 0 (a logarithm) moves by its unit: a fit measures its steps by the start.
        let is_number = linear && parameter.quantity == Quantity::One;
        let typical = parameter.typical(self.axis);
        let typical = if is_number && typical == 0.0 { 1.0 } else { typical };
        let start = if (lower..=upper).contains(&typical) { typical } else { middle };
        (lower, upper, start)
    }
}

/// Parameters that this comparison takes from the recording: those that are fixed by nature (a
/// stroke), and the neutral position of a spring, which only shifts the offset.
pub fn is_fixed(parameter: &effects::Parameter) -> bool {
    parameter.role == effects::ParameterRole::Fixed || parameter.extent.is_some()
}

/// A lag or a delay of 0 is none, and a small one acts in proportion: in a comparison of forces it
/// is an amplitude, like the sizes that a law is linear in.
fn is_amplitude(about: &About, parameter: &effects::Parameter) -> bool {
    let linear = parameter.scale == Scale::Linear;
    parameter.role == effects::ParameterRole::Amplitude
        || (linear && parameter.quantity == Quantity::Time && about.acts_on(Slot::Drive))
}

/// Trial periods along the stroke, or the recording, of `length` within the limits of `term`, the shortest first: evenly in
/// frequency, a little less than a line width apart, up to the frequency that passes the comparison's
/// bandwidth, in slow motion.
pub fn periods(prepared: &Prepared, length: f64, (term, law): (&Term, Periodic)) -> Vec<Vec<f64>> {
    let slow = match law.of {
        Repeats::Force | Repeats::Gain | Repeats::Sensor => {
            quantile(&prepared.sample(&prepared.velocity), 0.1).max(prepared.rest_speed)
        }
        // As time runs.
        Repeats::ForceOverTime => 1.0,
    };
    let longest = term.parameters.iter().find(|parameter| parameter.name == law.period);
    let lowest = (1.5 / length).max(longest.map_or(0.0, |period| 1.0 / period.upper));
    let passing = prepared.bandwidth / slow;
    let finest = law.shortest.map_or(f64::INFINITY, |shortest| 1.0 / shortest);
    let highest = passing.min(lowest + LINE_WIDTH * MOST_PERIODS as f64 / length).min(finest);
    let count = ((highest - lowest) * length / LINE_WIDTH).ceil().max(1.0) as usize;
    (0..=count)
        .rev()
        .map(|k| vec![1.0 / (lowest + (highest - lowest).max(0.0) * k as f64 / count as f64)])
        .collect()
}

/// Trial shapes of a term as its effect wants them: the product over its shapes, the last one fastest; nothing where it
/// has no wish.
pub fn trials(effect: &dyn Effect, term: &Term) -> Option<Vec<Vec<f64>>> {
    let shapes = term.parameters.iter().filter(|parameter| parameter.role == Role::Shape);
    let lines = shapes.map(|parameter| Some(line(effect.trials(&parameter.name)?, parameter)));
    let lines = lines.collect::<Option<Vec<_>>>().filter(|lines| !lines.is_empty())?;
    Some(lines.iter().fold(vec![Vec::new()], |points, line| {
        let longer = |point: &Vec<f64>| -> Vec<Vec<f64>> {
            line.iter().map(|value| [point.as_slice(), &[*value]].concat()).collect()
        };
        points.iter().flat_map(longer).collect()
    }))
}

fn line(trials: Trials, parameter: &TermParameter) -> Vec<f64> {
    match trials {
        Trials::Spread(count) => missing_physics::family::shapes::spread(parameter, count),
        Trials::At(values) => values.to_vec(),
        Trials::Turn(count) => (-count..=count)
            .map(|k| std::f64::consts::PI * f64::from(k) / f64::from(count))
            .collect(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::family::testing::{family, model};
    use missing_physics::{Channel, ModelFamily, Recording};

    /// Those of a sine of 0.05 m and 18 N in such counts.
    fn of_sine(count: f64) -> Limits {
        let time: Vec<f64> = (0..8000).map(|k| 2.5e-4 * f64::from(k)).collect();
        let position = |t: &f64| (0.05 * (6.0 * t).sin() / count).round() * count;
        let position: Vec<f64> = time.iter().map(position).collect();
        let force = time.iter().map(|t| -18.0 * (6.0 * t).sin()).collect();
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
        let recording = Recording::new("sine", time, channels).unwrap();
        let prepared = Prepared::new(&recording, None).unwrap();
        Limits::of(&prepared, (Axis::Linear, Effort::default()), (-0.05, 0.05))
    }

    #[test]
    fn a_spring_may_make_twice_the_whole_force_at_either_end_of_the_stroke() {
        let family = family();
        let spring = family.terms.iter().position(|term| term.name == "spring").unwrap();
        let spring = of_sine(1e-9).term(family.effect(spring).unwrap().about());
        assert!((spring.parameters[0].upper / 720.0 - 1.0).abs() < 1e-3);
    }

    #[test]
    fn how_large_a_mass_may_be_does_not_depend_on_the_counts() {
        let most = |count: f64| of_sine(count).mass().parameters[0].upper;
        for count in [1e-9, 1e-5, 2e-4] {
            assert!((most(count) / 200.0 - 1.0).abs() < 0.1, "{count}: {}", most(count));
        }
    }

    #[test]
    fn the_shares_of_a_free_contact_have_a_size_by_which_they_are_moved() {
        let family = family();
        let free = family.terms.iter().find(|term| term.name == "presliding:free").unwrap();
        let weights = free.parameters.iter().filter(|p| p.name.starts_with("w_"));
        assert_eq!(weights.filter(|p| p.start == 1.0).count(), 4);
    }

    #[test]
    fn a_friction_by_the_force_of_inertia_is_less_than_the_mass_and_a_coupling_rings() {
        let family = family();
        let limit = |name: &str, parameter: &str, values: &[(&str, f64)]| {
            let all = [values, &[("m", 20.0)]].concat();
            let model = model(&family, &["mass", "coulomb", name], &all);
            let term = *model.terms.last().unwrap();
            let parameters = &family.terms[term].parameters;
            let k = parameters.iter().position(|p| p.name == parameter).unwrap();
            let mass = model.values[0];
            (family.limits(&model, term, k).1, parameters[k].upper, mass)
        };
        let (most, _, mass) = limit("load-friction:both", "c", &[]);
        assert_eq!(most, 0.9 * mass);
        let (most, searched, _) = limit("load-friction:both", "mu", &[]);
        assert_eq!(most, searched);
        // A drift without end is a level where the model has no other.
        let (beside_level, searched, _) = limit("drift", "tau", &[]);
        assert_eq!(beside_level, searched);
        let alone = model(&family, &["mass", "viscous", "drift"], &[("m", 20.0)]);
        let time = family.recording.time();
        let duration = time[time.len() - 1] - time[0];
        assert_eq!(family.limits(&alone, alone.terms[2], 2).1, duration);
        let level = &family.terms[alone.terms[2]].parameters[0];
        assert_eq!(family.limits(&alone, alone.terms[2], 0).1, level.upper);
        // Both bodies swing against each other, the lighter the more: what is behind damps more than it seems.
        let (alone, ..) = limit("flexible-coupling", "zeta", &[("m_L", 1e-9)]);
        assert!((alone - 0.383).abs() < 1e-6);
        let (behind, _, mass) = limit("flexible-coupling", "zeta", &[("m_L", 10.0)]);
        assert!((behind / (0.383 / (1.0 + 10.0 / mass).sqrt()) - 1.0).abs() < 1e-12);
    }
}
