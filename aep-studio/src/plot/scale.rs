//! An axis of a plot: from values to places, and the ticks between.

/// Where the values of an axis lie on the page.
pub(crate) struct Scale {
    low: f64,
    high: f64,
    start: f64,
    end: f64,
    step: f64,
    /// Power of ten taken out of the tick labels.
    exponent: i32,
}

/// At most about this many steps between ticks.
const TICKS: f64 = 6.0;

impl Scale {
    /// An axis over all `values` from the place `start` to `end`; nothing without values.
    pub fn of<'a>(values: impl Iterator<Item = &'a f64>, start: f64, end: f64) -> Option<Self> {
        let range = values.fold(None, |range, &value| match range {
            None => Some((value, value)),
            Some((low, high)) => Some((f64::min(low, value), f64::max(high, value))),
        });
        let (low, high) = range?;
        let (low, high) = widened(low, high)?;
        let step = nice((high - low) / TICKS);
        let size = low.abs().max(high.abs());
        let exponent =
            if (1e-2..1e5).contains(&size) { 0 } else { 3 * (size.log10() / 3.0).floor() as i32 };
        Some(Self { low, high, start, end, step, exponent })
    }

    /// The place of a value.
    pub fn at(&self, value: f64) -> f64 {
        self.start + (value - self.low) / (self.high - self.low) * (self.end - self.start)
    }

    /// The place of zero, where it lies inside.
    pub fn zero(&self) -> Option<f64> {
        (self.low < 0.0 && self.high > 0.0).then(|| self.at(0.0))
    }

    /// Places and texts of the ticks.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let unit = 10_f64.powi(self.exponent);
        let decimals = (-(self.step / unit).log10().floor()).max(0.0) as usize;
        let first = (self.low / self.step).ceil() as i64;
        let last = (self.high / self.step).floor() as i64;
        (first..=last)
            .map(|k| {
                let value = k as f64 * self.step;
                (self.at(value), format!("{:.decimals$}", value / unit))
            })
            .collect()
    }

    /// The label of the axis with the power of ten that the ticks leave out.
    pub fn label(&self, label: &str) -> String {
        let power = self.exponent;
        if power == 0 { label.to_owned() } else { format!("{label}  (×10{})", superscript(power)) }
    }
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
        let scale = Scale::of([low, high].iter(), 0.0, 100.0).unwrap();
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
    fn a_single_value_has_room_around_it() {
        let scale = Scale::of([3.0].iter(), 0.0, 100.0).unwrap();
        assert!((scale.at(3.0) - 50.0).abs() < 1e-9);
        assert!(Scale::of(std::iter::empty(), 0.0, 1.0).is_none());
        assert!(Scale::of([-f64::MAX, f64::MAX].iter(), 0.0, 1.0).is_none());
    }
}
