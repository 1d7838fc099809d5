//! One cell of the matrix: many seeds of one hidden effect at one level.

use friction_ident::family::{FrictionFamily, Options};
use missing_physics::discover::terms;
use missing_physics::report::Verdict;
use missing_physics::{Discovery, ModelFamily, Settings, discover, search};

use super::motion::Excitation;
use super::table::{Hidden, Table};

/// How large the hidden effect is against the noise of a force estimate: the force that the base
/// model cannot imitate, root mean square of the 5 % of instants where it is largest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Level {
    /// 10 to 30 times.
    Clear,
    /// 3 to 10 times.
    Moderate,
    /// 1.2 to 2 times.
    Faint,
}

impl Level {
    /// By name.
    pub fn parse(name: &str) -> Option<Self> {
        match name {
            "clear" => Some(Self::Clear),
            "moderate" => Some(Self::Moderate),
            "faint" => Some(Self::Faint),
            _ => None,
        }
    }

    /// A ratio within the level; `draw` from 0 to 1.
    pub fn ratio(self, draw: f64) -> f64 {
        let (low, high) = match self {
            Self::Clear => (10.0f64, 30.0f64),
            Self::Moderate => (3.0, 10.0),
            Self::Faint => (1.2, 2.0),
        };
        low * (high / low).powf(draw)
    }
}

/// What a discovery said of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Answer {
    /// The hidden effect was added first.
    First,
    /// Another one was, but the hidden effect stands in an ambiguous set of at most three.
    InSet,
    /// The right verdict without a name: nothing missing where nothing is, or unexplained.
    Silent,
    /// Unexplained structure, where a listed effect was hidden.
    Unexplained,
    /// Nothing found, although something was hidden.
    Missed,
    /// Another effect, without doubt.
    Wrong,
}

/// Base model of every run.
const BASE: [&str; 3] = ["coulomb", "viscous", "offset"];

/// One run.
pub struct Outcome {
    /// What was said.
    pub answer: Answer,
    /// First effect added, or the verdict.
    pub said: String,
    /// Effects added besides the hidden ones and those that the report calls indistinguishable.
    pub extra: usize,
    /// Held-out error over that of the true structure, where the answer is right.
    pub error_ratio: Option<f64>,
    /// Time taken, s.
    pub wall_s: f64,
}

/// Root mean square of the largest 5 % of the residual that the base model leaves.
fn top(table: &Table, excitation: Excitation) -> Option<f64> {
    let family = FrictionFamily::new(&table.record(excitation).ok()?, &Options::default()).ok()?;
    let base = terms(&family, &BASE.map(str::to_owned)).ok()?;
    let weights = vec![1.0; family.target().len()];
    let mut squares: Vec<f64> = search::identify(&family, &base, &weights, 1)
        .fit
        .residual
        .iter()
        .map(|residual| residual * residual)
        .collect();
    squares.sort_unstable_by(|a, b| b.total_cmp(a));
    let count = squares.len().div_ceil(20);
    Some((squares[..count].iter().sum::<f64>() / count as f64).sqrt())
}

/// Size at which `kind` reaches `ratio` times the noise, by a few secant steps in the logarithm.
pub fn sized(kind: Hidden, seed: u64, excitation: Excitation, ratio: f64) -> Option<f64> {
    let noise = top(&Table::draw(seed, &[]), excitation)?;
    let mut size: f64 = match kind {
        Hidden::ActuatorLag => 2e-3,
        Hidden::Presliding | Hidden::Dahl => 3e-5,
        _ => 2.0,
    };
    for _ in 0..3 {
        let seen = top(&Table::draw(seed, &[(kind, size)]), excitation)?;
        // The noise adds to the square.
        let force = (seen * seen - noise * noise).max(0.01 * noise * noise).sqrt();
        size *= (ratio * noise / force).clamp(0.2, 5.0);
        size = match kind {
            Hidden::ActuatorLag => size.min(8e-3),
            // Beyond this the contact is the machine; below it the encoder sees nothing.
            Hidden::Presliding | Hidden::Dahl => size.clamp(3e-6, 1.5e-4),
            // A hump far above the Coulomb level is stick-slip from beginning to end.
            Hidden::Stribeck | Hidden::GaussianStribeck => size.min(8.0),
            _ => size.min(60.0),
        };
    }
    Some(size)
}

/// Hides `kinds` in the table of `seed` and asks; `names` are the right answers.
pub fn run(
    kinds: &[Hidden],
    names: &[&str],
    level: Level,
    excitation: Excitation,
    seed: u64,
) -> Option<Outcome> {
    let draw = (seed as f64 * 0.618_033_988_749_894_9).fract();
    let mut hidden = Vec::new();
    for kind in kinds.iter().filter(|kind| **kind != Hidden::Nothing) {
        hidden.push((*kind, sized(*kind, seed, excitation, level.ratio(draw))?));
    }
    let recording = Table::draw(seed, &hidden).record(excitation).ok()?;
    let family = FrictionFamily::new(&recording, &Options::default()).ok()?;
    let settings = Settings { base: BASE.map(str::to_owned).to_vec(), seed, ..Settings::default() };
    let found = discover(&family, &settings, &mut ()).ok()?;
    let answer = judge(&found, kinds, names);
    let said = found.added.first().cloned().unwrap_or_else(|| format!("{:?}", found.verdict));
    let error_ratio = (answer == Answer::First).then(|| ratio(&family, &found, names)).flatten();
    let extra = extra(&found, names);
    Some(Outcome { answer, said, extra, error_ratio, wall_s: found.wall_s })
}

/// The effect's name without its form.
fn stem(effect: &str) -> &str {
    effect.split(':').next().unwrap_or_default()
}

fn extra(found: &Discovery, names: &[&str]) -> usize {
    let excused = |added: &str| {
        found.ambiguous.iter().any(|set| {
            let inside = |effect: &str| set.effects.iter().any(|other| other == effect);
            inside(added) && set.effects.iter().any(|other| names.contains(&stem(other)))
        })
    };
    found.added.iter().filter(|added| !names.contains(&stem(added)) && !excused(added)).count()
}

fn judge(found: &Discovery, kinds: &[Hidden], names: &[&str]) -> Answer {
    let listed = |effect: &String| names.contains(&stem(effect));
    let in_set =
        found.ambiguous.iter().any(|set| set.effects.len() <= 3 && set.effects.iter().any(listed));
    let complete = names.iter().all(|name| found.added.iter().any(|added| stem(added) == *name));
    match (names.is_empty(), found.added.first()) {
        (false, Some(first)) if names.len() == 1 && listed(first) => Answer::First,
        (false, Some(_)) if names.len() > 1 && complete => Answer::First,
        (false, Some(_)) if in_set => Answer::InSet,
        (false, None) if found.verdict == Verdict::Unexplained => Answer::Unexplained,
        (false, None) => Answer::Missed,
        (true, None) => {
            let nothing = kinds == [Hidden::Nothing];
            let right = if nothing { Verdict::NothingMissing } else { Verdict::Unexplained };
            if found.verdict == right { Answer::Silent } else { Answer::Missed }
        }
        (_, Some(_)) => Answer::Wrong,
    }
}

/// Held-out error of the discovered model over that of the true structure.
fn ratio(family: &FrictionFamily, found: &Discovery, names: &[&str]) -> Option<f64> {
    let all: Vec<String> = BASE.iter().chain(names).map(|name| (*name).to_owned()).collect();
    let full = terms(family, &all).ok()?;
    let split = missing_physics::split::Split::new(family.target().len(), family.blocks());
    let weights: Vec<f64> =
        split.fit(family.target().len()).iter().map(|fit| f64::from(u8::from(*fit))).collect();
    let truth = search::identify(family, &full, &weights, 1).fit;
    let error = found.ladder.last()?.error.get("force_rms_N")?.validation;
    Some(error / split.rms(&truth.residual).validation)
}
