use super::*;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_xoshiro::Xoshiro256PlusPlus;

const POINTS: usize = 4000;
const INTERVAL: f64 = 1e-3;

/// Noise with a memory of about ten samples, four times as large in a fifth of the time.
fn noise(seed: u64) -> Vec<f64> {
    let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
    let mut normal = move || -> f64 { StandardNormal.sample(&mut random) };
    let mut state = 0.0;
    (0..POINTS)
        .map(|k| {
            state = 0.9 * state + 0.436 * normal();
            state * if k % 1000 < 200 { 4.0 } else { 1.0 }
        })
        .collect()
}

/// To and fro over 0.1 m at a speed of 0.1 m/s, then of 0.05 m/s.
fn position() -> Vec<f64> {
    (0..POINTS)
        .map(|k| {
            let t = k as f64 * INTERVAL;
            if t < 2.0 { 0.1 - (0.1 * t - 0.1).abs() } else { 0.05 * (t - 2.0) }
        })
        .collect()
}

fn full(residual: Vec<f64>) -> FullRate {
    let coordinate = Coordinate {
        name: "position".into(),
        unit: "m".into(),
        values: position(),
        parity: None,
        state: true,
    };
    FullRate {
        interval: INTERVAL,
        residual,
        used: vec![true; POINTS],
        pieces: std::iter::once(0..POINTS).collect(),
        coordinates: vec![coordinate],
    }
}

#[test]
fn noise_without_lines_has_a_line_in_at_most_one_per_cent_of_its_spectra() {
    // 600 spectra; at a true rate of 1 % more than 13 happen with a probability of 0.3 %.
    let alarms: usize = (0..300)
        .map(|seed| {
            let (lines, _) = lines(&full(noise(seed)), "force", "N");
            ["time", "position"]
                .iter()
                .filter(|along| lines.iter().any(|line| line.along == **along))
                .count()
        })
        .sum();
    assert!(alarms <= 13, "{alarms} of 600");
}

#[test]
fn a_burst_of_narrow_noise_in_a_tenth_of_the_time_is_no_line() {
    // 100 spectra; at a true rate of 1 % more than 4 happen with a probability of 0.4 %.
    let alarms = (0..100)
        .filter(|&seed| {
            let narrow = noise(5000 + seed);
            let residual = noise(seed)
                .iter()
                .enumerate()
                .map(|(k, quiet)| {
                    let burst = (1500..1900).contains(&k);
                    let wave = (TAU * 90.0 * k as f64 * INTERVAL).sin();
                    0.1 * quiet + if burst { 2.0 * narrow[k] * wave } else { 0.0 }
                })
                .collect();
            let (lines, _) = lines(&full(residual), "force", "N");
            lines.iter().any(|line| line.along == "time")
        })
        .count();
    assert!(alarms <= 4, "{alarms} of 100");
}

/// Whether a line has this period, to three digits.
fn is(line: &Line, along: &str, period: f64) -> bool {
    line.along == along && (line.period / period - 1.0).abs() < 5e-3
}

#[test]
fn a_hum_and_a_ripple_are_named_with_their_amplitudes() {
    let residual = noise(1)
        .iter()
        .zip(position())
        .enumerate()
        .map(|(k, (noise, x))| {
            let hum = (TAU * 50.0 * k as f64 * INTERVAL).sin();
            0.3 * noise + 0.5 * hum + 0.8 * (TAU * x / 2.5e-3).cos()
        })
        .collect();
    let (lines, plots) = lines(&full(residual), "force", "N");
    assert_eq!(plots.len(), 2);
    let hum = lines.iter().find(|line| is(line, "time", 0.02)).unwrap();
    assert!((hum.amplitude - 0.5).abs() < 0.1 && hum.p_value < 1e-4, "{hum:?}");
    assert_eq!(hum.relation, None);
    let ripple = lines.iter().find(|line| is(line, "position", 2.5e-3)).unwrap();
    assert!((ripple.amplitude - 0.8).abs() < 0.15 && ripple.relation.is_none(), "{ripple:?}");
    // At 0.1 and 0.05 m/s the ripple is seen at 40 and 20 Hz.
    for line in lines.iter().filter(|line| line.along == "time" && !is(line, "time", 0.02)) {
        let Some(Relation::SeenAt { of, rate, unit }) = &line.relation else {
            panic!("{line:?}");
        };
        assert_eq!((of, unit.as_str()), (&line_of(ripple), "m/s"));
        assert!([0.1, 0.05].iter().any(|speed| (rate / speed - 1.0).abs() < 0.02), "{line:?}");
    }
}

#[test]
fn a_second_harmonic_is_called_half_of_the_first() {
    let residual = noise(2)
        .iter()
        .zip(position())
        .map(|(noise, x)| 0.2 * noise + (TAU * x / 5e-3).cos() + 0.6 * (2.0 * TAU * x / 5e-3).sin())
        .collect();
    let (lines, _) = lines(&full(residual), "force", "N");
    let at = |period: f64| lines.iter().find(|line| is(line, "position", period)).unwrap();
    let whole = Relation::Harmonic { order: 2, of: line_of(at(5e-3)) };
    assert_eq!(at(2.5e-3).relation, Some(whole));
}

#[test]
fn too_little_to_look_at_has_no_lines() {
    let mut short = full(noise(1));
    short.pieces = std::iter::once(0..20).collect();
    short.used = vec![false; POINTS];
    assert_eq!(lines(&short, "force", "N"), (Vec::new(), Vec::new()));
    let still = full(vec![0.0; POINTS]);
    assert!(lines(&still, "force", "N").0.is_empty());
}
