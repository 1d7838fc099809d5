//! A limit of the drive that falls with the speed: the voltage that is left beside what the motor induces.

use super::{About, Effect, LIMIT, Parameter, Parameters, Quantity, SHOWS, Slot};
use crate::effects::about::Extent;
use crate::effects::{CLaw, Motion, Smooth};
use crate::simd::vectorised;

/// `clip(u, -u_max (1 + r v), u_max (1 - r v))` with `r = kappa/v_high`, as the force that is missing: the faster an axis is, the
/// less drives it on, and the more may brake it.
#[derive(Clone, Copy, Debug)]
pub(super) struct Speed;

static ABOUT: About = About {
    name: "saturation:speed",
    title: "saturation of the drive, sooner at speed (limited voltage)",
    equation: "F = clip(u, -u_max (1 + kappa v/v_high), u_max (1 - kappa v/v_high))",
    parameters: &[
        LIMIT,
        Parameter::shape(
            "kappa",
            "share of the limit that is lost at v_high",
            Quantity::One,
            (0.0, 0.98),
            0.5,
        )
        .linear(),
        Parameter::fixed("v_high", "top speed", Quantity::Velocity, (1e-6, 100.0), 0.05)
            .taken_from(Extent::TopSpeed),
    ],
    slots: &[Slot::SmoothForce],
    shows: SHOWS,
    reference: "W. Leonhard, Control of Electrical Drives, Springer (torque over speed at a limited voltage)",
};

impl Effect for Speed {
    fn about(&self) -> &'static About {
        &ABOUT
    }

    fn not_compensated(&self) -> Option<&'static str> {
        Some("it needs the force of the drive")
    }

    fn c_law(&self) -> Option<CLaw> {
        let smooth = "{
    const double less = {u_max} * {kappa} / {v_high} * v;
    force += drive - fmax(fmin(drive, {u_max} - less), -{u_max} - less);
}";
        let slope = "{
    const double per_speed = {u_max} * {kappa} / {v_high}, less = per_speed * v;
    if (drive > {u_max} - less || drive < -{u_max} - less) damping += per_speed;
}";
        Some(CLaw::smooth(smooth).damped(slope))
    }

    fn smooth_force(&self, p: Parameters<'_>, m: &Motion<'_>, out: &mut Smooth<'_>) {
        let law = (p.get(0), p.get(1), p.get(2));
        withhold(law.0, law.1, law.2, m.velocity, m.drive_force, out.force, out.damping);
    }
}

vectorised! {
    fn withhold(
        most: &[f64],
        lost: &[f64],
        top: &[f64],
        velocity: &[f64],
        drive: &[f64],
        force: &mut [f64],
        slope: &mut [f64],
    ) {
        let n = force.len();
        let (most, lost, top) = (&most[..n], &lost[..n], &top[..n]);
        let (velocity, drive, slope) = (&velocity[..n], &drive[..n], &mut slope[..n]);
        for i in 0..n {
            let per_speed = most[i] * lost[i] / top[i];
            let less = per_speed * velocity[i];
            let given = drive[i].min(most[i] - less).max(-most[i] - less);
            force[i] += drive[i] - given;
            // What is withheld grows with the speed that it is withheld at.
            slope[i] += if given == drive[i] { 0.0 } else { per_speed };
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::testing::{Point, along_and_simulated, smooth};

    #[test]
    fn the_faster_it_is_the_less_drives_and_the_more_brakes() {
        // 30 N at rest, half of it at the top speed; as much more may brake.
        let p = [30.0, 0.5, 0.2];
        let withheld = |drive_force: f64, v: f64| {
            smooth(&Speed, &p, Point { drive_force, ..Point::at(0.0, v) })
        };
        assert_eq!(withheld(10.0, 0.1), (0.0, 0.0));
        // A quarter of it is lost at half of the top speed, against 75 N/(m/s).
        assert_eq!(withheld(30.0, 0.1), (7.5, 75.0));
        assert_eq!(withheld(-35.0, 0.1), (0.0, 0.0));
        assert_eq!(withheld(-40.0, 0.1), (-2.5, 75.0));
        assert_eq!(withheld(-30.0, -0.1), (-7.5, 75.0));
        assert_eq!(withheld(50.0, 0.0), (20.0, 75.0));
    }

    #[test]
    fn the_force_along_a_simulated_motion_is_the_one_that_made_it() {
        let values = [("u_max", 25.0), ("kappa", 0.6), ("v_high", 0.3)];
        let left = along_and_simulated(&[("saturation:speed", &values)], None);
        assert!(left < 0.02, "{left}");
    }
}
