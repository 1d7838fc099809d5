//! What a user should know beside a verdict, in sentences.

use missing_physics::Hold;
use missing_physics::measurement::quantity::{percent, quantity};
use missing_physics::report::{Disagreement, Lacking, Remark};

use super::refusals::refusal;
use super::remains::no_cause;

/// A remark as a sentence.
pub fn remark(remark: &Remark) -> String {
    match remark {
        Remark::NotNamed { effects, refusal: why } => {
            format!("{} is not named: {}", effects.join(" + "), refusal(why))
        }
        Remark::FoundInPartOnly { effect } => format!(
            "A search on parts of the recording found {effect} besides; on all of it that gains too little or lowers no error."
        ),
        Remark::NotTheCause { effects, base, last, lacking, because } => format!(
            "nearest: {} would take the prediction error from {base:.2} to {last:.2} times what the sensors make{}: that \
             is not the cause{}",
            effects.join(" + "),
            lacking.as_ref().map_or_else(String::new, force),
            because.as_ref().map_or_else(String::new, |why| format!(" ({})", no_cause(why))),
        ),
        Remark::OtherLaw { of, law, nats } => format!(
            "{of} follows another law here, {law}, which leaves next to nothing of it: it stands in the base model, which \
             gains {nats:.0} nats by it, and counts as no effect that is missing. Put it in the place of {of} in your model."
        ),
        Remark::OfReading { effect, refusal: why, nats } => format!(
            "{effect} belongs to how the recording is read, stands in the base model, which gains {nats:.0} nats by it, and \
             counts as no effect that is missing: {}",
            refusal(why)
        ),
        Remark::Unconfirmed { share } => format!(
            "Time ran out: what is said was found on parts that are {} of what was looked at, and was not asked of all of it.",
            percent(*share)
        ),
        Remark::SensorsBetter { times } => format!(
            "The model errs {times:.2} times what the sensors make: their noise was taken as too large, and something \
             small may hide in it. Names rest on likelihoods, not on this."
        ),
        Remark::InputNoise { input, deviation, unit } => format!(
            "What is left is more than the sensors make and white, as large as a noise of the {input} of {} from sample to sample \
             makes it that the recording does not hold (of an amplifier, or of counts of a command). What lasts longer than a \
             sample is not in it.",
            quantity(*deviation, unit)
        ),
        Remark::ToldInBrief => {
            "Time ran out when the search was done: maps and tests of the residual were left out."
                .to_owned()
        }
        Remark::InPieces { samples, looked_at, pieces } => format!(
            "Of {samples} samples {looked_at} were looked at, in {pieces} pieces spread over the recording: what happens \
             only between them was not looked for."
        ),
        Remark::SearchedInPieces { share } => format!(
            "Nothing was named on pieces that are {} of what was looked at; there was no time to search all of it.",
            percent(*share)
        ),
        Remark::Read { input, hold, nats, by_search } => {
            let how = match hold {
                Hold::ZeroOrder => "held from one sample to the next",
                Hold::Sampled => "sampled, changing evenly between samples",
            };
            let why = if *by_search {
                "the simplest model hardly tells, the best model with one effect predicts better so"
                    .to_owned()
            } else {
                format!("that predicts better by {nats:.0} nats")
            };
            format!("The {input} is taken as {how}: {why}.")
        }
        Remark::Smoothed { input, below } => format!(
            "The {input} is recorded with noise that did not act: filtered below {}, without a delay, it predicts better. What \
             is said is said of the filtered {input}.",
            quantity(*below, "Hz")
        ),
        Remark::TakenTogether { input, every, apart } => format!(
            "From one sample to the next the position shows little but its counts and its noise: every {every} are taken \
             together, {} apart, the {input} averaged over them. What acts faster was not looked for.",
            quantity(*apart, "s")
        ),
        Remark::EvenSamples { jitter } => format!(
            "The time stamps jitter by {} of a sample, and the position does not move by that: it was sampled evenly. What is \
             said is said of even samples.",
            percent(*jitter)
        ),
        Remark::Given { input, most_shift } => format!(
            "The {input} that your model gives is taken over time, nothing of ours beside it. What its samples and \
             filters make is fitted and no effect: a shift of up to {most_shift} samples (timing.shift) and a smoothing \
             (timing.smoothing). Rests and reversals are left out, where a {input} made of velocities says nothing."
        ),
    }
}

fn force(lacking: &Lacking) -> String {
    let told = |force| quantity(force, &lacking.unit);
    format!(", the force that is lacking from {} to {}", told(lacking.base), told(lacking.last))
}

/// Where two views prefer different models.
pub fn disagreement(between: &Disagreement) -> String {
    let Disagreement { judge, prefers, view, instead, decides } = between;
    let advice = if *decides {
        "both views count: one of the models gains in its view by something that is not there"
    } else {
        "it is not to be judged by"
    };
    format!("the {judge} prefers '{prefers}', the {view} prefers '{instead}': {advice}")
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::report::{NamedValue, NoCause, Refusal};

    #[test]
    fn what_is_not_the_cause_says_what_it_would_do_and_why_it_is_none() {
        let told = remark(&Remark::NotTheCause {
            effects: vec!["ripple".into(), "drift".into()],
            base: 3.0,
            last: 2.5,
            lacking: Some(Lacking { base: 4.0, last: 3.5, unit: "N".into() }),
            because: Some(NoCause::MostIsLeft { coordinate: "position".into() }),
        });
        assert_eq!(
            told,
            "nearest: ripple + drift would take the prediction error from 3.00 to 2.50 times what the sensors make, the \
             force that is lacking from 4.00 N to 3.50 N: that is not the cause (most of what depends on position is left)"
        );
    }

    #[test]
    fn another_law_of_a_usual_effect_is_told_as_what_to_put_into_the_model() {
        let (of, law) = ("coulomb".to_owned(), "shear-thinning".to_owned());
        let told = remark(&Remark::OtherLaw { of, law, nats: 312.4 });
        assert!(told.contains("shear-thinning") && told.contains("312 nats"), "{told}");
        assert!(told.ends_with("Put it in the place of coulomb in your model."), "{told}");
    }

    #[test]
    fn what_belongs_to_the_reading_is_told_with_how_late_it_is() {
        let refusal = Refusal::NotThatEffect {
            effect: "input-delay".into(),
            value: NamedValue { name: "lateness".into(), value: 4.8e-4, unit: "s".into() },
            limit: 2.2e-3,
            meaning: "what the force does between two samples comes as late".into(),
        };
        let told =
            remark(&Remark::OfReading { effect: "input-delay".into(), refusal, nats: 312.4 });
        assert!(told.starts_with("input-delay belongs to how the recording is read"), "{told}");
        assert!(told.contains("312 nats") && told.contains("480 µs"), "{told}");
    }

    #[test]
    fn a_reading_says_how_and_why() {
        let read = |hold, by_search| {
            remark(&Remark::Read { input: "force".into(), hold, nats: 312.4, by_search })
        };
        assert_eq!(
            read(Hold::ZeroOrder, false),
            "The force is taken as held from one sample to the next: that predicts better by 312 nats."
        );
        assert!(read(Hold::Sampled, true).contains("hardly tells"));
    }

    #[test]
    fn samples_that_are_taken_together_are_told_with_their_number_and_distance() {
        let told = remark(&Remark::TakenTogether { input: "force".into(), every: 4, apart: 4e-3 });
        assert!(
            told.contains("every 4 are taken together, 4.00 ms apart, the force averaged"),
            "{told}"
        );
    }

    #[test]
    fn even_samples_are_told_with_how_far_their_stamps_were_off() {
        let told = remark(&Remark::EvenSamples { jitter: 0.0086 });
        assert!(told.starts_with("The time stamps jitter by 0.86 % of a sample, and"), "{told}");
    }

    #[test]
    fn noise_of_the_input_is_told_with_its_size() {
        let (input, unit) = ("force".into(), "N".into());
        let told = remark(&Remark::InputNoise { input, deviation: 0.55, unit });
        assert!(told.contains("as large as a noise of the force of 0.550 N from sample"), "{told}");
    }

    #[test]
    fn views_that_prefer_different_models_are_named_with_the_one_to_trust() {
        let between = Disagreement {
            judge: "force".into(),
            prefers: "a".into(),
            view: "free run".into(),
            instead: "b".into(),
            decides: false,
        };
        let said = "the force prefers 'a', the free run prefers 'b': it is not to be judged by";
        assert_eq!(disagreement(&between), said);
        assert!(
            disagreement(&Disagreement { decides: true, ..between }).contains("both views count")
        );
    }
}
