//! What is to be known of a recording before any model, in sentences.

use missing_physics::measurement::check::Finding;
use missing_physics::measurement::quantity::{percent, quantity};

/// A finding as a sentence.
pub fn finding(finding: &Finding) -> String {
    match finding {
        Finding::Gaps { count, longest, ends_a_segment } => format!(
            "{} in the samples, the longest {} at {:.3} s: {}",
            if *count == 1 { "a gap".to_owned() } else { format!("{count} gaps") },
            quantity(longest.length_s, "s"),
            longest.at_s,
            if *ends_a_segment {
                "the recording is cut into segments there"
            } else {
                "bridged by straight lines"
            },
        ),
        Finding::SlowSampling { interval_s } => format!(
            "one sample every {} is slow for a drive: is the time really in seconds?",
            quantity(*interval_s, "s")
        ),
        Finding::Jitter { jitter, interval_s } => format!(
            "the sampling interval varies by {} around {}",
            percent(*jitter),
            quantity(*interval_s, "s")
        ),
        Finding::Constant { channel, value, unit, .. } => {
            format!("the {channel} is {} in every sample", quantity(*value, unit))
        }
        Finding::Clipped { channel, level, unit, share } => format!(
            "the {channel} is held at {} in {} of the samples: it is clipped there",
            quantity(*level, unit),
            percent(*share)
        ),
        Finding::NegativeWork { share } => format!(
            "on the whole the force takes energy out of the axis ({} of all that goes to and fro), where it should move it against \
             friction: the sign of force or position is probably turned (--force-gain -1)",
            percent(-share)
        ),
        Finding::Fast { top, unit } => format!(
            "speeds up to {}: are position and time really in these units (--position-unit mm)?",
            quantity(*top, unit)
        ),
        Finding::OneDirection => {
            "the axis moves in one direction only: friction and a constant force cannot be told apart"
                .to_owned()
        }
        Finding::FewReversals { reversals } => format!(
            "only {}: what happens there is seen too rarely to be sure of",
            changes(*reversals)
        ),
        Finding::Counts { count, unit, step, top, speed_unit, coarse } => {
            let text = format!(
                "one count of the position is {}; one count a sample is {}",
                quantity(*count, unit),
                quantity(*step, speed_unit)
            );
            if *coarse {
                let top = quantity(*top, speed_unit);
                format!("{text}, which is coarse against a top speed of {top}")
            } else {
                text
            }
        }
        Finding::Speeds { top, slow, unit, slow_share, reversals } => format!(
            "speeds up to {}, {} of the samples below {}, {}",
            quantity(*top, unit),
            percent(*slow_share),
            quantity(*slow, unit),
            changes(*reversals)
        ),
        Finding::Repeats { period_s, cycles, force, force_unit } => {
            let motion =
                format!("the motion repeats every {}, {cycles} times", quantity(*period_s, "s"));
            match force {
                Some(force) => format!(
                    "{motion}; from cycle to cycle the force differs by {} rms",
                    quantity(*force, force_unit)
                ),
                None => motion,
            }
        }
    }
}

fn changes(reversals: usize) -> String {
    format!("{reversals} {} of direction", if reversals == 1 { "change" } else { "changes" })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_their_units_and_one_is_no_plural() {
        let clipped = Finding::Clipped {
            channel: "force".into(),
            level: -22.0,
            unit: "V".into(),
            share: 0.034,
        };
        assert_eq!(
            finding(&clipped),
            "the force is held at -22.0 V in 3.40 % of the samples: it is clipped there"
        );
        assert!(finding(&Finding::FewReversals { reversals: 1 }).starts_with("only 1 change of"));
        let repeats =
            |force| Finding::Repeats { period_s: 2.0, cycles: 5, force, force_unit: "N".into() };
        assert_eq!(finding(&repeats(None)), "the motion repeats every 2.00 s, 5 times");
        assert!(finding(&repeats(Some(0.5))).ends_with("the force differs by 0.500 N rms"));
    }
}
