//! A machine in motion with what is hidden in it.

use std::f64::consts::TAU;

use super::contact::Contact;
use super::drive::Drive;
use super::hidden::Hidden;
use super::integrator::Body;
use super::machine::{Build, Force, Machine, STEP};
use super::random::Stream;

/// How the second body hangs on the first.
#[derive(Clone, Copy, Debug)]
struct Joint {
    stiffness: f64,
    damping: f64,
    /// Play in all, m or rad.
    gap: f64,
    /// Part of the friction that acts on the second body.
    friction: f64,
}

impl Joint {
    /// Force on the second body.
    fn force(&self, stretch: f64, rate: f64) -> f64 {
        let half = 0.5 * self.gap;
        let pressed = stretch - stretch.clamp(-half, half);
        let force = self.stiffness * pressed + self.damping * rate;
        // Without play it is a spring; with play the sides only push.
        if self.gap > 0.0 && force * pressed <= 0.0 { 0.0 } else { force }
    }
}

/// See the module.
#[derive(Clone, Debug)]
pub struct Plant<'a> {
    machine: &'a Machine,
    hidden: Hidden,
    size: f64,
    /// Random numbers 0..1 of the law.
    draw: [f64; 6],
    end: f64,
    /// Largest command that the machine alone needs.
    peak: f64,
    drive: Drive,
    body: Body,
    second: Option<(Body, Joint)>,
    contact: Option<Contact>,
    /// Amplitude, wave number and phase of the profile along the way.
    profile: Vec<(f64, f64, f64)>,
    /// Time for which the contact has healed, s.
    healed: f64,
    /// Acceleration of the last step, and its mean size in the past.
    acceleration: (f64, f64),
    /// Largest acceleration that the motion wants, roughly.
    brisk: f64,
}

impl<'a> Plant<'a> {
    /// `machine` with `hidden` of `size`; `peak` is the largest command that the machine alone needs.
    pub fn new(
        (machine, build): (&'a Machine, Build),
        (hidden, size): (Hidden, f64),
        peak: f64,
        random: &mut Stream,
    ) -> Self {
        let draw = std::array::from_fn(|_| random.between(0.0, 1.0));
        let smooth = match machine.force {
            Force::Measured => machine.control_interval(),
            Force::Command => 0.0,
        };
        let delay = |time: f64| (time * machine.interval / STEP).round() as usize;
        let drive = match hidden {
            Hidden::Lag => Drive::ideal().lagging(size * machine.interval, false),
            Hidden::SecondOrderLag => Drive::ideal().lagging(0.5 * size * machine.interval, true),
            Hidden::Delay => Drive::ideal().delayed(delay(size)),
            Hidden::Saturation => Drive::ideal().limited((1.0 - size) * peak),
            _ => Drive::ideal().lagging(smooth, false),
        };
        let contact = match hidden {
            Hidden::LuGre if size > 0.0 => {
                Some(Contact::lugre(size * machine.short, 2e-4 + 1e-3 * draw[0]))
            }
            Hidden::Maxwell if size > 0.0 => Some(Contact::maxwell(size * machine.short, random)),
            _ => None,
        };
        let waves = (0..6).map(|_| {
            let wave = TAU / (machine.stroke * random.ratio(0.3, 2.0));
            (random.normal() / 3f64.sqrt(), wave, random.between(0.0, TAU))
        });
        let profile = waves.collect();
        let (part, joint) = Self::behind(machine, build, hidden, size, &draw);
        let second = joint.map(|joint| (Body::at(0.0, part * machine.mass), joint));
        Self {
            machine,
            hidden,
            size,
            draw,
            end: machine.wanted.len() as f64 * machine.control_interval(),
            peak,
            drive,
            body: Body::at(0.0, (1.0 - part) * machine.mass),
            second,
            contact,
            profile,
            healed: 1.0,
            acceleration: (0.0, 0.0),
            brisk: (peak - machine.coulomb).max(0.1 * peak) / machine.mass,
        }
    }

    /// Share of the mass behind the joint, and the joint.
    fn behind(
        machine: &Machine,
        build: Build,
        hidden: Hidden,
        size: f64,
        draw: &[f64; 6],
    ) -> (f64, Option<Joint>) {
        if size <= 0.0 {
            return (0.0, None);
        }
        match hidden {
            Hidden::Flexible => {
                let (low, high): (f64, f64) = match build {
                    Build::Table => (8.0, 35.0),
                    Build::Joint | Build::HangingJoint => (8.0, 30.0),
                    Build::Spindle => (40.0, 150.0),
                };
                let omega = TAU * low * (high / low).powf(draw[0]);
                let mass = size * machine.mass;
                let damping = 2.0 * (0.02 + 0.06 * draw[1]) * omega * mass;
                // A light load has little friction of its own.
                let friction = size * (0.3 + 0.9 * draw[2]);
                (size, Some(Joint { stiffness: mass * omega * omega, damping, gap: 0.0, friction }))
            }
            Hidden::Backlash => {
                let part = 0.3 + 0.3 * draw[0];
                let mass = part * machine.mass;
                let omega = TAU * (90.0 + 60.0 * draw[1]);
                let friction = 0.05 + 0.4 * draw[2];
                let (stiffness, damping) = (mass * omega * omega, 0.3 * omega * mass);
                (part, Some(Joint { stiffness, damping, gap: size * machine.short, friction }))
            }
            _ => (0.0, None),
        }
    }

    /// Position that the encoder sees.
    pub fn position(&self) -> f64 {
        self.body.x
    }

    /// Velocity of the body with the encoder.
    pub fn velocity(&self) -> f64 {
        self.body.v
    }

    /// Whether the contact gives before it slides.
    pub fn is_elastic(&self) -> bool {
        self.contact.is_some()
    }

    /// Force of the drive.
    pub fn force(&self) -> f64 {
        self.drive.force()
    }

    /// A number of the plant's own law in the unit of a model's parameter, with that parameter's name.
    pub fn parameter(&self, peak: f64) -> Option<(&'static str, f64)> {
        let Machine { coulomb, interval, speed, stroke, .. } = *self.machine;
        Some(match self.hidden {
            Hidden::Load => ("load-friction.mu", self.size),
            Hidden::Drag => ("quadratic-drag.c", self.size * coulomb / (speed * speed)),
            Hidden::Spring => ("spring.k", self.size * coulomb / stroke),
            Hidden::Lag => ("actuator-lag.tau", self.size * interval),
            Hidden::Delay => ("input-delay.T_d", self.size * interval),
            Hidden::Saturation => ("saturation.u_max", (1.0 - self.size) * peak),
            _ => return None,
        })
    }

    /// Friction level in a direction.
    fn level(&self, direction: f64, drive: f64, t: f64) -> f64 {
        let Machine { coulomb, mass, speed, .. } = *self.machine;
        let (size, draw) = (self.size, &self.draw);
        let slow = self.body.v.abs() / (speed * 5e-3 * 8f64.powf(draw[0]));
        let part = match self.hidden {
            Hidden::StribeckExponential => size * (-slow).exp(),
            Hidden::StribeckGaussian => size * (-slow * slow).exp(),
            Hidden::StribeckTanh => size * (1.0 - slow.tanh()),
            Hidden::Healing => size * (1.0 - (-self.healed / (0.2 * 10f64.powf(draw[0]))).exp()),
            Hidden::Profile => {
                let wave = |(a, k, phase): &(f64, f64, f64)| a * (k * self.body.x + phase).sin();
                size * self.profile.iter().map(wave).sum::<f64>()
            }
            Hidden::Load => size * drive.abs() / coulomb,
            Hidden::InertialLoad => size * mass * self.acceleration.0.abs() / coulomb,
            Hidden::Drift => size * self.warmth(t),
            Hidden::Asymmetry => size * (0.5 - draw[0]) * direction,
            Hidden::FrictionStep if t > (0.35 + 0.3 * draw[0]) * self.end => size,
            Hidden::PastAcceleration => size * self.acceleration.1 / self.brisk,
            _ => 0.0,
        };
        coulomb * (1.0 + part).max(0.05)
    }

    /// Share of the force that the drive was asked for and gives at `x`.
    fn gain(&self, force: f64, x: f64) -> f64 {
        let (size, draw) = (self.size, &self.draw);
        match self.hidden {
            Hidden::GainBySide if (force > 0.0) == (draw[0] < 0.5) => 1.0 + size,
            Hidden::GainBySide => 1.0 - size,
            Hidden::GainByCurrent => (1.0 - size * (force / self.peak).powi(2)).max(0.1),
            Hidden::GainAlongStroke => {
                // The stroke lies to either side of 0.
                let wave = 2.0 * self.machine.stroke / (1.6 * 5f64.powf(draw[0]));
                1.0 + size * (TAU * (x / wave + draw[1])).sin()
            }
            _ => 1.0,
        }
    }

    fn warmth(&self, t: f64) -> f64 {
        (-t / (self.end * (0.12 + 0.4 * self.draw[1]))).exp()
    }

    /// Viscous coefficient.
    fn viscous(&self, t: f64) -> f64 {
        let side = if self.draw[3] < 0.5 { self.size } else { -self.size };
        self.machine.viscous
            * match self.hidden {
                Hidden::Drift => 1.0 + 0.5 * self.size * self.warmth(t),
                Hidden::Asymmetry | Hidden::ViscosityByDirection => {
                    1.0 + side * self.body.v.signum()
                }
                _ => 1.0,
            }
    }

    /// Force that depends smoothly on place, speed and time and resists the motion.
    fn resistance(&self, x: f64, t: f64) -> f64 {
        let Machine { coulomb, offset, gravity, pitch, speed, stroke, .. } = *self.machine;
        let (size, draw) = (self.size * coulomb, &self.draw);
        let own = match self.hidden {
            Hidden::Ripple => {
                let angle = TAU * x / pitch + TAU * draw[0];
                size * (angle.sin() + (0.3 + 0.3 * draw[1]) * (2.0 * angle + TAU * draw[2]).sin())
            }
            Hidden::Drag => size * self.body.v * self.body.v.abs() / (speed * speed),
            Hidden::Spring => size * (x / stroke - 0.6 * (draw[0] - 0.5)),
            Hidden::Offset => {
                if draw[0] < 0.5 {
                    size
                } else {
                    -size
                }
            }
            Hidden::Periodic => size * (TAU * t * 0.4 * 18f64.powf(draw[0])).sin(),
            Hidden::SoftEnds => {
                let soft = stroke * (0.25 + 0.2 * draw[0]);
                let inside = (x.abs() - (stroke - soft)).max(0.0) / soft;
                size * inside * inside * x.signum()
            }
            _ => 0.0,
        };
        let offset = if self.hidden == Hidden::Offset { 0.0 } else { offset };
        own + offset + gravity.0 * (x - gravity.1).sin()
    }

    /// A step of the integrator under `command`.
    pub fn step(&mut self, command: f64, t: f64) {
        let middle = self.body.middle(STEP);
        let drive = self.drive.follow(command, STEP);
        let drive = drive * self.gain(drive, middle);
        let viscous = self.viscous(t);
        let mut push = drive - self.resistance(middle, t);
        let mut share = 1.0;
        if let Some((second, joint)) = self.second {
            let force = joint.force(middle - second.middle(STEP), self.body.v - second.v);
            push -= force;
            share = 1.0 - joint.friction;
            let level = self.level(1.0, drive, t) * joint.friction;
            let mut second = second;
            second.advance(force, |_| level, viscous * joint.friction, STEP);
            self.second = Some((second, joint));
        }
        let before = self.body.v;
        let levels = [-1.0, 1.0].map(|direction| share * self.level(direction, drive, t));
        if let Some(contact) = &mut self.contact {
            let level = if before < 0.0 { levels[0] } else { levels[1] };
            let force = contact.force(before * STEP, STEP, level);
            self.body.advance(push - force, |_| 0.0, viscous, STEP);
        } else {
            let level = |direction: f64| levels[usize::from(direction > 0.0)];
            self.body.advance(push, level, share * viscous, STEP);
        }
        let rate = (self.body.v - before) / STEP;
        let past = 0.1 + 0.4 * self.draw[2];
        // A transmitted force acts with a short delay, which also keeps the loop through the level stable.
        self.acceleration.0 += STEP / 2e-3 * (rate - self.acceleration.0);
        self.acceleration.1 += STEP / past * (self.acceleration.0.abs() - self.acceleration.1);
        let worn = 1e-6 * (2.0 + 8.0 * self.draw[4]);
        self.healed += STEP * (1.0 - self.body.v.abs() * self.healed / worn);
        self.healed = self.healed.max(0.0);
    }
}
