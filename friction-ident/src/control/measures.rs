//! What engineers read off a closed loop: errors, stick, standstill at reversals, effort.

use std::ops::Range;

use serde::Serialize;

use crate::closed_loop::Run;
use crate::reference::Reference;

/// Measures of one run. SI units of the axis.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Measures {
    /// Root mean square of reference minus position, m or rad.
    pub rms_error: f64,
    /// Largest of its sizes.
    pub peak_error: f64,
    /// Mean distance by which the axis is behind its moving reference, m or rad; negative where it
    /// runs ahead, which over-compensated friction does.
    pub mean_lag: f64,
    /// Time from the reference's first motion until the friction lets the axis go, s.
    pub breakaway_time: f64,
    /// Time after that in which the friction holds the axis though the reference moves, s.
    pub stick_time: f64,
    /// Periods of it that last for two samples or more.
    pub stick_episodes: usize,
    /// How much longer than the reference the axis stands at each reversal, s.
    pub standstill: Vec<f64>,
    /// Root mean square of the command, N or N m.
    pub effort_rms: f64,
    /// Largest size of the command.
    pub effort_peak: f64,
    /// Root mean square of the change of the command from sample to sample.
    pub effort_change: f64,
    /// Repeated stick away from reversals, or motion at rest, in the second half of the run.
    pub limit_cycle: Option<LimitCycle>,
}

/// A motion that repeats itself without being asked for.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct LimitCycle {
    /// Mean time between two repetitions, s.
    pub period: f64,
    /// Peak to peak of the tracking error in the time that it was seen, m or rad.
    pub amplitude: f64,
}

/// Share of a sample from which it counts as stick.
const HELD: f64 = 0.5;
/// Samples from which stick is an episode.
const EPISODE: usize = 2;
/// Repetitions that make a limit cycle.
const REPEATED: usize = 3;
/// Counts of the encoder within which an axis stands at a reversal.
pub const STANDSTILL_COUNTS: f64 = 5.0;
/// Time around a reversal, s, in which stick belongs to the reversal.
const REVERSAL: f64 = 0.1;

impl Measures {
    /// Of a run; `resolution` is that of the encoder, m or rad, and sets within which distance of its
    /// turning point an axis stands: 5 counts.
    pub fn of(run: &Run, reference: &Reference, resolution: f64) -> Self {
        let error: Vec<f64> =
            reference.position.iter().zip(&run.position).map(|(r, x)| r - x).collect();
        let step = reference.sample_time;
        let first = first_motion(run, reference);
        let episodes = episodes(run, reference, first);
        let stuck = (first..run.stuck.len()).filter(|&k| reference.velocity[k] != 0.0);
        let margin = (REVERSAL / step).round() as usize;
        let mut reversals = reversals(&reference.velocity);
        // One at the very end has nothing after it to be judged by.
        reversals.retain(|at| at + margin <= error.len());
        Self {
            rms_error: rms(&error),
            peak_error: peak(&error),
            mean_lag: mean_lag(&error, &reference.velocity),
            breakaway_time: breakaway_time(reference, first),
            stick_time: stuck.map(|k| run.stuck[k]).sum::<f64>() * step,
            stick_episodes: episodes.len(),
            standstill: standstill(run, reference, &reversals, STANDSTILL_COUNTS * resolution),
            effort_rms: rms(&run.command),
            effort_peak: peak(&run.command),
            effort_change: rms(&changes(&run.command)),
            limit_cycle: limit_cycle(run, reference, &reversals, &error, &episodes),
        }
    }

    /// Mean standstill at the reversals, s; none without reversals.
    pub fn mean_standstill(&self) -> Option<f64> {
        let count = self.standstill.len();
        (count > 0).then(|| self.standstill.iter().sum::<f64>() / count as f64)
    }
}

fn rms(values: &[f64]) -> f64 {
    (values.iter().map(|v| v * v).sum::<f64>() / values.len().max(1) as f64).sqrt()
}

fn peak(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |most, v| most.max(v.abs()))
}

fn changes(values: &[f64]) -> Vec<f64> {
    values.windows(2).map(|pair| pair[1] - pair[0]).collect()
}

fn mean_lag(error: &[f64], velocity: &[f64]) -> f64 {
    let moving = || error.iter().zip(velocity).filter(|(_, v)| **v != 0.0);
    moving().map(|(e, v)| e * v.signum()).sum::<f64>() / moving().count().max(1) as f64
}

/// First sample after which the axis slides though the reference has begun to move; the end if never.
fn first_motion(run: &Run, reference: &Reference) -> usize {
    let begin = reference.velocity.iter().position(|v| *v != 0.0).unwrap_or(run.stuck.len());
    (begin..run.stuck.len()).find(|&k| run.stuck[k] < HELD).unwrap_or(run.stuck.len())
}

fn breakaway_time(reference: &Reference, first: usize) -> f64 {
    let begin = reference.velocity.iter().position(|v| *v != 0.0).unwrap_or(first);
    (first - begin.min(first)) as f64 * reference.sample_time
}

/// Samples of each period of stick while the reference moves.
fn episodes(run: &Run, reference: &Reference, first: usize) -> Vec<Range<usize>> {
    runs(first..run.stuck.len(), |k| run.stuck[k] >= HELD && reference.velocity[k] != 0.0)
}

/// Stretches of at least [`EPISODE`] samples where `holds`.
fn runs(within: Range<usize>, holds: impl Fn(usize) -> bool) -> Vec<Range<usize>> {
    let (mut found, mut begin) = (Vec::new(), None);
    for k in within.clone() {
        match (holds(k), begin) {
            (true, None) => begin = Some(k),
            (false, Some(from)) => {
                found.push(from..k);
                begin = None;
            }
            _ => {}
        }
    }
    found.extend(begin.map(|from| from..within.end));
    found.retain(|episode: &Range<usize>| episode.len() >= EPISODE);
    found
}

/// Samples at which the reference begins to move against its last direction.
fn reversals(velocity: &[f64]) -> Vec<usize> {
    let (mut last, mut found) = (0.0, Vec::new());
    for (k, v) in velocity.iter().enumerate().filter(|(_, v)| **v != 0.0) {
        if last * v < 0.0 {
            found.push(k);
        }
        last = v.signum();
    }
    found
}

/// How much longer than the reference the axis stays within `band` of its turning point.
fn standstill(run: &Run, reference: &Reference, reversals: &[usize], band: f64) -> Vec<f64> {
    let samples = run.position.len();
    let stays = |position: &[f64], range: Range<usize>, up: bool| -> f64 {
        let height = |k: usize| if up { position[k] } else { -position[k] };
        let Some(top) = range.clone().max_by(|a, b| height(*a).total_cmp(&height(*b))) else {
            return 0.0;
        };
        let near = |k: &usize| height(top) - height(*k) <= band;
        let before = (range.start..top).rev().take_while(near).count();
        let after = (top..range.end).take_while(near).count();
        (before + after) as f64 * reference.sample_time
    };
    let span = |i: usize| {
        let before = if i == 0 { 0 } else { reversals[i - 1] };
        let after = reversals.get(i + 1).copied().unwrap_or(samples);
        let at = reversals[i];
        // From the middle of the stretch before to the middle of the one after; a lagging axis turns
        // later than its reference.
        before.midpoint(at)..at.midpoint(after + 1)
    };
    (0..reversals.len())
        .map(|i| {
            let up = reference.velocity[reversals[i]] < 0.0;
            let axis = stays(&run.position, span(i), up);
            (axis - stays(&reference.position, span(i), up)).max(0.0)
        })
        .collect()
}

fn limit_cycle(
    run: &Run,
    reference: &Reference,
    reversals: &[usize],
    error: &[f64],
    episodes: &[Range<usize>],
) -> Option<LimitCycle> {
    let half = run.position.len() / 2;
    let margin = (REVERSAL / reference.sample_time).round() as usize;
    let apart = |episode: &Range<usize>| {
        !reversals.iter().any(|&r| episode.start < r + margin && r < episode.end + margin)
    };
    let moving = episodes.iter().filter(|e| e.start >= half && apart(e)).map(|e| e.start);
    // At rest what counts is motion, after the axis had time to come to rest.
    let rests = |k: usize| {
        let since = k.saturating_sub(2 * margin);
        reference.velocity[since..=k].iter().all(|v| *v == 0.0)
    };
    let hunts = runs(half..run.stuck.len(), |k| rests(k) && run.stuck[k] < HELD);
    let starts: Vec<usize> = {
        let moving: Vec<usize> = moving.collect();
        if moving.len() >= REPEATED { moving } else { hunts.iter().map(|h| h.start).collect() }
    };
    let (first, last) = (*starts.first()?, *starts.last()?);
    if starts.len() < REPEATED {
        return None;
    }
    let seen = &error[first..=last];
    let high = seen.iter().fold(f64::NEG_INFINITY, |high, e| high.max(*e));
    let low = seen.iter().fold(f64::INFINITY, |low, e| low.min(*e));
    Some(LimitCycle {
        period: (last - first) as f64 * reference.sample_time / (starts.len() - 1) as f64,
        amplitude: high - low,
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::{Channel, Recording};

    /// A run of which only the motion matters.
    fn run(position: Vec<f64>, stuck: Vec<f64>) -> Run {
        let n = position.len();
        let time = (0..n).map(|k| k as f64).collect();
        let channel = Channel::new("position", "m", position.clone());
        Run {
            recording: Recording::new("test", time, vec![channel]).unwrap(),
            velocity: vec![0.0; n],
            command: vec![2.0; n],
            position,
            stuck,
        }
    }

    fn ramp(n: usize) -> Reference {
        super::super::course::Course::Ramp { speed: 1.0 }.sampled(0.01, (n - 1) as f64 * 0.01)
    }

    #[test]
    fn stick_is_counted_after_the_first_motion_and_in_episodes_of_two_samples() {
        let reference = ramp(20);
        let mut stuck = vec![1.0, 1.0, 0.0, 1.0, 1.0, 0.0, 1.0, 0.0, 0.2];
        stuck.resize(20, 0.0);
        let position: Vec<f64> = reference.position.iter().map(|x| x - 0.03).collect();
        let found = Measures::of(&run(position, stuck), &reference, 1e-6);
        assert_eq!((found.stick_episodes, found.limit_cycle), (1, None));
        assert!((found.stick_time - 0.032).abs() < 1e-12, "{found:?}");
        assert!((found.breakaway_time - 0.02).abs() < 1e-12);
        for size in [found.rms_error, found.peak_error, found.mean_lag] {
            assert!((size - 0.03).abs() < 1e-12, "{found:?}");
        }
        assert_eq!((found.effort_rms, found.effort_peak, found.effort_change), (2.0, 2.0, 0.0));
    }

    #[test]
    fn a_flat_top_is_the_standstill() {
        let course = super::super::course::Course::Reversal { speed: 1.0, interval: 1.0 };
        let reference = course.sampled(0.01, 2.0);
        // 0.12 m behind: it stands until the reference has come back by 0.12 m and goes on.
        let lag = |r: &f64, k: usize| if k < 100 { r - 0.06 } else { (r + 0.06).min(0.93) };
        let position = reference.position.iter().enumerate().map(|(k, r)| lag(r, k)).collect();
        let found = Measures::of(&run(position, vec![0.0; 201]), &reference, 1e-6);
        assert_eq!(found.standstill.len(), 1);
        assert!((found.standstill[0] - 0.13).abs() < 0.021, "{found:?}");
        let ideal =
            Measures::of(&run(reference.position.clone(), vec![0.0; 201]), &reference, 1e-6);
        assert_eq!(ideal.mean_standstill(), Some(0.0));
    }

    #[test]
    fn stick_that_repeats_is_a_limit_cycle_with_period_and_amplitude() {
        let reference = ramp(400);
        let stuck = (0..400).map(|k| f64::from(u8::from(k % 20 < 8 && k > 5))).collect();
        let lag = |(k, r): (usize, &f64)| r - 0.01 * (k % 20) as f64 / 19.0;
        let position = reference.position.iter().enumerate().map(lag).collect();
        let cycle = Measures::of(&run(position, stuck), &reference, 1e-6).limit_cycle.unwrap();
        assert!((cycle.period - 0.2).abs() < 1e-9, "{cycle:?}");
        assert!((cycle.amplitude - 0.01).abs() < 1e-9, "{cycle:?}");
    }

    #[test]
    fn hunting_at_rest_is_a_limit_cycle_too() {
        let mut reference = ramp(400);
        reference.velocity[50..].fill(0.0);
        let stuck = (0..400).map(|k| f64::from(u8::from(k % 30 > 10))).collect();
        let found = Measures::of(&run(vec![0.0; 400], stuck), &reference, 1e-6);
        assert!((found.limit_cycle.unwrap().period - 0.3).abs() < 1e-9, "{found:?}");
    }
}
