//! Elements: what answers a displacement of the mass with a force and has a state of its own.

use super::Parameters;

/// Utilisation of a contact from which it counts as sliding: some contacts only approach 1.
const BROKEN: f64 = 0.999;

/// Something with a state of its own that answers a displacement of the mass with a force: the
/// elastic friction contact, a second body behind a coupling.
///
/// The force must not decrease with the displacement in the step: then the implicit step has exactly
/// one solution.
pub trait Element: Sync + Send {
    /// State variables per lane; `state[k * lanes + i]` is variable `k` in lane `i`.
    fn states(&self) -> usize;

    /// State of one lane; `p` are the lane's parameters.
    fn start(&self, p: &[f64], at: &Onset, state: &mut [f64]);

    /// Mean resisting force over the step, and its slope against the displacement.
    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>);

    /// Takes the step: the state at its end.
    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]);

    /// Newton iterations of the implicit step after a first solution.
    fn iterations(&self) -> usize;

    /// For elements with the encoder on their own body: replaces positions of the mass, one per lane, by what is
    /// measured. Returns whether it does so.
    fn shown(&self, _p: Parameters<'_>, _state: &[f64], _position: &mut [f64]) -> bool {
        false
    }

    /// The same of velocities.
    fn shown_velocity(&self, _p: Parameters<'_>, _state: &[f64], _velocity: &mut [f64]) -> bool {
        false
    }

    /// Solves `inertia u + r f(r u) = push` for the mean velocity `u` and takes the step, where it
    /// is the only element and can do so in closed form. Returns whether it did.
    fn solve(
        &self,
        _p: Parameters<'_>,
        _balance: &Balance<'_>,
        _state: &mut [f64],
        _velocity: &mut [f64],
    ) -> bool {
        false
    }

    /// Whether the contact holds up to the level at rest and falls to the level of sliding when it
    /// breaks: then [`Step::breakaway`] is filled in.
    fn needs_breakaway(&self) -> bool {
        false
    }

    /// Force on the mass in a state, for elements whose force is part of their state; `p` and
    /// `state` are those of one lane.
    fn force(&self, _p: &[f64], _state: &[f64]) -> Option<f64> {
        None
    }

    /// Writes 1 where a contact slides in its state, 0 where it holds, at the friction `level`.
    fn sliding(&self, p: Parameters<'_>, level: &[f64], state: &[f64], sliding: &mut [f64]) {
        let lanes = level.len();
        let mut lane = vec![0.0; self.states()];
        let mut values = vec![0.0; p.parameters()];
        for (i, sliding) in sliding.iter_mut().enumerate() {
            lane.iter_mut().enumerate().for_each(|(k, slot)| *slot = state[k * lanes + i]);
            values.iter_mut().enumerate().for_each(|(k, slot)| *slot = p.get(k)[i]);
            let force = self.force(&values, &lane).unwrap_or(0.0);
            *sliding = f64::from(u8::from(force.abs() >= BROKEN * level[i]));
        }
    }

    /// Follows an observer that moves the estimate of the mass: what hangs on the mass moves with it, and
    /// what touches the ground is bent where it holds. Nothing slides for it: corrections of alternating
    /// sign must not ratchet a contact.
    fn correct(&self, _p: Parameters<'_>, _c: &Correction<'_>, _state: &mut [f64]) {}

    /// Force at every sample of a measured path: the state's force where there is one, else the mean
    /// of the steps before and after.
    fn along(&self, p: &[f64], path: &[Leg], state: &mut [f64], force: &mut [f64]) {
        let values = p;
        let p = Parameters::new(p, 1);
        let mut means = vec![0.0; path.len()];
        for (k, leg) in path.iter().enumerate() {
            let (duration, displacement) = ([leg.duration], [leg.displacement]);
            let (level, breakaway) = ([leg.level], [leg.breakaway]);
            let step = Step {
                duration: &duration,
                open: &duration,
                displacement: &displacement,
                level: &level,
                breakaway: &breakaway,
            };
            let (mut mean, mut stiffness) = ([0.0], [0.0]);
            let mut out = Response { force: &mut mean, stiffness: &mut stiffness };
            if leg.duration > 0.0 {
                self.respond(p, &step, state, &mut out);
                self.commit(p, &step, state);
            }
            means[k] = mean[0];
            force[k] = self.force(values, state).unwrap_or(f64::NAN);
        }
        if self.force(values, state).is_none() {
            let last = path.len().saturating_sub(1);
            for (k, force) in force.iter_mut().enumerate() {
                *force = 0.5 * (means[k.clamp(1.min(last), last)] + means[(k + 1).min(last)]);
            }
        }
    }
}

/// How a lane begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Onset {
    /// Friction level there, N or N m.
    pub level: f64,
    /// Utilisation of the contact, -1..1.
    pub used: f64,
    /// Velocity of the mass, m/s or rad/s.
    pub velocity: f64,
}

/// One step of a measured path.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// s; 0 at the first sample.
    pub duration: f64,
    /// m or rad.
    pub displacement: f64,
    /// Friction level, N or N m.
    pub level: f64,
    /// Friction level at rest, N or N m.
    pub breakaway: f64,
}

/// A step of the mass as an [`Element`] sees it.
#[derive(Clone, Copy, Debug)]
pub struct Step<'a> {
    /// Length of the step, s.
    pub duration: &'a [f64],
    /// Above 0 for plants whose answer is asked; that of others may be left out.
    pub open: &'a [f64],
    /// Displacement of the mass in the step, m or rad.
    pub displacement: &'a [f64],
    /// Friction level in the step, N or N m.
    pub level: &'a [f64],
    /// Friction level at rest, N or N m, for elements that ask for it.
    pub breakaway: &'a [f64],
}

/// A correction of the estimated motion of the mass, see [`Element::correct`].
#[derive(Clone, Copy, Debug)]
pub struct Correction<'a> {
    /// Added to the position, m or rad.
    pub displacement: &'a [f64],
    /// Added to the velocity, m/s or rad/s.
    pub velocity: &'a [f64],
    /// Friction level of the last step, N or N m.
    pub level: &'a [f64],
    /// Friction level at rest, N or N m, for elements that ask for it.
    pub breakaway: &'a [f64],
}

/// What an [`Element`] answers.
#[derive(Debug)]
pub struct Response<'a> {
    /// To be added to: mean force over the step, N or N m.
    pub force: &'a mut [f64],
    /// To be added to: slope of `force` against the displacement, at least 0.
    pub stiffness: &'a mut [f64],
}

/// The momentum balance of a step, see [`Element::solve`].
#[derive(Clone, Copy, Debug)]
pub struct Balance<'a> {
    /// Length `r` of the step, s.
    pub duration: &'a [f64],
    /// Twice the mass and the damping times `r`.
    pub inertia: &'a [f64],
    /// Twice the momentum at the start and the impulse of all other forces.
    pub push: &'a [f64],
    /// Friction level, N or N m.
    pub level: &'a [f64],
    /// Friction level at rest, for elements that ask for it.
    pub breakaway: &'a [f64],
}
