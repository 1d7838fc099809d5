//! Motions that an axis could be asked for, each made for the sake of some effects.

use crate::reference::{Profile, Reference};

/// What the axis has been seen to do. SI units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Room {
    /// Where motions begin.
    pub start: f64,
    /// Way that may be used from there, upwards.
    pub stroke: f64,
    /// Highest speed.
    pub speed: f64,
    /// Highest acceleration.
    pub acceleration: f64,
    /// Smallest displacement that is seen well.
    pub resolution: f64,
    /// Sampling interval, s.
    pub interval: f64,
}

/// A motion that could be asked for.
#[derive(Clone, Debug, PartialEq)]
pub struct Motion {
    /// Name, e.g. `constant speeds`.
    pub name: &'static str,
    /// What it does, in words.
    pub about: &'static str,
    /// The motion.
    pub reference: Reference,
}

/// Length of a motion, s; it is repeated, or as long as one pass takes.
const LENGTH: f64 = 16.0;
/// Samples over which accelerations are spread.
const SMOOTHING: f64 = 10.0;

/// Share of the acceleration that is used: pieces last whole samples, which makes their ends harder.
const SPARED: f64 = 0.9;

type Pass = fn(&Room, Profile) -> Profile;

const PASSES: [(&str, &str, Pass); 6] = [
    ("constant speeds", "constant speeds over a factor of 128, both ways", speeds),
    ("fast reversals", "reversals at full acceleration, ever faster", reversals),
    (
        "break-aways",
        "rests of 0.1 to 5 s, each followed by slow and fast ramps through low speed",
        rests,
    ),
    ("slow strokes", "the whole stroke at two slow speeds, both ways", strokes),
    (
        "small reversals",
        "reversals over a few to some hundred counts, slow and five times faster",
        small,
    ),
    (
        "a bit of everything",
        "constant speeds, fast, slow and small reversals, rests, slow strokes",
        all,
    ),
];

/// The motions to choose from.
pub fn motions(room: &Room) -> Vec<Motion> {
    let room = &Room { acceleration: SPARED * room.acceleration, ..*room };
    let build = |(name, about, pass): (&'static str, &'static str, Pass)| {
        let once = built(room, pass(room, Profile::new(room.interval)));
        let length = once.position.len() as f64 * room.interval;
        let times = (LENGTH / length).round().max(1.0) as usize;
        let again = |profile, _| pass(room, profile);
        let reference = match times {
            1 => once,
            _ => built(room, (0..times).fold(Profile::new(room.interval), again)),
        };
        Motion { name, about, reference }
    };
    PASSES.map(build).to_vec()
}

fn built(room: &Room, profile: Profile) -> Reference {
    profile.dwell(0.2).build(room.start, SMOOTHING * room.interval)
}

fn speeds(room: &Room, profile: Profile) -> Profile {
    (0..8).fold(profile.dwell(0.2), |profile, k| {
        let speed = room.speed / f64::from(1 << k);
        profile.round_trip(room.stroke.min(speed), speed, room.acceleration)
    })
}

/// Sines at the limit of acceleration, speed or stroke, up to a fiftieth of the sampling frequency.
fn reversals(room: &Room, profile: Profile) -> Profile {
    let highest = 0.02 / room.interval;
    let lowest = (room.acceleration / (std::f64::consts::TAU * room.speed)).min(0.1 * highest);
    (0..6).fold(profile.dwell(0.2), |profile, k| {
        let frequency = lowest * (highest / lowest).powf(f64::from(k) / 5.0);
        sine(room, profile, 0.5 * room.stroke, frequency, (0.8 * frequency).ceil())
    })
}

fn rests(room: &Room, profile: Profile) -> Profile {
    [0.1, 1.0, 5.0].into_iter().fold(profile, |profile, rest| {
        [2.0, 0.4].into_iter().fold(profile, |profile, duration| {
            let speed = (0.05 * room.speed).min(room.stroke / duration);
            profile.dwell(rest).velocity_triangle(speed, duration)
        })
    })
}

fn strokes(room: &Room, profile: Profile) -> Profile {
    [4.0, 1.5].into_iter().fold(profile.dwell(0.2), |profile, duration| {
        let speed = (room.stroke / duration).min(room.speed);
        profile.round_trip(room.stroke, speed, room.acceleration)
    })
}

fn small(room: &Room, profile: Profile) -> Profile {
    [2.0, 6.0, 20.0, 60.0, 200.0].into_iter().fold(profile.dwell(0.2), |profile, counts| {
        let amplitude = (counts * room.resolution).min(0.25 * room.stroke);
        let profile = sine(room, profile, amplitude, 1.0, 2.0);
        sine(room, profile, amplitude, 5.0, 3.0)
    })
}

fn all(room: &Room, profile: Profile) -> Profile {
    [speeds, reversals, strokes, small, rests]
        .iter()
        .fold(profile, |profile, pass| pass(room, profile))
}

/// A sine that begins at rest; its amplitude shrinks to what speed and acceleration allow.
fn sine(room: &Room, profile: Profile, amplitude: f64, frequency: f64, cycles: f64) -> Profile {
    let samples = (cycles / (frequency * room.interval)).round().max(1.0);
    let frequency = cycles / (samples * room.interval);
    let w = std::f64::consts::TAU * frequency;
    let most = (room.speed / w).min(room.acceleration / (w * w));
    profile.reciprocate(amplitude.min(most), frequency, cycles)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn motions_keep_to_what_the_axis_has_been_seen_to_do() {
        for (stroke, speed, acceleration, interval) in
            [(0.12, 0.3, 5.0, 1e-3), (1.0, 4.0, 60.0, 5.3e-3), (0.02, 0.5, 2.0, 1e-3)]
        {
            let room = Room {
                start: -0.3,
                stroke,
                speed,
                acceleration,
                resolution: 1e-5 * stroke,
                interval,
            };
            for motion in motions(&room) {
                let name = motion.name;
                let Reference { position, velocity, acceleration: a, .. } = &motion.reference;
                let above = |x: &f64| *x >= -0.3 - 1e-9 && *x <= -0.3 + stroke * (1.0 + 1e-9);
                assert!(position.iter().all(above), "{name} leaves the stroke");
                assert!(velocity.iter().all(|v| v.abs() <= 1.001 * speed), "{name} is too fast");
                assert!(a.iter().all(|a| a.abs() <= 1.01 * acceleration), "{name} is too hard");
                let length = position.len() as f64 * interval;
                assert!((8.0..100.0).contains(&length), "{name} takes {length} s");
                let back = position[position.len() - 1] - position[0];
                assert!(back.abs() < 0.02 * stroke, "{name} ends elsewhere");
            }
        }
    }
}
