//! Faults of a recording: instants, positions and time stamps that are not what they seem.

use super::hidden::Hidden;
use super::random::Stream;

/// How much later than its stamp each position is taken, in sampling intervals.
pub fn jitter(hidden: Hidden, size: f64, samples: usize, random: &mut Stream) -> Vec<f64> {
    let scale = if hidden == Hidden::Jitter { size } else { 0.0 };
    // The control sees a position at its instant, so that a late one is taken in the interval that follows.
    (0..samples).map(|_| (scale * random.normal()).abs().min(0.9)).collect()
}

/// Repeats old positions, or slows the stamps of a block down.
pub fn spoil(
    (hidden, size): (Hidden, f64),
    time: &mut [f64],
    position: &mut [f64],
    random: &mut Stream,
) {
    match hidden {
        Hidden::Dropped => drop(position, size, random),
        Hidden::WrongStamps => slow(time, size, random),
        _ => {}
    }
}

fn drop(position: &mut [f64], share: f64, random: &mut Stream) {
    let runs = (share * position.len() as f64 / 5.0).ceil() as usize;
    for _ in 0..runs {
        let (start, long) = (random.between(0.0, 1.0), random.between(3.0, 8.0) as usize);
        let start = (start * (position.len() - long - 1) as f64) as usize;
        let old = position[start];
        position[start..start + long].fill(old);
    }
}

fn slow(time: &mut [f64], part: f64, random: &mut Stream) {
    let (start, long) = (random.between(0.3, 0.7), random.between(0.08, 0.2));
    let samples = time.len() as f64;
    let (start, end) = ((start * samples) as usize, ((start + long) * samples) as usize);
    let interval = time[1] - time[0];
    for (k, time) in time.iter_mut().enumerate() {
        let inside = k.clamp(start, end) - start;
        *time += part * interval * inside as f64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn slowed_stamps_still_increase_and_keep_their_intervals_outside_the_block() {
        let mut time: Vec<f64> = (0..1000).map(|k| f64::from(k) * 0.01).collect();
        slow(&mut time, 0.2, &mut Stream::new(&["slow"], 3));
        let steps: Vec<f64> = time.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let slowed = steps.iter().filter(|step| (**step - 0.012).abs() < 1e-9).count();
        let usual = steps.iter().filter(|step| (**step - 0.01).abs() < 1e-9).count();
        assert_eq!(slowed + usual, 999);
        assert!((80..=200).contains(&slowed));
    }

    #[test]
    fn dropped_samples_repeat_an_old_position() {
        let mut position: Vec<f64> = (0..1000).map(f64::from).collect();
        drop(&mut position, 0.02, &mut Stream::new(&["drop"], 3));
        let repeated = position.windows(2).filter(|pair| pair[0] == pair[1]).count();
        assert!((5..=28).contains(&repeated), "{repeated}");
    }
}
