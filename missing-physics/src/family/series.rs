//! A force beside a model over time, as a family estimates it.

/// Half-width of a 95 % band in standard deviations.
const BAND: f64 = 1.96;

/// A force beside a model as a family estimates it; all lists have an entry for every instant, in order.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Series {
    /// Ends of the intervals, s.
    pub time: Vec<f64>,
    /// Force to be added to the recorded one; 0 where it is not known.
    pub force: Vec<f64>,
    /// Its standard deviation; where it is not known that before anything was measured.
    pub deviation: Vec<f64>,
    /// The recorded force.
    pub recorded: Vec<f64>,
    /// Whether anything is known: not where the model rests, whatever acts on it.
    pub known: Vec<bool>,
}

impl Series {
    /// Root mean squares of the force and of the half-widths of its 95 % bands, where it is known; nothing where it
    /// nowhere is or numbers are not finite.
    pub fn size(&self) -> Option<(f64, f64)> {
        let (force, band) = (self.rms(&self.force), BAND * self.rms(&self.deviation));
        (force.is_finite() && band.is_finite()).then_some((force, band))
    }

    /// Whether there are instants and nothing is known at any of them.
    pub fn is_unknown(&self) -> bool {
        !self.known.is_empty() && !self.known.contains(&true)
    }

    /// Root mean square of the recorded force.
    pub fn recorded(&self) -> f64 {
        let square: f64 = self.recorded.iter().map(|force| force * force).sum();
        (square / self.recorded.len().max(1) as f64).sqrt()
    }

    /// Root mean square of values at the instants at which the force is known.
    pub(crate) fn rms(&self, values: &[f64]) -> f64 {
        let known = values.iter().zip(&self.known).filter(|(_, known)| **known);
        let (square, count) =
            known.fold((0.0, 0), |(sum, count), (value, _)| (sum + value * value, count + 1));
        (square / f64::from(count)).sqrt()
    }
}
