//! One cell of the matrix: a hidden effect, a level, a seed, and what the discovery says of it.

use friction_ident::family::{FrictionFamily, Options};
use missing_physics::report::Verdict;
use missing_physics::{Discovery, ModelFamily, Settings, discover, fit, terms};

use super::hidden::{Case, Hidden};
use super::motion::Excitation;
use super::size::{Level, sized};
use super::table::Table;

/// What a discovery said of a table.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Answer {
    /// The hidden effect was added first; of several, all were added.
    First,
    /// Another one was, but the hidden effect stands in an ambiguous set of at most three.
    InSet,
    /// The right verdict without a name: nothing missing where nothing is, or unexplained on the right
    /// coordinate.
    Silent,
    /// Unexplained structure, where a listed effect was hidden, or on another coordinate.
    Unexplained,
    /// Nothing found, although something was hidden.
    Missed,
    /// Another effect, without doubt.
    Wrong,
}

/// Base model of every run.
const BASE: [&str; 3] = ["coulomb", "viscous", "offset"];
/// Largest p-value of a coordinate that counts as named.
const NAMED: f64 = 0.005;

/// One run.
pub struct Outcome {
    /// What was said.
    pub answer: Answer,
    /// Effects added, or the verdict.
    pub said: String,
    /// Effects added besides the hidden ones and those that the report calls indistinguishable.
    pub extra: usize,
    /// Held-out error over that of the true structure, where the answer is right.
    pub error_ratio: Option<f64>,
    /// Largest relative error of the size of what is hidden, where it was found in the law it has.
    pub size_error: Option<f64>,
    /// Time taken, s.
    pub wall_s: f64,
}

/// The table of `seed` with what `case` hides, at `level`; nothing where the motion cannot show that much.
pub fn table(case: &Case, level: Level, excitation: Excitation, seed: u64) -> Option<Table> {
    let base = base(case);
    let mut hidden = Vec::new();
    for kind in case.kinds.iter().filter(|kind| **kind != Hidden::Nothing) {
        hidden.push((*kind, sized(*kind, seed, excitation, level, &base)?));
    }
    Some(Table::draw(seed, &hidden))
}

fn base(case: &Case) -> Vec<String> {
    BASE.iter().chain(&case.beside).map(|name| (*name).to_owned()).collect()
}

/// What is asked of a discovery of `case`.
pub fn settings(case: &Case, seed: u64) -> Settings<'static> {
    Settings { base: base(case), seed, ..Settings::default() }
}

/// Hides `case` in the table of `seed` and asks.
pub fn run(case: &Case, level: Level, excitation: Excitation, seed: u64) -> Option<Outcome> {
    let table = table(case, level, excitation, seed)?;
    let family = FrictionFamily::new(&table.record(excitation).ok()?, &Options::default()).ok()?;
    let found = discover(&family, &settings(case, seed), &mut ()).ok()?;
    let answer = judge(&found, case);
    let right = answer == Answer::First;
    Some(Outcome {
        answer,
        said: format!("{:?} {}", found.verdict, found.added.join(" + ")),
        extra: extra(&found, &case.answers),
        error_ratio: right.then(|| ratio(&family, &found, case)).flatten(),
        size_error: right.then(|| size_error(&found, &table)).flatten(),
        wall_s: found.wall_s,
    })
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

fn judge(found: &Discovery, case: &Case) -> Answer {
    let names = &case.answers;
    let was_added = |name: &&str| found.added.iter().any(|added| stem(added) == *name);
    let in_set = |name: &&str| {
        found.ambiguous.iter().any(|set| {
            set.effects.len() <= 3 && set.effects.iter().any(|effect| stem(effect) == *name)
        })
    };
    let listed = !names.is_empty();
    let unexplained = found.verdict == Verdict::Unexplained;
    match found.added.first().filter(|_| !unexplained) {
        Some(first) if names.len() == 1 && names.contains(&stem(first)) => Answer::First,
        Some(_) if names.len() > 1 && names.iter().all(was_added) => Answer::First,
        Some(_) if listed && names.iter().all(|name| was_added(name) || in_set(name)) => {
            Answer::InSet
        }
        Some(_) => Answer::Wrong,
        None if case.kinds == [Hidden::Nothing] => match found.verdict {
            Verdict::NothingMissing => Answer::Silent,
            _ => Answer::Unexplained,
        },
        None if !unexplained => Answer::Missed,
        None if names_coordinate(found, &case.coordinates) => Answer::Silent,
        None => Answer::Unexplained,
    }
}

/// Whether the first coordinate on which the residual depends beyond doubt is one of these.
fn names_coordinate(found: &Discovery, coordinates: &[&str]) -> bool {
    let place = found.where_it_fails.iter().find(|place| place.p_value <= NAMED);
    place.is_some_and(|place| coordinates.contains(&place.coordinate.as_str()))
}

/// Held-out error of the discovered model over that of the true structure.
fn ratio(family: &FrictionFamily, found: &Discovery, case: &Case) -> Option<f64> {
    let truth = case.answers.iter().map(|name| (*name).to_owned());
    let full = terms(family, &base(case).into_iter().chain(truth).collect::<Vec<_>>()).ok()?;
    let split =
        missing_physics::statistics::split::Split::new(family.target().len(), family.blocks());
    let weights: Vec<f64> =
        split.fit(family.target().len()).iter().map(|fit| f64::from(u8::from(*fit))).collect();
    let truth = fit::identify(family, &full, &weights, 1).fit;
    let error = found.ladder.last()?.metrics.as_ref()?.validation.rms;
    Some(error / split.rms(&truth.residual).validation)
}

fn size_error(found: &Discovery, table: &Table) -> Option<f64> {
    let parameters = &found.ladder.last()?.parameters;
    let error = |(keys, truth): &(&[&str], f64)| {
        let squares: Option<Vec<f64>> =
            keys.iter().map(|key| parameters.get(*key).map(|p| p.value * p.value)).collect();
        Some((squares?.iter().sum::<f64>().sqrt() / truth - 1.0).abs())
    };
    table.truth().iter().filter_map(error).reduce(f64::max)
}
