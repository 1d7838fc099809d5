//! A plant in closed form for tests: a lag of first order under known inputs, seen by a noisy sensor.
//!
//! `x' = 0.9 x + sum of the terms`, `y = x + noise`. Its predictor is the scalar Kalman filter, so that the prediction
//! errors of the true model are white and as large as the noise.

use aep_core::Scale;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::report::Refusal;

use super::{Ahead, Rival, Trial, trials};
use crate::family::{
    ComparedQuantity, Coordinate, Fitted, Generic, ModelFamily, Regime, Role, Series,
    Term as About, TermParameter,
};

/// Samples and their distance, s.
pub const SAMPLES: usize = 2000;
pub const INTERVAL: f64 = 0.01;
/// Standard deviation of the sensor.
pub const NOISE: f64 = 0.02;
/// Share of the state that is left after a sample.
const LEFT: f64 = 0.9;
/// Process noise of the settings.
const PROCESS: [f64; 3] = [0.0, 0.01, 0.05];

/// The terms, in the order of the family.
pub const DRIVE: usize = 0;
pub const WAVE: usize = 1;
pub const BEAT: usize = 2;
/// Nearly the sum of a wave and a beat.
pub const BOTH: usize = 3;
/// A sine of a frequency that is searched.
pub const TONE: usize = 4;
/// The more flexible form of a wave.
pub const BENT: usize = 5;
/// Never negative.
pub const PUSH: usize = 6;

/// A wave that comes a little later: what the sensor shows hardly tells it from one.
pub const TWIN: usize = 7;

/// No effect: a wave less a part of a beat.
pub const RIVAL: usize = 8;

/// Limits of the frequency of a tone, rad/s.
pub const TONES: (f64, f64) = (2.0, 8.0);

/// Frequencies that rise, so that no signal is itself again at a later time.
fn wave(t: f64) -> f64 {
    (0.1 * t * t + 0.4 * t).sin().signum() * (0.7 * t).cos()
}
fn beat(t: f64) -> f64 {
    (0.17 * t * t + 1.0).cos()
}
fn rest(t: f64) -> f64 {
    0.5 * (0.3 * t * t).sin()
}

/// What a term adds to the state at an instant.
fn input(term: usize, values: &[f64], t: f64) -> f64 {
    let shape = match term {
        DRIVE => (1.3 * t).sin() + (3.1 * t).cos(),
        WAVE => wave(t),
        BEAT => beat(t),
        BOTH => wave(t) + beat(t) + rest(t),
        TONE => (values[1] * t).sin(),
        TWIN => wave(t - 2e-4),
        RIVAL => wave(t) - 0.4 * beat(t),
        BENT => return values[0] * wave(t) + values[1] * wave(t).powi(2),
        _ => (0.06 * t * t + 2.0 * t).sin(),
    };
    values[0] * shape
}

/// A recording of the plant.
pub struct Plant {
    terms: Vec<About>,
    time: Vec<f64>,
    measured: Vec<f64>,
    target: Vec<f64>,
    doubt: Vec<f64>,
    instants: Vec<(f64, usize)>,
    coordinates: Vec<Coordinate>,
    regimes: Vec<Regime>,
    /// A term that is no effect in its plain form.
    pub none: Option<usize>,
    /// A term that every system has, too little of it here to be seen.
    pub unseen: Option<usize>,
    /// The effects whose amplitudes may be none.
    pub optional: Vec<usize>,
    /// The effects that are shapes of the rival.
    pub kin: Vec<usize>,
    /// Forms with what they are forms of.
    pub forms: Vec<(usize, usize)>,
    /// Effects that every plant has.
    pub usual: Vec<usize>,
    /// A term and the largest size of it that makes sense.
    pub most: Option<(usize, f64)>,
    /// Terms with the usual ones that they are other laws of.
    pub laws: Vec<(usize, usize)>,
    /// A term that stands for how the recording is read.
    pub read: Option<usize>,
    /// A term that may be another one as well.
    pub related: Option<(usize, usize)>,
    /// Frequencies beside that of a tone, rad/s.
    pub leaps: Vec<f64>,
    /// What stands for a few pieces of the recording.
    pub part: Option<Box<Plant>>,
    /// What is searched in its place, and as how much of it.
    pub pieces: Option<(Box<Plant>, f64)>,
    /// And for more of it.
    pub more_pieces: Option<(Box<Plant>, f64)>,
    /// The force that every model lacks.
    pub lacks: Option<Series>,
    /// Whether effects have shares of what is missing.
    pub shares: bool,
    /// What each error is worth, if not 1.
    pub worth: Option<Vec<f64>>,
    /// At which errors it moves fast, if its terms act wherever it moves.
    pub in_motion: Option<Vec<bool>>,
}

fn about(name: &str, lower: f64, more: Option<TermParameter>) -> About {
    let size = TermParameter {
        name: "size".into(),
        unit: "V".into(),
        role: Role::Amplitude,
        lower,
        upper: 10.0,
        scale: Scale::Linear,
        start: 0.05,
    };
    About {
        name: name.into(),
        title: name.into(),
        equation: name.into(),
        parameters: std::iter::once(size).chain(more).collect(),
        always: name == "drive",
    }
}

impl Plant {
    /// The plant that obeys the drive at 1 and the `hidden` terms.
    pub fn new(seed: u64, hidden: &[(usize, &[f64])]) -> Self {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let time: Vec<f64> = (0..SAMPLES).map(|k| k as f64 * INTERVAL).collect();
        let target: Vec<f64> = time
            .iter()
            .map(|t| {
                let hidden: f64 = hidden.iter().map(|(term, v)| input(*term, v, *t)).sum();
                input(DRIVE, &[1.0], *t) + hidden
            })
            .collect();
        let mut x = 0.0;
        let mut measured = vec![0.0; SAMPLES];
        for k in 1..SAMPLES {
            let noise: f64 = StandardNormal.sample(&mut random);
            x = LEFT * x + target[k - 1];
            measured[k] = x + NOISE * noise;
        }
        let frequency = TermParameter {
            name: "omega".into(),
            unit: "rad/s".into(),
            role: Role::Shape,
            lower: TONES.0,
            upper: TONES.1,
            scale: Scale::Log,
            start: 4.0,
        };
        let bend =
            TermParameter { name: "bend".into(), ..about("", -10.0, None).parameters.remove(0) };
        let terms = vec![
            about("drive", 1e-3, None),
            about("wave", -10.0, None),
            about("beat", -10.0, None),
            about("both", -10.0, None),
            about("tone", -10.0, Some(frequency)),
            about("wave:bent", -10.0, Some(bend)),
            about("push", 0.0, None),
            about("twin", -10.0, None),
            about("rival", -10.0, None),
        ];
        let coordinate = Coordinate {
            name: "time".into(),
            unit: "s".into(),
            values: time.clone(),
            parity: None,
            state: false,
        };
        Self {
            terms,
            measured,
            target,
            doubt: vec![0.0; SAMPLES],
            instants: time.iter().skip(1).map(|t| (*t, 0)).collect(),
            coordinates: vec![coordinate],
            regimes: vec![Regime { name: "all".into(), member: vec![true; SAMPLES] }],
            time,
            none: None,
            unseen: None,
            optional: Vec::new(),
            kin: vec![PUSH],
            forms: vec![(BENT, WAVE)],
            usual: Vec::new(),
            most: None,
            laws: Vec::new(),
            read: None,
            related: None,
            leaps: Vec::new(),
            part: None,
            pieces: None,
            more_pieces: None,
            lacks: None,
            shares: true,
            worth: None,
            in_motion: None,
        }
    }

    /// Moves what the sensor shows at a sample.
    pub fn disturb(&mut self, sample: usize, by: f64) {
        self.measured[sample] += by;
    }

    /// The drive at its true size with more terms.
    pub fn model(more: &[(usize, &[f64])]) -> Fitted {
        let drive = Fitted { terms: vec![DRIVE], values: vec![1.0] };
        more.iter().fold(drive, |model, (term, values)| model.with(*term, values))
    }

    /// Gain of the Kalman filter at a setting and the deviation of the error that it expects.
    fn filter(setting: usize) -> (f64, f64) {
        let (q, r) = (PROCESS[setting % PROCESS.len()].powi(2), NOISE * NOISE);
        let mut p = 0.0;
        for _ in 0..1000 {
            let updated = p * r / (p + r);
            p = LEFT * LEFT * updated + q;
        }
        (p / (p + r), (p + r).sqrt())
    }

    fn inputs(&self, model: &Fitted) -> Vec<f64> {
        let mut sum = vec![0.0; SAMPLES];
        for (place, term) in model.terms.iter().enumerate() {
            let values = &model.values[model.range(self, place)];
            for (sum, t) in sum.iter_mut().zip(&self.time) {
                *sum += input(*term, values, *t);
            }
        }
        sum
    }
}

impl Ahead for Plant {
    fn settings(&self) -> usize {
        2 * PROCESS.len()
    }
    fn expected(&self, setting: usize) -> f64 {
        Self::filter(setting).1
    }
    fn budget(&self) -> f64 {
        NOISE
    }
    fn has_shares(&self) -> bool {
        self.shares
    }
    fn worth(&self) -> Option<&[f64]> {
        self.worth.as_deref()
    }
    fn in_motion(&self, _term: usize) -> Option<&[bool]> {
        self.in_motion.as_deref()
    }
    fn errors(&self, models: &[(Fitted, usize)]) -> Vec<Vec<f64>> {
        let one = |(model, setting): &(Fitted, usize)| {
            let (gain, _) = Self::filter(*setting);
            let inputs = self.inputs(model);
            let mut x = 0.0;
            (1..SAMPLES)
                .map(|k| {
                    x = LEFT * x + inputs[k - 1];
                    let error = self.measured[k] - x;
                    x += gain * error;
                    error
                })
                .collect()
        };
        models.iter().map(one).collect()
    }
    fn instants(&self) -> &[(f64, usize)] {
        &self.instants
    }
    fn trials(&self, model: &Fitted, term: usize) -> Vec<Trial> {
        trials(self, model, term, &self.shapes(term))
    }
    fn is_candidate(&self, term: usize) -> bool {
        term != BENT
    }
    fn flexible(&self, model: &Fitted, term: usize) -> Option<Fitted> {
        let place = model.terms.iter().position(|t| *t == term && term == WAVE)?;
        let size = model.values[model.range(self, place).start];
        Some(model.without(self, WAVE).with(BENT, &[size, 0.0]))
    }
    fn rivals(&self) -> Vec<Rival> {
        vec![Rival { term: RIVAL, title: "a wave less a beat", kin: self.kin.clone() }]
    }
    fn relatives(&self, model: &Fitted) -> Vec<Fitted> {
        let swapped = |(term, other)| {
            let place = model.terms.iter().position(|own| *own == term)?;
            let size = model.values[model.range(self, place).start];
            Some(model.without(self, term).with(other, &[size]))
        };
        self.related.and_then(swapped).into_iter().collect()
    }
    fn part(&self) -> Option<Box<dyn Ahead + '_>> {
        self.part.as_ref().map(|part| Box::new(Borrowed(part, 1.0)) as Box<dyn Ahead>)
    }
    fn variations(&self, model: &Fitted) -> Vec<Fitted> {
        let Some(place) = model.terms.iter().position(|term| *term == TONE) else {
            return Vec::new();
        };
        let size = model.values[model.range(self, place).start];
        let leap = |omega: &f64| model.without(self, TONE).with(TONE, &[size, *omega]);
        self.leaps.iter().map(leap).collect()
    }
    fn vanishes(&self, model: &Fitted, _base: &Fitted) -> Option<(usize, Refusal)> {
        let refusal = Refusal::AtLimit { parameter: "it is none".into() };
        self.none.filter(|term| model.terms.contains(term)).map(|term| (term, refusal))
    }
    fn may_be_unseen(&self) -> Option<usize> {
        self.unseen
    }
    fn is_unseen(&self, model: &Fitted, _base: &Fitted) -> bool {
        self.unseen.is_some_and(|term| model.terms.contains(&term))
    }
    fn of_reading(&self, model: &Fitted, base: &Fitted) -> Option<(usize, Refusal)> {
        let refusal = Refusal::AtLimit { parameter: "it is the reading".into() };
        let added = |term: &usize| model.terms.contains(term) && !base.terms.contains(term);
        self.read.filter(added).map(|term| (term, refusal))
    }
    fn missing_force(&self, _: &Fitted, _: usize) -> Option<Series> {
        self.lacks.clone()
    }
}

impl ModelFamily for Plant {
    fn terms(&self) -> &[About] {
        &self.terms
    }
    fn quantity(&self) -> ComparedQuantity {
        ComparedQuantity { name: "input".into(), unit: "V".into() }
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
    fn predict(&self, model: &Fitted, out: &mut [f64]) {
        out.copy_from_slice(&self.inputs(model));
    }
    fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }
    fn generic_term(&self, along: &Coordinate, shape: &Generic) -> Option<String> {
        Some(format!("{} {}", along.name, matches!(shape, Generic::InTime(_))))
    }
    fn regimes(&self) -> &[Regime] {
        &self.regimes
    }
    fn is_usual(&self, term: usize) -> bool {
        self.usual.contains(&term)
    }
    fn needs(&self, _term: usize, _parameter: &str) -> bool {
        true
    }
    fn may_be_none(&self, term: usize, _parameter: &str) -> bool {
        self.optional.contains(&term)
    }
    fn limits(&self, _model: &Fitted, term: usize, parameter: usize) -> (f64, f64) {
        let parameter = &self.terms[term].parameters[parameter];
        let most = self.most.filter(|(limited, _)| *limited == term);
        (parameter.lower, most.map_or(parameter.upper, |(_, most)| most))
    }
    fn law_of(&self, term: usize) -> Option<usize> {
        self.laws.iter().find(|(law, _)| *law == term).map(|(_, of)| *of)
    }
    fn form_of(&self, term: usize) -> Option<usize> {
        self.forms.iter().find(|(form, _)| *form == term).map(|(_, main)| *main)
    }
    fn joins(&self, model: &Fitted, term: usize) -> bool {
        let main = |t: usize| self.form_of(t).unwrap_or(t);
        term != RIVAL && model.terms.iter().all(|t| main(*t) != main(term))
    }
    fn ahead(&self) -> Option<Box<dyn Ahead + '_>> {
        Some(Box::new(Borrowed(self, 1.0)))
    }
    fn ahead_in_part(&self) -> Option<Box<dyn Ahead + '_>> {
        let (pieces, share) = self.pieces.as_ref()?;
        Some(Box::new(Borrowed(pieces, *share)))
    }
    fn ahead_in_longer_part(&self) -> Option<Box<dyn Ahead + '_>> {
        let (pieces, share) = self.more_pieces.as_ref()?;
        Some(Box::new(Borrowed(pieces, *share)))
    }
}

/// The plant as the box that the engine asks for, and as how much of the recording.
struct Borrowed<'a>(&'a Plant, f64);

impl Ahead for Borrowed<'_> {
    fn settings(&self) -> usize {
        self.0.settings()
    }
    fn expected(&self, setting: usize) -> f64 {
        self.0.expected(setting)
    }
    fn budget(&self) -> f64 {
        self.0.budget()
    }
    fn errors(&self, models: &[(Fitted, usize)]) -> Vec<Vec<f64>> {
        self.0.errors(models)
    }
    fn instants(&self) -> &[(f64, usize)] {
        self.0.instants()
    }
    fn share(&self) -> f64 {
        self.1
    }
    fn trials(&self, model: &Fitted, term: usize) -> Vec<Trial> {
        Ahead::trials(self.0, model, term)
    }
    fn is_candidate(&self, term: usize) -> bool {
        self.0.is_candidate(term)
    }
    fn flexible(&self, model: &Fitted, term: usize) -> Option<Fitted> {
        self.0.flexible(model, term)
    }
    fn rivals(&self) -> Vec<Rival> {
        self.0.rivals()
    }
}
