//! A contact whose force is any concave curve of the displacement: five elements with free shares.

use super::{
    About, Effect, Element, Onset, Parameter, Parameters, Quantity, Response, SHOWS, Slot, Step,
};
use crate::effects::{Leg, Trials};
use crate::simd::{limited, vectorised};

/// Number of elements.
const ELEMENTS: usize = 5;
/// Breakaway distances of the elements in units of `d`.
const REACH: [f64; ELEMENTS] = [0.08, 0.2, 0.45, 0.9, 1.7];
/// One over each.
const PER_REACH: [f64; ELEMENTS] =
    [1.0 / REACH[0], 1.0 / REACH[1], 1.0 / REACH[2], 1.0 / REACH[3], 1.0 / REACH[4]];
/// Utilisation from which the contact counts as sliding.
const BROKEN: f64 = 0.999;
/// Place of the damping among the parameters.
const DAMPING: usize = 5;

/// `level sum_i q_i z_i`, `z_i' = v/(d r_i)` within -1..1: Jenkins elements in parallel (Maxwell slip), each with its own
/// breakaway distance and a share `q_i` of the level, and a damping that ends where they all slide.
///
/// The states are the utilisations `z_i`, so that distances stay what they are where the level changes, and behind them
/// the shares, which are the same all the time.
#[derive(Clone, Copy, Debug)]
pub struct Free;

const fn weight(name: &'static str) -> Parameter {
    let meaning = "logarithm of the share of an element over that of element 3";
    Parameter::shape(name, meaning, Quantity::One, (-4.0, 4.0), 0.0).linear()
}

static ABOUT: About = About {
    name: "presliding:free",
    title: "pre-sliding displacement, free curve",
    equation: "level sum_{i=0..4} q_i z_i + sigma_1 v (1 - s sum q_i z_i) instead of level s, z_i' = v/(d r_i) within \
               -1..1, r = 0.08, 0.2, 0.45, 0.9, 1.7, q ~ exp(w), w_3 = 0, sum q_i = 1",
    parameters: &[
        Parameter::shape("d", "breakaway distance", Quantity::Length, (1e-7, 0.1), 5e-6),
        weight("w_0"),
        weight("w_1"),
        weight("w_2"),
        weight("w_4"),
        Parameter::shape("sigma_1", "damping of the contact", Quantity::Damping, (1.0, 1e5), 1e3),
    ],
    slots: &[Slot::Contact],
    shows: SHOWS,
    reference: "F. Al-Bender, V. Lampaert, J. Swevers, IEEE TAC 50, 2005; W. D. Iwan, J. Applied Mechanics 33, 1966",
};

impl Effect for Free {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    /// How far it gives lies in `d` and the shares together.
    fn whatever(&self) -> &'static [&'static str] {
        &["d", "sigma_1"]
    }

    fn gives(&self, values: &[f64], _level: f64) -> Option<f64> {
        let each = shares(values).into_iter().zip(REACH);
        Some(values[0] * each.map(|(share, reach)| share * reach).sum::<f64>())
    }

    /// Alone it would fit anything a little.
    fn is_only_flexible(&self) -> bool {
        true
    }

    /// The elements share the level evenly at first, as a grid over all shares would be some thousand trials.
    fn trials(&self, parameter: &str) -> Option<Trials> {
        Some(match parameter {
            "d" => Trials::Spread(16),
            "sigma_1" => Trials::Spread(3),
            _ => Trials::At(&[0.0]),
        })
    }

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }
}

/// Shares of the level.
fn shares(p: &[f64]) -> [f64; ELEMENTS] {
    let weights = [p[1], p[2], p[3], 0.0, p[4]];
    let most = weights.iter().fold(0.0, |most: f64, weight| most.max(*weight));
    let shares = weights.map(|weight| (weight - most).exp());
    let sum: f64 = shares.iter().sum();
    shares.map(|share| share / sum)
}

impl Element for Free {
    fn states(&self) -> usize {
        2 * ELEMENTS
    }

    fn start(&self, p: &[f64], at: &Onset, state: &mut [f64]) {
        let (used, share) = state.split_at_mut(ELEMENTS);
        used.fill(at.used);
        share.copy_from_slice(&shares(p));
    }

    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>) {
        let (time, moved, level) = (step.duration, step.displacement, step.level);
        respond(p.get(0), p.get(DAMPING), time, moved, level, state, out.force, out.stiffness);
    }

    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]) {
        let n = step.level.len();
        for (per_reach, used) in PER_REACH.iter().zip(state.chunks_mut(n)) {
            commit(*per_reach, p.get(0), step.displacement, used);
        }
    }

    fn iterations(&self) -> usize {
        // For either sign of the displacement the response is concave, so that Newton comes from below and passes one
        // kink with every iteration; two more are for the damping, which is quadratic between them.
        ELEMENTS + 3
    }

    fn sliding(&self, _p: Parameters<'_>, level: &[f64], state: &[f64], sliding: &mut [f64]) {
        let n = level.len();
        for (i, sliding) in sliding.iter_mut().enumerate() {
            let sum: f64 =
                (0..ELEMENTS).map(|e| state[e * n + i] * state[(ELEMENTS + e) * n + i]).sum();
            *sliding = f64::from(u8::from(sum.abs() >= BROKEN));
        }
    }

    /// The elastic force of every sample; the damping is the mean of the steps before and after.
    fn along(&self, p: &[f64], path: &[Leg], state: &mut [f64], force: &mut [f64]) {
        let (used, share) = state.split_at_mut(ELEMENTS);
        let mut damping = vec![0.0; path.len()];
        for (k, leg) in path.iter().enumerate() {
            force[k] = 0.0;
            for e in 0..ELEMENTS {
                let (reach, per_reach) = (p[0] * REACH[e], PER_REACH[e] / p[0]);
                let (open, _) = opened(used[e], leg.displacement, reach, per_reach);
                used[e] = limited(used[e] + leg.displacement * per_reach, 1.0);
                force[k] += leg.level * share[e] * used[e];
                if leg.duration > 0.0 {
                    damping[k] += p[DAMPING] * share[e] * open / leg.duration;
                }
            }
        }
        let last = path.len().saturating_sub(1);
        for (k, force) in force.iter_mut().enumerate() {
            *force += 0.5 * (damping[k.clamp(1.min(last), last)] + damping[(k + 1).min(last)]);
        }
    }
}

/// Integral of `1 - z s` over a displacement, with its sign, and the slope of that, for a breakaway distance and one over it.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn opened(used: f64, moved: f64, reach: f64, per_reach: f64) -> (f64, f64) {
    let left = 1.0 - if moved < 0.0 { -used } else { used };
    // What is gone of the way until it slides.
    let way = moved.abs().min(left * reach);
    let bent = way * per_reach;
    ((way * (left - 0.5 * bent)).copysign(moved), left - bent)
}

vectorised! {
    fn respond(
        distance: &[f64],
        damping: &[f64],
        duration: &[f64],
        moved: &[f64],
        level: &[f64],
        state: &[f64],
        force: &mut [f64],
        slope: &mut [f64],
    ) {
        let n = force.len();
        let (distance, damping, duration) = (&distance[..n], &damping[..n], &duration[..n]);
        let (moved, level) = (&moved[..n], &level[..n]);
        let slope = &mut slope[..n];
        let used: [&[f64]; ELEMENTS] = std::array::from_fn(|e| &state[e * n..][..n]);
        let share: [&[f64]; ELEMENTS] = std::array::from_fn(|e| &state[(ELEMENTS + e) * n..][..n]);
        for i in 0..n {
            // Two divisions for all elements.
            let per_distance = 1.0 / distance[i];
            let damping = damping[i] / duration[i].max(f64::MIN_POSITIVE);
            let (mut sum, mut bends) = (0.0, 0.0);
            for e in 0..ELEMENTS {
                let (reach, per_reach) = (REACH[e] * distance[i], PER_REACH[e] * per_distance);
                let (used, share) = (used[e][i], share[e][i]);
                let free = used + moved[i] * per_reach;
                let end = limited(free, 1.0);
                let (open, rate) = opened(used, moved[i], reach, per_reach);
                sum += share * (0.5 * level[i] * (used + end) + damping * open);
                let elastic = if free == end { 0.5 * level[i] * per_reach } else { 0.0 };
                bends += share * (elastic + damping * rate);
            }
            force[i] += sum;
            slope[i] += bends;
        }
    }

    fn commit(per_reach: f64, distance: &[f64], moved: &[f64], used: &mut [f64]) {
        for ((used, moved), distance) in used.iter_mut().zip(moved).zip(distance) {
            *used = limited(*used + moved * (per_reach * (1.0 / distance)), 1.0);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::tests::walk;
    use super::*;
    use crate::axis::Axis;
    use crate::effects::testing::along_and_simulated;
    use crate::model::Model;
    use crate::simulator::{Input, Start, simulate};
    use missing_physics::Hold;

    const P: [f64; 6] = [1e-5, 0.5, -1.0, 0.3, 1.2, 2e3];

    fn mean(used: f64, moved: f64) -> (f64, f64) {
        let mut state = [used; 2 * ELEMENTS];
        state[ELEMENTS..].copy_from_slice(&shares(&P));
        super::super::tests::mean(&Free, &P, &state, moved)
    }

    #[test]
    fn it_follows_its_curve_up_to_the_level_and_loops_with_twice_the_size() {
        let still = [&P[..5], &[0.0]].concat();
        let share = shares(&P);
        let curve = |x: f64| -> f64 {
            (0..ELEMENTS).map(|e| 5.0 * share[e] * (x / (1e-5 * REACH[e])).min(1.0)).sum()
        };
        let path = [vec![1e-7; 200], vec![-1e-7; 400]].concat();
        let force = walk(&Free, &still, &path, 5.0);
        for k in 0..200 {
            let x = 1e-7 * (k + 1) as f64;
            assert!((force[k] - curve(x)).abs() < 1e-9);
            // Masing: the way back is the virgin curve, twice as large.
            assert!((force[200 + k] - (5.0 - 2.0 * curve(0.5 * x))).abs() < 1e-9);
        }
        assert!((force[199] - 5.0).abs() < 1e-9 && (force[599] + 5.0).abs() < 1e-9);
    }

    #[test]
    fn the_slope_of_the_response_is_its_derivative_and_falls_with_the_way() {
        for used in [-0.7, 0.0, 0.4] {
            for side in [1.0, -1.0] {
                let mut before = f64::INFINITY;
                for way in [1e-8, 3e-7, 1.1e-6, 3e-6, 7e-6, 2e-5, 1e-4] {
                    let moved = side * way;
                    let numeric =
                        (mean(used, moved + 1e-11).0 - mean(used, moved - 1e-11).0) / 2e-11;
                    let slope = mean(used, moved).1;
                    assert!(
                        (slope - numeric).abs() < 1e-4 * before.min(1e6) + 1e-2,
                        "{used} {moved}"
                    );
                    assert!(slope <= before);
                    before = slope;
                }
            }
        }
    }

    #[test]
    fn newton_ends_at_the_balance() {
        // As the simulator iterates: 2 m u + r f(r u) = push.
        let (inertia, r) = (10.0, 1e-3);
        for used in [-1.0, -0.3, 0.0, 0.9] {
            for push in [-3.0, -0.1, -1e-3, 1e-5, 4e-3, 0.05, 1.0, 20.0] {
                let mut moved = 0.0;
                for _ in 0..=Free.iterations() {
                    let (force, slope) = mean(used, moved);
                    moved = r * (push - r * (force - slope * moved)) / (inertia + r * r * slope);
                }
                let left = inertia * moved / r + r * mean(used, moved).0 - push;
                assert!(left.abs() < 1e-9 * push.abs().max(1e-3), "{used} {push}: {left}");
            }
        }
    }

    /// Position after 0.1 s of a push that breaks the contact twice.
    fn pushed(step: f64) -> f64 {
        let model = Model::new(Axis::Linear, 5.0)
            .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
            .and_then(|m| {
                m.with("presliding:free", &[("d", 4e-4), ("w_0", -1.0), ("sigma_1", 30.0)])
            })
            .unwrap();
        let time: Vec<f64> = (0..=10).map(|k| f64::from(k) * 1e-2).collect();
        let force: Vec<f64> = time.iter().map(|t| 15.0 * (80.0 * t).sin()).collect();
        let input = Input::new(&time, &force, Hold::Sampled).with_max_step(step);
        simulate(&model, &input, &Start::at(0.0, 0.0)).unwrap().position[10]
    }

    #[test]
    fn a_smaller_step_divides_the_error_by_its_square() {
        let exact = pushed(1e-6);
        let (coarse, fine) = ((pushed(5e-4) - exact).abs(), (pushed(5e-5) - exact).abs());
        assert!(fine < coarse / 40.0, "{coarse:e} {fine:e}");
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("d", 5e-4), ("w_1", 1.0), ("w_4", -0.5), ("sigma_1", 20.0)];
        let left = along_and_simulated(&[("presliding:free", &values)], None);
        assert!(left < 0.05, "{left}");
    }
}
