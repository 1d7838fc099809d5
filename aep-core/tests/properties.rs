//! Invariants of the engine, for any cost, seed and setting that proptest comes up with.

use aep_core::{
    Aep, AepIndividual, Algorithm, Border, Child, Domain, Engine, MetaEp, Method, Mutation,
    OneToOne, Population, Start, Stream, methods,
};
use proptest::prelude::*;

/// A cost without any structure, a function of the position's bits; sometimes NaN or infinite.
fn rough(x: &[f64], salt: u64) -> f64 {
    let hash = x.iter().fold(salt, |hash, x| {
        (hash ^ x.to_bits()).wrapping_mul(0x9e37_79b9_7f4a_7c15).rotate_left(29)
    });
    match hash % 16 {
        0 => f64::NAN,
        1 => f64::INFINITY,
        _ => (hash >> 11) as f64 / 1e15 - 3.0,
    }
}

fn smooth(x: &[f64]) -> f64 {
    x.iter().enumerate().map(|(i, x)| (i + 1) as f64 * (x - 0.7).powi(2)).sum()
}

fn borders() -> impl Strategy<Value = Border> {
    prop::sample::select(vec![
        Border::Clamp,
        Border::Reflect,
        Border::Resample,
        Border::KeepComponent,
    ])
}

fn aeps() -> impl Strategy<Value = Aep> {
    (borders(), any::<bool>(), 1..40usize, 0.01..50.0f64).prop_map(|(border, real, count, beta)| {
        let aep = if real { Aep::practical() } else { Aep::paper().with_beta(beta, 0.01 * beta) };
        aep.with_border(border).with_population(count)
    })
}

fn step(optimizer: &mut dyn Algorithm, cost: impl Fn(&[f64]) -> f64) {
    let costs: Vec<f64> = optimizer.ask().rows().map(cost).collect();
    optimizer.tell(&costs).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn every_individual_stays_in_the_domain_and_their_number_is_constant(
        aep in aeps(), seed in any::<u64>(), salt in any::<u64>(), width in 1e-3..1e3f64,
    ) {
        let domain = Domain::cube(3, -width, 0.5 * width).unwrap();
        let ep = MetaEp::paper().with_border(aep.border).with_population(aep.population);
        let others: [Box<dyn Method>; 2] = [Box::new(aep.clone()), Box::new(ep)];
        for method in others {
            let mut optimizer = method.start(&Start::new(&domain, seed)).unwrap();
            for _ in 0..30 {
                prop_assert_eq!(optimizer.ask().len(), aep.population);
                prop_assert!(optimizer.ask().rows().all(|x| domain.contains(x)));
                step(&mut *optimizer, |x| rough(x, salt));
            }
        }
    }

    #[test]
    fn no_slot_ever_gets_worse_under_one_to_one_selection(
        aep in aeps(), seed in any::<u64>(), salt in any::<u64>(),
    ) {
        let domain = Domain::cube(2, -1.0, 1.0).unwrap();
        let mut engine = aep.engine(&Start::new(&domain, seed)).unwrap();
        step(&mut engine, |x| rough(x, salt));
        for _ in 0..30 {
            let before = engine.population().costs.clone();
            step(&mut engine, |x| rough(x, salt));
            let after = &engine.population().costs;
            prop_assert!(before.iter().zip(after).all(|(before, after)| after <= before));
        }
    }

    #[test]
    fn the_best_never_gets_worse_whatever_the_method(
        index in 0..methods::ALL.len(), seed in any::<u64>(), salt in any::<u64>(),
    ) {
        let domain = Domain::cube(3, -2.0, 2.0).unwrap();
        let method = (methods::ALL[index].build)(0);
        let mut optimizer = method.start(&Start::new(&domain, seed)).unwrap();
        let mut best = f64::INFINITY;
        for _ in 0..40 {
            prop_assert!(optimizer.ask().rows().all(|x| domain.contains(x)));
            step(&mut *optimizer, |x| rough(x, salt));
            if let Some(found) = optimizer.best() {
                prop_assert!(found.cost <= best);
                prop_assert_eq!(found.cost, rough(found.position, salt));
                best = found.cost;
            }
        }
    }

    #[test]
    fn age_and_direction_obey_rule_1(seed in any::<u64>(), salt in any::<u64>()) {
        let domain = Domain::cube(4, -1.0, 1.0).unwrap();
        let mut engine = Aep::paper().engine(&Start::new(&domain, seed)).unwrap();
        step(&mut engine, |x| rough(x, salt));
        for _ in 0..25 {
            let before = engine.population().clone();
            step(&mut engine, |x| rough(x, salt));
            for i in 0..before.len() {
                rule_1(&before, engine.population(), i)?;
            }
        }
    }

    #[test]
    fn a_restored_optimizer_goes_on_as_the_saved_one(
        index in 0..methods::ALL.len(), seed in any::<u64>(), at in 0..20usize,
    ) {
        let domain = Domain::cube(3, -2.0, 2.0).unwrap();
        let method = (methods::ALL[index].build)(0);
        let mut first = method.start(&Start::new(&domain, seed)).unwrap();
        for _ in 0..at {
            step(&mut *first, smooth);
        }
        let mut second = method.start(&Start::new(&domain, seed)).unwrap();
        second.restore(&first.save().unwrap()).unwrap();
        for _ in 0..10 {
            prop_assert_eq!(first.ask().as_slice(), second.ask().as_slice());
            step(&mut *first, smooth);
            step(&mut *second, smooth);
        }
    }

    #[test]
    fn any_state_that_is_not_one_is_refused_without_a_panic(
        index in 0..methods::ALL.len(), bytes in prop::collection::vec(any::<u8>(), 0..300),
    ) {
        let domain = Domain::cube(3, -2.0, 2.0).unwrap();
        let method = (methods::ALL[index].build)(0);
        let mut optimizer = method.start(&Start::new(&domain, 1)).unwrap();
        let _ = optimizer.restore(&bytes);
        step(&mut *optimizer, smooth);
        step(&mut *optimizer, smooth);
    }
}

/// Rule 1 between two generations of one slot.
fn rule_1(
    before: &Population<f64, AepIndividual>,
    after: &Population<f64, AepIndividual>,
    i: usize,
) -> Result<(), TestCaseError> {
    let (old, new) = (&before.individuals[i], &after.individuals[i]);
    if after.costs[i] < before.costs[i] {
        prop_assert_eq!(new.age(), 1);
        let moves = before.positions.row(i).iter().zip(after.positions.row(i));
        for (j, (from, to)) in moves.enumerate() {
            let expected = match to.partial_cmp(from) {
                Some(std::cmp::Ordering::Greater) => 1,
                Some(std::cmp::Ordering::Less) => -1,
                _ => old.directions()[j],
            };
            prop_assert_eq!(new.directions()[j], expected);
        }
    } else {
        prop_assert_eq!(new.age(), old.age() + 1);
        prop_assert_eq!(new.directions(), old.directions());
        prop_assert_eq!(before.positions.row(i), after.positions.row(i));
    }
    Ok(())
}

/// A mutation that counts on nothing but its own stream.
struct Jump;

impl Mutation<f64> for Jump {
    type Individual = ();

    fn individual(&self, _: &Domain, _: &mut Stream) {}

    fn mutate(
        &self,
        _: usize,
        _: &Population<f64, ()>,
        domain: &Domain,
        rng: &mut Stream,
        child: Child<'_, f64, ()>,
    ) {
        domain.sample(rng, child.position);
    }
}

#[test]
fn a_mutation_of_ones_own_runs_under_an_existing_selection() {
    let domain = Domain::cube(2, -1.0, 1.0).unwrap();
    let start = Start::new(&domain, 1);
    let mut engine = Engine::new("jump", &start, 20, Jump, OneToOne::Strict).unwrap();
    for _ in 0..200 {
        step(&mut engine, smooth);
    }
    assert!(engine.best().unwrap().cost < 0.1);
}
