//! Why something was refused, or what a comparison was about.

use missing_physics::measurement::quantity::{percent, quantity};
use missing_physics::report::{Decision, Reason, Refusal};

/// Why a comparison came out as it did: `the best set of 2`; nothing where the numbers say it.
pub fn reason(decision: &Decision) -> Option<String> {
    Some(match decision.because.as_ref()? {
        Reason::BestOfSize => format!("the best set of {}", decision.rung),
        Reason::AsGoodWithout => "as good without".to_owned(),
        Reason::WithinSensors => {
            "without it the model errs less than the sensors make, in whose units it gains too little".to_owned()
        }
        Reason::ErrorNoLower => "the prediction error is no lower with it".to_owned(),
        Reason::NotRecurring => {
            "by its standard error chance gains as much, and the model with it is incomplete"
                .to_owned()
        }
        Reason::AtRest => {
            "it gains next to rest, where a contact holds, and too little where the axis moves fast"
                .to_owned()
        }
        Reason::Colour => {
            "it rings no more than a noise that the errors before each sample foretell".to_owned()
        }
        Reason::Foretold => "the errors before each sample foretell as much".to_owned(),
        Reason::Chance => "chance gains as much".to_owned(),
        Reason::PlainForm => "the plain form".to_owned(),
        Reason::OtherLaw => {
            "another law of an effect of the base, which leaves nothing of it".to_owned()
        }
        Reason::Simpler => "simpler effects in the place of one".to_owned(),
        Reason::Usual => "the usual effects in its place".to_owned(),
        Reason::Rival { rival } => rival.clone(),
        Reason::Refused { refusal } => self::refusal(refusal),
        Reason::NotFinite => "its prediction errors are not finite".to_owned(),
    })
}

/// Why what was fitted is no such effect.
pub fn refusal(refusal: &Refusal) -> String {
    match refusal {
        Refusal::NothingLeft { parameter } => format!("nothing of {parameter} is left"),
        Refusal::AtLimit { parameter } => format!("{parameter} ended at the limit of its search"),
        Refusal::NotThatEffect { effect, value, limit, meaning } => format!(
            "{effect}: {meaning} ({} {}, limit {})",
            value.name,
            quantity(value.value, &value.unit),
            quantity(*limit, &value.unit)
        ),
        Refusal::Unknown { parameter, low, high, unit } => format!(
            "{parameter} may be anything from {} to {}",
            quantity(*low, unit),
            quantity(*high, unit)
        ),
        Refusal::ShareOfGiven { effect, share, .. } => {
            format!(
                "{effect} is {} of what the given force has: filters make as much of it",
                percent(*share)
            )
        }
        Refusal::ShareOfQuantity { effect, share, .. } => {
            format!("{effect} makes {} of the force: filters make as much", percent(*share))
        }
        Refusal::WithinNoise { effect, change, noise, unit } => format!(
            "{effect} makes {}, no more than noise that moves the axis can ({})",
            quantity(*change, unit),
            quantity(*noise, unit)
        ),
        Refusal::WithinSamples { effect, samples } => {
            format!("{effect} is within {samples} samples: their timing")
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::report::NamedValue;

    #[test]
    fn every_refusal_says_the_number_that_it_rests_on() {
        let effect = || "e".to_owned();
        let value = NamedValue { name: "b".into(), value: 1e-6, unit: "m".into() };
        let meaning = "the gap is as narrow as it may be".to_owned();
        let told = [
            (Refusal::NothingLeft { parameter: "mass.m".into() }, "nothing of mass.m is left"),
            (Refusal::AtLimit { parameter: "e.p".into() }, "e.p ended at the limit of its search"),
            (
                Refusal::NotThatEffect { effect: effect(), value, limit: 2e-6, meaning },
                "e: the gap is as narrow as it may be (b 1.00 µm, limit 2.00 µm)",
            ),
            (
                Refusal::Unknown {
                    parameter: "e.b".into(),
                    low: 1e-6,
                    high: 1e-2,
                    unit: "m".into(),
                },
                "e.b may be anything from 1.00 µm to 10.0 mm",
            ),
            (
                Refusal::ShareOfGiven { effect: effect(), share: 0.013, least: 0.02 },
                "e is 1.30 % of what the given force has: filters make as much of it",
            ),
            (
                Refusal::ShareOfQuantity { effect: effect(), share: 0.003, least: 0.005 },
                "e makes 0.30 % of the force: filters make as much",
            ),
            (
                Refusal::WithinNoise {
                    effect: effect(),
                    change: 0.5,
                    noise: 1.0,
                    unit: "N".into(),
                },
                "e makes 0.500 N, no more than noise that moves the axis can (1.00 N)",
            ),
            (
                Refusal::WithinSamples { effect: effect(), samples: 1.5 },
                "e is within 1.5 samples: their timing",
            ),
        ];
        for (refusal, words) in told {
            assert_eq!(self::refusal(&refusal), words);
        }
    }
}
