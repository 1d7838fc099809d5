//! The elastic contact of a model, taken along the desired path.

use crate::effects::{Onset, Parameters, Response, Step};
use crate::model::ModelEffect;

/// A contact at rest that is bent by what the desired path asks for.
#[derive(Clone, Debug)]
pub(super) struct Contact {
    term: ModelEffect,
    state: Vec<f64>,
    last: Option<f64>,
}

impl Contact {
    /// The contact of a term; none where the term has none.
    pub fn new(term: &ModelEffect) -> Option<Self> {
        let element = term.effect().element()?;
        Some(Self { term: term.clone(), state: vec![0.0; element.states()], last: None })
    }

    /// Its term.
    pub fn term(&self) -> &ModelEffect {
        &self.term
    }

    /// Follows the path to `position` (from `begin` at first), m or rad, in `duration` s at a friction
    /// `level` and one at rest, `breakaway`, N or N m. Gives the contact's force.
    pub fn follow(
        &mut self,
        begin: f64,
        position: f64,
        duration: f64,
        level: f64,
        breakaway: f64,
    ) -> f64 {
        let Some(element) = self.term.effect().element() else { return 0.0 };
        let values = self.term.values();
        let p = Parameters::new(values, 1);
        let last = self.last.unwrap_or_else(|| {
            element.start(values, &Onset { level, used: 0.0, velocity: 0.0 }, &mut self.state);
            begin
        });
        self.last = Some(position);
        let step = Step {
            duration: &[duration],
            open: &[duration],
            displacement: &[position - last],
            level: &[level],
            breakaway: &[breakaway],
        };
        let (mut force, mut stiffness) = ([0.0], [0.0]);
        let mut out = Response { force: &mut force, stiffness: &mut stiffness };
        // The mean force stands in for contacts whose force is no part of their state.
        element.respond(p, &step, &self.state, &mut out);
        element.commit(p, &step, &mut self.state);
        element.force(values, &self.state).unwrap_or(force[0])
    }
}
