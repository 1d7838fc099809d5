//! The text of the C files.

use std::fmt::Write as _;

use super::super::compensator::Compensator;
use super::{ExportError, Units};
use crate::axis::Axis;
use crate::effects::CLaw;
use crate::export::constants::{constant, filled, number};
use crate::model::ModelEffect;

/// Contacts that are written in C, and whether they break at the level at rest.
const CONTACTS: [(&str, bool); 2] = [("presliding", false), ("presliding:static", true)];

pub(super) struct Writer<'a> {
    compensator: &'a Compensator,
    units: Units,
    name: &'a str,
    laws: Vec<(&'a ModelEffect, CLaw)>,
    /// Whether the contact breaks at the level at rest; none without a contact.
    contact: Option<bool>,
}

impl<'a> Writer<'a> {
    pub fn new(
        compensator: &'a Compensator,
        units: Units,
        name: &'a str,
    ) -> Result<Self, ExportError> {
        let of = |term: &'a ModelEffect| {
            let law =
                term.effect().c_law().ok_or_else(|| ExportError::Effect(term.name().to_owned()))?;
            Ok((term, law))
        };
        let laws = compensator.terms().iter().map(of).collect::<Result<_, ExportError>>()?;
        let contact = match compensator.contact() {
            None => None,
            Some(contact) => {
                let name = contact.term().name();
                let known = CONTACTS.iter().find(|(known, _)| *known == name);
                Some(known.ok_or_else(|| ExportError::Contact(name.to_owned()))?.1)
            }
        };
        Ok(Self { compensator, units, name, laws, contact })
    }

    pub fn header(&self) -> String {
        let (name, guard, units) = (self.name, self.name.to_uppercase(), self.units);
        let effects: Vec<&str> =
            self.laws.iter().map(|(term, _)| term.name()).chain(self.contact_name()).collect();
        let left_out: Vec<String> = self
            .compensator
            .left_out()
            .iter()
            .map(|left| format!("{} ({})", left.effect, left.why))
            .collect();
        let left_out = if left_out.is_empty() { "nothing".to_owned() } else { left_out.join(", ") };
        format!(
            "/* Friction compensator, written by aep export. C99, no allocation, no global state.\n\
             \x20*\n\
             \x20* Effects: {}.\n\
             \x20* Left out: {left_out}.\n\
             \x20* Sampling time {:e} s, stick up to a measured speed of {:e} {}.\n\
             \x20*\n\
             \x20* Use: {name}_init once; then, every sampling time, add the result of {name}_force to the\n\
             \x20* command of the controller.\n\
             \x20*/\n\
             #ifndef {guard}_H\n\
             #define {guard}_H\n\
             \n\
             #ifdef __cplusplus\n\
             extern \"C\" {{\n\
             #endif\n\
             \n\
             typedef struct {{\n{}}} {name}_t;\n\
             \n\
             /* Puts the compensator to rest. */\n\
             void {name}_init({name}_t *c);\n\
             \n\
             /* Force to be added to the command, {}.\n\
             \x20* reference: position of the reference, {}\n\
             \x20* reference_velocity: its velocity, {}\n\
             \x20* position: as the encoder shows it, {} */\n\
             double {name}_force({name}_t *c, double reference, double reference_velocity, double position);\n\
             \n\
             #ifdef __cplusplus\n\
             }}\n\
             #endif\n\
             \n\
             #endif\n",
            effects.join(", "),
            self.compensator.settings().sample_time,
            self.compensator.settings().critical_velocity,
            units.velocity,
            self.members(),
            units.force,
            units.length,
            units.velocity,
            units.length,
        )
    }

    fn contact_name(&self) -> Option<&str> {
        self.compensator.contact().map(|contact| contact.term().name())
    }

    fn members(&self) -> String {
        let units = self.units;
        let mut text = format!(
            "    int started; /* 1 after the first sample */\n    \
             double last_position; /* {} */\n    \
             int slips; /* 1 while the measured speed is above the limit of stick */\n    \
             double dwell; /* s, length of this rest, or of the last one while slipping */\n    \
             double direction; /* of the reference's last motion, -1, 0 or 1 */\n",
            units.length
        );
        let bond = self.compensator.bond().is_some();
        if let Some(delay) = self.compensator.follower().delay() {
            let (samples, unit) = (delay.length(), units.velocity);
            let _ = writeln!(text, "    int head; /* of the delay lines */");
            let _ = writeln!(text, "    double desired[{samples}]; /* {unit} */");
            if bond {
                let _ = writeln!(text, "    double measured[{samples}]; /* {unit} */");
            }
        } else if self.compensator.follower().decay().is_some() {
            let _ = writeln!(text, "    double desired; /* {} */", units.velocity);
            if bond {
                let _ = writeln!(text, "    double measured; /* {} */", units.velocity);
            }
        }
        if bond {
            text.push_str(
                "    int slipped; /* state of the sample before */\n    \
                 double left; /* 0..1, what the last slide left of the static hump */\n    \
                 double formed; /* 0..1, what there is of it */\n",
            );
        }
        if self.contact.is_some() {
            let _ = write!(
                text,
                "    double path; /* {}, desired position in the middle of the last interval */\n    \
                 double held; /* {}, force of the elastic contact */\n    \
                 int slides; /* 1 while the contact slides */\n",
                units.length, units.force
            );
        }
        text
    }

    pub fn source(&self) -> String {
        let name = self.name;
        let parts = [
            format!(
                "/* See {name}.h. Compile with -ffp-contract=off where the test vectors are to be met to\n\
                 \x20* the last digit: fused operations round once instead of twice. */\n\
                 #include \"{name}.h\"\n\n#include <math.h>\n\n"
            ),
            self.constants(),
            self.smooth(),
            self.level(),
            self.memories(),
            self.contact(),
            self.init(),
            self.force(),
        ];
        parts.concat()
    }

    fn constants(&self) -> String {
        let settings = self.compensator.settings();
        let mut text = format!(
            "#define SAMPLE_TIME {} /* s */\n#define CRITICAL_VELOCITY {} /* {} */\n",
            number(settings.sample_time),
            number(settings.critical_velocity),
            self.units.velocity
        );
        let axis = if self.units.length == "rad" { Axis::Rotary } else { Axis::Linear };
        let contact = self.compensator.contact().map(super::super::contact::Contact::term);
        for term in self.laws.iter().map(|(term, _)| *term).chain(contact) {
            for (parameter, value) in term.effect().about().parameters.iter().zip(term.values()) {
                let _ = writeln!(
                    text,
                    "#define {} {} /* {}: {} */",
                    constant(term.name(), parameter.name),
                    number(*value),
                    axis.unit(parameter.quantity),
                    parameter.meaning,
                );
            }
        }
        if let Some(delay) = self.compensator.follower().delay() {
            let _ = write!(
                text,
                "#define LINE {} /* samples */\n#define FRACTION {} /* of a sample beyond the whole ones */\n",
                delay.length(),
                number(delay.fraction())
            );
        }
        if let Some(decay) = self.compensator.follower().decay() {
            let _ = writeln!(text, "#define DECAY {} /* per sample */", number(decay));
        }
        text + "\n"
    }

    fn smooth(&self) -> String {
        format!(
            "/* Forces of position x and velocity v, {}. */\n\
             static double smooth(double x, double v)\n{{\n    double force = 0.0;\n    (void)x;\n    (void)v;\n{}    return force;\n}}\n\n",
            self.units.force,
            self.statements(|law| law.smooth)
        )
    }

    fn level(&self) -> String {
        format!(
            "/* Friction level, {}, in direction s where the level follows the velocity w. */\n\
             static double friction_level(double x, double s, double w, double dwell, double bond)\n{{\n    \
             double level = 0.0;\n    (void)x;\n    (void)s;\n    (void)w;\n    (void)dwell;\n    (void)bond;\n\
             {}    return level > 0.0 ? level : 0.0;\n}}\n\n",
            self.units.force,
            self.statements(|law| law.level)
        )
    }

    fn statements(&self, part: impl Fn(&CLaw) -> &'static str) -> String {
        let mut text = String::new();
        for (term, law) in &self.laws {
            for line in filled(term, part(law)).lines() {
                let _ = writeln!(text, "    {line}");
            }
        }
        text
    }

    /// What the level remembers.
    fn memories(&self) -> String {
        let mut text = String::new();
        if self.compensator.follower().delay().is_some() {
            text.push_str(
                "/* Velocity a while ago; 0 before the first sample. */\n\
                 static double delayed(double *line, int head, double velocity)\n{\n    \
                 double oldest, younger;\n    line[head] = velocity;\n    oldest = line[(head + 1) % LINE];\n    \
                 younger = line[(head + 2) % LINE];\n    return younger + FRACTION * (oldest - younger);\n}\n\n",
            );
        }
        if let Some(bond) = self.compensator.bond() {
            let mut humps = self.laws.iter().filter(|(_, law)| !law.hump.is_empty());
            let hump = humps.next_back().map_or("1.0".to_owned(), |(t, law)| filled(t, law.hump));
            let _ = write!(
                text,
                "/* Takes the state of the motion; w is the velocity that the slide followed. Gives what there is\n\
                 \x20* of the static hump, 0..1. */\n\
                 static double bond_of({name}_t *c, double w)\n{{\n    (void)w;\n    \
                 if (c->slipped && !c->slips) {{\n        c->left = c->formed * ({hump});\n    }}\n    \
                 if (!(c->slipped && c->slips)) {{\n        \
                 c->formed = c->left + (1.0 - c->left) * (c->dwell / (c->dwell + {gamma}));\n    }}\n    \
                 c->slipped = c->slips;\n    return c->formed;\n}}\n\n",
                name = self.name,
                gamma = number(bond.gamma()),
            );
        }
        text
    }

    fn contact(&self) -> String {
        let (Some(breaks_at_rest), Some(contact)) = (self.contact, self.compensator.contact())
        else {
            return String::new();
        };
        let stiffness = constant(contact.term().name(), "k_t");
        let hold = if breaks_at_rest { "breakaway" } else { "level" };
        format!(
            "/* Bends the elastic contact by the desired path to x; it holds up to the level{at_rest} and then\n\
             \x20* slides. Gives its force, {force}. */\n\
             static double bend({name}_t *c, double x, double level, double breakaway)\n{{\n    \
             const double hold = {hold} > level ? {hold} : level;\n    \
             const double start_cap = c->slides ? level : hold;\n    \
             const double raised = c->held > -start_cap ? c->held : -start_cap;\n    \
             const double start = raised < start_cap ? raised : start_cap;\n    \
             const double trial = start + {stiffness} * (x - c->path);\n    \
             const int goes_on = c->slides && trial * start >= start * start;\n    \
             const double cap = goes_on ? level : hold;\n    \
             const int breaks = fabs(trial) > cap;\n    \
             (void)breakaway;\n    \
             c->held = breaks ? (trial < 0.0 ? -level : level) : trial;\n    \
             c->slides = breaks || (goes_on && fabs(trial) >= level);\n    \
             c->path = x;\n    return c->held;\n}}\n\n",
            at_rest = if breaks_at_rest { " at rest" } else { "" },
            force = self.units.force,
            name = self.name,
        )
    }

    fn init(&self) -> String {
        let mut text = format!("void {0}_init({0}_t *c)\n{{\n", self.name);
        let bond = self.compensator.bond().is_some();
        let delay = self.compensator.follower().delay().is_some();
        let lag = self.compensator.follower().decay().is_some();
        let mut line = |words: &str| {
            let _ = writeln!(text, "    {words}");
        };
        if delay {
            line("int k;");
            line("for (k = 0; k < LINE; k++) {");
            line("    c->desired[k] = 0.0;");
            if bond {
                line("    c->measured[k] = 0.0;");
            }
            line("}");
            line("c->head = 0;");
        } else if lag {
            line("c->desired = 0.0;");
            if bond {
                line("c->measured = 0.0;");
            }
        }
        line("c->started = 0;");
        line("c->last_position = 0.0;");
        line("c->slips = 0;");
        line("c->dwell = 0.0;");
        line("c->direction = 0.0;");
        if bond {
            line("c->slipped = 0;");
            line("c->left = 1.0;");
            line("c->formed = 1.0;");
        }
        if self.contact.is_some() {
            line("c->path = 0.0;");
            line("c->held = 0.0;");
            line("c->slides = 0;");
        }
        text + "}\n\n"
    }

    fn force(&self) -> String {
        let mut text = format!(
            "double {0}_force({0}_t *c, double reference, double reference_velocity, double position)\n{{\n",
            self.name
        );
        let bond = self.compensator.bond().is_some();
        let delay = self.compensator.follower().delay().is_some();
        let lag = self.compensator.follower().decay().is_some();
        let mut line = |words: &str| {
            let _ = writeln!(text, "    {words}");
        };
        line("const double last = c->started ? c->last_position : position;");
        line("const double measured = (position - last) / SAMPLE_TIME;");
        line("const int slips = fabs(measured) > CRITICAL_VELOCITY;");
        line("const double middle = reference + 0.5 * SAMPLE_TIME * reference_velocity;");
        line("const double s = (double)((reference_velocity > 0.0) - (reference_velocity < 0.0));");
        line(if bond { "double w, bond, force, level;" } else { "double w, force, level;" });
        line("");
        line("/* Stick or slip, and for how long. */");
        line("if (!c->slips && !slips) {");
        line("    c->dwell += SAMPLE_TIME;");
        line("} else if (c->slips && !slips) {");
        line("    c->dwell = 0.0;");
        line("}");
        line("c->slips = slips;");
        if self.contact.is_some() {
            line("if (!c->started) {");
            line("    c->path = reference;");
            line("}");
        }
        line("c->last_position = position;");
        line("c->started = 1;");
        line("if (s != 0.0) {");
        line("    c->direction = s;");
        line("}");
        line("");
        line("/* What the level remembers. */");
        if delay {
            line("w = delayed(c->desired, c->head, reference_velocity);");
            if bond {
                line("bond = bond_of(c, delayed(c->measured, c->head, measured));");
            }
            line("c->head = (c->head + 1) % LINE;");
        } else if lag {
            line(
                "c->desired = fabs(reference_velocity) + (c->desired - fabs(reference_velocity)) * DECAY;",
            );
            line("w = c->desired;");
            if bond {
                line("c->measured = fabs(measured) + (c->measured - fabs(measured)) * DECAY;");
                line("bond = bond_of(c, c->measured);");
            }
        } else {
            line("w = reference_velocity;");
            if bond {
                line("bond = bond_of(c, measured);");
            }
        }
        line("");
        line("/* The friction along the desired motion. */");
        let bond = if bond { "bond" } else { "1.0" };
        line("force = smooth(middle, reference_velocity);");
        line(&format!("level = friction_level(middle, c->direction, w, c->dwell, {bond});"));
        if self.contact.is_some() {
            line("return force");
            line(&format!(
                "    + bend(c, middle, level, friction_level(middle, c->direction, 0.0, c->dwell, {bond}));"
            ));
        } else {
            line("return force + level * s;");
        }
        text + "}\n"
    }

    pub fn test(&self) -> String {
        let (name, force) = (self.name, self.units.force);
        format!(
            "/* Runs the test vectors: {name}_test {name}_vectors.csv. Exit status 0 where every force agrees to\n\
             \x20* 1e-12 {force} (relative, above 1 {force}). */\n\
             #include <math.h>\n#include <stdio.h>\n\n#include \"{name}.h\"\n\n\
             int main(int argc, char **argv)\n{{\n    \
             char row[256];\n    {name}_t c;\n    FILE *file = argc == 2 ? fopen(argv[1], \"r\") : NULL;\n    \
             double worst = 0.0;\n    long rows = 0;\n\n    \
             if (file == NULL || fgets(row, sizeof row, file) == NULL) {{\n        \
             fprintf(stderr, \"usage: {name}_test {name}_vectors.csv\\n\");\n        return 2;\n    }}\n    \
             {name}_init(&c);\n    \
             while (fgets(row, sizeof row, file) != NULL) {{\n        \
             double reference, velocity, position, expected, off;\n        \
             if (sscanf(row, \"%lf,%lf,%lf,%lf\", &reference, &velocity, &position, &expected) != 4) {{\n            \
             fprintf(stderr, \"row %ld cannot be read\\n\", rows + 2);\n            return 2;\n        }}\n        \
             off = fabs({name}_force(&c, reference, velocity, position) - expected);\n        \
             off /= fabs(expected) > 1.0 ? fabs(expected) : 1.0;\n        \
             /* Not a number is the worst. */\n        \
             worst = off <= worst ? worst : off;\n        rows++;\n    }}\n    fclose(file);\n    \
             printf(\"%ld rows, largest deviation %g\\n\", rows, worst);\n    \
             return rows > 0 && worst <= 1e-12 ? 0 : 1;\n}}\n"
        )
    }
}
