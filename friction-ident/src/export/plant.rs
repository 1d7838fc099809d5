//! The plant as C: the simulator's step for one plant, and what the effects of a model do in it.

use std::fmt::Write as _;

use super::ExportError;
use super::constants::{filled, number};
use super::dynamics::{constants, dynamics, with_states};
use crate::effects::{CDynamics, CLaw};
use crate::model::{Model, ModelEffect};

const HEADER: &str = include_str!("c/plant.h");
const SOURCE: &str = include_str!("c/plant.c");
const RIGID: &str = include_str!("c/rigid_step.c");
const ELEMENTS: &str = include_str!("c/elements.c");
const ELASTIC: &str = include_str!("c/elastic_step.c");

/// A term with its place in the arrays of the plant.
struct Piece<'a> {
    term: &'a ModelEffect,
    law: CLaw,
    dynamics: CDynamics,
    first_parameter: usize,
    first_state: usize,
}

/// A model as a plant in C.
pub(super) struct Plant<'a> {
    model: &'a Model,
    pieces: Vec<Piece<'a>>,
}

impl<'a> Plant<'a> {
    /// # Errors
    /// Effects that are not written in C, all of them at once; a model without a mass of its own.
    pub fn new(model: &'a Model) -> Result<Self, ExportError> {
        if model.timing().is_some() {
            return Err(ExportError::NoPlant);
        }
        let unknown: Vec<String> = (model.terms().iter())
            .filter(|term| dynamics(term).is_none())
            .map(|term| term.name().to_owned())
            .collect();
        if !unknown.is_empty() {
            return Err(ExportError::NoLaw(unknown));
        }
        let (mut parameter, mut state) = (1, 0);
        let mut pieces = Vec::new();
        for term in model.terms() {
            let (law, dynamics) =
                (term.effect().c_law().unwrap_or_default(), dynamics(term).unwrap_or_default());
            let (first_parameter, first_state) = (parameter, state);
            pieces.push(Piece { term, law, dynamics, first_parameter, first_state });
            parameter += term.values().len();
            state += dynamics.states;
        }
        Ok(Self { model, pieces })
    }

    /// Whether it starts with an elastic contact.
    pub fn has_contact(&self) -> bool {
        self.contact().is_some()
    }

    fn contact(&self) -> Option<&Piece<'a>> {
        self.pieces.iter().find(|piece| !piece.dynamics.sliding.is_empty())
    }

    fn attached(&self) -> impl Iterator<Item = &Piece<'a>> {
        self.pieces.iter().filter(|piece| piece.dynamics.attached)
    }

    /// `plant.h`.
    pub fn header(&self) -> String {
        let states: usize = self.pieces.iter().map(|piece| piece.dynamics.states).sum();
        HEADER
            .replace("@PARAMETERS@", &self.model.values().len().to_string())
            .replace("@STATES@", &states.max(1).to_string())
    }

    /// `plant.c`; `about` are the lines of the comment at its head.
    pub fn source(&self, about: &[String]) -> String {
        let about: Vec<String> = about.iter().map(|line| format!(" * {line}")).collect();
        let names: Vec<String> =
            self.model.addresses().iter().map(|address| format!("\n    \"{address}\"")).collect();
        let values: Vec<String> =
            self.model.values().iter().map(|value| format!("\n    {}", number(*value))).collect();
        let rigid = self.contact().is_none();
        let flag = |on: bool| if on { "1" } else { "0" };
        let attached = self.attached().next().is_some();
        // A contact that is the only element solves the balance in closed form where it can.
        let solve = self.contact().filter(|c| !attached && !c.dynamics.solve.is_empty());
        let breakaway = self.contact().is_some_and(|c| c.dynamics.breakaway);
        let iterations = self.pieces.iter().map(|piece| piece.dynamics.iterations).max();
        let step = if rigid { RIGID.to_owned() } else { self.elastic(solve) };
        let sliding = if rigid {
            "start->v != 0.0 ? 1.0 : 0.0"
        } else {
            "start->v != 0.0 && fabs(start->used) >= 1.0 ? 1.0 : 0.0"
        };
        let (keep, pasts, free) = self.pasts();
        let newton = attached || (!rigid && solve.is_none());
        SOURCE
            .replace("@ELEMENTS@", if newton { ELEMENTS } else { "" })
            .replace("@STEP@", &step)
            .replace("@ABOUT@", &about.join("\n"))
            .replace("@CONSTANTS@", &self.constants())
            .replace("@NAMES@", &names.join(","))
            .replace("@VALUES@", &values.join(","))
            .replace("@HELPERS@", &self.helpers())
            .replace("@SMOOTH@", &self.laws(|law| vec![law.smooth, law.damping]))
            .replace("@LEVEL@", &self.laws(|law| vec![law.level]))
            .replace("@DRIVE@", &self.states(|d| d.drive))
            .replace("@START@", &self.states(|d| d.start))
            .replace("@LOAD@", &self.elements(|d| d.load))
            .replace("@RECALL@", &self.states(|d| d.recall))
            .replace("@HUMP@", &self.hump())
            .replace("@REMEMBER@", &self.states(|d| d.remember))
            .replace("@RESPOND@", &self.elements(|d| d.respond))
            .replace("@COMMIT@", &self.elements(|d| d.commit))
            .replace("@SHOWN@", &self.shown())
            .replace("@BREAKAWAY@", flag(breakaway))
            .replace("@ATTACHED@", flag(attached))
            .replace("@ITERATIONS@", &iterations.unwrap_or(0).to_string())
            .replace("@SLIDES@", sliding)
            .replace("@KEEP@", &keep)
            .replace("@PASTS@", &pasts)
            .replace("@FREE@", &free)
    }

    fn elastic(&self, solve: Option<&Piece<'a>>) -> String {
        let Some(contact) = self.contact() else { return String::new() };
        let of = |text: &str| {
            with_states(contact.term, text, contact.first_state, contact.dynamics.states)
        };
        let solver = solve.map_or(String::new(), |_| {
            format!(
                "/* The balance with the contact, in closed form. */\nstatic void solve(Plant *m)\n{{\n{}}}\n\n",
                indented(&of(contact.dynamics.solve))
            )
        });
        let solves = if solve.is_some() { "1" } else { "0" };
        solver
            + &ELASTIC
                .replace("@SLIDING@", &of(contact.dynamics.sliding))
                .replace("@SOLVES@", solves)
    }

    fn constants(&self) -> String {
        let (axis, effort) = (self.model.axis(), self.model.effort());
        let of = |piece: &Piece<'_>| {
            let parameters = piece.term.effect().about().parameters;
            constants(piece.term, piece.first_parameter, |k| {
                effort.unit(axis, parameters[k].quantity)
            })
        };
        self.pieces.iter().map(of).collect()
    }

    /// The functions that the effects need, each once.
    fn helpers(&self) -> String {
        let mut helpers: Vec<&str> = Vec::new();
        for helper in self.pieces.iter().flat_map(|piece| piece.dynamics.helpers) {
            if !helpers.contains(helper) {
                helpers.push(helper);
            }
        }
        helpers.concat()
    }

    fn laws(&self, part: impl Fn(&CLaw) -> Vec<&'static str>) -> String {
        let of = |piece: &Piece<'_>| -> String {
            let parts = part(&piece.law).into_iter().filter(|text| !text.is_empty());
            // Parameters can be set: what is constant to the compensator is none here.
            let own = |text: &str| text.replace("static const double ", "const double ");
            parts.map(|text| indented(&filled(piece.term, &own(text)))).collect()
        };
        self.pieces.iter().map(of).collect()
    }

    fn states(&self, part: impl Fn(&CDynamics) -> &'static str) -> String {
        self.pieces.iter().map(|piece| statements(piece, part(&piece.dynamics))).collect()
    }

    /// The same of elements: other bodies first, the contact last.
    fn elements(&self, part: impl Fn(&CDynamics) -> &'static str) -> String {
        self.attached()
            .chain(self.contact())
            .map(|piece| statements(piece, part(&piece.dynamics)))
            .collect()
    }

    /// What the encoder is on, then the encoder.
    fn shown(&self) -> String {
        let sensors = self.pieces.iter().filter(|piece| !piece.dynamics.attached);
        self.attached()
            .chain(sensors)
            .map(|piece| statements(piece, piece.dynamics.shown))
            .collect()
    }

    fn hump(&self) -> String {
        // The last hump there is counts, as in the simulator.
        let hump = self.pieces.iter().rev().find(|piece| !piece.law.hump.is_empty());
        hump.map_or(String::new(), |piece| {
            indented(&format!("m->hump = {};", filled(piece.term, piece.law.hump)))
        })
    }

    /// What keeps, starts and frees the pasts.
    fn pasts(&self) -> (String, String, String) {
        let (mut keep, mut start, mut free) = (String::new(), String::new(), String::new());
        let slow: Vec<String> = (self.pieces.iter())
            .filter(|piece| !piece.dynamics.slow.is_empty())
            .map(|piece| filled(piece.term, piece.dynamics.slow))
            .collect();
        let longest = slow.into_iter().reduce(|a, b| format!("fmax({a}, {b})"));
        if let Some(longest) = longest {
            keep += &indented("if (!past_push(&m->slow, m->time, m->v)) {\n    return 0;\n}");
            start += &indented(&format!(
                "if (!past_start(&m->slow, {longest}, m->time, m->v, 0.0)) {{\n    return 0;\n}}"
            ));
            free += &indented("free(m->slow.time);\nfree(m->slow.value);");
        }
        let input = self.pieces.iter().find(|piece| !piece.dynamics.input.is_empty());
        if let Some(piece) = input {
            let length = filled(piece.term, piece.dynamics.input);
            // The integral of a command that has always been there.
            start += &indented(&format!(
                "if (!past_start(&m->input, {length}, m->time, 0.0, start->command)) {{\n    return 0;\n}}"
            ));
            free += &indented("free(m->input.time);\nfree(m->input.value);");
        }
        (keep, start, free)
    }
}

fn statements(piece: &Piece<'_>, text: &str) -> String {
    if text.is_empty() {
        return String::new();
    }
    indented(&with_states(piece.term, text, piece.first_state, piece.dynamics.states))
}

fn indented(text: &str) -> String {
    let mut out = String::new();
    for line in text.lines() {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "    {line}");
    }
    out
}
