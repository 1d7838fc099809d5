//! The regimes of a motion: which of the instants stick, break away, reverse, creep, accelerate or slide.

use missing_physics::Regime;

use super::preparation::Prepared;

/// Distance after a reversal or a breakaway that belongs to it, as a share of the stroke.
const NEAR: f64 = 1e-3;
/// Fewest samples at rest before a motion that starts is a breakaway; a reversal rests for less.
const STANDS: usize = 20;
/// Speed below which motion is slow, and above which it is fast, as a share of the highest.
const SLOW: f64 = 0.05;
const FAST: f64 = 0.5;
/// Acceleration above which motion is not uniform, as a share of its root mean square.
const UNIFORM: f64 = 0.3;

/// Regimes that do not overlap. Of the stick only the instants beside a motion are compared: at rest any force
/// below breakaway holds.
const NAMES: [&str; 7] = [
    "stick",
    "breakaway",
    "reversal",
    "slow motion",
    "acceleration",
    "fast motion",
    "uniform motion",
];

/// The regimes of a motion on the comparison grid; those that it has.
pub fn regimes(p: &Prepared, stroke: (f64, f64)) -> Vec<Regime> {
    let all = names(p, stroke, &p.grid);
    NAMES
        .iter()
        .map(|name| Regime {
            name: (*name).to_owned(),
            member: all.iter().map(|other| other == name).collect(),
        })
        .filter(|regime| regime.member.contains(&true))
        .collect()
}

/// The regime of each of these samples.
pub fn names(p: &Prepared, stroke: (f64, f64), samples: &[usize]) -> Vec<&'static str> {
    let highest = p.velocity.iter().fold(0.0f64, |most, v| most.max(v.abs()));
    let square: f64 = p.acceleration.iter().map(|a| a * a).sum();
    let usual = (square / p.acceleration.len() as f64).sqrt();
    let near = (NEAR * (stroke.1 - stroke.0)).max(20.0 * p.position_noise);
    let starts = starts(p, near);
    let name = |k: usize| {
        let (speed, start) = (p.velocity[k].abs(), &starts[k]);
        let just_started = (p.position[k] - start.position).abs() < near;
        match () {
            () if p.moving[k] == 0.0 => "stick",
            () if just_started && start.from_rest => "breakaway",
            () if just_started => "reversal",
            () if speed < SLOW * highest => "slow motion",
            () if p.acceleration[k].abs() > UNIFORM * usual => "acceleration",
            () if speed >= FAST * highest => "fast motion",
            () => "uniform motion",
        }
    };
    samples.iter().map(|&k| name(k)).collect()
}

/// Where a motion last started or turned.
#[derive(Clone, Copy, Debug)]
struct Origin {
    position: f64,
    from_rest: bool,
}

/// The origin of the motion at every sample. A turn so `near` to a breakaway is the smoother's ringing.
fn starts(p: &Prepared, near: f64) -> Vec<Origin> {
    let mut starts = Vec::with_capacity(p.position.len());
    for range in &p.segments {
        let mut origin = Origin { position: p.position[range.start], from_rest: false };
        let (mut sign, mut rest) = (0.0, 0);
        for k in range.clone() {
            if p.moving[k] == 0.0 {
                rest += 1;
            } else {
                let (now, from_rest) = (p.velocity[k].signum(), rest >= STANDS);
                let way = (p.position[k] - origin.position).abs();
                let turns = now != sign && !(origin.from_rest && way < near);
                if from_rest || turns {
                    origin = Origin { position: p.position[k], from_rest };
                }
                (sign, rest) = (now, 0);
            }
            starts.push(origin);
        }
    }
    starts
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::challenge::{Hide, Level, STROKE, generate};
    use crate::reference::Profile;
    use missing_physics::{Channel, Recording};

    #[test]
    fn every_instant_is_in_one_regime_and_a_table_that_creeps_rests_and_runs_has_all() {
        let made = generate(&Hide::Nothing, 1, Level::Clear).unwrap();
        let prepared = Prepared::new(&made.recording, None).unwrap();
        let regimes = regimes(&prepared, (0.0, STROKE));
        let names: Vec<&str> = regimes.iter().map(|regime| regime.name.as_str()).collect();
        assert_eq!(names, NAMES);
        for k in 0..prepared.grid.len() {
            assert_eq!(regimes.iter().filter(|regime| regime.member[k]).count(), 1);
        }
        let slow = regimes.iter().find(|regime| regime.name == "slow motion").unwrap();
        let top = prepared.velocity.iter().fold(0.0f64, |top, v| top.max(v.abs()));
        for (k, _) in prepared.grid.iter().zip(&slow.member).filter(|(_, member)| **member) {
            assert!(prepared.velocity[*k].abs() < 0.05 * top);
        }
    }

    #[test]
    fn a_start_after_a_rest_is_a_breakaway_and_a_turn_is_a_reversal() {
        let trips = Profile::new(1e-3).round_trip(0.05, 0.1, 1.0).dwell(0.5);
        let position = trips.round_trip(0.05, 0.1, 1.0).build(0.0, 0.0).position;
        let time = (0..position.len()).map(|k| 1e-3 * k as f64).collect();
        let force = position.iter().map(|x| 10.0 * x).collect();
        let channels =
            vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
        let recording = Recording::new("trips", time, channels).unwrap();
        let starts = starts(&Prepared::new(&recording, None).unwrap(), 5e-5);
        // A way takes 0.6 s.
        let (turn, start) = (starts[700], starts[1800]);
        assert!(!turn.from_rest && (turn.position - 0.05).abs() < 1e-3, "{turn:?}");
        assert!(start.from_rest && start.position.abs() < 1e-3, "{start:?}");
    }
}
