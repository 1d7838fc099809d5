//! What an observer does to the plants between two steps: it moves the estimate of their states.

use super::Plants;
use crate::effects::{Correction, Parameters};
use crate::simd::add_to;

impl Plants {
    /// Adds `dx` (m or rad) to the position and `dv` (m/s or rad/s) to the velocity of each lane; the states of
    /// its elements and memories follow ([`crate::effects::Element::correct`],
    /// [`crate::effects::Memory::correct`]).
    ///
    /// It is the estimate that moves, not the plant: no time passes and nothing slides. The velocities that
    /// a memory has already seen stay as they were.
    pub fn correct(&mut self, dx: &[f64], dv: &[f64]) {
        if !self.fresh.is_empty() {
            self.load_elements();
        }
        add_to(&mut self.position, dx);
        add_to(&mut self.velocity, dv);
        let Self { effects, contact, attached, memories, scratch: s, lanes, .. } = self;
        for k in attached.iter().chain(contact.iter()) {
            let active = &mut effects[*k];
            let Some(element) = active.effect.element() else { continue };
            let is_contact = Some(*k) == *contact;
            let correction = Correction {
                displacement: dx,
                velocity: dv,
                level: if is_contact { &s.level } else { &s.zero },
                breakaway: if is_contact { &s.breakaway } else { &s.zero },
            };
            let p = Parameters::new(&active.values, *lanes);
            element.correct(p, &correction, &mut active.element);
        }
        for k in memories.iter() {
            let active = &mut effects[*k];
            let Some(memory) = active.effect.memory() else { continue };
            memory.correct(Parameters::new(&active.values, *lanes), dx, &mut active.memory);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::axis::Axis;
    use crate::model::Model;
    use crate::simulator::Start;

    const STEP: f64 = 1e-3;
    const CONTACTS: [(&str, &[(&str, f64)]); 5] = [
        ("presliding", &[("k_t", 2e6)]),
        ("presliding:static", &[("k_t", 2e6)]),
        ("presliding:dahl", &[("k_t", 2e6)]),
        ("presliding:lugre", &[("k_t", 2e6), ("sigma_1", 1e3)]),
        ("presliding:maxwell-slip", &[("k_t", 2e6), ("spread", 2.0)]),
    ];

    fn with(terms: &[(&str, &[(&str, f64)])]) -> Model {
        let plain = Model::new(Axis::Linear, 3.0).and_then(|m| m.with("coulomb", &[("F_C", 5.0)]));
        terms.iter().fold(plain.unwrap(), |m, (name, values)| m.with(name, values).unwrap())
    }

    /// Final position under a steady pull with corrections of alternating sign, every other lane with none.
    fn pulled(model: &Model, force: f64, dx: f64) -> [f64; 2] {
        let mut plants = Plants::uniform(model, 2);
        let velocity = if force > 5.0 { 0.01 } else { 0.0 };
        (0..2).for_each(|i| plants.start(i, &Start::at(0.0, velocity)));
        for k in 0..400 {
            plants.step(&[STEP; 2], &[force; 2]);
            let dx = if k % 2 == 0 { dx } else { -dx };
            plants.correct(&[0.0, dx], &[0.0; 2]);
        }
        [plants.position()[0], plants.position()[1]]
    }

    #[test]
    fn a_contact_that_slides_goes_on_sliding_under_corrections_of_either_sign() {
        for (name, values) in CONTACTS {
            let [plain, corrected] = pulled(&with(&[(name, values)]), 6.0, 4e-6);
            assert!((plain - corrected).abs() < 1e-9, "{name}: {plain} {corrected}");
        }
    }

    #[test]
    fn a_rest_goes_on_where_friction_takes_back_what_an_observer_moved() {
        // 2 N leave 3 N of the friction, 1 m/s^2: the second lane needs more than a step to come to rest again.
        let mut plants = Plants::uniform(&with(&[]), 2).watched();
        for k in 0..100 {
            plants.step(&[STEP; 2], &[2.0; 2]);
            assert_eq!(plants.sliding(), [0.0; 2]);
            plants.correct(&[0.0; 2], &[3e-4, if k % 5 == 0 { 2.5e-3 } else { 0.0 }]);
        }
        assert!((plants.dwell[0] - 100.0 * STEP).abs() < 1e-9, "{}", plants.dwell[0]);
        assert!(plants.dwell[1] > 40.0 * STEP, "{}", plants.dwell[1]);
        // A slide ends it: the next rest begins where that one stops.
        plants.step(&[STEP; 2], &[20.0; 2]);
        assert_eq!(plants.sliding(), [1.0; 2]);
        (0..20).for_each(|_| plants.step(&[STEP; 2], &[0.0; 2]));
        assert_eq!(plants.sliding(), [0.0; 2]);
        assert!(plants.dwell.iter().all(|dwell| *dwell < 20.0 * STEP), "{:?}", plants.dwell);
    }

    #[test]
    fn a_contact_that_holds_is_no_ratchet() {
        for (name, values) in CONTACTS {
            let [plain, corrected] = pulled(&with(&[(name, values)]), 2.0, 1e-8);
            // 2 N bend the contact by about 1 um.
            assert!(plain > 5e-7, "{name}: {plain}");
            assert!((plain - corrected).abs() < 1e-7, "{name}: {plain} {corrected}");
        }
    }

    #[test]
    fn a_contact_that_holds_is_bent_by_the_correction() {
        // Before the first step, too.
        for ((name, values), steps) in CONTACTS.into_iter().flat_map(|c| [(c, 0), (c, 1)]) {
            let model = with(&[(name, values)]);
            let mut plants = Plants::uniform(&model, 1);
            (0..steps).for_each(|_| plants.step(&[STEP], &[0.0]));
            plants.correct(&[1e-7], &[0.0]);
            // 0.2 N push back, so that the force which holds it there is as large.
            plants.step(&[STEP], &[0.2]);
            assert!((plants.position()[0] - 1e-7).abs() < 2e-9, "{name}: {:?}", plants.position());
        }
    }

    #[test]
    fn corrections_never_load_a_contact_beyond_its_level() {
        for (name, values) in CONTACTS {
            let model = with(&[(name, values)]);
            let mut plants = Plants::uniform(&model, 1);
            for dx in [1e-3, 1e-3, -5e-3, 1e-6] {
                plants.correct(&[dx], &[0.0]);
                let before = plants.velocity()[0];
                plants.step(&[STEP], &[0.0]);
                let change = (plants.velocity()[0] - before).abs();
                // Both sides of the level at most, should the contact turn over within the step.
                assert!(change <= 2.0 * 5.0 / 3.0 * STEP + 1e-12, "{name}: {change}");
            }
        }
    }

    #[test]
    fn both_bodies_of_a_coupling_move_together() {
        let load: &[(&str, f64)] = &[("m_L", 2.0), ("f", 30.0), ("zeta", 0.1)];
        let model =
            Model::new(Axis::Linear, 3.0).and_then(|m| m.with("flexible-coupling", load)).unwrap();
        let mut plants = Plants::uniform(&model, 2);
        for k in 0..300 {
            let force = 20.0 * (0.05 * f64::from(k)).sin();
            plants.step(&[STEP; 2], &[force; 2]);
            if k == 100 {
                plants.correct(&[0.0, 1e-3], &[0.0, 0.02]);
            }
        }
        // Galilei: nothing but a uniform motion more.
        let (x, v) = (plants.position(), plants.velocity());
        assert!((x[1] - x[0] - 1e-3 - 0.02 * 199.0 * STEP).abs() < 1e-12);
        assert!((v[1] - v[0] - 0.02).abs() < 1e-12);
    }

    #[test]
    fn a_gap_moves_with_the_correction_inside_and_stays_closed_at_its_end() {
        let backlash: (&str, &[(&str, f64)]) = ("backlash", &[("F_L", 4.0), ("b", 1e-4)]);
        let model = with(&[backlash]);
        let place = |plants: &Plants| plants.effects[1].memory.clone();
        let mut plants = Plants::uniform(&model, 3);
        (0..2).for_each(|i| plants.start(i, &Start::at(0.0, 0.01)));
        plants.correct(&[2e-5, -2e-5, 2e-5], &[0.0; 3]);
        assert_eq!(place(&plants)[..2], [0.5, 0.5]);
        assert!((place(&plants)[2] - 0.2).abs() < 1e-12);
        plants.correct(&[0.0, 0.0, 1e-3], &[0.0; 3]);
        assert_eq!(place(&plants)[2].to_bits(), 0.5f64.to_bits());
    }

    #[test]
    fn a_rigid_lane_simply_goes_on_from_where_it_was_put() {
        let model = with(&[]);
        let mut plants = Plants::uniform(&model, 1);
        plants.step(&[STEP], &[1.0]);
        plants.correct(&[1e-3], &[0.01]);
        for _ in 0..20 {
            plants.step(&[STEP], &[0.0]);
        }
        // It slides v^2 m / (2 F) and rests.
        let end = 1e-3 + 0.01 * 0.01 * 3.0 / 10.0;
        assert!((plants.position()[0] - end).abs() < 1e-12);
        assert_eq!(plants.velocity()[0].to_bits(), 0.0f64.to_bits());
    }
}
