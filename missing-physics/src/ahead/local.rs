//! Whether what is left lies somewhere: a model may err no more than the sensors make it on the whole and still fail
//! at one place, at one time, in a few samples, or by a force too slow to be seen from one sample to the next.

use super::Ahead;
use super::node::Node;
use crate::report::{Fault, Remains};
use crate::task::Thresholds;

/// Bins of equal count along time and each coordinate.
const BINS: usize = 40;
/// Fewest errors of a bin.
const FEWEST: usize = 30;
/// Errors beyond this many times their robust rms stand alone.
const ALONE: f64 = 8.0;
/// Share of the squared error in so few samples from which they are told as faults of the sampling.
const FAULTS: (f64, f64) = (0.5, 0.01);

/// Places where a model errs more than [`Thresholds::local`] times as much as the `noise` makes it, the worst first; before
/// them the force that it lacks (in `unit`), where that is larger than its band by more than [`Thresholds::complete`], or
/// nowhere known.
pub fn places(
    ahead: &dyn Ahead,
    (node, noise): (&Node, f64),
    thresholds: &Thresholds,
    unit: &str,
) -> Vec<Remains> {
    let factor = thresholds.local;
    let time = ahead.instants().iter().map(|(time, _)| *time).collect();
    let mut along = vec![("time".to_owned(), "s".to_owned(), time)];
    along.extend(ahead.along());
    let mut worst: Vec<(f64, Remains)> = Vec::new();
    if let Some(lacks) = missing(ahead, node, thresholds.complete, unit) {
        worst.push((f64::INFINITY, lacks));
    }
    let isolated = faults(&node.errors).map(|share| Fault::Isolated { share });
    let faults = ahead.faults().into_iter().chain(isolated);
    worst.extend(faults.map(|fault| (f64::INFINITY, Remains::Faulty { fault })));
    for (name, unit, values) in &along {
        let found = largest(values, &node.errors).map(|(rms, at)| (rms / noise, at));
        if let Some((ratio, at)) = found.filter(|(ratio, _)| *ratio > factor) {
            let (coordinate, unit) = (name.clone(), unit.clone());
            worst.push((ratio, Remains::ErrorNear { coordinate, at, unit, times: ratio }));
        }
    }
    worst.sort_by(|a, b| b.0.total_cmp(&a.0));
    worst.into_iter().map(|(_, remains)| remains).collect()
}

/// The force that a model lacks, where it is more than so many bands or nothing is known of it anywhere: such a model does
/// not predict what the axis does, the sensor alone does.
fn missing(ahead: &dyn Ahead, node: &Node, bands: f64, unit: &str) -> Option<Remains> {
    let unit = unit.to_owned();
    if let Some((rms, band)) = node.lacks(ahead) {
        return (rms > bands * band).then_some(Remains::MissingForce { rms, band, unit });
    }
    let unknown = node.missing_force(ahead).filter(|series| series.is_unknown())?;
    Some(Remains::UnknownForce { recorded: unknown.recorded(), unit })
}

/// The largest rms of the errors of a bin along `values`, and where it is.
fn largest(values: &[f64], errors: &[f64]) -> Option<(f64, f64)> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let size = (values.len() / BINS).max(FEWEST);
    let bins = order.chunks(size).filter(|bin| bin.len() >= FEWEST);
    let each = bins.map(|bin| {
        let square: f64 = bin.iter().map(|k| errors[*k] * errors[*k]).sum();
        ((square / bin.len() as f64).sqrt(), values[bin[bin.len() / 2]])
    });
    each.max_by(|a, b| a.0.total_cmp(&b.0))
}

/// Share of the squared error in a few isolated samples, where it is most of it.
pub fn faults(errors: &[f64]) -> Option<f64> {
    let limit = ALONE * super::statistics::spread(errors).max(f64::MIN_POSITIVE);
    let all: f64 = errors.iter().map(|e| e * e).sum();
    let alone: Vec<f64> = errors.iter().filter(|e| e.abs() > limit).map(|e| e * e).collect();
    let share = alone.iter().sum::<f64>() / all.max(f64::MIN_POSITIVE);
    let few = (alone.len() as f64) < FAULTS.1 * errors.len() as f64;
    (share > FAULTS.0 && few).then_some(share)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::fit;
    use crate::ahead::testing::Plant;
    use crate::family::Series;

    #[test]
    fn the_bin_with_the_largest_errors_is_found() {
        let values: Vec<f64> = (0..4000).map(|k| f64::from((k * 37) % 4000)).collect();
        let errors: Vec<f64> =
            values.iter().map(|v| if (1000.0..1100.0).contains(v) { 5.0 } else { 1.0 }).collect();
        let (rms, at) = largest(&values, &errors).unwrap();
        assert!((rms - 5.0).abs() < 1e-9 && (1000.0..1100.0).contains(&at), "{rms} {at}");
    }

    #[test]
    fn a_few_wild_samples_are_faults_and_even_errors_are_not() {
        let mut errors: Vec<f64> = (0..2000).map(|k| if k % 2 == 0 { 1.0 } else { -1.0 }).collect();
        assert_eq!(faults(&errors), None);
        errors[700] = 100.0;
        assert!(faults(&errors).unwrap() > 0.8);
    }

    #[test]
    fn a_force_beyond_its_band_is_told_and_one_that_is_nowhere_known_and_a_smaller_one_is_not() {
        let places = |lacks: Option<Series>| {
            let mut plant = Plant::new(1, &[]);
            plant.lacks = lacks;
            let node = fit::evaluated(&plant, Plant::model(&[]), 0);
            places(&plant, (&node, plant.budget()), &Thresholds::default(), "V")
        };
        let force = |force: f64, known: bool| Series {
            time: vec![0.0, 0.1, 0.2],
            force: vec![force, 99.0, -force],
            deviation: vec![1.0 / 1.96, 50.0, 1.0 / 1.96],
            recorded: vec![9.0; 3],
            known: vec![known, false, known],
        };
        assert_eq!(places(None), []);
        assert_eq!(places(Some(force(1.2, true))), []);
        let unit = || "V".to_owned();
        let [Remains::MissingForce { rms, band, unit: of }] = &places(Some(force(1.4, true)))[..]
        else {
            panic!("nothing is lacking")
        };
        assert!((rms - 1.4).abs() < 1e-9 && (band - 1.0).abs() < 1e-9 && *of == unit());
        let unknown = Remains::UnknownForce { recorded: 9.0, unit: unit() };
        assert_eq!(places(Some(force(1.2, false))), [unknown]);
        // A family may tell nothing of any instant.
        assert_eq!(places(Some(Series::default())), []);
    }
}
