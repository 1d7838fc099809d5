//! What effects with a state do, in C: drives, memories, elements and sensors, statement by statement as their hooks.

/// What an effect with a state does, or one that acts on drive or sensor, in C99; `{name}` stands for the constant of the
/// parameter `name`, `{s0}`, `{s1}` .. for its states. Statements do as the hooks of the effect do, in the order of their
/// operations.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct CDynamics {
    /// Number of its states.
    pub states: usize,
    /// Helpers that it needs, in this order: texts with functions, each put into a file once whoever asks for it.
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
    /// Newton iterations after a first solution.
    pub iterations: usize,
    /// Whether the contact holds up to the level at rest.
    pub breakaway: bool,
    /// Whether it is another body.
    pub attached: bool,
}

impl CDynamics {
    /// Nothing beside its law.
    pub const NONE: Self = Self {
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
}

/// Helper: `limited(value, most)`.
pub const LIMITED: &str = include_str!("../export/c/limited.c");
/// Helper: a load with friction over a step, whatever connects it.
pub const LOAD: &str = include_str!("../export/c/load.c");
/// Helper: `past_push` and `past_at`, what came before.
pub const PAST: &str = include_str!("../export/c/past.c");
