use super::*;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

struct Noise(Xoshiro256PlusPlus);

impl Noise {
    fn new(seed: u64) -> Self {
        Self(Xoshiro256PlusPlus::seed_from_u64(seed))
    }
    fn next(&mut self) -> f64 {
        StandardNormal.sample(&mut self.0)
    }
    fn white(&mut self, points: usize) -> Vec<f64> {
        (0..points).map(|_| self.next()).collect()
    }
    /// First-order autoregressive with this memory.
    fn slow(&mut self, points: usize, memory: f64) -> Vec<f64> {
        let mut state = self.next();
        (0..points)
            .map(|_| {
                state = memory * state + (1.0 - memory * memory).sqrt() * self.next();
                state
            })
            .collect()
    }
}

fn grid(points: usize) -> Vec<f64> {
    // A gap in the middle.
    (0..points).map(|k| 0.01 * k as f64 + if k > points / 2 { 1.0 } else { 0.0 }).collect()
}

/// At a true rate of 5 %, 200 trials give more than 19 alarms with a probability of 0.3 %.
const MOST_OF_200: usize = 19;

fn alarms(trial: impl Fn(u64) -> f64) -> usize {
    (0..200).filter(|&seed| trial(seed) <= 0.05).count()
}

#[test]
fn white_noise_is_called_coloured_in_at_most_five_per_cent() {
    let time = grid(600);
    let count =
        alarms(|seed| whiteness(&Noise::new(seed).white(600), &time, &[], 0).unwrap().p_value);
    assert!((2..=MOST_OF_200).contains(&count), "{count} of 200");
}

#[test]
fn white_noise_whose_size_changes_is_called_coloured_in_at_most_five_per_cent() {
    let time = grid(600);
    let count = alarms(|seed| {
        let mut noise = Noise::new(1000 + seed).white(600);
        for (k, value) in noise.iter_mut().enumerate() {
            *value *= if k % 150 < 40 { 5.0 } else { 1.0 };
        }
        whiteness(&noise, &time, &[], 0).unwrap().p_value
    });
    assert!(count <= MOST_OF_200, "{count} of 200");
}

#[test]
fn white_noise_that_the_comparison_smoothed_is_called_coloured_in_at_most_five_per_cent() {
    let time = grid(600);
    // Sums of two neighbours: a correlation of a half at lag 1.
    let count = alarms(|seed| {
        let noise = Noise::new(2000 + seed).white(601);
        let smooth: Vec<f64> = noise.windows(2).map(|pair| pair[0] + 0.6 * pair[1]).collect();
        whiteness(&smooth, &time, &[0.6 / 1.36], 0).unwrap().p_value
    });
    assert!(count <= MOST_OF_200, "{count} of 200");
}

#[test]
fn noise_with_a_memory_is_called_coloured_and_its_memory_is_about_right() {
    let test = whiteness(&Noise::new(3).slow(2000, 0.9), &grid(2000), &[], 0).unwrap();
    assert!(test.p_value < 1e-6);
    assert!((0.1..0.5).contains(&test.memory_s.unwrap_or(0.33)), "{:?}", test.memory_s);
}

#[test]
fn past_outputs_cost_degrees_of_freedom() {
    let noise = Noise::new(3).white(600);
    let none = whiteness(&noise, &grid(600), &[], 0).unwrap();
    let two = whiteness(&noise, &grid(600), &[], 2).unwrap();
    assert_eq!(none.degrees_of_freedom, two.degrees_of_freedom + 2);
    assert!(two.p_value < none.p_value);
}

#[test]
fn two_slow_signals_that_have_nothing_to_do_with_each_other_are_called_dependent_in_five_per_cent()
{
    let time = grid(900);
    let count = alarms(|seed| {
        let mut noise = Noise::new(5000 + seed);
        let (input, residual) = (noise.slow(900, 0.95), noise.slow(900, 0.9));
        independence("input", &input, &residual, &time, &[], seed).unwrap().p_value
    });
    assert!(count <= MOST_OF_200, "{count} of 200");
}

#[test]
fn a_residual_that_follows_an_input_is_found_with_its_lag() {
    let mut noise = Noise::new(9);
    let input = noise.slow(900, 0.8);
    let residual: Vec<f64> =
        (0..900).map(|k| if k >= 5 { 0.5 * input[k - 5] } else { 0.0 } + noise.next()).collect();
    let time: Vec<f64> = (0..900).map(|k| 0.01 * f64::from(k)).collect();
    let test = independence("input", &input, &residual, &time, &[], 1).unwrap();
    assert!(test.p_value <= 0.01);
    assert!((test.worst_lag_s - 0.05).abs() < 0.011, "{}", test.worst_lag_s);
}

#[test]
fn what_does_not_vary_or_is_too_short_is_not_tested() {
    assert!(whiteness(&[1.0; 100], &grid(100), &[], 0).is_none());
    assert!(whiteness(&[1.0, 2.0], &grid(2), &[], 0).is_none());
    assert!(independence("input", &[1.0; 200], &[1.0; 200], &grid(200), &[], 1).is_none());
}
