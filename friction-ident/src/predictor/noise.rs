//! What is known of the noise of encoder and force before any model is fitted.

use missing_physics::Recording;
use missing_physics::ahead::statistics::spread;
use missing_physics::measurement::check::count_of;
use missing_physics::statistics::basis::{dot, gram, solve};

/// Sum of the squares of the binomial coefficients of a fourth difference.
const FOURTH: f64 = 70.0;
/// Samples that a fourth difference looks at must move by this many counts: at rest counts say nothing.
const MOVING: f64 = 8.0;
/// Fewest fourth differences.
const FEWEST: usize = 300;
/// A control error explains the force where it leaves at most this share of it.
const EXPLAINED: f64 = 0.2;
/// The last resort for positions without counts or noise, as a share of the stroke.
const NONE: f64 = 1e-9;

/// Standard deviations.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Noise {
    /// Of the position, m or rad: counts and noise.
    pub position: f64,
    /// Of the recorded force against the one that acts, N or N m, as far as it is known: resolution, and what
    /// the controller's own law leaves where the reference was recorded.
    pub force: f64,
    /// White noise that the recorded force can hold at most: its quick part.
    pub force_at_most: f64,
}

impl Noise {
    /// The noise of a recording with channels `force` and `position` of a plant of about `mass`.
    pub(super) fn of(recording: &Recording, stale: &[bool], mass: f64) -> Option<Self> {
        let y = &recording.channel("position")?.values;
        let u = &recording.channel("force")?.values;
        let span = y.iter().fold((f64::MAX, f64::MIN), |(a, b), x| (a.min(*x), b.max(*x)));
        let count = count_of(y).unwrap_or(0.0);
        let position = quick_part(recording, (y, u), stale, mass, count);
        let resolution = count_of(u).unwrap_or(0.0) / 12f64.sqrt();
        let at_most = fourth_differences(recording, u, |_| true);
        let at_most = spread(&at_most) / FOURTH.sqrt();
        let force = of_controller(recording, y, u).map_or(resolution, |n| n.max(resolution));
        Some(Self {
            position: position.max(count / 12f64.sqrt()).max(NONE * (span.1 - span.0)),
            force: force.min(at_most.max(resolution)),
            force_at_most: at_most.max(force),
        })
    }
}

/// Noise of the position from its fourth differences, less what the force does to the second ones: exact for
/// a mass under a held force, and near it for one that changes slowly.
fn quick_part(
    recording: &Recording,
    (y, u): (&[f64], &[f64]),
    stale: &[bool],
    mass: f64,
    count: f64,
) -> f64 {
    let interval = recording.interval();
    let per_force = interval * interval / (2.0 * mass);
    // Twice the sum of the force's part from the start: its second difference is what the force adds.
    let mut free = y.to_vec();
    for segment in recording.segments() {
        let (mut slope, mut moved) = (0.0, 0.0);
        for k in segment.start + 1..segment.end {
            moved += slope + per_force * u[k - 1];
            slope += 2.0 * per_force * u[k - 1];
            free[k] -= moved;
        }
    }
    let fresh = |k: usize| stale[k..k + 5].iter().all(|stale| !stale);
    let moves = |k: usize| (y[k + 4] - y[k]).abs() > MOVING * count && fresh(k);
    let differences = fourth_differences(recording, &free, moves);
    if differences.len() < FEWEST { 0.0 } else { spread(&differences) / FOURTH.sqrt() }
}

/// Fourth differences of evenly sampled stretches that begin where `wanted` says so.
fn fourth_differences(
    recording: &Recording,
    values: &[f64],
    wanted: impl Fn(usize) -> bool,
) -> Vec<f64> {
    let (time, interval) = (recording.time(), recording.interval());
    let even =
        |k: usize| (1..=4).all(|j| ((time[k + j] - time[k + j - 1]) / interval - 1.0).abs() < 0.05);
    let mut out = Vec::new();
    for segment in recording.segments() {
        for k in segment.start..segment.end.saturating_sub(4) {
            if even(k) && wanted(k) {
                let v = &values[k..k + 5];
                out.push(v[0] - 4.0 * v[1] + 6.0 * v[2] - 4.0 * v[3] + v[4]);
            }
        }
    }
    out
}

/// Noise of the recorded force against a controller that acts on the control error and its difference.
fn of_controller(recording: &Recording, y: &[f64], u: &[f64]) -> Option<f64> {
    let reference = &recording.channel("reference")?.values;
    let error: Vec<f64> = reference.iter().zip(y).map(|(r, y)| r - y).collect();
    let inside = |k: &usize| recording.segments().iter().any(|s| *k > s.start && *k < s.end);
    let rows: Vec<usize> = (1..y.len()).filter(inside).collect();
    let column = |f: &dyn Fn(usize) -> f64| -> Vec<f64> { rows.iter().map(|k| f(*k)).collect() };
    let columns =
        [column(&|k| error[k]), column(&|k| error[k] - error[k - 1]), column(&|_| 1.0)].to_vec();
    let target = column(&|k| u[k]);
    let moment: Vec<f64> = columns.iter().map(|c| dot(c, &target)).collect();
    let law = solve(&gram(&columns), &moment, &[0, 1, 2]);
    let left = |i: usize| target[i] - (0..3).map(|j| law[j] * columns[j][i]).sum::<f64>();
    let noise = spread(&(0..rows.len()).map(left).collect::<Vec<_>>());
    let size = spread(&target);
    (noise < EXPLAINED * size).then_some(noise)
}
