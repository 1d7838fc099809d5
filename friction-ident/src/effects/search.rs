//! How an effect is looked for: what its shapes are tried at, and whether it repeats along the stroke.

use super::{Effect, Motion, ParameterRole, Parameters, Slot, Smooth, broadcast};
use crate::axis::Quantity;

/// Force per unit of each amplitude of a law, from the sine and the cosine of `2 pi x/period` at each position.
pub type OfWave = fn(&[(f64, f64)]) -> Vec<Vec<f64>>;

/// A law that repeats itself along the stroke or over time: its period is looked for among hundreds, as every line of a
/// spectrum is narrow.
#[derive(Clone, Copy, Debug)]
pub struct Periodic {
    /// The parameter that is the period; the only shape of the law.
    pub period: &'static str,
    /// What repeats.
    pub of: Repeats,
    /// Whether hundreds of periods are ranked by what a sine of each does to the prediction errors. Not for a form that
    /// is only tried where another one has found the period.
    pub ranked: bool,
    /// Force per unit of each amplitude, from the sine and the cosine of `2 pi x/period` at each position; nothing where
    /// it does not follow from these.
    pub columns: Option<OfWave>,
    /// Shortest period that is looked for, m, rad or s; nothing where only the recording limits it.
    pub shortest: Option<f64>,
}

/// What of an effect repeats, and along what.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Repeats {
    /// A force on the moving mass, along the stroke.
    Force,
    /// An error of what the sensor shows, along the stroke.
    Sensor,
    /// A share of the force of the drive, along the stroke.
    Gain,
    /// A force on the moving mass, over time.
    ForceOverTime,
}

/// What a shape is tried at in a screening.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Trials {
    /// So many values from its lower to its upper limit, evenly on its scale.
    Spread(usize),
    /// These values.
    At(&'static [f64]),
    /// So many angles to either side of 0, up to half a turn.
    Turn(i32),
}

/// Positions, in periods, at which a law is looked at.
const PLACES: [f64; 6] = [-7.31, -1.83, 0.117, 0.449, 2.77, 11.9];
/// Two values of a law are the same up to this share of its size.
const SAME: f64 = 1e-6;
/// A law varies where it changes by more than this share of its size within a period.
const VARIES: f64 = 1e-2;

/// How an effect repeats itself: as it says, or as its law does, where that is a force with one shape, a length, by
/// which a shift of the position changes nothing. So an effect of a user's own is looked for as a ripple of the library.
pub fn periodic(effect: &dyn Effect) -> Option<Periodic> {
    effect.periodic().or_else(|| repeats_by_law(effect))
}

fn repeats_by_law(effect: &dyn Effect) -> Option<Periodic> {
    let about = effect.about();
    let mut shapes =
        about.parameters.iter().enumerate().filter(|(_, p)| p.role == ParameterRole::Shape);
    let (Some((place, period)), None) = (shapes.next(), shapes.next()) else { return None };
    let is_force = matches!(about.slots, [Slot::SmoothForce]);
    if !is_force || period.quantity != Quantity::Length || period.low <= 0.0 {
        return None;
    }
    let values = |length: f64| -> Vec<f64> {
        let each = about.parameters.iter().enumerate();
        each.map(|(k, p)| if k == place { length } else { 0.7 * p.default + 0.3 }).collect()
    };
    let repeats = |length: f64| {
        let at = |shift: f64| -> Vec<f64> {
            let values = values(length);
            PLACES.iter().map(|x| force(effect, &values, length * (x + shift))).collect()
        };
        let (here, later) = (at(0.0), at(1.0));
        let size = here.iter().fold(0.0f64, |size, f| size.max(f.abs()));
        let differs =
            |other: &[f64], by: f64| here.iter().zip(other).any(|(a, b)| (a - b).abs() > by * size);
        let finite = here.iter().chain(&later).all(|f| f.is_finite());
        finite && size > 0.0 && !differs(&later, SAME) && differs(&at(0.29), VARIES)
    };
    let middle = (period.low * period.high).sqrt();
    [period.low, middle, period.high].into_iter().all(repeats).then_some(Periodic {
        period: period.name,
        of: Repeats::Force,
        ranked: true,
        columns: None,
        shortest: Some(period.low),
    })
}

/// The smooth force of an effect at a position, in slow motion forth.
fn force(effect: &dyn Effect, values: &[f64], position: f64) -> f64 {
    let (mut force, mut damping) = ([0.0], [0.0]);
    let motion = Motion {
        time: &[0.0],
        position: &[position],
        velocity: &[0.01],
        acceleration: &[0.0],
        direction: &[1.0],
        level_velocity: &[0.01],
        dwell: &[0.0],
        bond: &[1.0],
        drive_force: &[1.0],
    };
    let mut out = Smooth { force: &mut force, damping: &mut damping };
    effect.smooth_force(Parameters::new(&broadcast(values, 1), 1), &motion, &mut out);
    force[0]
}

#[cfg(test)]
mod tests {
    use super::super::{ALL, formula};
    use super::*;

    fn own(law: &str, quantity: &str) -> &'static dyn Effect {
        let text = format!(
            "name = \"own\"\nforce = \"{law}\"\n[parameters]\n\
             a = {{ unit = \"N\", low = -20.0, high = 20.0, default = 1.0, linear = true }}\n\
             p = {{ unit = \"{quantity}\", low = 2e-4, high = 2e-3, default = 5.5e-4 }}"
        );
        formula::read(&text).unwrap()
    }

    #[test]
    fn a_law_of_ones_own_that_repeats_is_looked_for_as_a_ripple() {
        let ripple = periodic(own("a * sin(2 * pi * x / p)", "m")).unwrap();
        assert_eq!((ripple.period, ripple.of, ripple.ranked), ("p", Repeats::Force, true));
        assert_eq!(ripple.shortest, Some(2e-4));
        assert!(periodic(own("a * abs(sin(2 * pi * x / p))", "m")).is_some());
    }

    #[test]
    fn a_law_that_does_not_repeat_is_none() {
        assert!(periodic(own("a * exp(-1*(x/p)^2)", "m")).is_none());
        assert!(periodic(own("a * sin(2 * pi * x / p) + a * x / p", "m")).is_none());
        assert!(periodic(own("a + 0 * p * x", "m")).is_none());
        // A period in time is none along the stroke.
        assert!(periodic(own("a * sin(2 * pi * t / p)", "s")).is_none());
    }

    #[test]
    fn effects_of_the_library_say_themselves_that_they_repeat() {
        let all = ALL.iter().flat_map(|e| std::iter::once(e).chain(e.forms()));
        let found: Vec<&str> = all
            .filter(|effect| periodic(**effect).is_some())
            .map(|effect| effect.about().name)
            .collect();
        let expected = [
            "ripple",
            "ripple:harmonics",
            "ripple:direction",
            "motor-gain:ripple",
            "encoder",
            "encoder:harmonics",
        ];
        assert_eq!(found, expected);
        // Asked for its law alone, the plain ripple would be recognised as well, and nothing else.
        let by_law = ALL.iter().filter(|effect| repeats_by_law(**effect).is_some());
        let by_law: Vec<&str> = by_law.map(|effect| effect.about().name).collect();
        assert_eq!(by_law, ["ripple"]);
    }
}
