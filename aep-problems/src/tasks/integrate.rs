//! Steps of simulations.

/// One step of the classical Runge-Kutta method.
pub fn runge_kutta<const N: usize>(
    x: [f64; N],
    step: f64,
    slope: impl Fn([f64; N]) -> [f64; N],
) -> [f64; N] {
    let moved = |by: f64, slope: [f64; N]| std::array::from_fn(|i| x[i] + by * slope[i]);
    let a = slope(x);
    let b = slope(moved(0.5 * step, a));
    let c = slope(moved(0.5 * step, b));
    let d = slope(moved(step, c));
    std::array::from_fn(|i| x[i] + step / 6.0 * (a[i] + 2.0 * (b[i] + c[i]) + d[i]))
}

/// A velocity after dry friction that can change it by `most`: the implicit step, which comes to rest
/// and stays there.
pub fn rubbed(velocity: f64, most: f64) -> f64 {
    velocity - velocity.clamp(-most, most)
}

/// A value as it was up to a few steps ago, between steps by a straight line.
pub struct Delay<const N: usize> {
    values: [f64; N],
    now: usize,
}

impl<const N: usize> Delay<N> {
    /// One that has always been 0. N is a power of two.
    pub fn new() -> Self {
        const { assert!(N.is_power_of_two()) };
        Self { values: [0.0; N], now: 0 }
    }

    /// The value of this step.
    pub fn push(&mut self, value: f64) {
        self.now = (self.now + 1) & (N - 1);
        self.values[self.now] = value;
    }

    /// The value `steps` ago, at most N - 2.
    pub fn ago(&self, steps: f64) -> f64 {
        let steps = steps.clamp(0.0, (N - 2) as f64);
        let whole = steps as usize;
        let at = |back: usize| self.values[(self.now + N - back) & (N - 1)];
        at(whole) + (steps - whole as f64) * (at(whole + 1) - at(whole))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_step_of_an_oscillator_is_exact_to_the_fourth_order() {
        let ten = |h: f64, steps: usize| {
            (0..steps).fold([1.0, 0.0], |x, _| runge_kutta(x, h, |x| [x[1], -x[0]]))[0]
        };
        let error = |h: f64, steps: usize| (ten(h, steps) - (h * steps as f64).cos()).abs();
        let order = (error(0.1, 100) / error(0.05, 200)).log2();
        assert!((order - 4.0).abs() < 0.3, "{order}");
    }

    #[test]
    fn friction_brings_to_rest_and_no_further() {
        assert_eq!([rubbed(3.0, 1.0), rubbed(-3.0, 1.0), rubbed(0.5, 1.0)], [2.0, -2.0, 0.0]);
    }

    #[test]
    fn a_delay_lies_between_steps() {
        let mut delay = Delay::<8>::new();
        (0..20).for_each(|i| delay.push(f64::from(i)));
        assert_eq!([delay.ago(0.0), delay.ago(2.5), delay.ago(6.0)], [19.0, 16.5, 13.0]);
        assert_eq!(delay.ago(100.0), 13.0);
    }
}
