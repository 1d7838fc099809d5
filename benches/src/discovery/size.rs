//! How large a hidden effect is made: relative to what a force estimate leaves to noise.

use friction_ident::family::{FrictionFamily, Options};
use missing_physics::{ModelFamily, fit, terms};

use super::hidden::Hidden;
use super::motion::Excitation;
use super::table::Table;

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

    /// Smallest and largest ratio.
    fn range(self) -> (f64, f64) {
        match self {
            Self::Clear => (10.0, 30.0),
            Self::Moderate => (3.0, 10.0),
            Self::Faint => (1.2, 2.0),
        }
    }

    /// A ratio within the level; `draw` from 0 to 1.
    pub fn ratio(self, draw: f64) -> f64 {
        let (low, high) = self.range();
        low * (high / low).powf(draw)
    }
}

/// Secant steps towards a wanted ratio.
const STEPS: usize = 4;

/// Start and limits of a size: beyond them the effect is the machine (stick-slip from beginning to end, a
/// mass that is all behind the coupling) or below the encoder.
fn limits(kind: Hidden) -> (f64, f64, f64) {
    match kind {
        Hidden::ActuatorLag => (2e-3, 1e-4, 8e-3),
        Hidden::InputDelay => (2e-3, 1e-4, 5e-3),
        Hidden::FrictionalMemory => (5e-3, 2e-4, 3e-2),
        Hidden::Presliding | Hidden::Dahl | Hidden::LuGre => (3e-5, 3e-6, 4e-4),
        Hidden::Stribeck | Hidden::GaussianStribeck | Hidden::RisingStatic | Hidden::Backlash => {
            (2.0, 1e-3, 8.0)
        }
        Hidden::Saturation => (0.1, 1e-3, 0.6),
        Hidden::Encoder => (5e-6, 1e-7, 5e-5),
        Hidden::LoadFriction => (0.1, 1e-3, 0.5),
        Hidden::FlexibleCoupling => (0.2, 1e-3, 0.6),
        _ => (2.0, 1e-3, 60.0),
    }
}

/// Root mean square of the largest 5 % of the residual that the base model leaves.
fn top(table: &Table, excitation: Excitation, base: &[String]) -> Option<f64> {
    let family = FrictionFamily::new(&table.record(excitation).ok()?, &Options::default()).ok()?;
    let base = terms(&family, base).ok()?;
    let weights = vec![1.0; family.target().len()];
    let mut squares: Vec<f64> = fit::identify(&family, &base, &weights, 1)
        .fit
        .residual
        .iter()
        .map(|residual| residual * residual)
        .collect();
    squares.sort_unstable_by(|a, b| b.total_cmp(a));
    let count = squares.len().div_ceil(20);
    Some((squares[..count].iter().sum::<f64>() / count as f64).sqrt())
}

/// The size at which `kind` reaches the level on the table of `seed`, by a few secant steps in the
/// logarithm. Nothing where no sensible size does: this motion hardly shows it.
pub fn sized(
    kind: Hidden,
    seed: u64,
    excitation: Excitation,
    level: Level,
    base: &[String],
) -> Option<f64> {
    let ratio = level.ratio((seed as f64 * 0.618_033_988_749_894_9).fract());
    let (start, low, high) = limits(kind);
    let noise = top(&Table::draw(seed, &[(kind, low)]), excitation, base)?;
    // The noise adds to the square.
    let force = |size: f64| -> Option<f64> {
        let seen = top(&Table::draw(seed, &[(kind, size)]), excitation, base)?;
        Some((seen * seen - noise * noise).max(0.01 * noise * noise).sqrt() / noise)
    };
    let mut size: f64 = start;
    for _ in 0..STEPS {
        size = (size * (ratio / force(size)?).clamp(0.2, 5.0)).clamp(low, high);
    }
    (force(size)? > 0.7 * level.range().0).then_some(size)
}
