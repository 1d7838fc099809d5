//! An axis of a plot: from values to places, and the ticks between.

/// Where the values of an axis lie on the page.
pub(crate) struct PlotScale {
    low: f64,
    high: f64,
    start: f64,
    end: f64,
    kind: Kind,
}

enum Kind {
    /// Even steps; a power of ten is taken out of the tick labels.
    Linear { step: f64, exponent: i32 },
    /// Decades.
    Logarithmic,
}

/// At most about this many steps between ticks.
const TICKS: f64 = 6.0;
/// Values that span this factor and crowd near the smallest are drawn in decades.
const SPAN: f64 = 300.0;
/// They crowd where half of them lie below this share of the largest.
const CROWDED: f64 = 0.1;

impl PlotScale {
    /// An axis over all `values` from the place `start` to `end`; nothing without values.
    pub fn of<'a>(values: impl Iterator<Item = &'a f64>, start: f64, end: f64) -> Option<Self> {
        let (low, high) = range(values)?;
        let (low, high) = widened(low, high)?;
        let step = nice((high - low) / TICKS);
        let size = low.abs().max(high.abs());
        let plain = (1e-2..1e5).contains(&size);
        let exponent = if plain { 0 } else { 3 * (size.log10() / 3.0).floor() as i32 };
        Some(Self { low, high, start, end, kind: Kind::Linear { step, exponent } })
    }

    /// Like [`PlotScale::of`], but in decades where a linear axis would crowd most of the values into a
    /// corner, as it does with speeds and distances that begin near nothing.
    pub fn fitting<'a>(
        values: impl Iterator<Item = &'a f64> + Clone,
        start: f64,
        end: f64,
    ) -> Option<Self> {
        let (low, high) = range(values.clone())?;
        let below = values.clone().filter(|value| **value < CROWDED * high).count();
        let crowded = 2 * below > values.count();
        if !(low > 0.0 && high > SPAN * low && crowded && high.is_finite()) {
            return Self::of([low, high].iter(), start, end);
        }
        let (low, high) = (low.log10(), high.log10());
        let room = 0.03 * (high - low);
        Some(Self { low: low - room, high: high + room, start, end, kind: Kind::Logarithmic })
    }

    /// The place of a value.
    pub fn at(&self, value: f64) -> f64 {
        let value = match self.kind {
            Kind::Linear { .. } => value,
            Kind::Logarithmic => value.log10(),
        };
        self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)
    }

    /// The place of zero, where it lies inside.
    pub fn zero(&self) -> Option<f64> {
        let inside = self.low < 0.0 && self.high > 0.0;
        (inside && matches!(self.kind, Kind::Linear { .. })).then(|| self.at(0.0))
    }

    /// Places and texts of the ticks.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let (step, exponent) = match self.kind {
            Kind::Linear { step, exponent } => (step, exponent),
            Kind::Logarithmic => return self.decades(),
        };
        let unit = 10_f64.powi(exponent);
        let decimals = (-(step / unit).log10().floor()).max(0.0) as usize;
        let first = (self.low / step).ceil() as i64;
        let last = (self.high / step).floor() as i64;
        (first..=last)
            .map(|k| {
                let value = k as f64 * step;
                (self.at(value), format!("{:.decimals$}", value / unit))
            })
            .collect()
    }

    fn decades(&self) -> Vec<(f64, String)> {
        let decades = self.low.ceil() as i32..=self.high.floor() as i32;
        decades.map(|k| (self.at(10_f64.powi(k)), format!("10{}", superscript(k)))).collect()
    }

    /// The label of the axis with the power of ten that the ticks leave out.
    pub fn label(&self, label: &str) -> String {
        match self.kind {
            Kind::Linear { exponent, .. } if exponent != 0 => {
                format!("{label}  (×10{})", superscript(exponent))
            }
            _ => label.to_owned(),
        }
    }
}

fn range<'a>(values: impl Iterator<Item = &'a f64>) -> Option<(f64, f64)> {
    values.fold(None, |range, &value| match range {
        None => Some((value, value)),
        Some((low, high)) => Some((f64::min(low, value), f64::max(high, value))),
    })
}

/// The range with a little room around it; nothing where it cannot be drawn.
fn widened(low: f64, high: f64) -> Option<(f64, f64)> {
    let span = high - low;
    if !span.is_finite() {
        return None;
    }
    if span <= 1e-12 * low.abs().max(high.abs()) {
        let room = if low == 0.0 { 1.0 } else { 0.5 * low.abs() };
        return Some((low - room, high + room));
    }
    Some((low - 0.04 * span, high + 0.04 * span))
}

/// The nearest 1, 2 or 5 times a power of ten that is not smaller.
fn nice(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    let factor = [1.0, 2.0, 5.0].into_iter().find(|factor| factor * power >= step * 0.999);
    factor.unwrap_or(10.0) * power
}

fn superscript(power: i32) -> String {
    let digit = |c: char| match c {
        '-' => '⁻',
        '0' => '⁰',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        '4' => '⁴',
        '5' => '⁵',
        '6' => '⁶',
        '7' => '⁷',
        '8' => '⁸',
        _ => '⁹',
    };
    power.to_string().chars().map(digit).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn texts(low: f64, high: f64) -> (Vec<String>, String) {
        let scale = PlotScale::of([low, high].iter(), 0.0, 100.0).unwrap();
        (scale.ticks().into_iter().map(|tick| tick.1).collect(), scale.label("x / m"))
    }

    #[test]
    fn ticks_are_round_numbers() {
        assert_eq!(texts(-0.125, 0.125).0, ["-0.10", "-0.05", "0.00", "0.05", "0.10"]);
        assert_eq!(texts(0.0, 3.0).0, ["0", "1", "2", "3"]);
    }

    #[test]
    fn small_and_large_values_take_their_power_into_the_label() {
        let (ticks, label) = texts(0.0, 4e-5);
        assert_eq!((ticks[1].as_str(), label.as_str()), ("10", "x / m  (×10⁻⁶)"));
        assert!(texts(0.0, 5e7).1.contains("×10⁶"));
    }

    #[test]
    fn values_crowded_near_nothing_are_drawn_in_decades() {
        let speeds = [1e-4, 2e-4, 1e-3, 2e-3, 5e-3, 0.1, 0.3];
        let scale = PlotScale::fitting(speeds.iter(), 0.0, 100.0).unwrap();
        let ticks: Vec<String> = scale.ticks().into_iter().map(|tick| tick.1).collect();
        assert_eq!(ticks, ["10⁻⁴", "10⁻³", "10⁻²", "10⁻¹"]);
        assert!(scale.at(1e-3) > 25.0 && scale.zero().is_none());
        // Evenly spread, or with a zero, they are not.
        for even in [vec![1e-4, 0.1, 0.2, 0.3], vec![0.0, 1e-4, 1e-3, 1e-3, 0.3]] {
            let scale = PlotScale::fitting(even.iter(), 0.0, 100.0).unwrap();
            assert!(scale.ticks().iter().all(|tick| !tick.1.contains('⁻')));
        }
    }

    #[test]
    fn a_single_value_has_room_around_it() {
        let scale = PlotScale::of([3.0].iter(), 0.0, 100.0).unwrap();
        assert!((scale.at(3.0) - 50.0).abs() < 1e-9);
        assert!(PlotScale::of(std::iter::empty(), 0.0, 1.0).is_none());
        assert!(PlotScale::of([-f64::MAX, f64::MAX].iter(), 0.0, 1.0).is_none());
    }
}
