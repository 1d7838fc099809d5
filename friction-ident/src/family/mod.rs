//! A recording of a drive as a [`ModelFamily`]: the force that a model requires along the measured
//! motion, compared with the force that was recorded.
//!
//! Every effect of the library is a candidate term; the mass is part of every model.

mod ahead;
mod answers;
mod apart;
pub mod compare;
mod coordinates;
pub mod experiment;
mod filter;
mod foreign;
mod forms;
mod friction;
mod full_rate;
mod generic;
mod given;
mod hold;
mod in_time;
mod law;
mod limits;
mod on_view;
mod own;
mod part;
mod plant;
mod plots;
mod points;
mod preparation;
mod regimes;
mod samples;
mod smoothed;
mod stamps;
mod surrogates;
mod sweep;
#[cfg(test)]
mod testing;
mod typed;
mod views;

use std::ops::Range;
use std::sync::OnceLock;

use missing_physics::statistics::basis::{dot, gram, solve};
use missing_physics::{Coordinate, Fitted, ModelFamily, Recording, Regime, Term};

pub use apart::{Alike, explained, mistaken_for};
pub use compare::{GivenModels, NoView, SideBySide};
pub use foreign::ForeignModel;
pub use hold::HoldChoice;
pub use points::{Decides, ModelPoints, PointValues, Points};
pub use preparation::{PreparationError, Prepared};

use crate::axis::{Axis, Effort};
use crate::driven::MeasuredMotion;
use crate::effects::beside::{BESIDE, MODEL_FORCE};
use crate::effects::free::RIVALS;
use crate::effects::{Effect, Extent, Library, Periodic, Repeats, Slot, search};
use crate::known::Known;
use crate::model::MASS;

/// What the lighter smoother does to the motion, as a multiple of what the heavier one does beyond it.
const DOUBT: f64 = 1.0 / (preparation::SMOOTHER / preparation::HEAVIER - 1.0);

/// What can be chosen.
#[derive(Clone, Default)]
pub struct Options {
    /// Bandwidth of the comparison, Hz; by default 5 % of the sampling frequency.
    pub bandwidth: Option<f64>,
    /// Effects that may be in a model.
    pub library: Library,
    /// Parameters that are known from elsewhere.
    pub known: Known,
}

/// See the module.
#[derive(Clone)]
pub struct FrictionFamily {
    recording: Recording,
    prepared: Prepared,
    axis: Axis,
    effort: Effort,
    library: Library,
    known: Known,
    effects: Vec<&'static dyn Effect>,
    /// How the law of each effect repeats itself.
    periodic: Vec<Option<Periodic>>,
    terms: Vec<Term>,
    time: Vec<f64>,
    target: Vec<f64>,
    doubt: Vec<f64>,
    coordinates: Vec<Coordinate>,
    regimes: Vec<Regime>,
    motion: Vec<Vec<f64>>,
    blocks: Vec<Range<usize>>,
    stroke: (f64, f64),
    hold: Option<HoldChoice>,
    other_hold: Option<Box<Self>>,
    /// The same with the bandwidth that is shown, where that is another than a search's.
    on_view: Option<Box<Self>>,
    /// How far its stamps jittered where its samples do not, samples.
    jitter: Option<f64>,
    /// The cut-off below which its force was taken, Hz.
    smoothing: Option<f64>,
    /// The same recording with the noise of its force smoothed away.
    filtered: smoothed::Filtered,
    /// The force that another model gives, where the recording has one: the models here stand beside it.
    given: Option<given::Given>,
    /// The same of pieces of a long recording.
    part: Option<Box<Self>>,
    ahead: Option<ahead::OneAhead>,
    thinned: Option<ahead::OneAhead>,
    less_thinned: OnceLock<Option<ahead::OneAhead>>,
    top_speed: f64,
}

impl FrictionFamily {
    /// Prepares a recording with channels `force` and `position`. Where it does not say what the force does between
    /// samples, that is decided by what predicts better.
    ///
    /// # Errors
    /// A channel is missing or constant, or too little of the recording moves.
    pub fn new(recording: &Recording, options: &Options) -> Result<Self, PreparationError> {
        let even = stamps::even(recording);
        let read = even.as_ref().map_or(recording, |even| &even.recording);
        let family = Self::of_any_length(read, options)?;
        Ok(family.stamped(even.map(|even| even.jitter)))
    }

    /// The same of a recording whose stamps jittered so far.
    fn stamped(mut self, jitter: Option<f64>) -> Self {
        self.jitter = jitter;
        self.other_hold = self.other_hold.map(|other| Box::new(other.stamped(jitter)));
        self
    }

    /// What was decided about the force between samples, where the recording does not say it.
    pub fn hold(&self) -> Option<HoldChoice> {
        self.hold
    }

    fn as_recorded(recording: &Recording, options: &Options) -> Result<Self, PreparationError> {
        let given = recording.channel(MODEL_FORCE).is_some();
        let prepared = if given {
            let bandwidth = options.bandwidth.unwrap_or(given::bandwidth(recording.interval()));
            Prepared::new(recording, Some(bandwidth))?.without_rests()?
        } else {
            Prepared::new(recording, options.bandwidth)?
        };
        let rotary = recording.channel("position").is_some_and(|channel| channel.unit == "rad");
        let axis = if rotary { Axis::Rotary } else { Axis::Linear };
        let effort =
            recording.channel("force").map_or(Effort::Si, |channel| Effort::of(&channel.unit));
        let stroke = prepared
            .position
            .iter()
            .fold((f64::MAX, f64::MIN), |(low, high), x| (low.min(*x), high.max(*x)));
        let main = options.library.effects().iter().copied().filter(|effect| effect.suits(axis));
        let beside = BESIDE.iter().copied().filter(|_| given);
        let effects: Vec<&'static dyn Effect> = main
            .flat_map(|effect| std::iter::once(effect).chain(effect.forms().iter().copied()))
            .chain(beside)
            .chain(RIVALS.iter().map(|free| free.effect))
            .map(|effect| effect.bound(recording).unwrap_or(effect))
            .collect();
        let limits = limits::Limits::of(&prepared, (axis, effort), stroke);
        let mut terms = vec![if given { limits.timing() } else { limits.mass() }];
        terms.extend(effects.iter().map(|effect| limits.term(effect.about())));
        if given {
            given::as_deviations(&mut terms, &effects);
        }
        options.known.apply(&mut terms)?;
        let coordinates = coordinates::coordinates(&prepared, (axis, effort), recording);
        let regimes = regimes::regimes(&prepared, stroke);
        let mut family = Self {
            recording: recording.clone(),
            axis,
            effort,
            library: options.library.clone(),
            periodic: effects.iter().map(|effect| search::periodic(*effect)).collect(),
            known: options.known.clone(),
            effects,
            terms,
            time: prepared.sample(&prepared.time),
            target: prepared.compare(&prepared.force),
            doubt: Vec::new(),
            coordinates,
            regimes,
            motion: coordinates::motion(&prepared),
            blocks: coordinates::cycles(&prepared),
            stroke,
            hold: None,
            other_hold: None,
            on_view: None,
            jitter: None,
            smoothing: None,
            filtered: smoothed::Filtered::default(),
            part: None,
            given: None,
            ahead: None,
            thinned: None,
            less_thinned: OnceLock::new(),
            top_speed: prepared.velocity.iter().fold(f64::MIN_POSITIVE, |top, v| top.max(v.abs())),
            prepared,
        };
        family.check_laws()?;
        family.given = given::Given::of(&family);
        let (simple, doubt) = family.disagreement();
        family.doubt = doubt;
        if family.given.is_some() {
            family.weigh_given();
            return Ok(family);
        }
        let mass = match (family.known.fixed.get(MASS), family.terms[0].parameters.first()) {
            (Some(mass), _) => *mass,
            (None, Some(mass)) => simple[0].max(0.02 * mass.start),
            (None, None) => simple[0],
        };
        let apart = family.prepared.apart();
        family.ahead = ahead::OneAhead::new(recording, mass, simple[1].max(0.0), apart);
        family.thinned = family.ahead.as_ref().and_then(ahead::OneAhead::thinned);
        Ok(family)
    }

    /// The same with the stroke and the top speed of `other`: a law along the stroke or a curve over speed that
    /// was identified there then means the same places and speeds here.
    #[must_use]
    pub fn with_stroke_of(mut self, other: &Self) -> Self {
        self.stroke = other.stroke;
        self.top_speed = other.top_speed;
        self.on_view = self.on_view.map(|shown| Box::new(shown.with_stroke_of(other)));
        self
    }

    /// Linear or rotary.
    pub fn axis(&self) -> Axis {
        self.axis
    }

    /// What its forces are measured in.
    pub fn effort(&self) -> Effort {
        self.effort
    }

    /// The prepared motion and force.
    pub fn prepared(&self) -> &Prepared {
        &self.prepared
    }

    /// Whether the models of this family stand beside a force that another model gives for every sample
    /// (a channel `model_force`): they have no mass and cannot be simulated.
    pub fn is_beside(&self) -> bool {
        self.given.is_some()
    }

    /// What is known of parameters from elsewhere.
    pub fn known(&self) -> &Known {
        &self.known
    }

    /// Whether a model has a friction level that every axis has, by whatever law, or may have it in a given force.
    fn has_level(&self, model: &Fitted) -> bool {
        let is_level = |term: usize| {
            let effect = self.effect(self.law_of(term).unwrap_or(term))?;
            Some(effect.is_usual() && effect.about().slots.contains(&Slot::FrictionLevel))
        };
        self.given.is_some() || model.terms.iter().any(|term| is_level(*term) == Some(true))
    }

    /// Noise of the measured position, m or rad.
    fn position_deviation(&self) -> f64 {
        let known = self.ahead.as_ref().map(|ahead| ahead.predictor.noise().position);
        known.unwrap_or(self.prepared.position_noise)
    }

    /// Parameters that are not fitted: stroke and top speed are those of the recording, a spring is relaxed in
    /// its middle.
    fn extent(&self, of: Extent) -> Option<f64> {
        match of {
            Extent::StrokeBegin => Some(self.stroke.0),
            Extent::StrokeEnd => Some(self.stroke.1),
            Extent::StrokeMiddle => Some(f64::midpoint(self.stroke.0, self.stroke.1)),
            Extent::RecordingBegin => self.recording.time().first().copied(),
            Extent::RecordingEnd => self.recording.time().last().copied(),
            Extent::TopSpeed => Some(self.top_speed),
        }
    }

    fn driven<R>(&self, run: impl FnOnce(&MeasuredMotion<'_>) -> R) -> R {
        let p = &self.prepared;
        self.driven_by(&p.velocity, &p.acceleration, run)
    }

    fn driven_by<R>(
        &self,
        velocity: &[f64],
        acceleration: &[f64],
        run: impl FnOnce(&MeasuredMotion<'_>) -> R,
    ) -> R {
        let p = &self.prepared;
        let motion = MeasuredMotion::new(&p.time, &p.position, velocity, acceleration)
            .and_then(|motion| motion.with_segments(&p.segments))
            .and_then(|motion| motion.with_drive_force(&p.force));
        match motion {
            Ok(motion) => run(&motion.with_cutoff(p.cutoff)),
            Err(_) => unreachable!("channels of a prepared recording have one length"),
        }
    }

    /// How far the prediction of a simple model moves when the motion is smoothed more heavily:
    /// around reversals and impacts, where the smoother matters, much; elsewhere hardly.
    fn disagreement(&self) -> (Vec<f64>, Vec<f64>) {
        let p = &self.prepared;
        let sliding = |motion: &MeasuredMotion<'_>| motion.sliding();
        let columns = |velocity: &[f64], acceleration: &[f64]| {
            let sliding = self.driven_by(velocity, acceleration, sliding);
            [acceleration, velocity, &sliding, &vec![1.0; velocity.len()]]
                .map(|column| p.compare(column))
                .to_vec()
        };
        let light = columns(&p.velocity, &p.acceleration);
        let heavy = columns(&p.heavier.0, &p.heavier.1);
        let moment: Vec<f64> = light.iter().map(|column| dot(column, &self.target)).collect();
        let simple = solve(&gram(&light), &moment, &[0, 1, 2, 3]);
        let mut difference = vec![0.0; self.target.len()];
        for (k, factor) in simple.iter().enumerate() {
            for (value, (a, b)) in difference.iter_mut().zip(light[k].iter().zip(&heavy[k])) {
                *value += DOUBT * factor * (a - b);
            }
        }
        let doubt = (0..difference.len())
            .map(|k| {
                let near = k.saturating_sub(1)..(k + 2).min(difference.len());
                difference[near].iter().fold(0.0, |most: f64, value| most.max(value.abs()))
            })
            .collect();
        (simple, doubt)
    }

    /// The effect behind a term; nothing for the mass.
    fn effect(&self, term: usize) -> Option<&'static dyn Effect> {
        term.checked_sub(1).map(|index| self.effects[index])
    }

    /// How the law of a term repeats itself along the stroke.
    fn periodic(&self, term: usize) -> Option<Periodic> {
        term.checked_sub(1).and_then(|index| self.periodic[index])
    }

    /// Length of what a law repeats itself along, m, rad or s.
    fn extent_of(&self, law: Periodic) -> f64 {
        match law.of {
            Repeats::Force | Repeats::Gain | Repeats::Sensor => self.stroke.1 - self.stroke.0,
            Repeats::ForceOverTime => self.duration(),
        }
    }

    /// From the begin of the recording to its end, s.
    fn duration(&self) -> f64 {
        let moment = |extent| self.extent(extent).unwrap_or_default();
        moment(Extent::RecordingEnd) - moment(Extent::RecordingBegin)
    }

    fn is_simple(&self, term: usize) -> bool {
        term > 0 && {
            let about = self.effects[term - 1].about();
            about.slots.iter().all(|slot| matches!(slot, Slot::SmoothForce | Slot::FrictionLevel))
        }
    }
}
