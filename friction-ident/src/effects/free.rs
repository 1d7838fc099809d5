//! What varies freely, with time or along the stroke, or swings by itself: no effect, but what an effect must be told from.
//!
//! A friction level or a force that may be anything at every moment or place explains nothing. Where it predicts as
//! well as effects do that were found, the recording does not show those effects: see [`missing_physics::family::Rival`].

mod gain;
mod wave;

use super::about::STROKE;
use super::{About, Effect, Extent, Motion, Parameter, Parameters, Slot, Smooth};
use crate::axis::Quantity;
use missing_physics::report::Course;

pub use gain::GainOverTime;
pub use wave::ForceWave;

/// Knots over the recording or the stroke; straight between them.
const KNOTS: usize = 24;
const GAPS: usize = KNOTS - 1;

/// A friction level over time.
#[derive(Clone, Copy, Debug)]
pub struct FrictionOverTime;

/// A force over time.
#[derive(Clone, Copy, Debug)]
pub struct ForceOverTime;

/// A friction level that changes at one moment.
#[derive(Clone, Copy, Debug)]
pub struct FrictionStep;

/// A force along the stroke: a stop, soft ends, a cover, whatever else is no spring and no ripple.
#[derive(Clone, Copy, Debug)]
pub struct ForceOverPosition;

/// What no effect of the library may be mistaken for.
pub struct Free {
    /// Its law. Its values are 0 where there is nothing.
    pub effect: &'static dyn Effect,
    /// What it is.
    pub title: &'static str,
    /// Whether an effect is one shape of it.
    pub is_kin: fn(&dyn Effect) -> bool,
}

/// All of them, in the order in which they are asked.
pub static RIVALS: [Free; 6] = [
    Free {
        effect: &FrictionOverTime,
        title: "a friction level that varies freely with time",
        is_kin: |effect| effect.is_course_of_time(),
    },
    Free {
        effect: &FrictionStep,
        title: "a friction level that changes at one moment",
        is_kin: |effect| effect.is_course_of_time(),
    },
    Free {
        effect: &ForceOverTime,
        title: "a force that varies freely with time",
        is_kin: is_constant,
    },
    Free {
        effect: &ForceOverPosition,
        title: "a force that varies freely along the stroke",
        is_kin: |effect| effect.is_of_place() || is_constant(effect),
    },
    Free { effect: &ForceWave, title: "a force that repeats itself over time", is_kin: |_| false },
    Free {
        effect: &GainOverTime,
        title: "a gain of the drive that changes over time",
        is_kin: |effect| effect.is_course_of_time(),
    },
];

/// Whether a force is the same everywhere and always: a course without a bend.
fn is_constant(effect: &dyn Effect) -> bool {
    effect.about().name == "offset"
}

/// Share of the recording over which a step rises: a fit has to feel where it is.
const RISE: f64 = 0.005;

const NAMES: [&str; KNOTS] = [
    "k_0", "k_1", "k_2", "k_3", "k_4", "k_5", "k_6", "k_7", "k_8", "k_9", "k_10", "k_11", "k_12",
    "k_13", "k_14", "k_15", "k_16", "k_17", "k_18", "k_19", "k_20", "k_21", "k_22", "k_23",
];

const fn moment(name: &'static str, meaning: &'static str, default: f64) -> Parameter {
    Parameter::fixed(name, meaning, Quantity::Time, (-1e9, 1e9), default)
}

/// A `span` and what is free at its knots, from the first one or the second one on; it is 0 before.
///
/// Along the stroke all are free: a base need have no `offset` that a course could begin from. Over time it begins at 0: an
/// axis that rests does not show what is there.
const fn parameters<const N: usize>(span: [Parameter; 2]) -> [Parameter; N] {
    let mut all = [span[0]; N];
    all[1] = span[1];
    let mut k = 2;
    while k < N {
        all[k] = Parameter::signed(
            NAMES[k + KNOTS - N],
            "what is there at knot k of 24",
            Quantity::Force,
            100.0,
            if k == 2 { 1.0 } else { 0.0 },
        );
        k += 1;
    }
    all
}

static OVER_TIME: [Parameter; KNOTS + 1] = parameters([BEGIN, END]);
static OVER_POSITION: [Parameter; KNOTS + 2] = parameters(STROKE);

static FRICTION: About = About {
    name: "friction-over-time",
    title: "friction level that varies freely with time",
    equation: "k(t) s, k straight between 24 knots over the recording, k = 0 at its begin",
    parameters: &OVER_TIME,
    slots: &[Slot::FrictionLevel],
    shows: "(residual x sign of velocity) against time",
    reference: "L. Ljung, System Identification, 1999, ch. 10.3 (time-varying parameters)",
};

static FORCE: About = About {
    name: "force-over-time",
    title: "force that varies freely with time",
    equation: "k(t), straight between 24 knots over the recording, k = 0 at its begin",
    parameters: &OVER_TIME,
    slots: &[Slot::SmoothForce],
    shows: "the residual against time",
    reference: "L. Ljung, System Identification, 1999, ch. 10.3 (time-varying parameters)",
};

static ALONG: About = About {
    name: "force-over-position",
    title: "force that varies freely along the stroke",
    equation: "k(x), straight between 24 knots over the stroke",
    parameters: &OVER_POSITION,
    slots: &[Slot::SmoothForce],
    shows: "the residual against position",
    reference: "L. Ljung, System Identification, 1999, ch. 5.4 (basis functions)",
};

pub(super) const BEGIN: Parameter =
    moment("begin", "begin of the recording", 0.0).taken_from(Extent::RecordingBegin);
pub(super) const END: Parameter =
    moment("finish", "end of the recording", 1.0).taken_from(Extent::RecordingEnd);

static STEP: About = About {
    name: "friction-step",
    title: "friction level that changes at one moment",
    equation: "dF s from the share u of the recording on",
    parameters: &[
        BEGIN,
        END,
        Parameter::signed("dF", "change of the level", Quantity::Force, 100.0, 1.0),
        Parameter::shape(
            "u",
            "moment as a share of the recording",
            Quantity::One,
            (0.02, 0.98),
            0.5,
        )
        .linear(),
    ],
    slots: &[Slot::FrictionLevel],
    shows: "(residual x sign of velocity) against time: a step",
    reference: "M. Basseville, I. V. Nikiforov, Detection of Abrupt Changes, 1993",
};

impl Effect for FrictionStep {
    fn about(&self) -> &'static About {
        &STEP
    }

    /// A step is narrow in time.
    fn few_trials(&self) -> Option<&'static [usize]> {
        Some(&[40])
    }

    /// To the next trials and to the middle between two, and halves of that: a fit feels where the step is no farther than
    /// it rises, and the first order errs where it is large. Over the gap between two pieces of a long recording, too.
    fn other_valleys(&self, fitted: &[f64]) -> Vec<Vec<f64>> {
        const LEAPS: [f64; 14] = [
            -0.2, -0.15, -0.1, -0.05, -0.024, -0.012, -0.006, 0.006, 0.012, 0.024, 0.05, 0.1, 0.15,
            0.2,
        ];
        let &[size, moment] = fitted else { return Vec::new() };
        LEAPS.iter().map(|leap| vec![size, moment + leap]).collect()
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        for (i, level) in level.iter_mut().enumerate() {
            let (begin, end) = (p.get(0)[i], p.get(1)[i]);
            let after = (m.time[i] - begin) / (end - begin) - p.get(3)[i];
            *level += p.get(2)[i] * (after / RISE + 0.5).clamp(0.0, 1.0);
        }
    }
}

impl Effect for FrictionOverTime {
    fn about(&self) -> &'static About {
        &FRICTION
    }

    fn friction_level(&self, p: Parameters<'_>, m: &Motion<'_>, level: &mut [f64]) {
        for (i, level) in level.iter_mut().enumerate() {
            *level += at(p, m.time, i);
        }
    }
}

impl Effect for ForceOverTime {
    fn about(&self) -> &'static About {
        &FORCE
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        for (i, force) in out.force.iter_mut().enumerate() {
            *force += at(p, m.time, i);
        }
    }
}

impl Effect for ForceOverPosition {
    fn about(&self) -> &'static About {
        &ALONG
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        for (i, force) in out.force.iter_mut().enumerate() {
            *force += at(p, m.position, i);
        }
    }
}

/// The value in lane `i` at its time or place.
fn at(p: Parameters<'_>, along: &[f64], i: usize) -> f64 {
    let (begin, end) = (p.get(0)[i], p.get(1)[i]);
    let place = ((along[i] - begin) / (end - begin)).clamp(0.0, 1.0) * GAPS as f64;
    let knot = (place as usize).min(GAPS - 1);
    let value = |k: usize| {
        let of = (k + p.parameters()).checked_sub(KNOTS).filter(|of| *of >= 2);
        of.map_or(0.0, |of| p.get(of)[i])
    };
    let part = place - knot as f64;
    (1.0 - part) * value(knot) + part * value(knot + 1)
}

/// Begin and end of what a rival may vary over, and the unit.
#[derive(Clone, Copy, Debug)]
pub struct Span<'a> {
    /// First value.
    pub begin: f64,
    /// Last value.
    pub end: f64,
    /// Unit of both.
    pub unit: &'a str,
}

/// What a rival was found to be, over the recording and the stroke. Nothing for an effect.
pub fn course(
    name: &str,
    values: &[f64],
    (time, stroke): (Span<'_>, Span<'_>),
    unit: &str,
) -> Option<Course> {
    let span = if name == ALONG.name { stroke } else { time };
    let moment = |share: f64| span.begin + (span.end - span.begin) * share;
    let (unit, along_unit) = (unit.to_owned(), span.unit.to_owned());
    match (name, values) {
        ("friction-step", [change, share]) => {
            Some(Course::Step { change: *change, at: moment(*share), unit, along_unit })
        }
        ("force-wave", [sine, cosine, period]) => {
            Some(Course::Wave { amplitude: sine.hypot(*cosine), period: *period, unit, along_unit })
        }
        ("friction-over-time" | "force-over-time" | "force-over-position", _) => {
            let fixed = std::iter::repeat_n(0.0, KNOTS.saturating_sub(values.len()));
            let knots: Vec<f64> = fixed.chain(values.iter().copied()).collect();
            Some(varies(&knots, moment, unit, along_unit))
        }
        ("gain-over-time", [even, growing]) => {
            let share = |k: usize| k as f64 / GAPS as f64;
            let at = |k| gain::gain([0.0, 1.0, *even, *growing], share(k));
            let knots: [f64; KNOTS] = std::array::from_fn(at);
            Some(varies(&knots, moment, unit, along_unit))
        }
        _ => None,
    }
}

/// What takes these values at the knots.
fn varies(knots: &[f64], moment: impl Fn(f64) -> f64, unit: String, along_unit: String) -> Course {
    let low = knots.iter().fold(f64::INFINITY, |low, v| low.min(*v));
    let high = knots.iter().fold(f64::NEG_INFINITY, |high, v| high.max(*v));
    let jump = |k: &usize| (knots[k + 1] - knots[*k]).abs();
    let most = (0..GAPS).max_by(|a, b| jump(a).total_cmp(&jump(b))).unwrap_or(0);
    let at = |k: usize| moment(k as f64 / GAPS as f64);
    let (from, to) = (at(most), at(most + 1));
    Course::Varies { range: high - low, from, to, unit, along_unit }
}

#[cfg(test)]
mod tests {
    use super::super::testing::{Point, level, smooth};
    use super::*;

    #[test]
    fn it_is_straight_between_the_knots_and_level_beyond() {
        let course = |from: usize| -> Vec<f64> {
            [10.0, 33.0].into_iter().chain((from..KNOTS).map(|k| (k as f64).cos())).collect()
        };
        let (over_time, along) = (course(1), course(0));
        let knot = |k: f64| k.cos();
        // Over time it is 0 at the begin.
        for (place, [before, after], part) in [
            (0.0, [0.0, 1.0], 0.0),
            (10.0, [0.0, 1.0], 0.0),
            (10.5, [0.0, 1.0], 0.5),
            (12.25, [2.0, 3.0], 0.25),
            (33.0, [22.0, 23.0], 1.0),
            (40.0, [22.0, 23.0], 1.0),
        ] {
            let exact = (1.0 - part) * knot(before) + part * knot(after);
            let at_rest = if before == 0.0 { part * knot(after) } else { exact };
            let point = Point { time: place, ..Point::at(0.0, 0.1) };
            assert!((level(&FrictionOverTime, &over_time, point) - at_rest).abs() < 1e-12);
            assert!((smooth(&ForceOverTime, &over_time, point).0 - at_rest).abs() < 1e-12);
            let point = Point::at(place, 0.1);
            assert!((smooth(&ForceOverPosition, &along, point).0 - exact).abs() < 1e-12, "{place}");
        }
    }

    #[test]
    fn a_constant_force_is_a_shape_of_one_that_is_free_and_of_no_level() {
        let kin = |effect: &dyn Effect| -> Vec<&str> {
            let of = RIVALS.iter().filter(|free| (free.is_kin)(effect));
            of.map(|free| free.effect.about().name).collect()
        };
        assert_eq!(
            kin(&crate::effects::offset::Offset),
            ["force-over-time", "force-over-position"]
        );
        assert_eq!(kin(&crate::effects::coulomb::Coulomb), [""; 0]);
    }

    #[test]
    fn a_course_says_how_much_and_when() {
        let mut values = vec![0.0; GAPS];
        values[10..].fill(-1.7);
        let span = |end, unit| Span { begin: 0.0, end, unit };
        let told = |name, values| course(name, values, (span(23.0, "s"), span(0.23, "m")), "N");
        let varies = |from: f64, to: f64, along_unit: &str| Course::Varies {
            range: 1.7,
            from,
            to,
            unit: "N".into(),
            along_unit: along_unit.into(),
        };
        assert_eq!(told("friction-over-time", &values).unwrap(), varies(10.0, 11.0, "s"));
        let along = [&[0.0][..], &values].concat();
        let Some(Course::Varies { range, from, to, unit, along_unit }) =
            told("force-over-position", &along)
        else {
            panic!("it varies")
        };
        assert_eq!((range, unit.as_str(), along_unit.as_str()), (1.7, "N", "m"));
        assert!((from - 0.1).abs() < 1e-12 && (to - 0.11).abs() < 1e-12, "{from} {to}");
        let Some(Course::Varies { range, .. }) = told("gain-over-time", &[-0.2, 0.1]) else {
            panic!("it varies")
        };
        assert!((range - 0.1).abs() < 1e-12, "{range}");
        let (unit, along_unit) = ("N".to_owned(), "s".to_owned());
        let step = Course::Step { change: -1.7, at: 11.5, unit, along_unit };
        assert_eq!(told("friction-step", &[-1.7, 0.5]).unwrap(), step);
        let (unit, along_unit) = ("N".to_owned(), "s".to_owned());
        let wave = Course::Wave { amplitude: 5.0, period: 0.4, unit, along_unit };
        assert_eq!(told("force-wave", &[3.0, -4.0, 0.4]).unwrap(), wave);
        assert_eq!(told("stribeck", &[1.0]), None);
    }

    #[test]
    fn a_step_is_there_from_its_moment_on() {
        let p = [10.0, 30.0, -1.5, 0.5];
        for (time, exact) in [(0.0, 0.0), (19.9, 0.0), (20.0, -0.75), (20.1, -1.5), (40.0, -1.5)] {
            let point = Point { time, ..Point::at(0.0, 0.1) };
            assert!((level(&FrictionStep, &p, point) - exact).abs() < 1e-9, "{time}");
        }
    }
}
