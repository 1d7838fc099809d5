//! A recording of a drive as a [`ModelFamily`]: the force that a model requires along the measured
//! motion, compared with the force that was recorded.
//!
//! Every effect of the library is a candidate term; the mass is part of every model.

mod ahead;
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

use std::collections::BTreeMap;
use std::ops::Range;
use std::sync::OnceLock;

use missing_physics::family::{Ahead, FullRate, Generic, OtherReading, sizes};
use missing_physics::report::{Course, NamedError, Plot, Remark};
use missing_physics::statistics::basis::{dot, gram, solve};
use missing_physics::statistics::split::Split;
use missing_physics::{
    ComparedQuantity, Coordinate, Fitted, ModelFamily, Recording, Regime, Role, Term,
};

use rayon::prelude::*;

pub use apart::{Alike, explained, mistaken_for};
pub use compare::{GivenModels, NoView, SideBySide};
pub use foreign::ForeignModel;
pub use hold::HoldChoice;
pub use points::{Decides, ModelPoints, PointValues, Points};
pub use preparation::{PreparationError, Prepared};

use crate::axis::{Axis, Effort};
use crate::driven::{MeasuredMotion, columns_along, force_along};
use crate::effects::beside::{BESIDE, MODEL_FORCE};
use crate::effects::free::{self, RIVALS, Span};
use crate::effects::{Effect, Extent, Library, Periodic, Repeats, Slot, formula, search};
use crate::known::Known;
use crate::model::{MASS, Model, ModelError, SHIFT, SMOOTHING, Timing, address};

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

    /// A fitted model as a plant.
    ///
    /// # Errors
    /// The terms do not fit together.
    pub fn model(&self, fitted: &Fitted) -> Result<Model, ModelError> {
        let mut mass = self.known.fixed.get(MASS).copied().unwrap_or(1.0);
        let known = |address: &str| self.known.fixed.get(address).copied().unwrap_or(0.0);
        let mut timing = Timing { shift: known(SHIFT), smoothing: known(SMOOTHING) };
        let mut effects = Vec::new();
        for (position, &index) in fitted.terms.iter().enumerate() {
            let values = &fitted.values[fitted.range(self, position)];
            match index {
                0 => {
                    for (parameter, value) in self.terms[0].parameters.iter().zip(values) {
                        match parameter.name.as_str() {
                            "shift" => timing.shift = *value,
                            "smoothing" => timing.smoothing = *value,
                            _ => mass = *value,
                        }
                    }
                }
                _ => effects.push((self.effects[index - 1], values)),
            }
        }
        let mut model = match &self.given {
            Some(_) => Model::beside(self.axis, timing)?,
            None => Model::new(self.axis, mass)?,
        }
        .with_effort(self.effort);
        for (effect, values) in effects {
            model = model.with_effect(effect)?;
            let mut values = values.iter();
            for parameter in effect.about().parameters {
                let value = if let Some(known) = self.known_value(effect, parameter.name) {
                    Some(known)
                } else if limits::is_fixed(parameter) {
                    parameter.extent.and_then(|extent| self.extent(extent))
                } else {
                    values.next().copied()
                };
                if let Some(value) = value {
                    model.set(&address(effect, parameter.name), value)?;
                }
            }
        }
        Ok(model)
    }

    /// A plant as values of this family's terms.
    ///
    /// # Errors
    /// An effect of the plant is not in the family's library.
    pub fn fitted(&self, model: &Model) -> Result<Fitted, ModelError> {
        let mut fitted = match model.timing() {
            Some(timing) => self.timed(timing),
            None => self.bare(model.mass()),
        };
        for term in model.terms() {
            let found = self.effects.iter().position(|e| e.about().name == term.name());
            let Some(index) = found else {
                return Err(Library::builtin().find(term.name()).err().map_or_else(
                    || ModelError::Syntax(format!("effect '{}' cannot be compared", term.name())),
                    ModelError::from,
                ));
            };
            fitted.terms.push(index + 1);
            let parameters = term.effect().about().parameters.iter().zip(term.values());
            let is_free = |p: &crate::effects::Parameter| {
                !limits::is_fixed(p) && self.known_value(term.effect(), p.name).is_none()
            };
            fitted.values.extend(parameters.filter(|(p, _)| is_free(p)).map(|(_, value)| *value));
        }
        Ok(fitted)
    }

    /// The force that a model requires along the measured motion, sample by sample.
    fn required(&self, fitted: &Fitted) -> Result<Vec<f64>, ModelError> {
        let model = self.model(fitted)?;
        match &self.given {
            Some(given) => given.required(self, &model),
            None => Ok(self.driven(|motion| force_along(&model, motion))),
        }
    }

    /// Whether the models of this family stand beside a force that another model gives for every sample
    /// (a channel `model_force`): they have no mass and cannot be simulated.
    pub fn is_beside(&self) -> bool {
        self.given.is_some()
    }

    /// A given force with this timing alone.
    fn timed(&self, timing: Timing) -> Fitted {
        let parameters = self.terms[0].parameters.iter();
        let value = |shift: bool| if shift { timing.shift } else { timing.smoothing };
        Fitted { terms: vec![0], values: parameters.map(|p| value(p.name == "shift")).collect() }
    }

    /// What is known of parameters from elsewhere.
    pub fn known(&self) -> &Known {
        &self.known
    }

    fn known_value(&self, effect: &dyn Effect, parameter: &str) -> Option<f64> {
        if self.known.fixed.is_empty() {
            return None;
        }
        self.known.fixed.get(&address(effect, parameter)).copied()
    }

    /// A model of the first term alone.
    fn bare(&self, value: f64) -> Fitted {
        Fitted { terms: vec![0], values: vec![value; self.terms[0].parameters.len()] }
    }

    /// Whether a model requires a force everywhere along the measured motion.
    ///
    /// # Errors
    /// A law of it has no value somewhere.
    pub fn check(&self, model: &Model) -> Result<(), PreparationError> {
        let Ok(force) = self.fitted(model).and_then(|fitted| self.required(&fitted)) else {
            return Ok(());
        };
        let name = || {
            let user =
                model.terms().iter().find(|t| t.effect().about().reference == formula::REFERENCE);
            user.or(model.terms().first()).map_or("the model", |term| term.name()).to_owned()
        };
        self.finite(&force, name)
    }

    fn finite(&self, force: &[f64], effect: impl Fn() -> String) -> Result<(), PreparationError> {
        let Some(k) = force.iter().position(|value| !value.is_finite()) else { return Ok(()) };
        let p = &self.prepared;
        Err(PreparationError::Law {
            effect: effect(),
            value: force[k],
            sample: k + 1,
            time: p.time[k],
            position: p.position[k],
            velocity: p.velocity[k],
        })
    }

    /// Laws of the user must have a value along the whole motion, where nothing of them is fitted yet.
    fn check_laws(&self) -> Result<(), PreparationError> {
        for effect in self.effects.iter().filter(|e| e.about().reference == formula::REFERENCE) {
            if let Some(name) = effect.columns().iter().find(|_| !effect.is_bound()) {
                let (effect, column) = (effect.about().name.to_owned(), name.clone());
                return Err(PreparationError::Column { effect, column });
            }
            let Ok(plant) = Model::new(self.axis, 1.0).and_then(|m| m.with_effect(*effect)) else {
                continue;
            };
            let force = self.driven(|motion| force_along(&plant, motion));
            self.finite(&force, || effect.about().name.to_owned())?;
        }
        Ok(())
    }

    /// The value of the first term at which a term alone is looked at.
    fn neutral(&self) -> f64 {
        if self.given.is_some() { 0.0 } else { 1.0 }
    }

    /// Mass of a model; beside a given force what that one seems to have.
    fn mass_of(&self, fitted: &Fitted) -> f64 {
        match &self.given {
            Some(given) => given.mass,
            None => match self.known.fixed.get(MASS) {
                Some(mass) => *mass,
                None => fitted.values.first().copied().unwrap_or(1.0),
            },
        }
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

impl ModelFamily for FrictionFamily {
    fn terms(&self) -> &[Term] {
        &self.terms
    }

    fn shown(&self) -> Option<&dyn ModelFamily> {
        Some(self.on_view.as_deref()?)
    }

    fn quantity(&self) -> ComparedQuantity {
        let (name, unit) = match (self.effort, self.axis) {
            (Effort::Volt, _) => ("voltage", "V"),
            (Effort::Ampere, _) => ("current", "A"),
            (Effort::Si, Axis::Linear) => ("force", "N"),
            (Effort::Si, Axis::Rotary) => ("torque", "Nm"),
        };
        ComparedQuantity { name: name.into(), unit: unit.into() }
    }

    fn time(&self) -> &[f64] {
        &self.time
    }

    fn target(&self) -> &[f64] {
        &self.target
    }

    fn doubt(&self) -> &[f64] {
        &self.doubt
    }

    fn predict(&self, fitted: &Fitted, out: &mut [f64]) {
        let possible = |place: usize| {
            let effect = self.effect(fitted.terms[place])?;
            Some(effect.is_possible(&self.values_in_full(fitted, place)?))
        };
        // A combination that is no plant predicts nothing; it then loses against every other.
        if (0..fitted.terms.len()).any(|place| possible(place) == Some(false)) {
            return out.fill(0.0);
        }
        let Ok(force) = self.required(fitted) else { return out.fill(0.0) };
        // Nor does a law that has no value somewhere.
        if !force.iter().all(|value| value.is_finite()) {
            return out.fill(0.0);
        }
        out.copy_from_slice(&self.prepared.compare(&force));
    }

    fn shapes(&self, term: usize) -> Vec<Vec<f64>> {
        let about = &self.terms[term];
        if about.parameters.iter().all(|p| p.role == Role::Amplitude) {
            return vec![Vec::new()];
        }
        if let Some(law) = self.periodic(term) {
            return limits::periods(&self.prepared, self.extent_of(law), (about, law));
        }
        let trials = self.effect(term).and_then(|effect| limits::trials(effect, about));
        trials.unwrap_or_else(|| missing_physics::family::shapes::grid(about))
    }

    fn columns(
        &self,
        model: &Fitted,
        prediction: &[f64],
        term: usize,
        shape: &[f64],
    ) -> Vec<Vec<f64>> {
        if self.periodic(term).is_some_and(|law| law.of == Repeats::Sensor) {
            return self.encoders(model, &[shape.to_vec()]).swap_remove(0);
        }
        let simple = model.terms.iter().skip(1).chain([&term]).all(|&term| self.is_simple(term));
        let about = &self.terms[term];
        let values = missing_physics::family::shapes::assemble(about, shape, &[]);
        let alone = self.bare(self.neutral()).with(term, &values);
        // Without contact and drive in play a term's columns do not depend on the rest.
        match self.model(&alone) {
            Ok(plant) if simple => {
                let split = self.driven(|motion| columns_along(&plant, motion));
                split
                    .addresses
                    .iter()
                    .zip(&split.columns)
                    .filter(|(address, _)| *address != MASS)
                    .map(|(_, column)| self.prepared.compare(column))
                    .collect()
            }
            _ => missing_physics::family::columns(self, model, prediction, term, shape),
        }
    }

    fn columns_of_shapes(
        &self,
        model: &Fitted,
        prediction: &[f64],
        term: usize,
        shapes: &[Vec<f64>],
    ) -> Vec<Vec<Vec<f64>>> {
        match self.periodic(term) {
            Some(Periodic { of: Repeats::Sensor, .. }) => self.encoders(model, shapes),
            Some(Periodic { of: Repeats::Gain, .. }) => self.gains(shapes),
            Some(Periodic { columns: Some(columns), .. }) => self.repeated(columns, shapes),
            _ => shapes
                .par_iter()
                .map(|shape| self.columns(model, prediction, term, shape))
                .collect(),
        }
    }

    fn ahead(&self) -> Option<Box<dyn Ahead + '_>> {
        if let Some(given) = &self.given {
            return Some(Box::new(given::View { family: self, given }));
        }
        let ahead = self.ahead.as_ref()?;
        Some(Box::new(ahead::View::new(self, ahead)))
    }

    fn other_reading(&self) -> Option<OtherReading<'_>> {
        let HoldChoice { nats, by_search, .. } = self.hold?;
        Some(OtherReading { family: self.other_hold.as_deref()?, nats, decided: !by_search })
    }

    fn without_noise(&self, more: usize) -> Option<&dyn ModelFamily> {
        Some(self.filtered(more)?)
    }

    fn without_lateness(&self, model: &Fitted) -> Fitted {
        self.in_time(model)
    }

    fn reading(&self) -> Vec<Remark> {
        let input = self.quantity().name;
        let smoothed = self.smoothing.map(|below| Remark::Smoothed { input: input.clone(), below });
        let read = if self.given.is_some() {
            Some(Remark::Given { input, most_shift: given::MOST_SHIFT })
        } else {
            self.hold.map(|hold| hold.remark(input))
        };
        let even = self.jitter.map(|jitter| Remark::EvenSamples { jitter });
        let together = self.ahead.as_ref().and_then(|ahead| {
            let apart = ahead.predictor.interval();
            let every = (apart / self.prepared.interval).round() as usize;
            let input = self.quantity().name;
            (every > 1).then_some(Remark::TakenTogether { input, every, apart })
        });
        let (looked_at, pieces) = (self.recording.len(), self.recording.segments().len());
        let taken_from = self.recording.taken_from();
        let in_pieces = taken_from.map(|samples| Remark::InPieces { samples, looked_at, pieces });
        read.into_iter().chain(smoothed).chain(even).chain(together).chain(in_pieces).collect()
    }

    fn in_part(&self) -> Option<&dyn ModelFamily> {
        Some(self.part.as_deref()?)
    }

    fn ahead_in_part(&self) -> Option<Box<dyn Ahead + '_>> {
        let ahead = self.thinned.as_ref()?;
        Some(Box::new(ahead::View::new(self, ahead)))
    }

    fn ahead_in_longer_part(&self) -> Option<Box<dyn Ahead + '_>> {
        let longer = || self.ahead.as_ref().and_then(ahead::OneAhead::less_thinned);
        let ahead = self.less_thinned.get_or_init(longer).as_ref()?;
        Some(Box::new(ahead::View::new(self, ahead)))
    }

    fn form_of(&self, term: usize) -> Option<usize> {
        let stem = self.terms[term].name.split_once(':')?.0;
        self.terms.iter().position(|main| main.name == stem)
    }

    fn needs(&self, term: usize, parameter: &str) -> bool {
        self.effect(term).is_none_or(|effect| !effect.whatever().contains(&parameter))
    }

    fn may_be_none(&self, term: usize, parameter: &str) -> bool {
        !self.needs(term, parameter)
    }

    fn limits(&self, model: &Fitted, term: usize, parameter: usize) -> (f64, f64) {
        let parameter = &self.terms[term].parameters[parameter];
        let most = || {
            let effect = self.effect(term)?;
            if effect.is_course_of_time() && !self.has_level(model) {
                // Where nothing is left in the end a course without end is the level itself.
                return (parameter.role == Role::Shape).then(|| self.duration());
            }
            let place = model.terms.iter().position(|t| *t == term)?;
            let values = self.values_in_full(model, place)?;
            effect.most(&parameter.name, &values, self.mass_of(model))
        };
        (parameter.lower, parameter.upper.min(most().unwrap_or(f64::INFINITY)))
    }

    fn law_of(&self, term: usize) -> Option<usize> {
        let of = self.effect(term)?.law_of()?;
        self.terms.iter().position(|term| term.name == of)
    }

    fn is_usual(&self, term: usize) -> bool {
        self.effect(term).is_some_and(Effect::is_usual)
    }

    fn joins(&self, model: &Fitted, term: usize) -> bool {
        let Some(effect) = term.checked_sub(1).map(|index| self.effects[index]) else {
            return false;
        };
        let name = effect.about().name;
        if self.given.is_some() && !effect.shows_beside_given_force() {
            return false;
        }
        if !effect.is_determined() || RIVALS.iter().any(|free| free.effect.about().name == name) {
            return false;
        }
        self.model(model).and_then(|plant| plant.with_effect(effect)).is_ok()
    }

    fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    fn regimes(&self) -> &[Regime] {
        &self.regimes
    }

    fn motion(&self) -> Vec<Vec<f64>> {
        self.motion.clone()
    }

    fn blocks(&self) -> Vec<Range<usize>> {
        self.blocks.clone()
    }

    fn views(&self, fitted: &Fitted, split: &Split) -> Vec<NamedError> {
        if self.given.is_some() {
            // Nothing can be simulated with a force that is given over time.
            return Vec::new();
        }
        let model = self.model(fitted).ok();
        let view = |model| views::views(&model, &self.recording, &self.time, split);
        model.and_then(view).into_iter().collect()
    }

    fn full_rate(&self, fitted: &Fitted) -> Option<FullRate> {
        Some(full_rate::full_rate(self, &self.required(fitted).ok()?))
    }

    fn colour(&self) -> Vec<f64> {
        self.prepared.colour()
    }

    fn noise(&self) -> BTreeMap<String, f64> {
        let unit = if self.axis == Axis::Rotary { "angle_rad" } else { "position_m" };
        BTreeMap::from([(unit.to_owned(), self.prepared.position_noise)])
    }

    fn course(&self, term: usize, values: &[f64]) -> Course {
        let about = &self.terms[term];
        let unit = about.parameters.first().map_or("", |parameter| &parameter.unit);
        let moment = |extent| self.extent(extent).unwrap_or_default();
        let (begin, end) = (moment(Extent::RecordingBegin), moment(Extent::RecordingEnd));
        let time = Span { begin, end, unit: "s" };
        let length = if self.axis == Axis::Rotary { "rad" } else { "m" };
        let stroke = Span { begin: self.stroke.0, end: self.stroke.1, unit: length };
        let course = free::course(&about.name, values, (time, stroke), unit);
        course.unwrap_or_else(|| Course::Values { values: sizes(about, values) })
    }

    fn experiment(&self, terms: &[String]) -> Option<String> {
        Some(apart::experiment(&self.effects, terms))
    }

    fn generic_term(&self, coordinate: &Coordinate, shape: &Generic) -> Option<String> {
        let unit = self.effort.unit(self.axis, crate::axis::Quantity::Force);
        generic::effect(coordinate, shape, unit)
    }

    fn plots(&self, base: &Fitted, last: &Fitted) -> Vec<Plot> {
        plots::plots(self, base, last)
    }
}
