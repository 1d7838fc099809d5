//! Memories along a measured motion: one plant, sample after sample.

use super::{MeasuredMotion, Walk};
use crate::effects::{Begun, Memory, Parameters, Past, Recalled, Slot, Taken};
use crate::model::ModelEffect;

/// Time at rest so far at every sample; while the axis slides, the length of its last rest.
pub(super) fn dwell(motion: &MeasuredMotion<'_>) -> Vec<f64> {
    let mut dwell = vec![0.0; motion.len()];
    for segment in &motion.segments {
        let (mut length, mut rested) = (0.0, false);
        for k in segment.clone() {
            let rests = motion.velocity[k].abs() <= motion.rest_velocity;
            if rests {
                length = if rested { length + motion.time[k] - motion.time[k - 1] } else { 0.0 };
            }
            rested = rests;
            dwell[k] = length;
        }
    }
    dwell
}

impl Walk<'_> {
    /// Lets the memories of `terms` say what the level sees.
    pub(super) fn recall(&mut self, terms: &[ModelEffect]) {
        for term in terms.iter().filter(|term| term.effect().about().acts_on(Slot::Memory)) {
            if let Some(memory) = term.effect().memory() {
                self.remembered.resize(self.motion.len(), 0.0);
                self.recall_one(term, memory, terms);
            }
        }
    }

    fn recall_one(&mut self, term: &ModelEffect, memory: &dyn Memory, terms: &[ModelEffect]) {
        let p = Parameters::new(term.values(), 1);
        let mut level_velocity = self.level_velocity.to_vec();
        for segment in self.motion.segments.clone().iter().filter(|s| !s.is_empty()) {
            let first = segment.start;
            let mut state = vec![0.0; memory.states()];
            let begun = Begun { velocity: self.motion.velocity[first], came: None };
            memory.start(term.values(), &begun, &mut state);
            let mut past = Past::new(1, memory.memory(p));
            past.start(0, self.motion.time[first], self.motion.velocity[first], 0.0);
            for k in segment.clone() {
                past.push(&self.motion.time[k..=k], &self.motion.velocity[k..=k]);
                let (mut seen, mut bond, mut level) = ([level_velocity[k]], [self.bond[k]], [0.0]);
                self.remember(p, memory, k, first, hump(terms, seen), &mut state);
                let motion = self.motion_of(k..k + 1);
                let mut out =
                    Recalled { level_velocity: &mut seen, bond: &mut bond, level: &mut level };
                memory.recall(p, &motion, &past, &state, &mut out);
                level_velocity[k] = seen[0];
                self.bond[k] = bond[0];
                self.remembered[k] += level[0];
            }
        }
        self.level_velocity = level_velocity.into();
    }

    /// Level that the memory of `term` adds.
    pub(super) fn remembered_by(&self, term: &ModelEffect) -> Vec<f64> {
        let mut walk = Walk {
            beside: false,
            motion: self.motion,
            direction: self.direction.clone(),
            level_velocity: self.level_velocity.clone(),
            dwell: self.dwell.clone(),
            bond: self.bond.clone(),
            remembered: vec![0.0; self.motion.len()],
            drive_force: self.drive_force.clone(),
            smooth: Vec::new(),
            mass: self.mass,
            friction: Vec::new(),
            used: Vec::new(),
            attached: Vec::new(),
        };
        if let Some(memory) = term.effect().memory() {
            walk.recall_one(term, memory, &[]);
        }
        walk.remembered
    }

    /// Takes the step to sample `k` into a state.
    fn remember(
        &self,
        p: Parameters<'_>,
        memory: &dyn Memory,
        k: usize,
        first: usize,
        hump: [f64; 1],
        state: &mut [f64],
    ) {
        let (motion, before) = (self.motion, k.saturating_sub(1).max(first));
        let slides = motion.velocity[k].abs() > motion.rest_velocity;
        let taken = Taken {
            duration: &[motion.time[k] - motion.time[before]],
            displacement: &[motion.position[k] - motion.position[before]],
            sliding: &[f64::from(u8::from(slides))],
            dwell: &self.dwell[k..=k],
            hump: &hump,
        };
        memory.remember(p, &taken, state);
    }
}

/// Share of the static hump that is left at a level velocity.
fn hump(terms: &[ModelEffect], level_velocity: [f64; 1]) -> [f64; 1] {
    let mut share = [1.0];
    for term in terms {
        term.effect().hump(Parameters::new(term.values(), 1), &level_velocity, &mut share);
    }
    share
}
