//! What a view compares, and why its numbers must not be taken as they are.

use missing_physics::measurement::quantity::{percent, quantity};
use missing_physics::report::{Caveat, Compares, View};

/// What a view compares, and how.
pub fn compares(view: &View) -> String {
    match &view.compares {
        Compares::Residual { quantity, bandwidth } => {
            format!("{quantity} along the measured motion, below {bandwidth:.3} Hz")
        }
        Compares::Windows { .. } => {
            "position, simulated from a fitted start in each window; outliers capped".to_owned()
        }
        Compares::FreeRun => "position, simulated from the first sample of each segment".to_owned(),
        Compares::ClosedLoop { described, lag } => format!(
            "position, simulated under the controller that the recording shows ({:.1} % of its force; measured lag \
             behind the reference {} rms)",
            100.0 * described,
            quantity(*lag, &view.unit)
        ),
    }
}

/// Why the numbers of a view must not be taken as they are, where that is so.
pub fn caveat(view: &View) -> Option<String> {
    Some(match view.caveat? {
        Caveat::Drifted { times } => format!(
            "the free run has drifted: {times:.0} times the error of short windows. It adds up the force error twice, \
             also that of noise, and ranks models wrongly"
        ),
        Caveat::Hidden { bare, share } => format!(
            "the controller hides what the model lacks: a bare mass without any friction stays within {} ({}) here",
            quantity(bare, &view.unit),
            percent(share)
        ),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::report::{Metrics, SplitMetrics};

    fn view(compares: Compares, caveat: Option<Caveat>) -> View {
        let metrics = Metrics::of(&[1e-5], &[1.0]);
        let metrics = SplitMetrics { fit: metrics, validation: metrics };
        let (name, unit) = ("view".to_owned(), "m".to_owned());
        View { name, compares, unit, metrics, floor: None, decides: false, caveat }
    }

    #[test]
    fn a_view_is_told_with_its_numbers_and_what_speaks_against_it() {
        let hidden = Caveat::Hidden { bare: 2.5e-6, share: 0.004 };
        let closed = view(Compares::ClosedLoop { described: 0.987, lag: 1.2e-4 }, Some(hidden));
        assert!(
            compares(&closed)
                .ends_with("98.7 % of its force; measured lag behind the reference 120 µm rms)")
        );
        assert!(caveat(&closed).unwrap().ends_with("stays within 2.50 µm (0.40 %) here"));
        let free = view(Compares::FreeRun, Some(Caveat::Drifted { times: 41.7 }));
        assert!(caveat(&free).unwrap().contains("drifted: 42 times the error"));
        let force =
            view(Compares::Residual { quantity: "torque".to_owned(), bandwidth: 51.2 }, None);
        assert_eq!(compares(&force), "torque along the measured motion, below 51.200 Hz");
        assert_eq!(caveat(&force), None);
    }
}
