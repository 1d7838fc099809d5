//! Pre-sliding: the contact is a spring up to the friction level, then it slides.

use super::{About, Effect, Element, Parameter, Parameters, Response, Slot, Step};
use crate::axis::Quantity;

/// `clip(k_t z, +-level)`: linear elastic, ideally plastic (Jenkins element).
///
/// The state is the contact force itself, so that the level may change while the contact is loaded.
#[derive(Clone, Copy, Debug)]
pub struct Presliding;

static ABOUT: About = About {
    name: "presliding",
    title: "pre-sliding displacement",
    equation: "k_t z instead of level s, |k_t z| <= level, z' = v below",
    parameters: &[Parameter::shape(
        "k_t",
        "tangential stiffness of the contact",
        Quantity::Stiffness,
        (1e4, 1e9),
        5e6,
    )],
    slots: &[Slot::Contact],
    shows: "residual against displacement since the last reversal, the same at every speed",
    reference: "P. R. Dahl, AIAA J. 14, 1976; K. L. Johnson, Contact Mechanics, 1987",
};

impl Effect for Presliding {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }
}

impl Element for Presliding {
    fn states(&self) -> usize {
        1
    }

    fn start(&self, _p: &[f64], level: f64, direction: f64, state: &mut [f64]) {
        state[0] = level * direction;
    }

    fn force(&self, _p: Parameters<'_>, step: &Step<'_>, state: &[f64], force: &mut [f64]) {
        // A level that fell since the last step takes the loaded contact down with it.
        for ((force, state), level) in force.iter_mut().zip(state).zip(step.level) {
            *force += state.max(-level).min(*level);
        }
    }

    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>) {
        let lanes = out.force.len();
        let (stiffness, state) = (&p.get(0)[..lanes], &state[..lanes]);
        let (moved, level) = (&step.displacement[..lanes], &step.level[..lanes]);
        let (force, slope) = (&mut out.force[..lanes], &mut out.stiffness[..lanes]);
        for i in 0..lanes {
            let held = state[i].max(-level[i]).min(level[i]);
            let trial = held + stiffness[i] * moved[i];
            let inside = trial.abs() <= level[i];
            force[i] += trial.max(-level[i]).min(level[i]);
            slope[i] += if inside { stiffness[i] } else { 0.0 };
        }
    }

    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]) {
        let lanes = state.len();
        let stiffness = &p.get(0)[..lanes];
        let (moved, level) = (&step.displacement[..lanes], &step.level[..lanes]);
        for i in 0..lanes {
            let held = state[i].max(-level[i]).min(level[i]);
            state[i] = (held + stiffness[i] * moved[i]).max(-level[i]).min(level[i]);
        }
    }

    fn iterations(&self) -> usize {
        // The response is piecewise linear with one kink on either side: the elastic trial is
        // exact if it stays inside, else the sliding step is.
        2
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Contact force along a path of displacements.
    fn walk(path: &[f64], level: f64, stiffness: f64) -> Vec<f64> {
        let (mut state, p) = ([0.0], [stiffness]);
        let p = Parameters::new(&p, 1);
        path.iter()
            .map(|moved| {
                let step = Step { duration: &[1e-3], displacement: &[*moved], level: &[level] };
                Presliding.commit(p, &step, &mut state);
                state[0]
            })
            .collect()
    }

    #[test]
    fn it_is_a_spring_up_to_the_level_and_slides_beyond() {
        let force = walk(&[1e-6, 1e-6, 1e-6, -1e-6], 5.0, 2e6);
        assert_eq!(force, [2.0, 4.0, 5.0, 3.0]);
    }

    #[test]
    fn the_loop_of_a_full_reversal_encloses_the_work_of_sliding() {
        // Amplitude A: the area is 4 F (A - F / k).
        let (level, stiffness, amplitude, steps) = (5.0, 2e6, 10e-6, 10_000);
        let step = 2.0 * amplitude / f64::from(steps);
        let mut path = vec![step; steps as usize];
        path.extend(vec![-step; steps as usize]);
        let twice: Vec<f64> = path.iter().chain(&path).copied().collect();
        let force = walk(&twice, level, stiffness);
        let area: f64 =
            force.iter().zip(&twice).skip(path.len()).map(|(force, moved)| force * moved).sum();
        let exact = 4.0 * level * (amplitude - level / stiffness);
        assert!((area / exact - 1.0).abs() < 1e-3, "{area} against {exact}");
    }
}
