//! Pre-sliding: the contact is a spring up to the friction level, then it slides.

mod bristle;
mod free;
mod maxwell;

use super::{
    About, Apart, Balance, Before, Begin, Correction, Effect, Element, Onset, Parameter,
    Parameters, Response, Slot, Step,
};
use crate::axis::Quantity;
use crate::effects::CDynamics;
use crate::effects::c_dynamics::LIMITED;
use crate::simd::{limited, vectorised};

/// `clip(k_t z, +-level)`: linear elastic, ideally plastic (Jenkins element).
///
/// The first state is the contact force itself, so that the level may change while the contact is
/// loaded; the second is 1 while it slides.
#[derive(Clone, Copy, Debug)]
pub struct Presliding {
    breakaway: Breakaway,
}

/// Up to which level the contact holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Breakaway {
    /// The level at the velocity of the mass: the force is continuous.
    Kinetic,
    /// The level at rest; the force falls when the contact breaks.
    Static,
}

/// The default form.
pub static PRESLIDING: Presliding = Presliding { breakaway: Breakaway::Kinetic };
static STATIC: Presliding = Presliding { breakaway: Breakaway::Static };
static FORMS: [&dyn Effect; 5] =
    [&STATIC, &bristle::DAHL, &bristle::LUGRE, &maxwell::MaxwellSlip, &free::Free];

const STIFFNESS: Parameter = Parameter::shape(
    "k_t",
    "tangential stiffness of the contact",
    Quantity::Stiffness,
    (1.0, 1e9),
    5e6,
);
const SHOWS: &str =
    "residual against displacement since the last reversal, the same at every speed";

static ABOUT: About = About {
    name: "presliding",
    title: "pre-sliding displacement",
    equation: "k_t z instead of level s, |k_t z| <= level, z' = v below",
    parameters: &[STIFFNESS],
    slots: &[Slot::Contact],
    shows: SHOWS,
    reference: "P. R. Dahl, AIAA J. 14, 1976; K. L. Johnson, Contact Mechanics, 1987",
};
static STATIC_ABOUT: About = About {
    name: "presliding:static",
    title: "pre-sliding displacement, breaking at the level at rest",
    equation: "k_t z up to level(v = 0), then level(v) s until the motion reverses",
    parameters: &[STIFFNESS],
    slots: &[Slot::Contact],
    shows: SHOWS,
    reference: "B. Armstrong-Helouvry et al., Automatica 30, 1994 (seven-parameter model)",
};

/// The free curve breaks away about as far as a contact of this stiffness does.
fn as_far(before: &Before<'_>) -> Begin {
    match (before.value)("k_t") {
        Some(stiffness) => Begin::at([("d", 1.5 * before.level.unwrap_or(1.0) / stiffness)]),
        None => Begin::default(),
    }
}

/// Helper functions in C.
const CONTACT_IN_C: &str = include_str!("../export/c/contact.c");

/// An elastic contact that holds up to `$hold` (`level` or `breakaway`).
macro_rules! contact {
    ($hold:literal, $solve:literal, $breakaway:literal) => {
        CDynamics {
            states: 2,
            helpers: &[LIMITED, CONTACT_IN_C],
            load: "{s0} = level * used;\n{s1} = fabs(used) < 1.0 ? 0.0 : 1.0;",
            respond: concat!(
                "{
    const double hold = m->",
                $hold,
                ", moved = m->displacement;
    const double start = contact_at_start({s0}, {s1}, m->level, hold), trial = start + {k_t} * moved;
    int breaks;
    const double end = contact_at_end(start, trial, {s1}, m->level, hold, &breaks);
    m->elements += contact_mean(start, trial, end, breaks, {s1}, m->level, hold);
    m->stiffness += breaks && moved != 0.0 ? 0.0 : 0.5 * {k_t};
}"
            ),
            commit: concat!(
                "{
    const double hold = m->",
                $hold,
                ";
    const double start = contact_at_start({s0}, {s1}, m->level, hold), trial = start + {k_t} * m->displacement;
    int breaks;
    {s0} = contact_at_end(start, trial, {s1}, m->level, hold, &breaks);
    {s1} = breaks ? 1.0 : 0.0;
}"
            ),
            solve: $solve,
            sliding: "{s1}",
            iterations: 1,
            breakaway: $breakaway,
            ..CDynamics::NONE
        }
    };
}

impl Effect for Presliding {
    fn about(&self) -> &'static About {
        match self.breakaway {
            Breakaway::Kinetic => &ABOUT,
            Breakaway::Static => &STATIC_ABOUT,
        }
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(match self.breakaway {
            Breakaway::Kinetic => contact!(
            "level",
            "{
    const double r = m->left, level = m->level, start = limited({s0}, level);
    const double bend = {k_t} * r, free = m->push - r * start, whole = m->inertia + 0.5 * bend * r;
    const double trial = start * whole + bend * free;
    const int breaks = fabs(trial) > level * whole;
    const double slid = copysign(level, trial);
    m->mean = breaks ? (m->push - 0.5 * r * (start + slid)) / m->inertia : free / whole;
    {s0} = breaks ? slid : start + bend * m->mean;
    {s1} = breaks ? 1.0 : 0.0;
}",
            false
        ),
            Breakaway::Static => contact!(
            "breakaway",
            "{
    const double r = m->left, level = m->level, hold = m->breakaway;
    const double start = contact_at_start({s0}, {s1}, level, hold), bend = {k_t} * r;
    const double elastic = (m->push - r * start) / (m->inertia + 0.5 * bend * r), trial = start + bend * elastic;
    int breaks;
    const double end = contact_at_end(start, trial, {s1}, level, hold, &breaks);
    const double broken = contact_mean(start, trial, end, breaks, {s1}, level, hold);
    m->mean = breaks ? (m->push - r * broken) / m->inertia : elastic;
    {s0} = end;
    {s1} = breaks ? 1.0 : 0.0;
}",
            true
        ),
        })
    }

    fn gives(&self, values: &[f64], level: f64) -> Option<f64> {
        Some(level / values[0])
    }

    fn flexible_form(&self) -> Option<&'static str> {
        Some("presliding:free")
    }

    fn begins_flexible(&self, before: &Before<'_>) -> Begin {
        as_far(before)
    }

    fn told_apart(&self) -> &'static [Apart] {
        if self.breakaway != Breakaway::Kinetic {
            return &[];
        }
        &[Apart {
            from: &["backlash", "flexible-coupling"],
            experiment: "reverse with high acceleration: only with backlash does the motor's inertia run free",
        }]
    }

    fn forms(&self) -> &'static [&'static dyn Effect] {
        match self.breakaway {
            Breakaway::Kinetic => &FORMS,
            Breakaway::Static => &[],
        }
    }

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }
}

impl Presliding {
    /// The level up to which the contact holds.
    fn hold<'a>(self, level: &'a [f64], breakaway: &'a [f64]) -> &'a [f64] {
        match self.breakaway {
            Breakaway::Kinetic => level,
            Breakaway::Static => breakaway,
        }
    }
}

impl Element for Presliding {
    fn states(&self) -> usize {
        2
    }

    fn start(&self, _p: &[f64], at: &Onset, state: &mut [f64]) {
        state[0] = at.level * at.used;
        state[1] = if at.used.abs() < 1.0 { 0.0 } else { 1.0 };
    }

    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>) {
        let hold = self.hold(step.level, step.breakaway);
        let (held, slides) = state.split_at(step.level.len());
        let (force, slope) = (&mut *out.force, &mut *out.stiffness);
        respond(p.get(0), step.displacement, step.level, hold, held, slides, force, slope);
    }

    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]) {
        let hold = self.hold(step.level, step.breakaway);
        let (held, slides) = state.split_at_mut(step.level.len());
        commit(p.get(0), step.displacement, step.level, hold, held, slides);
    }

    fn iterations(&self) -> usize {
        // The response is piecewise linear: the elastic trial is exact if it holds, else the
        // sliding step is.
        1
    }

    fn solve(
        &self,
        p: Parameters<'_>,
        b: &Balance<'_>,
        state: &mut [f64],
        velocity: &mut [f64],
    ) -> bool {
        let (held, slides) = state.split_at_mut(b.level.len());
        let (stiffness, r, inertia, push) = (p.get(0), b.duration, b.inertia, b.push);
        match self.breakaway {
            Breakaway::Kinetic => {
                solve(stiffness, r, inertia, push, b.level, held, slides, velocity);
            }
            Breakaway::Static => {
                let hold = b.breakaway;
                solve_static(stiffness, r, inertia, push, b.level, hold, held, slides, velocity);
            }
        }
        true
    }

    /// What slides goes on sliding; what holds is bent, up to what it can hold.
    fn correct(&self, p: Parameters<'_>, c: &Correction<'_>, state: &mut [f64]) {
        let hold = self.hold(c.level, c.breakaway);
        let (held, slides) = state.split_at_mut(c.level.len());
        correct(p.get(0), c.displacement, hold, slides, held);
    }

    fn needs_breakaway(&self) -> bool {
        self.breakaway == Breakaway::Static
    }

    fn force(&self, _p: &[f64], state: &[f64]) -> Option<f64> {
        Some(state[0])
    }

    fn sliding(&self, _p: Parameters<'_>, level: &[f64], state: &[f64], sliding: &mut [f64]) {
        sliding.copy_from_slice(&state[level.len()..]);
    }
}

/// What the contact holds at the start: a level that fell takes a loaded contact down with it.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn at_start(held: f64, slides: f64, level: f64, hold: f64) -> f64 {
    let cap = if slides > 0.0 { level } else { hold.max(level) };
    limited(held, cap)
}

/// Mean force over a step from `start` to `end`. Where the contact falls from what it holds to the
/// level, the fall has its place in time: taken for the whole step it would cost an order of accuracy.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn mean(start: f64, trial: f64, end: f64, breaks: bool, slides: f64, level: f64, hold: f64) -> f64 {
    let goes_on = slides > 0.0 && trial * start >= start * start;
    let falls = breaks && !goes_on && hold > level;
    // Share of the step until then; the trial grows evenly with time.
    let top = hold.copysign(trial);
    let until = limited((top - start) / (trial - start), 1.0).max(0.0);
    let fallen = until * 0.5 * (start + top) + (1.0 - until) * end;
    if falls { fallen } else { 0.5 * (start + end) }
}

/// Contact force at the end of a step that is elastic at first, and whether it slides then.
#[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
#[inline(always)]
fn at_end(start: f64, trial: f64, slides: f64, level: f64, hold: f64) -> (f64, bool) {
    // Once it slides it goes on sliding until the force turns back.
    let goes_on = slides > 0.0 && trial * start >= start * start;
    let cap = if goes_on { level } else { hold.max(level) };
    let breaks = trial.abs() > cap;
    (if breaks { level.copysign(trial) } else { trial }, breaks || goes_on && trial.abs() >= level)
}

vectorised! {
    fn respond(
        stiffness: &[f64],
        moved: &[f64],
        level: &[f64],
        hold: &[f64],
        held: &[f64],
        slides: &[f64],
        force: &mut [f64],
        slope: &mut [f64],
    ) {
        let n = force.len();
        let (stiffness, moved, level) = (&stiffness[..n], &moved[..n], &level[..n]);
        let (hold, held, slides) = (&hold[..n], &held[..n], &slides[..n]);
        let slope = &mut slope[..n];
        for i in 0..n {
            let start = at_start(held[i], slides[i], level[i], hold[i]);
            let trial = start + stiffness[i] * moved[i];
            let (end, breaks) = at_end(start, trial, slides[i], level[i], hold[i]);
            force[i] += mean(start, trial, end, breaks, slides[i], level[i], hold[i]);
            slope[i] += if breaks && moved[i] != 0.0 { 0.0 } else { 0.5 * stiffness[i] };
        }
    }

    fn commit(
        stiffness: &[f64],
        moved: &[f64],
        level: &[f64],
        hold: &[f64],
        held: &mut [f64],
        slides: &mut [f64],
    ) {
        let n = held.len();
        let (stiffness, moved, level) = (&stiffness[..n], &moved[..n], &level[..n]);
        let (hold, slides) = (&hold[..n], &mut slides[..n]);
        for i in 0..n {
            let start = at_start(held[i], slides[i], level[i], hold[i]);
            let trial = start + stiffness[i] * moved[i];
            let (end, breaks) = at_end(start, trial, slides[i], level[i], hold[i]);
            held[i] = end;
            slides[i] = if breaks { 1.0 } else { 0.0 };
        }
    }

    fn correct(
        stiffness: &[f64],
        moved: &[f64],
        hold: &[f64],
        slides: &[f64],
        held: &mut [f64],
    ) {
        let n = held.len();
        let (stiffness, moved) = (&stiffness[..n], &moved[..n]);
        let (hold, slides) = (&hold[..n], &slides[..n]);
        for i in 0..n {
            let bent = limited(held[i] + stiffness[i] * moved[i], hold[i]);
            let holds = slides[i] == 0.0 && held[i].abs() < hold[i];
            held[i] = if holds { bent } else { held[i] };
        }
    }

    fn solve(
        stiffness: &[f64],
        duration: &[f64],
        inertia: &[f64],
        push: &[f64],
        level: &[f64],
        held: &mut [f64],
        slides: &mut [f64],
        velocity: &mut [f64],
    ) {
        let n = held.len();
        let (stiffness, duration, inertia) = (&stiffness[..n], &duration[..n], &inertia[..n]);
        let (push, level) = (&push[..n], &level[..n]);
        let (slides, velocity) = (&mut slides[..n], &mut velocity[..n]);
        for i in 0..n {
            let r = duration[i];
            let start = limited(held[i], level[i]);
            let bend = stiffness[i] * r;
            // The elastic trial, all times its inertia: one division serves both outcomes.
            let (free, whole) = (push[i] - r * start, inertia[i] + 0.5 * bend * r);
            let trial = start * whole + bend * free;
            let breaks = trial.abs() > level[i] * whole;
            let slid = level[i].copysign(trial);
            let sliding = push[i] - 0.5 * r * (start + slid);
            let mean = if breaks { sliding } else { free } / if breaks { inertia[i] } else { whole };
            held[i] = if breaks { slid } else { start + bend * mean };
            slides[i] = if breaks { 1.0 } else { 0.0 };
            velocity[i] = mean;
        }
    }

    fn solve_static(
        stiffness: &[f64],
        duration: &[f64],
        inertia: &[f64],
        push: &[f64],
        level: &[f64],
        hold: &[f64],
        held: &mut [f64],
        slides: &mut [f64],
        velocity: &mut [f64],
    ) {
        let n = held.len();
        let (stiffness, duration, inertia) = (&stiffness[..n], &duration[..n], &inertia[..n]);
        let (push, level, hold) = (&push[..n], &level[..n], &hold[..n]);
        let (slides, velocity) = (&mut slides[..n], &mut velocity[..n]);
        for i in 0..n {
            let r = duration[i];
            let start = at_start(held[i], slides[i], level[i], hold[i]);
            let bend = stiffness[i] * r;
            let (free, whole) = (push[i] - r * start, inertia[i] + 0.5 * bend * r);
            let elastic = free / whole;
            let trial = start + bend * elastic;
            let (end, breaks) = at_end(start, trial, slides[i], level[i], hold[i]);
            let broken = mean(start, trial, end, breaks, slides[i], level[i], hold[i]);
            let sliding = (push[i] - r * broken) / inertia[i];
            held[i] = end;
            slides[i] = if breaks { 1.0 } else { 0.0 };
            velocity[i] = if breaks { sliding } else { elastic };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::super::element::Leg;
    use super::*;

    /// Mean force of a contact and its slope over a step of 1 ms by `moved`, at a level of 5.
    pub(super) fn mean(contact: &dyn Element, p: &[f64], state: &[f64], moved: f64) -> (f64, f64) {
        let (duration, displacement, level) = ([1e-3], [moved], [5.0]);
        let step = Step {
            duration: &duration,
            open: &duration,
            displacement: &displacement,
            level: &level,
            breakaway: &level,
        };
        let (mut force, mut stiffness) = ([0.0], [0.0]);
        let mut out = Response { force: &mut force, stiffness: &mut stiffness };
        contact.respond(Parameters::new(p, 1), &step, state, &mut out);
        (force[0], stiffness[0])
    }

    /// Contact force along a path of displacements, from rest.
    pub(super) fn walk(contact: &dyn Element, p: &[f64], path: &[f64], level: f64) -> Vec<f64> {
        walk_to(contact, p, path, level, level)
    }

    fn walk_to(
        contact: &dyn Element,
        p: &[f64],
        path: &[f64],
        level: f64,
        breakaway: f64,
    ) -> Vec<f64> {
        let mut state = vec![0.0; contact.states()];
        contact.start(p, &Onset { level, used: 0.0, velocity: 0.0 }, &mut state);
        let leg = |moved: &f64| Leg { duration: 1e-3, displacement: *moved, level, breakaway };
        let legs: Vec<Leg> = path.iter().map(leg).collect();
        let mut force = vec![0.0; path.len()];
        contact.along(p, &legs, &mut state, &mut force);
        force
    }

    #[test]
    fn it_is_a_spring_up_to_the_level_and_slides_beyond() {
        let force = walk(&PRESLIDING, &[2e6], &[1e-6, 1e-6, 1e-6, -1e-6], 5.0);
        assert_eq!(force, [2.0, 4.0, 5.0, 3.0]);
    }

    #[test]
    fn the_static_form_holds_up_to_the_level_at_rest_and_falls_to_the_level_of_sliding() {
        let path = [1e-6, 1e-6, 1e-6, 1e-6, 1e-6, 1e-6, -1e-6, 1e-6];
        let force = walk_to(&STATIC, &[2e6], &path, 5.0, 9.0);
        assert_eq!(force, [2.0, 4.0, 6.0, 8.0, 5.0, 5.0, 3.0, 5.0]);
    }

    #[test]
    fn the_loop_of_a_full_reversal_encloses_the_work_of_sliding() {
        // Amplitude A: the area is 4 F (A - F / k).
        let (level, stiffness, amplitude, steps) = (5.0, 2e6, 10e-6, 10_000);
        let step = 2.0 * amplitude / f64::from(steps);
        let mut path = vec![step; steps as usize];
        path.extend(vec![-step; steps as usize]);
        let twice: Vec<f64> = path.iter().chain(&path).copied().collect();
        let force = walk(&PRESLIDING, &[stiffness], &twice, level);
        let area: f64 =
            force.iter().zip(&twice).skip(path.len()).map(|(force, moved)| force * moved).sum();
        let exact = 4.0 * level * (amplitude - level / stiffness);
        assert!((area / exact - 1.0).abs() < 1e-3, "{area} against {exact}");
    }

    #[test]
    fn the_closed_form_solves_the_balance_that_the_response_states() {
        for contact in [&PRESLIDING, &STATIC] {
            for (k, push) in [-40.0, -3.0, -0.1, 0.0, 0.02, 1.0, 7.0, 300.0].into_iter().enumerate()
            {
                let (held, slides) = ([4.0, -4.0, 5.0][k % 3], [0.0, 0.0, 1.0][k % 3]);
                let (inertia, r, level, breakaway) = (60.0, 1e-3, 5.0, 7.0);
                let (mut state, mut velocity) = ([held, slides], [0.0]);
                let balance = Balance {
                    duration: &[r],
                    inertia: &[inertia],
                    push: &[push * r],
                    level: &[level],
                    breakaway: &[breakaway],
                };
                let stiffness = [2e6];
                let p = Parameters::new(&stiffness, 1);
                assert!(contact.solve(p, &balance, &mut state, &mut velocity));
                let step = Step {
                    duration: &[r],
                    open: &[r],
                    displacement: &[r * velocity[0]],
                    level: &[level],
                    breakaway: &[breakaway],
                };
                let (mut force, mut stiffness) = ([0.0], [0.0]);
                let mut out = Response { force: &mut force, stiffness: &mut stiffness };
                contact.respond(p, &step, &[held, slides], &mut out);
                let left = inertia * velocity[0] + r * force[0] - push * r;
                // The static form's response jumps where the contact breaks.
                assert!(left.abs() < 1e-12 || contact.needs_breakaway(), "{push}: {left}");
            }
        }
    }
}
