use super::*;
use crate::ahead::testing::Plant;

/// A force of 2 at every instant of the plant but those in the middle third, known to 0.1.
fn series(plant: &Plant) -> Series {
    let time = plant.time().to_vec();
    let known: Vec<bool> =
        (0..time.len()).map(|k| !(time.len() / 3..2 * time.len() / 3).contains(&k)).collect();
    let force = known.iter().map(|known| if *known { 2.0 } else { 0.0 }).collect();
    let deviation = known.iter().map(|known| if *known { 0.1 } else { 50.0 }).collect();
    Series { recorded: vec![8.0; time.len()], time, force, deviation, known }
}

#[test]
fn only_what_is_known_counts() {
    let plant = Plant::new(1, &[]);
    let (missing, regimes) = MissingForce::of(&plant, &series(&plant)).unwrap();
    assert!((missing.rms - 2.0).abs() < 1e-12 && (missing.share - 0.25).abs() < 1e-12);
    assert!((missing.band - 0.196).abs() < 1e-12 && (missing.known - 2.0 / 3.0).abs() < 1e-3);
    assert!(missing.force.iter().all(|force| *force == 2.0));
    assert!(missing.time.len() <= MOST_POINTS && missing.time.len() == missing.half_width.len());
    // One regime has all that is known; its size is not made smaller by what is not.
    assert_eq!((regimes.len(), regimes[0].share, regimes[0].time_share), (1, 1.0, 1.0));
    assert!((regimes[0].rms - 2.0).abs() < 1e-12);
}

#[test]
fn of_nothing_known_nothing_is_told() {
    let plant = Plant::new(1, &[]);
    assert!(MissingForce::of(&plant, &Series::default()).is_none());
    let mut unknown = series(&plant);
    unknown.known.fill(false);
    assert!(MissingForce::of(&plant, &unknown).is_none());
    let mut wild = series(&plant);
    wild.force[0] = f64::NAN;
    assert!(MissingForce::of(&plant, &wild).is_none());
}

#[test]
fn along_an_even_coordinate_a_force_against_the_motion_is_positive() {
    let plant = Plant::new(1, &[]);
    let time = plant.time();
    let grid: Vec<Option<f64>> = time.iter().map(|t| Some(-3.0 * t.sin().signum())).collect();
    let coordinate = Coordinate {
        name: "speed".into(),
        unit: "m/s".into(),
        values: time.iter().map(|t| t.sin().abs()).collect(),
        parity: Some(time.iter().map(|t| t.sin().signum()).collect()),
        state: true,
    };
    let map = along(&coordinate, &grid, time).unwrap();
    assert!(map.against_motion && map.bins.iter().all(|bin| (bin.mean - 3.0).abs() < 1e-9));
}
