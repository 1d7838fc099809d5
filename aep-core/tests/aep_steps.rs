//! AEP's steps as they are drawn: their length, direction and reach against the formulas, by many children of one parent.

use aep_core::{
    Aep, AepIndividual, AepMutation, AgeLimit, Border, Child, Components, ConfigError, Division,
    Domain, Individual, Mutation, Points, Population, Purpose, Spread, Start, StepScale, StepUnit,
    Streams,
};

const DRAWS: usize = 20_000;
/// Five standard errors of an rms over so many normal numbers.
const NEAR: f64 = 0.025;

/// Individuals at these positions with these costs; `age` failures of the first lie behind it.
fn population(positions: &[&[f64]], costs: &[f64], age: u32) -> Population<f64, AepIndividual> {
    let dimension = positions[0].len();
    let mut points = Points::zeros(positions.len(), dimension);
    for (i, position) in positions.iter().enumerate() {
        points.row_mut(i).copy_from_slice(position);
    }
    let streams = Streams::new(7, Purpose::Individual, 0);
    let mut individuals: Vec<AepIndividual> = (0..positions.len())
        .map(|i| AepIndividual::random(dimension, &mut streams.stream(i)))
        .collect();
    (1..age).for_each(|_| Individual::<f64>::survived(&mut individuals[0]));
    Population { positions: points, costs: costs.to_vec(), individuals }
}

/// What children of the first individual have over it.
fn steps(aep: Aep, population: &Population<f64, AepIndividual>, width: f64) -> Vec<Vec<f64>> {
    let parent = population.positions.row(0).to_vec();
    let domain = Domain::cube(parent.len(), -width, width).unwrap();
    let mut mutation = AepMutation::new(aep);
    mutation.prepare(population, &domain);
    let streams = Streams::new(1, Purpose::Mutation, 1);
    let (mut position, mut individual) = (parent.clone(), population.individuals[0].clone());
    (0..DRAWS)
        .map(|draw| {
            let child = Child { position: &mut position, individual: &mut individual };
            mutation.mutate(0, population, &domain, &mut streams.stream(draw), child);
            position.iter().zip(&parent).map(|(child, parent)| child - parent).collect()
        })
        .collect()
}

fn rms(steps: &[Vec<f64>], component: usize) -> f64 {
    let square: f64 = steps.iter().map(|step| step[component].powi(2)).sum();
    (square / steps.len() as f64).sqrt()
}

#[track_caller]
fn assert_near(value: f64, expected: f64) {
    assert!((value / expected - 1.0).abs() < NEAR, "{value} instead of {expected}");
}

/// The paper's rules with steps of their own factors.
fn plain() -> Aep {
    Aep::paper().with_beta(3.0, 0.2)
}

#[test]
fn a_step_is_as_long_as_cost_age_and_reading_make_it() {
    let at = |age| population(&[&[0.0, 0.0, 0.0, 0.0]], &[6.0], age);
    let length = |aep: Aep, age| rms(&steps(aep, &at(age), 1e6), 2);
    let reading = |spread, division| plain().with_spread(spread, division);
    let (deviation, variance) = (Spread::StandardDeviation, Spread::Variance);
    let (whole, each) = (Division::Whole, Division::PerComponent);
    assert_near(length(reading(deviation, whole), 1), 3.0 * 6.0);
    assert_near(length(reading(deviation, each), 1), 3.0 * 6.0 / 4.0);
    assert_near(length(reading(variance, whole), 1), (3.0 * 6.0f64).sqrt());
    assert_near(length(reading(deviation, whole), 2), 0.2 * 6.0 * 2.0);
    assert_near(length(reading(deviation, whole), 7), 0.2 * 6.0 * 7.0);
    let aged = |limit| reading(deviation, whole).with_age_limit(limit);
    assert_near(length(aged(AgeLimit::Saturate(4)), 7), 0.2 * 6.0 * 4.0);
    // Nobody is better than an individual alone.
    assert_near(length(aged(AgeLimit::Adopt(4)), 7), 0.2 * 6.0 * 4.0);
    let scaled = |scale| reading(deviation, whole).with_steps(scale, StepUnit::Absolute);
    assert_near(length(scaled(StepScale::AboveReference(4.0)), 1), 3.0 * 2.0);
    assert_near(length(scaled(StepScale::Constant), 1), 3.0);
    let by_domain = reading(deviation, whole).with_steps(StepScale::Constant, StepUnit::Domain);
    let narrow = steps(by_domain.with_beta(1e-3, 1e-3), &at(1), 5.0);
    assert_near(rms(&narrow, 0), 1e-3 * 10.0);
}

#[test]
fn at_age_1_a_step_goes_along_the_directions_and_later_either_way() {
    let aep = || plain().with_spread(Spread::StandardDeviation, Division::Whole);
    let young = population(&[&[0.0, 0.0, 0.0]], &[2.0], 1);
    let directions = young.individuals[0].directions().to_vec();
    for step in steps(aep(), &young, 1e6) {
        let along = step.iter().zip(&directions).all(|(step, d)| step * f64::from(*d) >= 0.0);
        assert!(along, "{step:?} {directions:?}");
    }
    let old = population(&[&[0.0, 0.0, 0.0]], &[2.0], 2);
    let up = steps(aep(), &old, 1e6).iter().filter(|step| step[0] > 0.0).count();
    assert!((up as f64 / DRAWS as f64 - 0.5).abs() < 0.02, "{up}");
}

#[test]
fn at_age_1_a_step_of_all_components_together_goes_along_the_directions_each_in_its_own_unit() {
    // One component is a thousand times as wide as another, one is the same everywhere.
    let positions: [&[f64]; 4] =
        [&[0.0, 0.0, 7.0], &[1000.0, 2.0, 7.0], &[-1000.0, 1.0, 7.0], &[500.0, -3.0, 7.0]];
    let unit = |j: usize| {
        let mean = positions.iter().map(|x| x[j]).sum::<f64>() / 4.0;
        (positions.iter().map(|x| (x[j] - mean).powi(2)).sum::<f64>() / 4.0).sqrt()
    };
    let aep = plain()
        .with_beta(1.0, 0.5)
        .with_spread(Spread::StandardDeviation, Division::Whole)
        .with_steps(StepScale::Constant, StepUnit::Covariance { share: 1.0 });
    let young = population(&positions, &[1.0, 2.0, 3.0, 4.0], 1);
    let directions = young.individuals[0].directions().to_vec();
    for step in steps(aep, &young, 1e9) {
        let along: f64 = (0..2).map(|j| f64::from(directions[j]) * step[j] / unit(j)).sum();
        assert!(along >= -1e-9 && step[2] == 0.0, "{step:?} {directions:?}");
    }
}

#[test]
fn a_step_that_is_drawn_again_is_one_that_stays_within() {
    // From 0.8 of a domain that ends at 1, in steps of 0.5: what is left of the normal distribution between -1.8 and 0.2.
    let aep = || {
        plain()
            .with_beta(0.25, 0.125)
            .with_spread(Spread::StandardDeviation, Division::Whole)
            .with_steps(StepScale::Constant, StepUnit::Domain)
            .with_border(Border::Resample)
    };
    let either = steps(aep(), &population(&[&[0.8]], &[1.0], 2), 1.0);
    assert!(either.iter().all(|step| (-1.8..=0.2 + 1e-12).contains(&step[0])));
    assert_near(rms(&either, 0), truncated(-1.8, 0.2));
    // Where it goes only up, or only down, it is the one half of that.
    let up = population(&[&[0.8]], &[1.0], 1);
    let direction = f64::from(up.individuals[0].directions()[0]);
    let one_way = steps(aep(), &population(&[&[0.8 * direction]], &[1.0], 1), 1.0);
    assert!(one_way.iter().all(|step| (0.0..=0.2 + 1e-12).contains(&(step[0] * direction))));
    assert_near(rms(&one_way, 0), truncated(0.0, 0.2));
}

/// Rms of a normal number of standard deviation 0.5 that lies within limits, by the sums of a fine grid.
fn truncated(from: f64, to: f64) -> f64 {
    let (mut square, mut weight) = (0.0, 0.0);
    for k in 0..100_000 {
        let x = from + (to - from) * (f64::from(k) + 0.5) / 1e5;
        let density = (-0.5 * (x / 0.5) * (x / 0.5)).exp();
        square += density * x * x;
        weight += density;
    }
    f64::sqrt(square / weight)
}

#[test]
fn the_better_part_of_a_population_makes_unit_and_covariance() {
    // The worst one is far away and does not count.
    let positions: [&[f64]; 4] = [&[0.0, 0.0], &[3.0, 1.0], &[-3.0, -1.0], &[0.0, 90.0]];
    let of = |age| population(&positions, &[1.0, 2.0, 3.0, 4.0], age);
    let aep = |unit| {
        plain()
            .with_beta(1.0, 0.5)
            .with_spread(Spread::StandardDeviation, Division::Whole)
            .with_steps(StepScale::Constant, unit)
    };
    let units = [(2.0 * 9.0 / 3.0f64).sqrt(), (2.0 / 3.0f64).sqrt()];
    for unit in [StepUnit::Population { share: 0.75 }, StepUnit::Covariance { share: 0.75 }] {
        for age in [1, 2] {
            let drawn = steps(aep(unit), &of(age), 1e6);
            assert_near(rms(&drawn, 0), units[0]);
            assert_near(rms(&drawn, 1), units[1]);
        }
    }
    // Three of these lie on a line, and so do steps by their covariance; at age 1 it is gone along the directions.
    let together = |age| steps(aep(StepUnit::Covariance { share: 0.75 }), &of(age), 1e6);
    let directions = of(1).individuals[0].directions().to_vec();
    let along = |step: &[f64]| -> f64 {
        let parts = step.iter().zip(&directions).zip(units);
        parts.map(|((step, d), unit)| step / unit * f64::from(*d)).sum()
    };
    for step in together(1).iter().chain(&together(2)) {
        assert!((step[0] - 3.0 * step[1]).abs() < 1e-9, "{step:?}");
    }
    assert!(together(1).iter().all(|step| along(step) >= -1e-12));
    let against = together(2).iter().filter(|step| step[0] < 0.0).count();
    assert!((against as f64 / DRAWS as f64 - 0.5).abs() < 0.02, "{against}");
}

#[test]
fn costs_relative_to_the_population_have_no_unit_and_no_offset() {
    let positions: [&[f64]; 3] = [&[0.0], &[1.0], &[2.0]];
    let aep = plain()
        .with_spread(Spread::StandardDeviation, Division::Whole)
        .with_steps(StepScale::Relative { floor: 0.1 }, StepUnit::Absolute);
    for (unit, offset) in [(1.0, 0.0), (250.0, -7e3)] {
        let length = |first: f64| {
            let costs = [first, 2.0, 5.0].map(|cost| unit * cost + offset);
            rms(&steps(aep.clone(), &population(&positions, &costs, 1), 1e6), 0)
        };
        // (f - best) / (median - best) + floor
        assert_near(length(8.0), 3.0 * ((8.0 - 2.0) / (5.0 - 2.0) + 0.1));
        assert_near(length(1.0), 3.0 * 0.1);
    }
    // Of five the median is the third.
    let five: [&[f64]; 5] = [&[0.0], &[1.0], &[2.0], &[3.0], &[4.0]];
    let drawn = steps(aep.clone(), &population(&five, &[11.0, 2.0, 5.0, 8.0, 9.0], 1), 1e6);
    assert_near(rms(&drawn, 0), 3.0 * ((11.0 - 2.0) / (8.0 - 2.0) + 0.1));
    // Where the better half is all alike, or the median has no cost, the floor is all there is.
    for costs in [[4.0; 3], [4.0, f64::INFINITY, f64::INFINITY]] {
        let drawn = steps(aep.clone(), &population(&positions, &costs, 1), 1e6);
        assert_near(rms(&drawn, 0), 3.0 * 0.1);
    }
}

#[test]
fn an_individual_past_its_limit_has_children_from_a_better_one() {
    let limit = 3;
    let aep = || {
        plain()
            .with_spread(Spread::StandardDeviation, Division::Whole)
            .with_beta(3.0, 0.01)
            .with_age_limit(AgeLimit::Adopt(limit))
    };
    let origin_of = |costs: &[f64], age| {
        let drawn = steps(aep(), &population(&[&[0.0], &[100.0]], costs, age), 1e6);
        let there = drawn.iter().filter(|step| step[0] > 50.0);
        let there: Vec<Vec<f64>> = there.map(|step| vec![step[0] - 100.0]).collect();
        let here: Vec<Vec<f64>> = drawn.into_iter().filter(|step| step[0] <= 50.0).collect();
        (here, there)
    };
    // At the limit it is still its own; past it half of the draws point at the other one, which is better or not.
    assert!(origin_of(&[9.0, 4.0], limit).1.is_empty());
    assert!(origin_of(&[4.0, 9.0], limit + 1).1.is_empty());
    assert!(origin_of(&[4.0, 4.0], limit + 1).1.is_empty());
    let (here, there) = origin_of(&[9.0, 4.0], limit + 1);
    assert!((there.len() as f64 / DRAWS as f64 - 0.5).abs() < 0.02, "{}", there.len());
    // From there with the step of age 2, from here with that of the limit.
    assert!((rms(&there, 0) / (0.01 * 4.0 * 2.0) - 1.0).abs() < 2.0 * NEAR, "{}", rms(&there, 0));
    assert!((rms(&here, 0) / (0.01 * 9.0 * 3.0) - 1.0).abs() < 2.0 * NEAR, "{}", rms(&here, 0));
}

#[test]
fn some_children_change_few_components_and_one_at_least() {
    let aep = plain().with_components(Components::Mixed { probability: 0.4, share: 0.25 });
    let drawn = steps(aep, &population(&[&[0.0; 9]], &[1.0], 2), 1e6);
    let moved = |step: &Vec<f64>| step.iter().filter(|step| **step != 0.0).count();
    assert!(drawn.iter().all(|step| moved(step) >= 1));
    let few = drawn.iter().filter(|step| moved(step) < 9).count() as f64 / DRAWS as f64;
    assert!((few - 0.4).abs() < 0.02, "{few}");
    // One for certain, of the eight others a quarter.
    let partly: Vec<f64> = drawn.iter().map(|s| moved(s) as f64).filter(|n| *n < 9.0).collect();
    let mean = partly.iter().sum::<f64>() / partly.len() as f64;
    assert!((mean - 3.0).abs() < 0.06, "{mean}");
}

#[test]
fn without_a_finite_cost_a_child_is_drawn_anywhere() {
    let drawn = steps(plain(), &population(&[&[0.0]], &[f64::INFINITY], 1), 2.0);
    assert_near(rms(&drawn, 0), 2.0 / 3.0f64.sqrt());
}

#[test]
fn every_setting_is_the_one_that_was_given() {
    let paper = Aep::paper();
    let changed = Aep::paper()
        .with_population(9)
        .with_beta(2.0, 0.3)
        .with_spread(Spread::StandardDeviation, Division::Whole)
        .with_border(Border::Clamp)
        .with_steps(StepScale::Constant, StepUnit::Domain)
        .with_components(Components::Mixed { probability: 0.1, share: 0.2 })
        .with_age_limit(AgeLimit::Saturate(5));
    let expected = Aep {
        population: 9,
        beta1: 2.0,
        beta2: 0.3,
        spread: Spread::StandardDeviation,
        division: Division::Whole,
        border: Border::Clamp,
        step_scale: StepScale::Constant,
        step_unit: StepUnit::Domain,
        components: Components::Mixed { probability: 0.1, share: 0.2 },
        age_limit: AgeLimit::Saturate(5),
    };
    assert_eq!(changed, expected);
    assert_ne!(paper, expected);
}

#[test]
fn the_practical_settings_are_those_that_the_docs_tell() {
    let expected = Aep::paper()
        .with_beta(1.0, 0.5)
        .with_spread(Spread::StandardDeviation, Division::Whole)
        .with_steps(StepScale::Constant, StepUnit::Covariance { share: 0.75 })
        .with_components(Components::Mixed { probability: 0.5, share: 0.2 })
        .with_age_limit(AgeLimit::Adopt(3));
    assert_eq!(Aep::practical(), expected);
}

#[test]
fn a_setting_out_of_its_range_is_refused_by_name_and_one_at_its_end_is_not() {
    let domain = Domain::cube(2, -1.0, 1.0).unwrap();
    let start = Start::new(&domain, 1);
    let asked = |aep: Aep| -> Result<(), ConfigError> { aep.engine(&start).map(|_| ()) };
    let steps = |scale, unit| asked(plain().with_steps(scale, unit));
    let mixed = |probability, share| {
        asked(plain().with_components(Components::Mixed { probability, share }))
    };
    let relative = |floor| steps(StepScale::Relative { floor }, StepUnit::Absolute);
    let better = |share| steps(StepScale::Constant, StepUnit::Population { share });
    for good in [
        relative(0.0),
        relative(2.0),
        better(1.0),
        better(1e-3),
        mixed(0.0, 1.0),
        mixed(1.0, 0.0),
        steps(StepScale::AboveReference(-3.0), StepUnit::Absolute),
    ] {
        assert!(good.is_ok(), "{good:?}");
    }
    for (bad, name) in [
        (asked(plain().with_beta(0.0, 1.0)), "beta1"),
        (asked(plain().with_beta(f64::INFINITY, 1.0)), "beta1"),
        (asked(plain().with_beta(1.0, -1.0)), "beta2"),
        (asked(plain().with_beta(1.0, f64::NAN)), "beta2"),
        (relative(-1e-9), "floor"),
        (relative(f64::INFINITY), "floor"),
        (better(0.0), "share"),
        (better(1.0 + 1e-9), "share"),
        (mixed(1.1, 0.5), "probability"),
        (mixed(0.5, -0.1), "share of components"),
        (steps(StepScale::AboveReference(f64::NAN), StepUnit::Absolute), "reference"),
    ] {
        let error = bad.expect_err(name).to_string();
        assert!(error.contains(name), "{name}: {error}");
    }
}
