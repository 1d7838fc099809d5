//! The cost along one component.

use serde::{Deserialize, Serialize};

/// How far below the best cost the parabolas of [`Line::easiest`] reach, as a share of what is known
/// of the range of costs.
const BELOW: f64 = 1e-8;
/// Least distance of two places.
const CLOSEST: f64 = 1e-9;
/// Least move of [`Line::vertex`], as a share of its interval: the interval must shrink from both
/// sides.
const LEAST_MOVE: f64 = 0.02;

/// Places on [0, 1] and their costs.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Line {
    /// In the order of places.
    known: Vec<(f64, f64)>,
    best: usize,
}

impl Line {
    pub fn new(place: f64, cost: f64) -> Self {
        Self { known: vec![(place, cost)], best: 0 }
    }

    /// Notes a cost; whether it is the best one.
    pub fn note(&mut self, place: f64, cost: f64) -> bool {
        let at = self.known.partition_point(|(known, _)| *known < place);
        let better = cost < self.known[self.best].1;
        if at <= self.best {
            self.best += 1;
        }
        self.known.insert(at, (place, cost));
        if better {
            self.best = at;
        }
        better
    }

    /// Shifts all costs so that the best one is `cost`.
    pub fn shift_to(&mut self, cost: f64) {
        let shift = cost - self.known[self.best].1;
        self.known.iter_mut().for_each(|(_, known)| *known += shift);
    }

    /// Where to look next: both ends, then in turns at the bottom of the best minimum and wherever a
    /// lower one fits in most easily. None when every place is known.
    pub fn propose(&self, turn: u64) -> Option<f64> {
        let (first, last) = (self.known[0].0, self.known[self.known.len() - 1].0);
        if first > 0.0 {
            return Some(0.0);
        }
        if last < 1.0 {
            return Some(1.0);
        }
        let bottom = if turn.is_multiple_of(2) { self.vertex() } else { None };
        bottom.or_else(|| self.easiest())
    }

    /// The vertex of the parabola through the best place and its neighbours.
    fn vertex(&self) -> Option<f64> {
        let neighbours = self.best.checked_sub(1)?..self.best + 2;
        let [(x0, y0), (x1, y1), (x2, y2)] = self.known.get(neighbours)? else { return None };
        if x2 - x0 < CLOSEST {
            return None;
        }
        let (p, q) = ((x1 - x0) * (y1 - y2), (x1 - x2) * (y1 - y0));
        let vertex = x1 - 0.5 * ((x1 - x0) * p - (x1 - x2) * q) / (p - q);
        let least = LEAST_MOVE * (x2 - x0);
        let vertex = if (vertex - x1).abs() >= least {
            vertex
        } else if x2 - x1 > x1 - x0 {
            x1 + least
        } else {
            x1 - least
        };
        (*x0 < vertex && vertex < *x2).then_some(vertex)
    }

    /// The middle of the interval where the parabola through both ends that goes below the best cost
    /// bends least (S.T.E.P.). Its curvature is the square of
    /// (sqrt(y0 - below) + sqrt(y1 - below)) / width.
    fn easiest(&self) -> Option<f64> {
        let finite = || self.known.iter().map(|(_, cost)| *cost).filter(|cost| cost.is_finite());
        let low = self.known[self.best].1;
        let below = low - BELOW * (finite().fold(low, f64::max) - low).max(f64::MIN_POSITIVE);
        let mut easiest = None;
        let mut least = f64::INFINITY;
        for pair in self.known.windows(2) {
            let width = pair[1].0 - pair[0].0;
            let bend = ((pair[0].1 - below).sqrt() + (pair[1].1 - below).sqrt()) / width;
            if width > CLOSEST && bend < least {
                least = bend;
                easiest = Some(f64::midpoint(pair[0].0, pair[1].0));
            }
        }
        easiest
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn search(cost: impl Fn(f64) -> f64, evaluations: u64) -> (f64, f64) {
        let mut line = Line::new(0.4, cost(0.4));
        for turn in 0..evaluations {
            let Some(place) = line.propose(turn) else { break };
            line.note(place, cost(place));
        }
        line.known[line.best]
    }

    #[test]
    fn the_lowest_of_many_minima_is_found_and_its_bottom_reached() {
        let dents = |x: f64| 30.0 * (x - 0.73).powi(2) - (80.0 * (x - 0.73)).cos();
        let (place, cost) = search(dents, 120);
        assert!((place - 0.73).abs() < 1e-5 && cost < -1.0 + 1e-7, "{place} {cost}");
    }

    #[test]
    fn an_optimum_at_an_end_and_costs_that_are_not_finite_are_no_obstacle() {
        assert_eq!(search(|x| -x, 5).0, 1.0);
        let half = |x: f64| if x < 0.3 { f64::INFINITY } else { (x - 0.31).powi(2) };
        assert!((search(half, 80).0 - 0.31).abs() < 1e-3);
    }
}
