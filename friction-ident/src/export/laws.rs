//! The laws of the effects in C, statement by statement as the hooks compute them.

use crate::model::Term;

/// What a term adds, in C99; `{name}` stands for the constant of the parameter `name`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Law {
    /// Statements that add to `force`, of `x` (position), `v` (velocity) and `t` (time).
    pub smooth: &'static str,
    /// Statements that add to `damping`, the slope of `force` against the velocity, of the same.
    pub damping: &'static str,
    /// Statements that add to `level`, of `x`, `s` (direction), `w` (the velocity that the level
    /// follows), `dwell` and `bond`; what no compensator acts on also of `t`, `drive` (force of the
    /// drive) and `a` (acceleration).
    pub level: &'static str,
    /// Expression of `w`: the share that is left of the static hump.
    pub hump: &'static str,
}

const NONE: Law = Law { smooth: "", damping: "", level: "", hump: "" };

/// A sum of cosines over the stroke, and more terms of `u`.
macro_rules! profile {
    ($count:literal, $amplitudes:literal, $add:literal) => {
        concat!(
            "{
    static const double c[",
            $count,
            "] = {",
            $amplitudes,
            "};
    const double share = (x - {start}) / ({end} - {start});
    const double u = share < 0.0 ? 0.0 : (share > 1.0 ? 1.0 : share);
    const double cosine = cos(3.141592653589793 * u);
    double before = 1.0, now = cosine, sum = 0.0;
    int k;
    for (k = 0; k < ",
            $count,
            "; k++) {
        const double next = 2.0 * cosine * now - before;
        sum += c[k] * now;
        before = now;
        now = next;
    }
    ",
            $add,
            "
}"
        )
    };
}

/// How far `w` has gone, 0..1, from a knot of the free curve to the next one.
macro_rules! gone {
    ($from:literal, $to:literal) => {
        concat!(
            "fmin(fmax((asinh(fabs(w) / (0.002 * {v_high})) - ",
            $from,
            ") / (",
            $to,
            " - ",
            $from,
            "), 0.0), 1.0)"
        )
    };
}

/// What the free curve has at `w` of what it has at rest, where that is a hump.
const FREE_SHARE: &str = concat!(
    "{c_0} > 0.0 ? fmin(fmax((",
    "{c_0} * (1.0 - ",
    gone!("0.0", "0.48121182505960347"),
    ") + {c_1} * (",
    gone!("0.0", "0.48121182505960347"),
    " - ",
    gone!("0.48121182505960347", "1.1947632172871094"),
    ") + {c_2} * (",
    gone!("0.48121182505960347", "1.1947632172871094"),
    " - ",
    gone!("1.1947632172871094", "2.0947125472611012"),
    ") + {c_3} * (",
    gone!("1.1947632172871094", "2.0947125472611012"),
    " - ",
    gone!("2.0947125472611012", "2.7764722807237177"),
    ") + {c_4} * (",
    gone!("2.0947125472611012", "2.7764722807237177"),
    " - ",
    gone!("2.7764722807237177", "3.4023066454805946"),
    ") + {c_5} * (",
    gone!("2.7764722807237177", "3.4023066454805946"),
    " - ",
    gone!("3.4023066454805946", "4.09462222433053"),
    ") + {c_6} * (",
    gone!("3.4023066454805946", "4.09462222433053"),
    " - ",
    gone!("4.09462222433053", "4.78756117999381"),
    ") + {c_7} * (",
    gone!("4.09462222433053", "4.78756117999381"),
    " - ",
    gone!("4.78756117999381", "5.703793585582131"),
    ") + {c_8} * (",
    gone!("4.78756117999381", "5.703793585582131"),
    " - ",
    gone!("5.703793585582131", "6.907756278980637"),
    ")",
    ") / {c_0}, 0.0), 1.0) : 1.0 - ",
    gone!("0.0", "0.48121182505960347")
);

/// The law of a term; none where there is none in C.
pub(crate) fn law(term: &Term) -> Option<Law> {
    Some(match term.name() {
        "coulomb" => Law { level: "level += {F_C};", ..NONE },
        "viscous" => {
            Law { smooth: "force += {F_v} * v;", damping: "damping += {F_v};", ..NONE }
        }
        "offset" => Law { smooth: "force += {F_0};", ..NONE },
        "asymmetry" => Law {
            smooth: "force += {dF_v} * fabs(v);",
            damping: "damping += {dF_v} * (double)((v > 0.0) - (v < 0.0));",
            level: "level += {dF_C} * s;",
            ..NONE
        },
        "stribeck" => Law {
            level: "level += {dF} * bond * ({v_s} * {v_s}) / ({v_s} * {v_s} + w * w);",
            hump: "({v_s} * {v_s}) / ({v_s} * {v_s} + w * w)",
            ..NONE
        },
        "stribeck:gaussian" => Law {
            level: "level += {dF} * bond * exp(-(w / {v_s}) * (w / {v_s}));",
            hump: "exp(-(w / {v_s}) * (w / {v_s}))",
            ..NONE
        },
        "stribeck:exponential" => Law {
            level: "level += {dF} * bond * exp(-pow(fabs(w / {v_s}), {delta}));",
            hump: "exp(-pow(fabs(w / {v_s}), {delta}))",
            ..NONE
        },
        "stribeck:free" => Law {
            level: "{
    static const double knots[10] = {0.0, 0.48121182505960347, 1.1947632172871094, 2.0947125472611012,
        2.7764722807237177, 3.4023066454805946, 4.09462222433053, 4.78756117999381,
        5.703793585582131, 6.907756278980637};
    static const double c[9] = {{c_0}, {c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}, {c_7}, {c_8}};
    const double z = asinh(fabs(w) / (0.002 * {v_high}));
    double before = 1.0, sum = 0.0;
    int k;
    for (k = 0; k < 9; k++) {
        const double gone = (z - knots[k]) / (knots[k + 1] - knots[k]);
        const double next = gone < 0.0 ? 0.0 : (gone > 1.0 ? 1.0 : gone);
        sum += c[k] * (before - next);
        before = next;
    }
    level += bond * sum;
}",
            hump: FREE_SHARE,
            ..NONE
        },
        "rising-static-friction" => Law {
            level: "level += {dF} * dwell / (dwell + {gamma}) / (1.0 + (w / {v_s}) * (w / {v_s}));",
            ..NONE
        },
        "ripple" => Law {
            smooth: "{
    const double a = 6.283185307179586 * (x / {l});
    const double sine = sin(a), cosine = cos(a);
    const double second = 2.0 * {a_2} * sine * cosine + {b_2} * (1.0 - 2.0 * sine * sine);
    force += {a_1} * sine + {b_1} * cosine + second;
}",
            ..NONE
        },
        "ripple:harmonics" => Law {
            smooth: "{
    static const double a[6] = {{a_1}, {a_2}, {a_3}, {a_4}, {a_5}, {a_6}};
    static const double b[6] = {{b_1}, {b_2}, {b_3}, {b_4}, {b_5}, {b_6}};
    const double angle = 6.283185307179586 * (x / {l});
    const double sine = sin(angle), cosine = cos(angle);
    double sine_k = sine, cosine_k = cosine, sum = 0.0;
    int k;
    for (k = 0; k < 6; k++) {
        const double next = sine_k * cosine + cosine_k * sine;
        sum += a[k] * sine_k + b[k] * cosine_k;
        cosine_k = cosine_k * cosine - sine_k * sine;
        sine_k = next;
    }
    force += sum;
}",
            ..NONE
        },
        "ripple:direction" => Law {
            smooth: "{
    const double a = 6.283185307179586 * (x / {l});
    force += 0.5 * (({a_p} + {a_m}) * sin(a) + ({b_p} + {b_m}) * cos(a));
}",
            level: "{
    const double a = 6.283185307179586 * (x / {l});
    level += 0.5 * (({a_p} - {a_m}) * sin(a) + ({b_p} - {b_m}) * cos(a));
}",
            ..NONE
        },
        "position-friction" => {
            Law { level: profile!("6", "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}", "level += sum;"), ..NONE }
        }
        "position-friction:fine" => Law {
            level: profile!(
                "20",
                "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}, {c_7}, {c_8}, {c_9}, {c_10},
        {c_11}, {c_12}, {c_13}, {c_14}, {c_15}, {c_16}, {c_17}, {c_18}, {c_19}, {c_20}",
                "level += sum + {p_1} * (u - 0.5) + {p_2} * (u * u - u + 1.0 / 6.0);"
            ),
            ..NONE
        },
        "viscous-stroke" => Law {
            smooth: profile!("6", "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}", "force += sum * v;"),
            damping: profile!("6", "{c_1}, {c_2}, {c_3}, {c_4}, {c_5}, {c_6}", "damping += sum;"),
            ..NONE
        },
        "spring" => Law { smooth: "force += {k} * (x - {x_0});", ..NONE },
        "gravity-pendulum" => Law { smooth: "force += {M} * sin(x - {q_0});", ..NONE },
        "quadratic-drag" => Law {
            smooth: "force += {c} * v * fabs(v);",
            damping: "damping += {c} * fabs(v);",
            ..NONE
        },
        "shear-thinning" => Law {
            smooth: "force += {dF} * tanh(v / {v_n});",
            damping: "{
    const double part = tanh(v / {v_n});
    damping += {dF} * (1.0 - part * part) / {v_n};
}",
            ..NONE
        },
        "load-friction" => Law { level: "level += {mu} * fabs(drive);", ..NONE },
        "load-friction:inertia" => Law { level: "level += {c} * fabs(a);", ..NONE },
        "load-friction:both" => {
            Law { level: "level += {mu} * fabs(drive) + {c} * fabs(a);", ..NONE }
        }
        "drift" => Law {
            smooth: "force += {dF_v} * exp(-t / {tau}) * v;",
            damping: "damping += {dF_v} * exp(-t / {tau});",
            level: "level += {dF_C} * exp(-t / {tau});",
            ..NONE
        },
        "frictional-memory" | "frictional-memory:lag" | "rising-static-friction:bond" => NONE,
        _ => return None,
    })
}

/// The constant of a parameter.
pub(crate) fn constant(effect: &str, parameter: &str) -> String {
    let name = format!("{effect}_{parameter}").to_uppercase();
    // Symbols such as F_c and F_C differ in their case only where they belong to one effect.
    name.chars().map(|c| if c.is_ascii_alphanumeric() { c } else { '_' }).collect()
}

/// A law with the constants of a term in place of its parameters.
pub(crate) fn filled(term: &Term, law: &str) -> String {
    let parameters = term.effect().about().parameters;
    parameters.iter().fold(law.to_owned(), |law, parameter| {
        law.replace(&format!("{{{}}}", parameter.name), &constant(term.name(), parameter.name))
    })
}

/// A number that C reads back to the bit.
pub(crate) fn number(value: f64) -> String {
    if value < 0.0 { format!("({value:e})") } else { format!("{value:e}") }
}
