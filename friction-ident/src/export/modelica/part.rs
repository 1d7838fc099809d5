//! What one effect adds to a model in Modelica.

use std::fmt::Write as _;

use super::text::{filled, identifier, parameter};
use crate::effects::Slot;
use crate::model::ModelEffect;

/// What a term adds. In a level `@s` stands for the direction, `@w` for the velocity that it follows, `@bond` for a factor.
/// In declarations `@velocity` is that of the mass at the start.
#[derive(Clone, Debug, Default)]
pub(super) struct Part {
    /// What the names of its parameters and variables begin with.
    pub prefix: String,
    /// Force that resists, of `x`, `v`, `time`.
    pub smooth: String,
    /// Addend of the friction level.
    pub level: String,
    /// The same at the start, at rest, where it differs.
    pub level_at_start: Option<&'static str>,
    /// Level per acceleration.
    pub carried: String,
    /// Share of the static hump that is left, of `@w`.
    pub hump: String,
    /// What the force becomes in the drive; `@in` is what comes in.
    pub drive: String,
    /// The same at the start, where it differs.
    pub drive_at_start: Option<&'static str>,
    /// The force on the mass from another body.
    pub pull: String,
    /// What the sensor shows; `@in` is the position so far.
    pub shown: String,
    /// Takes the place of `v` in the level.
    pub level_velocity: String,
    /// Takes the place of `@bond` in the level.
    pub bond: String,
    /// Whether it reads how long the contact has been at rest, or whether it slides.
    pub reads_dwell: bool,
    /// The same: whether it slides.
    pub reads_sliding: bool,
    /// Whether its level jumps at a place.
    pub jumps: bool,
    /// Declarations, initial equations, equations.
    pub declared: Vec<String>,
    pub initial: Vec<String>,
    pub equations: Vec<String>,
    pub contact: Option<Contact>,
}

/// An elastic contact in place of rigid friction.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Contact {
    /// A spring that slides at the level; whether it holds up to that at rest.
    Spring { at_rest: bool },
    /// A bristle; whether it is damped.
    Bristle { damped: bool },
    /// Four springs in parallel.
    Springs,
}

/// The law of a load that slides on the ground, with what pulls it in `{}_pull`.
const LOAD: [&str; 9] = [
    "Real {}_x \"position of the load\";",
    "Real {}_v \"velocity of the load\";",
    "Real {}_pull \"force on the load from the mass\";",
    "Real {}_applied \"force on the load without its Coulomb friction\";",
    "Integer {}_direction \"in which the load slides, 0 where it sticks\";",
    "{}_direction = if {}_v > 0 then 1 elseif {}_v < 0 then -1 elseif {}_applied > {F_L} then 1 elseif {}_applied < -{F_L} then -1 else 0;",
    "{}_applied = {}_pull - {d_L}*{}_v;",
    "der({}_x) = {}_v;\n{m_L}*der({}_v) = if {}_direction == 0 then 0 else {}_applied - {}_direction*{F_L};",
    "when pre({}_direction) == 0 and ({}_applied > {F_L} or {}_applied < -{F_L}) then\n  {}_direction = if {}_applied > 0 then 1 else -1;\nelsewhen pre({}_direction)*{}_v < 0 then\n  {}_direction = 0;\n  reinit({}_v, 0);\nend when;",
];

impl Part {
    /// What `term` adds, or why Modelica does not say it here.
    pub fn of(term: &ModelEffect) -> Result<Self, &'static str> {
        let mut part = Self::raw(term)?;
        let names = |text: &str| filled(term, text);
        for text in [
            &mut part.smooth,
            &mut part.level,
            &mut part.carried,
            &mut part.hump,
            &mut part.drive,
            &mut part.pull,
            &mut part.shown,
            &mut part.level_velocity,
            &mut part.bond,
        ] {
            *text = names(text);
        }
        for lines in [&mut part.declared, &mut part.initial, &mut part.equations] {
            for line in lines.iter_mut() {
                *line = names(line);
            }
        }
        part.prefix = identifier(term.name());
        Ok(part)
    }

    /// Whether its level depends on the direction.
    pub fn has_direction(&self) -> bool {
        self.level.contains("@s")
    }

    /// The same beside `contact`, or why it cannot stand there: a tool that stops at every event gets no further where
    /// each event of a contact that holds undoes the one before.
    pub fn beside(self, contact: Option<Contact>) -> Result<Self, &'static str> {
        let Some(contact) = contact else { return Ok(self) };
        if !self.carried.is_empty() {
            return Err(
                "beside an elastic contact, friction by the acceleration is an equation of itself",
            );
        }
        let springs = matches!(contact, Contact::Spring { .. });
        if self.has_direction() && (self.jumps || !springs) {
            return Err(
                "its level jumps with the direction, which an elastic contact that holds changes without end",
            );
        }
        Ok(self)
    }

    fn raw(term: &ModelEffect) -> Result<Self, &'static str> {
        let smooth = |text: &str| Self { smooth: text.to_owned(), ..Self::default() };
        let level = |text: &str| Self { level: text.to_owned(), ..Self::default() };
        Ok(match term.name() {
            "coulomb" => level("{F_C}"),
            "viscous" => smooth("{F_v}*v"),
            "offset" => smooth("{F_0}"),
            "spring" => smooth("{k}*(x - {x_0})"),
            "spring:stiffening" => smooth(
                "{k}*(x - ({start} + {end})/2) + {F_2}*((2*x - {start} - {end})/({end} - {start}))^2 + \
                 {F_3}*((2*x - {start} - {end})/({end} - {start}))^3",
            ),
            "gravity-pendulum" => smooth("{M}*sin(x - {q_0})"),
            "quadratic-drag" => smooth("{c}*v*abs(v)"),
            "quadratic-drag:power" => smooth("{c}*{v_high}*(abs(v)/{v_high})^({n} - 1)*v"),
            "shear-thinning" => smooth("{dF}*tanh(v/{v_n})"),
            "shear-thinning:eyring" => {
                smooth("{dF}*sign(v)*log(abs(v)/{v_n} + sqrt(1 + (v/{v_n})^2))")
            }
            "shear-thinning:cross" => smooth("{dF}*v/{v_n}/(1 + (abs(v)/{v_n})^{m})"),
            "asymmetry" => Self { smooth: "{dF_v}*abs(v)".into(), ..level("{dF_C}*@s") },
            "drift" => Self {
                smooth: "{dF_v}*exp(-time/{tau})*v".into(),
                ..level("{dF_C}*exp(-time/{tau})")
            },
            "drift:linear" => Self {
                smooth: "{dF_v}*(time - {begin})/({finish} - {begin})*v".into(),
                ..level("{dF_C}*(time - {begin})/({finish} - {begin})")
            },
            "ripple" => smooth(&waves(2)),
            "ripple:harmonics" => smooth(&waves(6)),
            "ripple:direction" => Self {
                smooth: "0.5*(({a_p} + {a_m})*sin(2*pi*x/{l}) + ({b_p} + {b_m})*cos(2*pi*x/{l}))"
                    .into(),
                ..level("0.5*(({a_p} - {a_m})*sin(2*pi*x/{l}) + ({b_p} - {b_m})*cos(2*pi*x/{l}))")
            },
            "position-friction" => Self { level: format!("({})", cosines(6)), ..along_stroke() },
            "position-friction:fine" => Self {
                level: format!(
                    "({} + {{p_1}}*({{}}_u - 0.5) + {{p_2}}*({{}}_u^2 - {{}}_u + 1/6))",
                    cosines(20)
                ),
                ..along_stroke()
            },
            "viscous-stroke" => Self { smooth: format!("({})*v", cosines(6)), ..along_stroke() },
            "stribeck" => hump("{v_s}^2/({v_s}^2 + @w^2)"),
            "stribeck:gaussian" => hump("exp(-(@w/{v_s})^2)"),
            "stribeck:exponential" => hump("exp(-abs(@w/{v_s})^{delta})"),
            "load-friction" => level("{mu}*abs(drive)"),
            "load-friction:inertia" => Self { carried: "{c}".into(), ..Self::default() },
            "load-friction:both" => Self { carried: "{c}".into(), ..level("{mu}*abs(drive)") },
            "rising-static-friction" => Self {
                reads_dwell: true,
                ..level("{dF}*dwell/(dwell + {gamma})/(1 + (@w/{v_s})^2)")
            },
            "rising-static-friction:bond" => bond(),
            "rising-static-friction:ageing" => Self {
                level: "{B}*log(1 + {}_age*{v_c}/{D_c})".into(),
                declared: vec!["Real {}_age \"age of the contacts\";".into()],
                initial: vec!["{}_age = if v == 0 then 1 else {D_c}/abs(v);".into()],
                equations: vec!["der({}_age) = 1 - {}_age*abs(v)/{D_c};".into()],
                ..Self::default()
            },
            "rising-static-friction:healing" => Self {
                level: "{dF}*{}_h".into(),
                reads_sliding: true,
                declared: vec!["Real {}_h \"share that has come, 0..1\";".into()],
                initial: vec!["{}_h = if v == 0 then {h_0} else 0;".into()],
                equations: vec![
                    "der({}_h) = if slides then -{}_h*abs(v)/{D_c} else (1 - {}_h)/{gamma};".into(),
                ],
                ..Self::default()
            },
            "frictional-memory" => {
                Self { level_velocity: "delay(v, {tau_L})".into(), ..Self::default() }
            }
            "frictional-memory:lag" => lagging(""),
            "frictional-memory:whole" => lagging("{F_w}*{}_w"),
            "reversal-decay" => reversal(),
            "reversal-decay:hysteresis" => hysteresis("v - {}_h*abs(v)"),
            "reversal-decay:bouc-wen" => {
                hysteresis("v*(1 - abs({}_h)^{n}*(1 - {beta} + {beta}*sign({}_h*v)))")
            }
            "backlash" => gap_without_load(),
            "motor-gain" => drive("{g}*@in"),
            "motor-gain:direction" => drive("@in + {dg}*abs(@in)"),
            "motor-gain:current" => drive("@in/(1 + {c}*abs(@in))"),
            "motor-gain:knee" => drive("@in/(1 + (1.5^{n} - 1)*({c}*abs(@in))^{n})^(1/{n})"),
            "motor-gain:ripple" => Self {
                smooth: "(-drive*({a}*sin(2*pi*x/{l}) + {b}*cos(2*pi*x/{l})))".into(),
                ..Self::default()
            },
            "motor-gain:stroke" => {
                Self { smooth: format!("(-({})*drive)", cosines(6)), ..along_stroke() }
            }
            "saturation" => drive("max(-{u_max}, min({u_max}, @in))"),
            "saturation:soft" => drive("@in/(1 + (abs(@in)/{u_max})^{n})^(1/{n})"),
            "saturation:speed" => Self {
                smooth: "(drive - max(-{u_max}*(1 + {kappa}*v/{v_high}), min({u_max}*(1 - {kappa}*v/{v_high}), drive)))".into(),
                ..Self::default()
            },
            // A lag or delay of nothing is none: its equation would be singular.
            "actuator-lag" | "actuator-lag:second-order" | "input-delay"
                if term.values()[0] <= 0.0 =>
            {
                drive("@in")
            }
            "actuator-lag" => Self {
                declared: vec!["Real {}_force \"behind the lag\";".into()],
                initial: vec!["{}_force = @command;".into()],
                equations: vec!["{tau}*der({}_force) = @in - {}_force;".into()],
                drive_at_start: Some("@command"),
                ..drive("{}_force")
            },
            "actuator-lag:second-order" => Self {
                declared: vec![
                    "Real {}_force \"behind the lag\";".into(),
                    "Real {}_rate \"its derivative times the time constant\";".into(),
                ],
                initial: vec!["{}_force = @command;".into(), "{}_rate = 0;".into()],
                equations: vec![
                    "{tau}*der({}_force) = {}_rate;".into(),
                    "{tau}*der({}_rate) = @in - {}_force - 2*{zeta}*{}_rate;".into(),
                ],
                drive_at_start: Some("@command"),
                ..drive("{}_force")
            },
            "input-delay" => Self { drive_at_start: Some("@in"), ..drive("delay(@in, {T_d})") },
            "encoder" => Self {
                shown: "@in + {a}*sin(2*pi*(@in)/{p}) + {b}*cos(2*pi*(@in)/{p})".into(),
                ..Self::default()
            },
            "encoder:harmonics" => Self {
                shown: "@in + {a}*sin(2*pi*(@in)/{p}) + {b}*cos(2*pi*(@in)/{p}) \
                        + {a_2}*sin(4*pi*(@in)/{p}) + {b_2}*cos(4*pi*(@in)/{p})"
                    .into(),
                ..Self::default()
            },
            "flexible-coupling" => coupling(),
            "flexible-coupling:friction" => coupling_with_friction(""),
            "flexible-coupling:load" => coupling_with_friction("{}_x"),
            "backlash:two-mass" => gap_with_load(),
            "presliding" => contact(Contact::Spring { at_rest: false }),
            "presliding:static" => contact(Contact::Spring { at_rest: true }),
            "presliding:dahl" => contact(Contact::Bristle { damped: false }),
            "presliding:lugre" => contact(Contact::Bristle { damped: true }),
            "presliding:maxwell-slip" => contact(Contact::Springs),
            "stribeck:free" => free_hump(term),
            _ => return Err(why(term)),
        })
    }
}

fn why(term: &ModelEffect) -> &'static str {
    match term.effect().about().slots.first() {
        Some(Slot::Contact) => "the free curve of a contact has no law in closed form",
        _ => "a law of one's own, or of a recorded signal, is not translated to Modelica",
    }
}

fn drive(law: &str) -> Part {
    Part { drive: law.to_owned(), ..Part::default() }
}

fn contact(contact: Contact) -> Part {
    Part { contact: Some(contact), ..Part::default() }
}

fn hump(share: &str) -> Part {
    Part { level: format!("{{dF}}*@bond{share}"), hump: share.to_owned(), ..Part::default() }
}

fn waves(harmonics: usize) -> String {
    let wave =
        |k: usize| format!("{{a_{k}}}*sin({k}*2*pi*x/{{l}}) + {{b_{k}}}*cos({k}*2*pi*x/{{l}})");
    (1..=harmonics).map(wave).collect::<Vec<String>>().join(" + ")
}

fn cosines(count: usize) -> String {
    let cosine = |k: usize| format!("{{c_{k}}}*cos({k}*pi*{{}}_u)");
    (1..=count).map(cosine).collect::<Vec<String>>().join(" + ")
}

/// Where on the stroke, 0..1.
fn along_stroke() -> Part {
    Part {
        declared: vec!["Real {}_u \"share of the stroke\";".into()],
        equations: vec!["{}_u = max(0, min(1, (x - {start})/({end} - {start})));".into()],
        ..Part::default()
    }
}

/// The hump as hats over `asinh(|w|/(0.002 v_high))`: a sum of ramps between its knots.
fn free_hump(term: &ModelEffect) -> Part {
    use crate::effects::stribeck::KNOT_SPEEDS;
    let name = term.name();
    let place = |share: f64| (share / 0.002).asinh();
    let count = KNOT_SPEEDS.len();
    let knots: Vec<f64> = KNOT_SPEEDS.iter().copied().chain([1.0]).map(place).collect();
    let mut sum = parameter(name, "c_0");
    for k in 0..count {
        let (from, way) = (knots[k], knots[k + 1] - knots[k]);
        let last = parameter(name, &format!("c_{k}"));
        let rise = if k + 1 < count {
            format!("({} - {last})", parameter(name, &format!("c_{}", k + 1)))
        } else {
            format!("(-{last})")
        };
        // Writing to a string cannot fail.
        let _ = write!(sum, " + {rise}*max(0, min(1, (@z - {from:?})/{way:?}))");
    }
    // Modelica has no asinh.
    let z = "log(abs(@w)/(0.002*{v_high}) + sqrt((@w/(0.002*{v_high}))^2 + 1))";
    Part {
        level: format!("({sum})"),
        declared: vec!["Real {}_z \"speed, as the knots are spaced\";".into()],
        equations: vec![format!("{{}}_z = {z};")],
        ..Part::default()
    }
}

/// While it slides the time at rest stands still, so that one law holds then and at rest.
fn bond() -> Part {
    Part {
        bond: "{}_b".into(),
        reads_dwell: true,
        declared: vec![
            "Real {}_b \"share of the hump that has grown back\";".into(),
            "discrete Real {}_left(start=1, fixed=true) \"share that the last slide left\";".into(),
        ],
        equations: vec![
            "{}_b = pre({}_left) + (1 - pre({}_left))*dwell/(dwell + {gamma});".into(),
            "when not slides then\n  {}_left = {}_b*@hump;\nend when;".into(),
        ],
        ..Part::default()
    }
}

/// A level that follows the speed with a lag, and what is added to it.
fn lagging(level: &str) -> Part {
    Part {
        level_velocity: "{}_w".into(),
        level: level.into(),
        declared: vec!["Real {}_w \"speed that friction follows\";".into()],
        initial: vec!["{}_w = abs(v);".into()],
        equations: vec!["{tau_L}*der({}_w) = abs(v) - {}_w;".into()],
        ..Part::default()
    }
}

/// A force beside friction that turns around over `{l}`; `goes` is its share's slope times the velocity.
fn hysteresis(goes: &str) -> Part {
    Part {
        level: "{F_h}*@s*{}_h".into(),
        reads_sliding: true,
        declared: vec!["Real {}_h \"share of the force, -1..1\";".into()],
        initial: vec!["{}_h = sign(v);".into()],
        equations: vec![format!("der({{}}_h) = if slides then ({goes})/{{l}} else 0;")],
        ..Part::default()
    }
}

fn reversal() -> Part {
    Part {
        level: "{F_r}*(if @s*pre({}_last) < 0 then 1 else {}_share)".into(),
        level_at_start: Some(""),
        reads_sliding: true,
        declared: vec![
            "Real {}_share(start=if @velocity > 0 or @velocity < 0 then 0 else 1, fixed=true) \"what is left of the force after the last reversal\";".into(),
            "Integer {}_last(start=if @velocity > 0 then 1 elseif @velocity < 0 then -1 else 0, fixed=true) \"direction of the last slide\";".into(),
        ],
        equations: vec![
            "der({}_share) = if slides then -abs(v)/{l}*{}_share else 0;".into(),
            "when slides then\n  {}_last = if @sliding > 0 then 1 else -1;\n  reinit({}_share, if pre({}_last)*@sliding < 0 then 1 else {}_share);\nend when;".into(),
        ],
        ..Part::default()
    }
}

fn gap_without_load() -> Part {
    Part {
        jumps: true,
        level: "(if @s*{}_place < 0.5 then -{F_L} else 0)".into(),
        declared: vec!["Real {}_place \"of the drive in the gap, -0.5..0.5\";".into()],
        initial: vec!["{}_place = 0.5*sign(v);".into()],
        equations: vec![
            "der({}_place) = if {}_place >= 0.5 and v > 0 or {}_place <= -0.5 and v < 0 then 0 else v/{b};"
                .into(),
        ],
        ..Part::default()
    }
}

/// Written per mass of the load, which may be nothing.
fn coupling() -> Part {
    Part {
        pull: "{m_L}*{}_a".into(),
        declared: vec![
            "Real {}_x \"position of the load\";".into(),
            "Real {}_v \"velocity of the load\";".into(),
            "Real {}_a \"acceleration of the load\";".into(),
        ],
        initial: vec!["{}_x = x;".into(), "{}_v = v;".into()],
        equations: vec![
            "der({}_x) = {}_v;".into(),
            "der({}_v) = {}_a;".into(),
            "{}_a = (2*pi*{f})^2*(x - {}_x) + 2*{zeta}*2*pi*{f}*(v - {}_v);".into(),
        ],
        ..Part::default()
    }
}

/// A load with friction of its own.
fn load(start: &str, pull: &str) -> Part {
    let mut part = Part { pull: "{}_pull".into(), ..Part::default() };
    part.declared.extend(LOAD[..5].iter().map(|line| (*line).to_owned()));
    part.initial = vec![start.to_owned(), "{}_v = v;".to_owned(), LOAD[5].to_owned()];
    part.equations.push(format!("{{}}_pull = {pull};"));
    part.equations.extend(LOAD[6..].iter().map(|line| (*line).to_owned()));
    part
}

fn coupling_with_friction(shown: &str) -> Part {
    let part = load(
        "{}_x = x - ({F_L}*sign(v) + {d_L}*v)/({m_L}*(2*pi*{f})^2);",
        "{m_L}*(2*pi*{f})^2*(x - {}_x) + 2*{zeta}*{m_L}*2*pi*{f}*(v - {}_v)",
    );
    Part { shown: shown.to_owned(), ..part }
}

/// Either end of the gap pushes, and never pulls.
fn gap_with_load() -> Part {
    let end = |side: &str, most: &str| {
        format!(
            "{most}(0, {{k}}*(x - {{}}_x {side} 0.5*{{b}}) + 2*{{zeta}}*sqrt({{k}}*{{m_L}})*(v - {{}}_v))"
        )
    };
    load(
        "{}_x = x - 0.5*{b}*sign(v) - ({F_L}*sign(v) + {d_L}*v)/{k};",
        &format!(
            "if x - {{}}_x > 0.5*{{b}} then {} elseif x - {{}}_x < -0.5*{{b}} then {} else 0",
            end("-", "max"),
            end("+", "min")
        ),
    )
}
