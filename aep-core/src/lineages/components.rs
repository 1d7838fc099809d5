//! A search along each component by itself, for costs that are sums over components.

use serde::{Deserialize, Serialize};

use super::line::Line;

/// Generations without a better parent after which the search ends.
const MOST_AGE: u64 = 100;
/// Most generations of the search.
const MOST_GENERATIONS: u64 = 400;

/// Each generation has one child per component, which differs from the parent in that component only;
/// what improves goes into the next parent together.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct ComponentSearch {
    parent: Vec<f64>,
    cost: f64,
    lines: Vec<Line>,
    /// The parent that several improvements make, and the cost that they add up to: evaluated next.
    joined: Option<(Vec<f64>, f64)>,
    generation: u64,
    /// Generations since the parent has last become better.
    age: u64,
    ended: bool,
}

impl ComponentSearch {
    /// `cost` must be finite.
    pub fn new(parent: Vec<f64>, cost: f64) -> Self {
        let lines = parent.iter().map(|place| Line::new(*place, cost)).collect();
        Self { parent, cost, lines, joined: None, generation: 0, age: 0, ended: false }
    }

    pub fn parent(&self) -> &[f64] {
        &self.parent
    }

    pub fn ended(&self) -> bool {
        self.ended
    }

    pub fn ask(&self, points: &mut Vec<f64>) {
        if let Some((joined, _)) = &self.joined {
            points.extend_from_slice(joined);
            return;
        }
        for (j, place) in self.places() {
            let from = points.len();
            points.extend_from_slice(&self.parent);
            points[from + j] = place;
        }
    }

    /// Each component with something left to look at, and the place.
    fn places(&self) -> impl Iterator<Item = (usize, f64)> {
        let lines = self.lines.iter().enumerate();
        lines.filter_map(|(j, line)| Some((j, line.propose(self.generation)?)))
    }

    /// The costs of what was asked; numbers are known to `epsilon` of their size.
    pub fn tell(&mut self, costs: &[f64], epsilon: f64) {
        if let Some((parent, expected)) = self.joined.take() {
            let allowed = 1e3 * epsilon * self.cost.abs().max(expected.abs());
            if (costs[0] - expected).abs() <= allowed {
                self.go_to(parent, costs[0]);
            } else {
                self.ended = true;
            }
            return;
        }
        let places: Vec<(usize, f64)> = self.places().collect();
        let mut parent = self.parent.clone();
        let mut gains = Vec::new();
        for ((j, place), cost) in places.into_iter().zip(costs) {
            if self.lines[j].note(place, *cost) {
                parent[j] = place;
                gains.push(self.cost - cost);
            }
        }
        self.generation += 1;
        self.age += 1;
        let expected = self.cost - gains.iter().sum::<f64>();
        match gains.len() {
            0 => {}
            1 => self.go_to(parent, expected),
            _ => self.joined = Some((parent, expected)),
        }
        let exhausted = self.joined.is_none() && self.places().next().is_none();
        self.ended = exhausted || self.age > MOST_AGE || self.generation > MOST_GENERATIONS;
    }

    /// Takes a new parent. What is known along a line holds for the new other components, too, but for
    /// a constant.
    fn go_to(&mut self, parent: Vec<f64>, cost: f64) {
        self.lines.iter_mut().for_each(|line| line.shift_to(cost));
        if cost < self.cost {
            self.age = 0;
        }
        (self.parent, self.cost) = (parent, cost);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn all_components_reach_the_lowest_of_their_minima() {
        let best = [0.13, 0.5, 0.86, 0.999];
        let cost = |x: &[f64]| -> f64 {
            let dent = |d: f64| 1.0 + 30.0 * d * d - (80.0 * d).cos();
            x.iter().zip(best).map(|(x, best)| dent(x - best)).sum()
        };
        let start = vec![0.5; 4];
        let mut search = ComponentSearch::new(start.clone(), cost(&start));
        let (mut points, mut evaluations) = (Vec::new(), 0);
        while !search.ended() {
            points.clear();
            search.ask(&mut points);
            let costs: Vec<f64> = points.chunks(4).map(cost).collect();
            evaluations += costs.len();
            search.tell(&costs, f64::EPSILON);
        }
        for (x, best) in search.parent().iter().zip(best) {
            assert!((x - best).abs() < 1e-5, "{x} {best}");
        }
        assert!(evaluations < 2_000, "{evaluations}");
    }
}
