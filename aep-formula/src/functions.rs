//! The functions and constants of a formula: the one list of them.

/// A function.
#[derive(Clone, Copy, Debug)]
pub struct Function {
    /// Its name; case matters.
    pub name: &'static str,
    /// What it is, in words.
    pub about: &'static str,
    pub(crate) call: Call,
}

/// How it is called.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Call {
    One(fn(f64) -> f64),
    Two(fn(f64, f64) -> f64),
    Three(fn(f64, f64, f64) -> f64),
    /// Two or more arguments, from the left.
    Many(fn(f64, f64) -> f64),
}

impl Call {
    /// Fewest and most arguments.
    pub(crate) fn arguments(self) -> (usize, usize) {
        match self {
            Self::One(_) => (1, 1),
            Self::Two(_) => (2, 2),
            Self::Three(_) => (3, 3),
            Self::Many(_) => (2, usize::MAX),
        }
    }
}

const fn one(name: &'static str, about: &'static str, call: fn(f64) -> f64) -> Function {
    Function { name, about, call: Call::One(call) }
}

const fn two(name: &'static str, about: &'static str, call: fn(f64, f64) -> f64) -> Function {
    Function { name, about, call: Call::Two(call) }
}

const fn three(
    name: &'static str,
    about: &'static str,
    call: fn(f64, f64, f64) -> f64,
) -> Function {
    Function { name, about, call: Call::Three(call) }
}

const fn many(name: &'static str, about: &'static str, call: fn(f64, f64) -> f64) -> Function {
    Function { name, about, call: Call::Many(call) }
}

/// Every function.
pub const FUNCTIONS: &[Function] = &[
    one("abs", "abs(x)            size without sign", f64::abs),
    one("sign", "sign(x)           -1, 0 or 1", sign),
    many("min", "min(a, b, ..)     the least", f64::min),
    many("max", "max(a, b, ..)     the largest", f64::max),
    three("clamp", "clamp(x, low, high)  x, but within low .. high", clamp),
    three("if", "if(c, a, b)       a where c is not 0, else b", choose),
    one("sqrt", "sqrt(x)           square root", f64::sqrt),
    one("cbrt", "cbrt(x)           cube root", f64::cbrt),
    two("pow", "pow(a, b)         a to the power b", f64::powf),
    two("hypot", "hypot(a, b)       sqrt(a^2 + b^2)", f64::hypot),
    one("exp", "exp(x)            e to the power x", f64::exp),
    one("log", "log(x), ln(x)     natural logarithm", f64::ln),
    one("ln", "", f64::ln),
    one("log2", "log2(x)           logarithm to base 2", f64::log2),
    one("log10", "log10(x)          logarithm to base 10", f64::log10),
    one("sin", "sin(x)            x in rad, as for all of these", f64::sin),
    one("cos", "cos(x)", f64::cos),
    one("tan", "tan(x)", f64::tan),
    one("asin", "asin(x)", f64::asin),
    one("acos", "acos(x)", f64::acos),
    one("atan", "atan(x)", f64::atan),
    two("atan2", "atan2(y, x)       angle of the point (x, y)", f64::atan2),
    one("sinh", "sinh(x)", f64::sinh),
    one("cosh", "cosh(x)", f64::cosh),
    one("tanh", "tanh(x)", f64::tanh),
    one("asinh", "asinh(x)", f64::asinh),
    one("acosh", "acosh(x)", f64::acosh),
    one("atanh", "atanh(x)", f64::atanh),
    one("floor", "floor(x)          next whole number below", f64::floor),
    one("ceil", "ceil(x)           next whole number above", f64::ceil),
    one("round", "round(x)          nearest whole number", f64::round),
    one("trunc", "trunc(x)          x without its fraction", f64::trunc),
    one("fract", "fract(x)          the fraction", f64::fract),
    one("signum", "signum(x)         -1 or 1, by the sign bit", f64::signum),
];

/// Value of a constant: `pi`, `PI`, `TAU`, `E`. A column or a parameter of that name comes first.
pub fn constant(name: &str) -> Option<f64> {
    match name {
        "pi" | "PI" | "π" => Some(std::f64::consts::PI),
        "TAU" | "τ" => Some(std::f64::consts::TAU),
        "E" => Some(std::f64::consts::E),
        _ => None,
    }
}

fn sign(x: f64) -> f64 {
    if x == 0.0 { 0.0 } else { x.signum() }
}

/// Unlike the one of the standard library it takes any limits: the lower one counts where they are crossed.
fn clamp(x: f64, low: f64, high: f64) -> f64 {
    if x.is_nan() { x } else { x.min(high).max(low) }
}

fn choose(condition: f64, yes: f64, no: f64) -> f64 {
    if condition == 0.0 { no } else { yes }
}
