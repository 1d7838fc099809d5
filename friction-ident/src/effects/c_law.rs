//! The law of an effect in C, statement by statement as its hooks compute it.

/// What an effect adds, in C99; `{name}` stands for the constant of the parameter `name`. The compensator computes the same
/// to the bit where operations come in the order of the hooks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CLaw {
    /// Statements that add to `force`, of `x` (position) and `v` (velocity); what no compensator acts on also of `t`.
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

impl CLaw {
    /// Nothing of its own: what it changes is computed elsewhere (a memory).
    pub const NONE: Self = Self { smooth: "", damping: "", level: "", hump: "" };

    /// A force of position and velocity.
    pub const fn smooth(smooth: &'static str) -> Self {
        Self { smooth, ..Self::NONE }
    }

    /// The slope of its force against the velocity.
    #[must_use]
    pub const fn damped(self, damping: &'static str) -> Self {
        Self { damping, ..self }
    }

    /// A level of friction.
    pub const fn level(level: &'static str) -> Self {
        Self { level, ..Self::NONE }
    }
}

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

pub(super) use profile;
