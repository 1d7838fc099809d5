//! What slides or sticks: rigid friction as a state machine, or an elastic contact in its place.

use super::part::Contact;

/// The friction level, in either direction.
#[derive(Clone, Debug)]
pub(super) struct Levels {
    /// A sum in which `@s` is the direction, `@w` the velocity that it follows, and `@bond` a factor of the hump.
    pub sum: String,
    /// The same before the first motion.
    pub at_start: String,
    /// What it follows in place of the velocity of the mass.
    pub velocity: String,
    /// The factor.
    pub bond: String,
    /// Share of the hump that is left, of `@w`.
    pub hump: String,
}

impl Levels {
    fn none(&self) -> bool {
        self.sum.is_empty()
    }

    /// Whether both directions have the same.
    fn even(&self) -> bool {
        !self.sum.contains("@s")
    }

    /// The name of what the level follows.
    fn followed(&self) -> &str {
        if self.velocity.is_empty() { "v" } else { "level_velocity" }
    }

    /// In a direction; at rest it follows no velocity.
    fn written(&self, direction: &str, at_rest: bool) -> String {
        if self.none() {
            return "0".to_owned();
        }
        let (w, z) = if at_rest { ("0", "0") } else { (self.followed(), "stribeck_free_z") };
        let bond = if self.bond.is_empty() { String::new() } else { format!("{}*", self.bond) };
        let sum = self.sum.replace("@s", direction).replace("@bond", &bond);
        format!("max(0, {})", sum.replace("@w", w).replace("@z", z))
    }

    /// At the start, at rest. What remembers nothing yet is left out: where a discrete variable stands in the
    /// level, the direction at the start would be an equation of itself.
    fn written_at_start(&self, direction: &str) -> String {
        if self.at_start.is_empty() {
            return "0".to_owned();
        }
        let sum = self.at_start.replace("@s", direction).replace("@bond", "");
        format!("max(0, {})", sum.replace("@w", "0").replace("@z", "0"))
    }
}

/// Friction of a model.
#[derive(Clone, Debug)]
pub(super) struct Friction {
    /// An elastic contact and the prefix of its parameters.
    pub contact: Option<(Contact, String)>,
    pub levels: Levels,
    /// Level per acceleration.
    pub carried: String,
    /// Whether something asks for how long it has been at rest, and whether it slides.
    pub dwells: bool,
    pub slides: bool,
}

/// Within which an elastic contact follows a level that falls: short against everything that a drive does, so that a
/// tenth of it changes nothing that is seen.
const RELAXATION: &str = "constant Real relaxation(unit=\"s\") = 1e-6 \"within which the contact follows a level that falls\";";

/// Springs of [`Contact::Springs`].
const SPRINGS: usize = 4;

impl Friction {
    /// What the marks of a text stand for.
    pub fn filled(&self, text: &str) -> String {
        let hump = if self.levels.hump.is_empty() { "1" } else { &self.levels.hump };
        let sliding = if self.contact.is_some() { "held" } else { "direction" };
        text.replace("@hump", &format!("({hump})"))
            .replace("@sliding", sliding)
            .replace("@w", self.levels.followed())
    }

    /// Whether nothing sticks.
    fn none(&self) -> bool {
        self.levels.none() && self.carried.is_empty() && self.contact.is_none()
    }

    fn level_names(&self) -> [&'static str; 2] {
        if self.levels.even() { ["level", "level"] } else { ["level_forward", "level_backward"] }
    }

    /// What the states of the contact are told apart by, and their stiffnesses.
    fn springs(&self) -> Vec<(String, String)> {
        let Some((contact, prefix)) = &self.contact else { return Vec::new() };
        match contact {
            Contact::Spring { .. } | Contact::Bristle { .. } => {
                vec![(String::new(), format!("{prefix}_k_t"))]
            }
            Contact::Springs => (1..=SPRINGS)
                .map(|k| {
                    let spread = format!("{prefix}_spread");
                    let sum = format!("(1 + 1/{spread} + 1/{spread}^2 + 1/{spread}^3)");
                    (format!("_{k}"), format!("{prefix}_k_t/{spread}^{}/{sum}", k - 1))
                })
                .collect(),
        }
    }

    pub fn declared(&self) -> Vec<String> {
        let mut lines = Vec::new();
        if self.none() {
            return lines;
        }
        let [forward, backward] = self.level_names();
        if self.levels.even() {
            lines.push("Real level \"friction level\";".to_owned());
        } else {
            lines.push(format!("Real {forward} \"friction level for v > 0\";"));
            lines.push(format!("Real {backward} \"friction level for v < 0\";"));
        }
        if !self.levels.velocity.is_empty() {
            lines.push("Real level_velocity \"velocity that the level follows\";".to_owned());
        }
        match &self.contact {
            None => {
                lines.push(
                    "Integer direction \"in which it slides, 0 while it sticks\";".to_owned(),
                );
                if !self.carried.is_empty() {
                    lines.push("Real left \"force that accelerates, and presses\";".to_owned());
                }
            }
            Some((contact, _)) => {
                if !self.levels.even() {
                    lines.push("Real level \"friction level\";".to_owned());
                }
                lines.push("Real held \"force of the contact\";".to_owned());
                if *contact == (Contact::Spring { at_rest: true }) {
                    lines.push("Real hold \"what it holds before it slides\";".to_owned());
                    lines.push("Boolean breaks(start=false, fixed=true) \"whether it has broken, and slides\";".to_owned());
                }
                if matches!(contact, Contact::Bristle { .. }) {
                    lines.push("Real rate \"of the bristle's force\";".to_owned());
                }
                lines.push(RELAXATION.to_owned());
            }
        }
        for (k, _) in self.springs().iter().filter(|_| self.contact.is_some()) {
            lines.push(format!(
                "Real elastic{k} \"force of the contact, not yet cut off at its level\";"
            ));
            lines.push(format!("Real spring{k} \"force of the contact, cut off\";"));
        }
        if self.slides {
            lines.push("Boolean slides \"whether the contact slides\";".to_owned());
        }
        if self.dwells {
            lines.push("Real dwell(start=0, fixed=true, unit=\"s\") \"time at rest\";".to_owned());
        }
        lines
    }

    /// Equations of the start: `velocity` is that of the mass, `applied` the force on it without friction levels.
    pub fn initial(&self, velocity: &str, applied: &str) -> Vec<String> {
        if self.none() {
            return Vec::new();
        }
        let [forward, backward] = ["1", "(-1)"].map(|s| self.levels.written_at_start(s));
        if self.contact.is_none() {
            return vec![format!(
                "pre(direction) = if {velocity} > 0 then 1 elseif {velocity} < 0 then -1 \
                 elseif {applied} > {forward} then 1 elseif {applied} < -{backward} then -1 else 0;"
            )];
        }
        let level = if self.levels.even() {
            forward
        } else {
            format!("if contact_start >= 0 then {forward} else {backward}")
        };
        let springs = self.springs();
        let count = springs.len();
        let of = |(k, _): &(String, String)| {
            let share = if count == 1 { String::new() } else { format!("/{count}") };
            format!("elastic{k} = contact_start*({level}){share};")
        };
        springs.iter().map(of).collect()
    }

    pub fn equations(&self) -> Vec<String> {
        if self.none() {
            return vec!["friction = 0;".to_owned(), "mass*a = applied;".to_owned()];
        }
        let mut lines = Vec::new();
        let [forward, backward] = self.level_names();
        lines.push(format!("{forward} = {};", self.levels.written("1", false)));
        if !self.levels.even() {
            lines.push(format!("{backward} = {};", self.levels.written("(-1)", false)));
        }
        if !self.levels.velocity.is_empty() {
            lines.push(format!("level_velocity = {};", self.levels.velocity));
        }
        match &self.contact {
            None => lines.extend(self.rigid()),
            Some((contact, prefix)) => {
                if !self.levels.even() {
                    lines.push(format!(
                        "level = if {} >= 0 then {forward} else {backward};",
                        self.side()
                    ));
                }
                lines.extend(self.elastic(*contact, prefix));
                lines.push("mass*a = applied - friction;".to_owned());
            }
        }
        if self.slides {
            let sliding = match &self.contact {
                None => "direction <> 0",
                Some((Contact::Spring { at_rest: true }, _)) => "breaks",
                Some((Contact::Spring { at_rest: false }, _)) => {
                    "elastic >= level or elastic <= -level"
                }
                // What only approaches its level never slides.
                Some(_) => "held >= 0.999*level or held <= -0.999*level",
            };
            lines.push(format!("slides = {sliding};"));
        }
        if self.dwells {
            lines.push("der(dwell) = if slides then 0 else 1;".to_owned());
            lines.push("when not slides then\n  reinit(dwell, 0);\nend when;".to_owned());
        }
        lines
    }

    fn rigid(&self) -> Vec<String> {
        let [forward, backward] = self.level_names();
        let slid = format!(
            "if direction == 1 then {forward} elseif direction == -1 then -{backward} else applied"
        );
        let machine = format!(
            "when pre(direction) == 0 and (applied > {forward} or applied < -{backward}) then\n  \
             direction = if applied > 0 then 1 else -1;\n\
             elsewhen pre(direction)*v < 0 then\n  direction = 0;\n  reinit(v, 0);\nend when;"
        );
        if self.carried.is_empty() {
            return vec![
                machine,
                format!("friction = {slid};"),
                "mass*a = applied - friction;".to_owned(),
            ];
        }
        // The level grows by c |a|: solved for a, whose sign is that of what is left.
        vec![
            machine,
            format!("left = applied - ({slid});"),
            format!("a = left/(mass + direction*sign(left)*({}));", self.carried),
            "friction = applied - mass*a;".to_owned(),
        ]
    }

    /// What tells the direction of the level: that in which the contact is bent. A level that jumped with the sign of
    /// the velocity would hold the mass at rest by events without end.
    fn side(&self) -> String {
        let springs: Vec<String> =
            self.springs().iter().map(|(k, _)| format!("elastic{k}")).collect();
        springs.join(" + ")
    }

    /// The spring is cut off at the level, and what is beyond fades at once, within [`RELAXATION`]: so it follows a
    /// level that falls, and holds again where the level rises faster than the spring is bent.
    fn elastic(&self, contact: Contact, prefix: &str) -> Vec<String> {
        let springs = self.springs();
        let mut lines = Vec::new();
        let mut cap = "level".to_owned();
        if contact == (Contact::Spring { at_rest: true }) {
            let [forward, backward] = ["1", "(-1)"].map(|s| self.levels.written(s, true));
            let at_rest = if self.levels.even() {
                forward
            } else {
                format!("if {} >= 0 then {forward} else {backward}", self.side())
            };
            lines.push(format!("hold = max(level, {at_rest});"));
            // Not beyond its level it holds; between that and what it holds at rest it does what it did.
            lines.push(
                "breaks = elastic > hold or elastic < -hold or pre(breaks) and (elastic > level or elastic < -level);"
                    .to_owned(),
            );
            "(if breaks then level else hold)".clone_into(&mut cap);
        }
        let count = springs.len();
        if count > 1 {
            cap = format!("level/{count}");
        }
        for (k, stiffness) in &springs {
            lines.push(format!("spring{k} = max(-{cap}, min({cap}, elastic{k}));"));
            let bent = if matches!(contact, Contact::Bristle { .. }) {
                "rate".to_owned()
            } else {
                format!("{stiffness}*v")
            };
            lines.push(format!("der(elastic{k}) = {bent} - (elastic{k} - spring{k})/relaxation;"));
        }
        let all: Vec<String> = springs.iter().map(|(k, _)| format!("spring{k}")).collect();
        lines.push(format!("held = {};", all.join(" + ")));
        let mut damping = String::new();
        if let Contact::Bristle { damped } = contact {
            lines.push(format!("rate = {prefix}_k_t*v*(1 - held*sign(v)/max(1e-10, level));"));
            if damped {
                damping = format!(" + {prefix}_sigma_1/{prefix}_k_t*rate");
            }
        }
        lines.push(format!("friction = held{damping};"));
        lines
    }
}
