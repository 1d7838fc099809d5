//! What effects with a state do, in C: drives, memories, elements and sensors, statement by statement as their hooks.

use super::constants::{constant, filled};
use crate::effects::Slot;
use crate::model::Term;

/// What a term does in C99; `{name}` stands for the constant of the parameter `name`, `{s0}`, `{s1}` .. for its states.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Dynamics {
    /// Number of its states.
    pub states: usize,
    /// Functions that it needs, in this order.
    pub helpers: &'static [&'static str],
    /// Sets the states of a drive or a memory, of `velocity` and `command`.
    pub start: &'static str,
    /// Replaces `force`, of `duration` and `end` (time).
    pub drive: &'static str,
    /// Expression: over which time, s, the integral of what came into the drive is kept.
    pub input: &'static str,
    /// Expression: over which time, s, the velocity is kept.
    pub slow: &'static str,
    /// Changes `m->level_velocity`, `m->bond`, `m->remembered`.
    pub recall: &'static str,
    /// Takes a piece of motion, of `m->taken`, `m->displacement`, `m->sliding`, `m->dwell`, `m->hump`.
    pub remember: &'static str,
    /// Sets the states of an element, of `level`, `used` and `velocity`.
    pub load: &'static str,
    /// Adds to `m->elements` and `m->stiffness`, of `m->left` and `m->displacement`.
    pub respond: &'static str,
    /// Takes a piece into the element, of `m->taken` and `m->displacement`.
    pub commit: &'static str,
    /// Solves the balance in closed form where it is the only element.
    pub solve: &'static str,
    /// For contacts: expression that is 1 while it slides.
    pub sliding: &'static str,
    /// Changes `position`, which is shown.
    pub shown: &'static str,
    /// Newton iterations after a first solution for no displacement.
    pub iterations: usize,
    /// Whether the contact holds up to the level at rest.
    pub breakaway: bool,
    /// Whether it is another body.
    pub attached: bool,
}

pub(super) const LIMITED: &str = include_str!("c/limited.c");
pub(super) const PAST: &str = include_str!("c/past.c");
const CONTACT: &str = include_str!("c/contact.c");
const BRISTLE: &str = include_str!("c/bristle.c");
const SECOND_ORDER: &str = include_str!("c/second_order.c");
const SWING: &str = include_str!("c/swing.c");
const LOAD: &str = include_str!("c/load.c");
const COUPLED: &str = include_str!("c/coupled.c");
const GAPPED: &str = include_str!("c/gapped.c");

const NONE: Dynamics = Dynamics {
    states: 0,
    helpers: &[],
    start: "",
    drive: "",
    input: "",
    slow: "",
    recall: "",
    remember: "",
    load: "",
    respond: "",
    commit: "",
    solve: "",
    sliding: "",
    shown: "",
    iterations: 0,
    breakaway: false,
    attached: false,
};

/// An elastic contact that holds up to `$hold` (`level` or `breakaway`).
macro_rules! contact {
    ($hold:literal, $solve:literal, $breakaway:literal) => {
        Dynamics {
            states: 2,
            helpers: &[LIMITED, CONTACT],
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
            ..NONE
        }
    };
}

/// A bristle, whose own damping is `$damping`.
macro_rules! bristle {
    ($damping:literal) => {
        Dynamics {
            states: 1,
            helpers: &[LIMITED, BRISTLE],
            load: "{s0} = level * used;",
            respond: concat!(
                "{
    const double held = limited({s0}, m->level);
    double slope;
    const double end = bristle(held, m->displacement, {k_t}, m->level, &slope);
    const double rate = ",
                $damping,
                " / ({k_t} * fmax(m->left, DBL_MIN));
    m->elements += 0.5 * (held + end) + rate * (end - held);
    m->stiffness += (0.5 + rate) * slope;
}"
            ),
            commit: "{
    double slope;
    {s0} = bristle({s0}, m->displacement, {k_t}, m->level, &slope);
}",
            sliding: "fabs({s0}) >= 0.999 * m->level ? 1.0 : 0.0",
            iterations: 5,
            ..NONE
        }
    };
}

/// A load with friction behind a coupling; `$shown`: what the encoder shows of it.
macro_rules! coupled {
    ($shown:literal) => {
        Dynamics {
            states: 2,
            helpers: &[LOAD, COUPLED],
            load: "{
    const double w = 6.283185307179586 * {f}, k = {m_L} * w * w;
    {s0} = k > 0.0 ? -({F_L} * sign(velocity) + {d_L} * velocity) / k : 0.0;
    {s1} = velocity;
}",
            respond: "{
    const double p[5] = {{m_L}, {f}, {zeta}, {F_L}, {d_L}};
    double slope, mean;
    m->elements += coupled(p, m->left, m->displacement, {s0}, {s1}, &slope, &mean);
    m->stiffness += slope;
}",
            commit: "{
    const double p[5] = {{m_L}, {f}, {zeta}, {F_L}, {d_L}};
    double slope, mean;
    coupled(p, m->taken, m->displacement, {s0}, {s1}, &slope, &mean);
    {s0} += m->taken > 0.0 ? m->taken * mean - m->displacement : 0.0;
    {s1} = 2.0 * mean - {s1};
}",
            shown: $shown,
            iterations: 3,
            attached: true,
            ..NONE
        }
    };
}

/// What a term does beside its law; none where it is not written in C.
pub(super) fn dynamics(term: &Term) -> Option<Dynamics> {
    Some(match term.name() {
        "actuator-lag" => Dynamics {
            states: 1,
            start: "{s0} = command;",
            drive: "{
    const double ratio = duration / {tau}, left = exp(-ratio), off = {s0} - force;
    const double mean = ratio > 1e-8 ? (1.0 - left) / ratio : 1.0;
    {s0} = force + off * left;
    force = force + off * (isfinite(ratio) ? mean : 0.0);
}",
            ..NONE
        },
        "actuator-lag:second-order" => Dynamics {
            states: 2,
            helpers: &[SECOND_ORDER],
            start: "{s0} = command;\n{s1} = 0.0;",
            drive: "{
    const double t = duration / {tau};
    if (!isfinite(t)) {
        {s0} = force;
        {s1} = 0.0;
    } else {
        const double off = {s0} - force, rate = {s1};
        double even, odd, off_then, rate_then, mean;
        lag_response({zeta}, t, &even, &odd);
        off_then = (even + {zeta} * odd) * off + odd * rate;
        rate_then = (even - {zeta} * odd) * rate - odd * off;
        mean = t > 1e-5 ? (2.0 * {zeta} * (off - off_then) + rate - rate_then) / t : off + 0.5 * t * rate;
        {s0} = force + off_then;
        {s1} = rate_then;
        force = force + mean;
    }
}",
            ..NONE
        },
        "input-delay" => Dynamics {
            helpers: &[PAST],
            // A little more, so that a delay of 0 keeps its past as well.
            input: "fmax(1e-6, {T_d})",
            drive: "{
    const double sum = m->input.value[m->input.end - 1] + duration * force;
    if (!past_push(&m->input, end, sum)) {
        return 0;
    }
    if (duration > 0.0) {
        const double to = end - {T_d};
        force = (past_at(&m->input, to) - past_at(&m->input, to - duration)) / duration;
    }
}",
            ..NONE
        },
        "saturation" => Dynamics {
            helpers: &[LIMITED],
            drive: "force = limited(force, {u_max});",
            ..NONE
        },
        "motor-gain" => Dynamics { drive: "force *= {g};", ..NONE },
        "encoder" => Dynamics {
            shown: "{
    const double a = 6.283185307179586 * (position / {p});
    position += {a} * sin(a) + {b} * cos(a);
}",
            ..NONE
        },
        "frictional-memory" => Dynamics {
            helpers: &[PAST],
            slow: "{tau_L}",
            recall: "{
    const double then = m->when - {tau_L};
    const double newest = m->slow.time[m->slow.end - 1], last = m->slow.value[m->slow.end - 1];
    m->level_velocity = then > newest
        ? last + (then - newest) / (m->when - newest) * (m->predicted - last)
        : past_at(&m->slow, then);
}",
            ..NONE
        },
        "frictional-memory:lag" => Dynamics {
            states: 1,
            start: "{s0} = velocity;",
            recall: "m->level_velocity = {s0};",
            remember: "if (m->taken > 0.0) {
    const double mean = m->displacement / m->taken;
    {s0} = mean + ({s0} - mean) * exp(-m->taken / {tau_L});
}",
            ..NONE
        },
        // States: what the last slide left, the bond while sliding, 1 while sliding.
        "rising-static-friction:bond" => Dynamics {
            states: 3,
            start: "{s0} = 1.0;\n{s1} = 1.0;\n{s2} = velocity != 0.0 ? 1.0 : 0.0;",
            recall: "m->bond = {s2} > 0.0 ? {s1} : {s0} + (1.0 - {s0}) * m->dwell / (m->dwell + {gamma});",
            remember: "{
    const int was = {s2} > 0.0, is = m->sliding > 0.0;
    const double grown = {s0} + (1.0 - {s0}) * m->dwell / (m->dwell + {gamma});
    {s0} = was && !is ? {s1} * m->hump : {s0};
    {s1} = was ? {s1} : grown;
    {s2} = m->sliding;
}",
            ..NONE
        },
        // States: distance since the last reversal, and the direction since then.
        "reversal-decay" => Dynamics {
            states: 2,
            helpers: &[PAST],
            slow: "1e-9",
            start: "{s0} = DBL_MAX;\n{s1} = sign(velocity);",
            recall: "{
    const double ahead = fmax(m->when - m->slow.time[m->slow.end - 1], 0.0) * fabs(m->predicted);
    const double going = m->predicted == 0.0 ? m->drive : m->predicted;
    const double since = going * {s1} < 0.0 ? ahead : {s0} + ahead;
    m->remembered += {F_r} * exp(-since / {l});
}",
            remember: "if (m->sliding > 0.0 && m->displacement != 0.0) {
    const double way = fabs(m->displacement);
    {s0} = m->displacement * {s1} < 0.0 ? way : {s0} + way;
    {s1} = sign(m->displacement);
}",
            ..NONE
        },
        "backlash" => Dynamics {
            states: 1,
            helpers: &[LIMITED],
            start: "{s0} = 0.5 * sign(velocity);",
            recall: "{
    const double towards = m->direction == 0.0 ? sign(m->drive) : m->direction;
    m->remembered -= {s0} * towards < 0.5 ? {F_L} : 0.0;
}",
            remember: "{s0} = limited({s0} + m->displacement / {b}, 0.5);",
            ..NONE
        },
        "presliding" => contact!(
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
        "presliding:static" => contact!(
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
        "presliding:dahl" => bristle!("0.0"),
        "presliding:lugre" => bristle!("{sigma_1}"),
        "presliding:maxwell-slip" => Dynamics {
            states: 4,
            helpers: &[LIMITED],
            load: "{s0} = {s1} = {s2} = {s3} = level * used / 4.0;",
            respond: "{
    const double cap = m->level / 4.0, q = 1.0 / {spread}, sum = 1.0 + q + q * q + q * q * q;
    double share = 1.0;
    int e;
    for (e = 0; e < 4; e++) {
        const double k = {k_t} * share / sum, held = limited((&{s0})[e], cap), trial = held + k * m->displacement;
        m->elements += 0.5 * (held + limited(trial, cap));
        m->stiffness += fabs(trial) <= cap ? 0.5 * k : 0.0;
        share /= {spread};
    }
}",
            commit: "{
    const double cap = m->level / 4.0, q = 1.0 / {spread}, sum = 1.0 + q + q * q + q * q * q;
    double share = 1.0;
    int e;
    for (e = 0; e < 4; e++) {
        const double k = {k_t} * share / sum;
        (&{s0})[e] = limited(limited((&{s0})[e], cap) + k * m->displacement, cap);
        share /= {spread};
    }
}",
            sliding: "fabs({s0} + {s1} + {s2} + {s3}) >= 0.999 * m->level ? 1.0 : 0.0",
            iterations: 5,
            ..NONE
        },
        "flexible-coupling" => Dynamics {
            states: 2,
            helpers: &[SWING],
            load: "{s0} = 0.0;\n{s1} = velocity;",
            respond: "{
    const double p[3] = {{m_L}, {f}, {zeta}};
    double slope, mean;
    m->elements += swing(p, m->left, m->displacement, {s0}, {s1}, &slope, &mean);
    m->stiffness += slope;
}",
            commit: "{
    const double p[3] = {{m_L}, {f}, {zeta}};
    double slope, mean;
    swing(p, m->taken, m->displacement, {s0}, {s1}, &slope, &mean);
    {s0} += m->taken * mean - m->displacement;
    {s1} += 2.0 * (mean - {s1});
}",
            iterations: 1,
            attached: true,
            ..NONE
        },
        "flexible-coupling:friction" => coupled!(""),
        "flexible-coupling:load" => coupled!("position += {s0};"),
        "backlash:two-mass" => Dynamics {
            states: 2,
            helpers: &[LOAD, GAPPED],
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
            ..NONE
        },
        _ => {
            // What acts by its law alone.
            let slots = term.effect().about().slots;
            let by_law =
                slots.iter().all(|slot| matches!(slot, Slot::SmoothForce | Slot::FrictionLevel));
            return (by_law && term.effect().c_law().is_some()).then_some(NONE);
        }
    })
}

/// Statements of a term whose states begin at `first`.
pub(super) fn with_states(term: &Term, statements: &str, first: usize, states: usize) -> String {
    let text = filled(term, statements);
    (0..states)
        .fold(text, |text, k| text.replace(&format!("{{s{k}}}"), &format!("m->s[{}]", first + k)))
}

/// Constants of a term, whose first parameter is number `first` of the plant.
pub(super) fn constants(term: &Term, first: usize, unit: impl Fn(usize) -> &'static str) -> String {
    use std::fmt::Write as _;
    let mut text = String::new();
    for (k, parameter) in term.effect().about().parameters.iter().enumerate() {
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "#define {} (m->p[{}]) /* {}: {} */",
            constant(term.name(), parameter.name),
            first + k,
            unit(k),
            parameter.meaning
        );
    }
    text
}
