//! How large a hidden effect is made: relative to what a comparison of forces leaves to noise.

use super::case::{Case, Size};
use super::hidden::Hidden;
use super::machine::{Force, Machine};
use super::random::Stream;
use super::record::{Run, run};
use super::visibility;

/// Force that the base model cannot imitate, over what it leaves of the same machine with nothing hidden; see
/// [`visibility::error`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Level {
    /// 10 to 30 times.
    Clear,
    /// 3 to 10 times.
    Moderate,
    /// 1.2 to 2 times.
    Faint,
    /// What the case says, or nothing at all.
    Fixed,
}

impl Level {
    /// By name.
    pub fn parse(name: &str) -> Option<Self> {
        [Self::Clear, Self::Moderate, Self::Faint].into_iter().find(|level| level.name() == name)
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Clear => "clear",
            Self::Moderate => "moderate",
            Self::Faint => "faint",
            Self::Fixed => "fixed",
        }
    }

    /// Smallest and largest ratio.
    pub fn range(self) -> (f64, f64) {
        match self {
            Self::Clear => (10.0, 30.0),
            Self::Moderate => (3.0, 10.0),
            Self::Faint => (1.2, 2.0),
            Self::Fixed => (0.0, f64::INFINITY),
        }
    }
}

/// Secant steps towards a wanted ratio.
const STEPS: usize = 5;

/// A recording with a known truth.
#[derive(Clone, Debug, PartialEq)]
pub struct Recorded {
    /// The recording.
    pub run: Run,
    /// Whether angle and torque are recorded.
    pub rotary: bool,
    /// What the force is.
    pub force: Force,
    /// Size of what is hidden, in the unit that [`Hidden`] says.
    pub size: f64,
    /// What the base model cannot imitate of it, over the noise.
    pub visibility: f64,
    /// The noise: force that the base model leaves with nothing hidden.
    pub noise: f64,
    /// Mass, Coulomb level, viscous coefficient, offset, torque of the weight.
    pub truth: [f64; 5],
}

/// The recording of `case` at `level` and `seed`; nothing where no sensible size shows as much as wanted.
pub fn recorded(case: &Case, level: Level, seed: u64) -> Option<Recorded> {
    let names = [case.kind, case.name, level.name()];
    let mut random = Stream::new(&names, seed);
    // Every second recording holds its command, if what is hidden allows a measured force at all.
    let held = seed % 2 == 1 || case.hidden.needs_command();
    let force = if held { Force::Command } else { Force::Measured };
    let (low, high) = level.range();
    let wanted = random.ratio(low.max(1.0), high.min(1e3));
    let machine = Machine::draw(case.build, force, &mut random);
    let make =
        |size: f64, peak: f64| run((&machine, case.build), (case.hidden, size), peak, &names, seed);
    let alone = make(0.0, f64::INFINITY);
    let noise = visibility::error(&machine, &alone, &case.base);
    let shows = |run: &Run| -> f64 {
        let seen = visibility::error(&machine, run, &case.base);
        (seen * seen - noise * noise).max(0.0).sqrt() / noise
    };
    let Machine { rotary, mass, coulomb, viscous, offset, gravity, .. } = machine;
    let (run, size) = match case.size {
        Size::Nothing => (alone, 0.0),
        Size::Fixed(size) => (make(size, alone.peak), size),
        Size::ByLevel => sized(case.hidden, wanted, |size| {
            let run = make(size, alone.peak);
            (shows(&run), run)
        }),
    };
    let visibility = shows(&run);
    (level == Level::Fixed || (0.8 * low..1.25 * high).contains(&visibility)).then_some(Recorded {
        run,
        rotary,
        force,
        size,
        visibility,
        noise,
        truth: [mass, coulomb, viscous, offset, gravity.0],
    })
}

/// The size that comes nearest to `wanted`, by secant steps in the logarithm.
fn sized(hidden: Hidden, wanted: f64, make: impl Fn(f64) -> (f64, Run)) -> (Run, f64) {
    let (mut size, low, high) = hidden.limits();
    let mut known: Vec<(f64, f64)> = Vec::new();
    let mut best: Option<(f64, Run, f64)> = None;
    for _ in 0..=STEPS {
        let (seen, run) = make(size);
        let (at, miss) = (size.ln(), (seen.max(0.05) / wanted).ln());
        if best.as_ref().is_none_or(|(least, ..)| miss.abs() < *least) {
            best = Some((miss.abs(), run, size));
        }
        if miss.abs() < 0.08 {
            break;
        }
        let slope = known.last().map_or(1.0, |(x, y)| {
            let slope = (miss - y) / (at - x);
            if slope.is_finite() { slope.clamp(0.4, 4.0) } else { 1.0 }
        });
        known.push((at, miss));
        size = (at - (miss / slope).clamp(-1.6, 1.6)).exp().clamp(low, high);
    }
    best.map(|(_, run, size)| (run, size)).expect("at least one size was tried")
}

#[cfg(test)]
mod tests {
    use super::super::case::all;
    use super::super::visibility;
    use super::*;

    fn case(kind: &str, name: &str) -> Case {
        all().into_iter().find(|case| (case.kind, case.name) == (kind, name)).expect("exists")
    }

    #[test]
    fn a_recording_follows_from_case_level_and_seed() {
        let case = case("table", "stribeck");
        let make = |level, seed| recorded(&case, level, seed);
        assert_eq!(make(Level::Clear, 3), make(Level::Clear, 3));
        let positions = |level, seed| make(level, seed).map(|found| found.run.position);
        assert_ne!(positions(Level::Clear, 3), positions(Level::Clear, 5));
        assert_ne!(positions(Level::Clear, 3), positions(Level::Moderate, 3));
    }

    #[test]
    fn the_level_is_what_it_says_by_a_comparison_along_the_true_equation() {
        // An offset shows by its own size wherever the body moves, less what the other terms imitate of it:
        // little, as the motion goes as far one way as the other.
        let case = case("table", "offset");
        for (level, seed) in [(Level::Clear, 1), (Level::Moderate, 2), (Level::Faint, 3)] {
            let found = recorded(&case, level, seed).expect("an offset shows");
            let offset = found.size * found.truth[1];
            let ratio = offset / found.noise;
            assert!(
                (0.5 * found.visibility..2.0 * found.visibility).contains(&ratio),
                "{level:?}: an offset of {ratio} times the noise, visible {} times",
                found.visibility
            );
            assert!((0.8 * level.range().0..1.25 * level.range().1).contains(&found.visibility));
        }
    }

    #[test]
    fn a_machine_with_nothing_hidden_leaves_a_small_part_of_its_friction() {
        for (kind, name) in [("table", "nothing"), ("joint", "nothing"), ("spindle", "nothing")] {
            for seed in [1, 2] {
                let found = recorded(&case(kind, name), Level::Fixed, seed).expect("always");
                let part = found.noise / found.truth[1];
                assert!(part < 0.15, "{kind} {seed}: {part} of the Coulomb level");
            }
        }
    }

    #[test]
    fn least_squares_of_an_exact_model_leave_nothing() {
        let case = case("table", "nothing");
        let random = &mut Stream::new(&["exact"], 1);
        let mut machine = Machine::draw(case.build, Force::Command, random);
        (machine.count, machine.encoder_noise, machine.force_noise) = (1e-12, 0.0, 0.0);
        let run = run((&machine, case.build), (Hidden::Nothing, 0.0), 1.0, &["exact"], 1);
        let left = visibility::error(&machine, &run, &case.base);
        assert!(left < 5e-3 * machine.coulomb, "{left} N of {} N", machine.coulomb);
    }
}
