//! Two masses and a gap between them: the impact at its ends is part of the law.

use std::ops::Range;

use super::super::load::{Connection, Load, Pull};
use super::{About, AsFound, Effect, Parameter, Parameters, Refused, Slot, WIDTH, closed};
use crate::axis::Quantity;
use crate::effects::CDynamics;
use crate::effects::c_dynamics::LOAD as LOAD_IN_C;
use crate::effects::{Along, Correction, Element, Onset, Response, SecondBody, Step};
use crate::simd::{STRETCH, open_stretches, sign, vectorised};

/// A second mass `m_L` with friction of its own that the mass meets at either end of a gap `b`, over a
/// spring and a damper in parallel that push but never pull.
#[derive(Clone, Copy, Debug)]
pub struct TwoMass;

/// Share of the gap next to each end within which an observer takes it for closed.
const NEAR_END: f64 = 0.05;
/// Least viscous friction of the load against stiffness and step.
const NOTHING: f64 = 1e-14;

static ABOUT: About = About {
    name: "backlash:two-mass",
    title: "load behind a gap",
    equation: "m_L x_L'' = N - F_L sgn x_L' - d_L x_L', N acts back on the mass; N = k p + d p' >= 0 for p = x - x_L - b/2 > 0, mirrored at the other end, d = 2 zeta sqrt(k m_L)",
    parameters: &[
        Parameter::level("m_L", "mass behind the gap", Quantity::Mass, 1e3, 10.0),
        Parameter::level("F_L", "Coulomb friction of the load", Quantity::Force, 200.0, 4.0),
        Parameter::level("d_L", "viscous friction of the load", Quantity::Damping, 1e4, 20.0),
        WIDTH,
        Parameter::shape(
            "k",
            "stiffness of the contact at its ends",
            Quantity::Stiffness,
            (1.0, 1e9),
            5e6,
        ),
        Parameter::shape("zeta", "damping ratio of the contact", Quantity::One, (1e-3, 2.0), 0.1),
    ],
    slots: &[Slot::Attached],
    shows: "after a reversal the load is missing over the distance b, then an impact",
    reference: "M. Nordin, P.-O. Gutman, Automatica 38, 2002; K. H. Hunt, F. R. E. Crossley, J. Appl. Mech. 42, 1975",
};

static SECOND_BODY: SecondBody = SecondBody {
    along: Along::Gap { count: 16, deviations: 4.0, share: 0.01 },
    damping: 0.1,
    shares: &[0.35, 0.55, 0.75],
    factors: &[0.75, 0.9, 1.0, 1.12, 1.35],
    related: Some("flexible-coupling:friction"),
};

/// Helper functions in C.
const GAPPED_IN_C: &str = include_str!("../../export/c/gapped.c");

impl Effect for TwoMass {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn whatever(&self) -> &'static [&'static str] {
        &["k", "zeta"]
    }

    fn c_dynamics(&self) -> Option<CDynamics> {
        Some(CDynamics {
            states: 2,
            helpers: &[LOAD_IN_C, GAPPED_IN_C],
            load: "{s0} = -0.5 * {b} * sign(velocity) - ({F_L} * sign(velocity) + {d_L} * velocity) / {k};\n{s1} = velocity;",
            respond: "{
    const double p[6] = {{m_L}, {F_L}, {d_L}, {b}, {k}, {zeta}};
    double slope, mean;
    m->elements += gapped(p, m->left, m->displacement, {s0}, {s1}, &slope, &mean);
    m->stiffness += slope;
}",
            commit: "{
    const double p[6] = {{m_L}, {F_L}, {d_L}, {b}, {k}, {zeta}};
    double slope, mean;
    gapped(p, m->taken, m->displacement, {s0}, {s1}, &slope, &mean);
    {s0} += m->taken > 0.0 ? m->taken * mean - m->displacement : 0.0;
    {s1} = 2.0 * mean - {s1};
}",
            iterations: 4,
            attached: true,
            ..CDynamics::NONE
        })
    }

    fn second_body(&self) -> Option<&'static SecondBody> {
        Some(&SECOND_BODY)
    }

    fn element(&self) -> Option<&dyn Element> {
        Some(self)
    }

    fn refused(&self, found: &AsFound<'_>) -> Option<Refused> {
        let (load, gap, stiffness) = (found.values[0], found.values[3], found.values[4]);
        closed(found, 3).or_else(|| {
            // Either side of the middle has half of the gap. What presses the contact moves the load against its friction.
            let moves = (found.force * load / (load + found.mass)).max(found.values[1]);
            let gives = moves / stiffness;
            (gives > 0.5 * gap).then_some(Refused {
                name: "give of the contact",
                value: gives,
                limit: 0.5 * gap,
                unit_of: "b",
                meaning: "the contact gives more than its gap is wide",
            })
        })
    }
}

/// Both ends of the gap over a step. At each the mean force along an even motion is exact, whenever in the
/// step it opens or closes: that of the spring is its change of energy over the distance, so that the spring
/// gives back what it took and no more.
struct Gap {
    /// Side of the middle on which the step starts; the others are seen from there.
    side: f64,
    /// Way to that end of the gap, and how far it is pressed instead: one of them is 0.
    open: f64,
    pressed: f64,
    /// Way to the other end.
    behind: f64,
    stiffness: f64,
    /// Damping over the length of the step.
    damping: f64,
}

/// Where a gap goes in a step, seen from the side where it starts.
struct Course {
    /// What holds the mass while its end is closed, against how far it runs ahead.
    all: f64,
    /// How far the mass runs ahead where nothing holds it, and where it stays as it starts.
    free: f64,
    straight: f64,
    /// How far its end is pressed for what comes at the other one.
    still: f64,
    /// Whether it comes to its end, leaves it, comes to the other one.
    closes: bool,
    opens: bool,
    crosses: bool,
}

impl Gap {
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn new(place: f64, half: f64, stiffness: f64, damping: f64) -> Self {
        let side = if place < 0.0 { -1.0 } else { 1.0 };
        let place = place * side;
        let (open, pressed) = ((half - place).max(0.0), (place - half).max(0.0));
        Self { side, open, pressed, behind: place + half, stiffness, damping }
    }

    /// Work of the end where it starts, once it has left it by `way`.
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn let_go(&self, way: f64) -> f64 {
        let spring = 0.5 * self.stiffness * self.pressed * self.pressed;
        (spring - self.damping * self.pressed * way).max(0.0)
    }

    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn course(&self, inertia: f64, total: f64) -> Course {
        let Self { side, open, pressed, behind, stiffness, damping } = *self;
        let total = total * side;
        let all = 0.5 * stiffness + damping + inertia;
        // One division for the two of them.
        let shared = 1.0 / (all * inertia);
        let free = total * all * shared;
        let line = (total - stiffness * pressed) * inertia * shared;
        let let_go = self.let_go(behind);
        let crosses = total * behind < let_go - inertia * behind * behind;
        let opens = pressed > 0.0 && line < -pressed && !crosses;
        let still = if let_go > 0.0 { pressed } else { 0.0 };
        let closes = pressed <= 0.0 && free > open && !crosses;
        let straight = if pressed > 0.0 { line.min(free) } else { free };
        Course { all, free, straight, still, closes, opens, crosses }
    }
}

impl Connection for Gap {
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn pull(&self, ahead: f64) -> Pull {
        let Self { side, open, pressed, behind, stiffness, damping } = *self;
        let ahead = ahead * side;
        let per_way = 1.0 / ahead.abs().max(f64::MIN_POSITIVE);
        // The end where it starts, pressed by `after` in the end.
        let after = (pressed - open + ahead).max(0.0);
        let closed = pressed > 0.0 && after > 0.0;
        let share = (after + pressed) * per_way;
        let (entering, leaving) = (share * (1.0 - 0.5 * share), 0.5 * share * share);
        let slope = if after > 0.0 { entering } else { leaving };
        let slope = if closed { 0.5 } else { slope };
        let spring = if closed { 0.5 } else { 0.5 * share } * (after + pressed);
        let force = stiffness * spring + damping * (after - pressed);
        let slope = stiffness * slope + if after > 0.0 { damping } else { 0.0 };
        let pushes = force > 0.0;
        let (force, slope) = if pushes { (force, slope) } else { (0.0, 0.0) };
        // The other end.
        let after = (-behind - ahead).max(0.0);
        let share = after * per_way;
        let back = (0.5 * stiffness * share + damping) * after;
        let damped = if after > 0.0 { damping } else { 0.0 };
        let stiff = stiffness * share * (1.0 - 0.5 * share) + damped;
        Pull { force: side * (force - back), slope: slope + stiff, holds: true }
    }

    /// A line while the end where it starts stays closed or both are open; else the larger root of
    /// `square t^2 - linear t + rest = 0` for the way `t` to where it goes.
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn run_ahead(&self, inertia: f64, total: f64) -> f64 {
        let Self { side, open, pressed, behind, stiffness, damping } = *self;
        let Course { all, free, straight, still, closes, opens, crosses } =
            self.course(inertia, total);
        let total = total * side;
        let square = if opens { inertia } else { all };
        let way = if crosses { behind } else { open };
        let (toward, damped) = (if crosses { -total } else { total }, damping * (way - still));
        let linear =
            if opens { -total - damping * pressed } else { stiffness * way + damped + toward };
        let from = if opens { -pressed * pressed } else { way * way - still * still };
        let rest = 0.5 * stiffness * from;
        let root = (linear * linear - 4.0 * square * rest).max(0.0).sqrt();
        // Without a difference of near equals.
        let forth = linear >= 0.0;
        let above = if forth { linear + root } else { -2.0 * rest };
        let t = above / if forth { 2.0 * square } else { root - linear };
        let ahead = if crosses {
            -t
        } else if opens {
            free.min(-t)
        } else if closes {
            t
        } else {
            straight
        };
        side * ahead
    }
}

/// The same while the end where it starts stays closed or the gap stays open: most of the time, and by far less.
struct Stays(Gap);

impl Connection for Stays {
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn pull(&self, ahead: f64) -> Pull {
        let Gap { side, open, pressed, behind, stiffness, damping } = self.0;
        let ahead = ahead * side;
        let (closed, reach) = (pressed > 0.0, pressed - open + ahead);
        let after = reach.max(0.0);
        let force = stiffness * (0.5 * (after + pressed)) + damping * (after - pressed);
        let slope = stiffness * 0.5 + damping;
        let pushes = closed && force > 0.0;
        let (force, slope) = if pushes { (force, slope) } else { (0.0, 0.0) };
        let is_open = reach <= 0.0 && -behind - ahead <= 0.0;
        let holds = if closed { after > 0.0 } else { is_open };
        Pull { force: side * force, slope, holds }
    }

    /// Not a number where it does not stay so.
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn run_ahead(&self, inertia: f64, total: f64) -> f64 {
        let Course { straight, closes, opens, crosses, .. } = self.0.course(inertia, total);
        self.0.side * if opens || closes || crosses { f64::NAN } else { straight }
    }
}

/// Parameters of some lanes.
struct Lanes<'a> {
    mass: &'a [f64],
    level: &'a [f64],
    viscous: &'a [f64],
    width: &'a [f64],
    stiffness: &'a [f64],
    zeta: &'a [f64],
}

/// A stretch of lanes: force, slope and mean velocity of each.
type Stretch = [[f64; STRETCH]; 3];

impl<'a> Lanes<'a> {
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn new(p: Parameters<'a>, lanes: Range<usize>) -> Self {
        let of = |k: usize| &p.get(k)[lanes.clone()];
        let (mass, level, viscous) = (of(0), of(1), of(2));
        Self { mass, level, viscous, width: of(3), stiffness: of(4), zeta: of(5) }
    }

    /// What the lanes do, from how long they go on, how far they move, and their states.
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn pulled(&self, r: &[f64], moved: &[f64], stretch: &[f64], velocity: &[f64]) -> Stretch {
        let mut all = [[0.0; STRETCH]; 3];
        // To the bit what the whole law says, so that it does not matter what the other lanes do.
        if !self.through(Stays, r, moved, stretch, velocity, &mut all) {
            self.through(|gap| gap, r, moved, stretch, velocity, &mut all);
        }
        all
    }

    /// The same over a connection; tells whether that was right in all of them.
    #[expect(clippy::inline_always, reason = "it must be compiled anew for each instruction set")]
    #[inline(always)]
    fn through<C: Connection>(
        &self,
        connection: impl Fn(Gap) -> C,
        r: &[f64],
        moved: &[f64],
        stretch: &[f64],
        velocity: &[f64],
        [force, slope, mean]: &mut Stretch,
    ) -> bool {
        let mut others = 0_u64;
        let lanes = r.len().min(STRETCH);
        let (moved, stretch, velocity) = (&moved[..lanes], &stretch[..lanes], &velocity[..lanes]);
        let (mass, level, viscous) =
            (&self.mass[..lanes], &self.level[..lanes], &self.viscous[..lanes]);
        let (width, k, zeta) =
            (&self.width[..lanes], &self.stiffness[..lanes], &self.zeta[..lanes]);
        for i in 0..lanes {
            let (mass, level, stiffness, r) = (mass[i], level[i], k[i], r[i]);
            let rate = if r > 0.0 { 1.0 / r } else { 0.0 };
            let damping = 2.0 * zeta[i] * (stiffness * mass).sqrt() * rate;
            // Next to nothing on the ground holds a load of nothing.
            let viscous = viscous[i].max(NOTHING * stiffness * r);
            let gap = Gap::new(-stretch[i], 0.5 * width[i], stiffness, damping);
            let load = Load { mass, level, viscous };
            let pulled = load.step(velocity[i], r, moved[i], &connection(gap));
            (force[i], slope[i], mean[i]) = (pulled.force, pulled.slope, pulled.mean);
            others += u64::from(!pulled.holds);
        }
        others == 0
    }
}

vectorised! {
    fn answer(
        p: Parameters<'_>,
        duration: &[f64],
        open: &[f64],
        displacement: &[f64],
        state: &[f64],
        force: &mut [f64],
        stiffness: &mut [f64],
    ) {
        let (stretch, velocity) = state.split_at(duration.len());
        for lanes in open_stretches(open) {
            let plants = Lanes::new(p, lanes.clone());
            let (duration, displacement) = (&duration[lanes.clone()], &displacement[lanes.clone()]);
            let (stretch, velocity) = (&stretch[lanes.clone()], &velocity[lanes.clone()]);
            let [pulled, slope, _] = plants.pulled(duration, displacement, stretch, velocity);
            for (force, pulled) in force[lanes.clone()].iter_mut().zip(pulled) {
                *force += pulled;
            }
            for (stiffness, slope) in stiffness[lanes].iter_mut().zip(slope) {
                *stiffness += slope;
            }
        }
    }

    fn take(
        p: Parameters<'_>,
        duration: &[f64],
        open: &[f64],
        displacement: &[f64],
        state: &mut [f64],
    ) {
        let (stretch, velocity) = state.split_at_mut(duration.len());
        for lanes in open_stretches(open) {
            let plants = Lanes::new(p, lanes.clone());
            let (duration, displacement) = (&duration[lanes.clone()], &displacement[lanes.clone()]);
            let (stretch, velocity) = (&mut stretch[lanes.clone()], &mut velocity[lanes]);
            let [_, _, mean] = plants.pulled(duration, displacement, stretch, velocity);
            for i in 0..duration.len() {
                let (r, moved) = (duration[i], displacement[i]);
                stretch[i] += if r > 0.0 { r * mean[i] - moved } else { 0.0 };
                velocity[i] = 2.0 * mean[i] - velocity[i];
            }
        }
    }
}

/// States: stretch `x_L - x` and velocity of the load.
impl Element for TwoMass {
    fn states(&self) -> usize {
        2
    }

    /// At rest the mass is in the middle of the gap, else at the end where it pushes the load, pressed as far as
    /// the friction of the load asks for.
    fn start(&self, p: &[f64], at: &Onset, state: &mut [f64]) {
        let load = Load { mass: p[0], level: p[1], viscous: p[2] };
        let stretch = -0.5 * p[3] * sign(at.velocity) - load.drag(at.velocity) / p[4];
        state.copy_from_slice(&[stretch, at.velocity]);
    }

    fn respond(&self, p: Parameters<'_>, step: &Step<'_>, state: &[f64], out: &mut Response<'_>) {
        answer(p, step.duration, step.open, step.displacement, state, out.force, out.stiffness);
    }

    fn commit(&self, p: Parameters<'_>, step: &Step<'_>, state: &mut [f64]) {
        take(p, step.duration, step.open, step.displacement, state);
    }

    /// Well inside the gap the mass moves alone, up to its end; else both bodies move together.
    fn correct(&self, p: Parameters<'_>, c: &Correction<'_>, state: &mut [f64]) {
        let (stretch, velocity) = state.split_at_mut(c.displacement.len());
        for (i, (stretch, velocity)) in stretch.iter_mut().zip(velocity).enumerate() {
            let (width, half) = (p.get(3)[i], 0.5 * p.get(3)[i]);
            if half - stretch.abs() > NEAR_END * width {
                *stretch = (*stretch - c.displacement[i]).max(-half).min(half);
            } else {
                *velocity += c.velocity[i];
            }
        }
    }

    fn iterations(&self) -> usize {
        // Soft in the gap, stiff at its ends, and stiff between two softer pieces where the load sticks.
        4
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    proptest! {
        #[test]
        fn what_stays_closed_or_open_does_to_the_bit_what_the_whole_law_says(
            place in -2.0..2.0_f64,
            way in -1.0..1.0_f64,
            velocity in -1.0..1.0_f64,
            (mass, level, viscous) in (0.0..10.0_f64, 0.0..5.0_f64, 1e-3..100.0_f64),
            damping in 0.0..1e4_f64,
        ) {
            let (half, r, stiffness) = (1e-4, 1e-3, 1e5);
            let gap = || Gap::new(place * half, half, stiffness, damping);
            let load = Load { mass, level, viscous };
            let (velocity, moved) = (0.3 * velocity, 3.0 * half * way);
            let (whole, stays) =
                (load.step(velocity, r, moved, &gap()), load.step(velocity, r, moved, &Stays(gap())));
            prop_assert!(whole.holds);
            if stays.holds {
                prop_assert_eq!(stays.force.to_bits() << 1, whole.force.to_bits() << 1);
                prop_assert_eq!(stays.slope, whole.slope);
                prop_assert_eq!(stays.mean, whole.mean);
            }
        }
    }

    #[test]
    fn it_stays_as_it_is_well_inside_and_well_pressed_and_not_at_the_ends() {
        let (half, r) = (1e-4, 1e-3);
        let load = Load { mass: 5.0, level: 0.0, viscous: 1.0 };
        let stays = |place: f64, velocity: f64, moved: f64| {
            load.step(velocity, r, moved, &Stays(Gap::new(place, half, 1e5, 10.0))).holds
        };
        assert!(stays(0.0, 0.0, 0.5 * half) && stays(2.0 * half, 0.0, 0.0));
        assert!(!stays(0.9 * half, 0.0, 0.5 * half), "it closes");
        assert!(!stays(1.01 * half, 0.3, 0.0), "it opens");
    }
}
