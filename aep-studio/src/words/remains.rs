//! What keeps a model incomplete, in sentences.

use missing_physics::measurement::quantity::quantity;
use missing_physics::report::{Astray, Course, Fault, NoCause, Refusal, Remains};

use super::places::pattern;
use super::times;

/// Something that a model leaves, as a sentence.
pub fn remains(what: &Remains) -> String {
    match what {
        Remains::Rival { rival, instead_of, nats, course } => {
            let does = if instead_of.is_empty() {
                format!("lowers the prediction error by {nats:.0} nats")
            } else {
                format!("does what {} would do ({nats:+.0} nats)", instead_of.join(" + "))
            };
            let rival = capital(rival);
            match course {
                Some(course) => format!(
                    "{rival} {does}: {}. Why, this recording does not show.",
                    self::course(course)
                ),
                None => format!("{rival} {does}. How large it is, and why, this recording does not show."),
            }
        }
        Remains::Outdone { by, refusal, instead_of, nats } => {
            let does = if instead_of.is_empty() {
                format!("lowers the prediction error by {nats:.0} nats")
            } else {
                format!("predicts better than {} by {nats:.0} nats", instead_of.join(" + "))
            };
            let (by, refused) = (by.join(" + "), super::refusal(refusal));
            match refusal {
                Refusal::Unknown { .. } => format!(
                    "{by} {does}, but {refused}: something is missing that acts like it, and this recording does not tell what."
                ),
                _ => format!(
                    "{by} {does}, but is not that ({refused}): something is missing that acts like it and is not in the library."
                ),
            }
        }
        Remains::SoFar { effects, nats, last } => format!(
            "Found so far: {} ({nats:+.0} nats; {} times what the sensors make is left). What might take that back was not asked: \
             more effects, fewer ones, what stands for none. A longer time limit asks it.",
            effects.join(", "),
            times(*last)
        ),
        Remains::MissingForce { rms, band, unit } => format!(
            "It lacks {} (rms) beyond doubt: that is known to ±{}.",
            quantity(*rms, unit),
            quantity(*band, unit)
        ),
        Remains::UnknownForce { recorded, unit } => format!(
            "What it lacks is nowhere known to a tenth of the recorded {} (rms): only the sensor predicts where the axis goes, and a \
             model that lacks most would do as well.",
            quantity(*recorded, unit)
        ),
        Remains::Faulty { fault } => self::fault(fault),
        Remains::ErrorNear { coordinate, at, unit, times } => format!(
            "Near {coordinate} {} it errs {times:.1} times as much as the sensors make it.",
            quantity(*at, unit)
        ),
        Remains::Structure { place } => format!(
            "What it leaves still depends on {} ({:.0} % of it; {}).",
            place.coordinate,
            100.0 * place.share,
            pattern(place)
        ),
        Remains::Astray { astray } => {
            let where_least = if astray.is_too_large() {
                "the measured force hardly matters"
            } else {
                "hardly anything has to be accelerated"
            };
            format!(
                "{}: one sample ahead this model errs least where {where_least}, and says little of what the force does. Where \
                 the value is known, fix it (--fix).",
                capital(&self::astray(astray))
            )
        }
        Remains::TooCoarse => {
            "From one sample to the next the model's own output changes as much as what it leaves: this is too coarse to \
             tell noise from something that is missing, unless the noise is stated."
                .to_owned()
        }
        Remains::Slow { rms, noise, unit } => format!(
            "What it leaves, {}, changes more slowly than noise of {}: something is missing that no effect describes, or \
             the noise has a colour that was not stated.",
            quantity(*rms, unit),
            quantity(*noise, unit)
        ),
    }
}

fn astray(astray: &Astray) -> String {
    let Astray { parameter, value, balance, unit } = astray;
    let value_told = quantity(*value, unit);
    let far = if astray.is_too_large() {
        format!("{:.0} times the", value / balance)
    } else if astray.is_too_small() {
        "less than a third of the".to_owned()
    } else {
        return format!("{parameter} is {value_told}, the least that is looked for");
    };
    let balance = quantity(*balance, unit);
    format!("{parameter} is {value_told}, {far} {balance} that the balance of forces gives")
}

fn fault(fault: &Fault) -> String {
    match fault {
        Fault::Repeated { share } => format!(
            "{:.2} % of the samples repeat the position before them while the axis moves: they were dropped, or the \
             recorder reads slower than it writes. They were left out.",
            100.0 * share
        ),
        Fault::Isolated { share } => format!(
            "{:.0} % of the squared error is in isolated samples: faults of the sampling look so (dropped or late samples, \
             wrong time stamps), and so do impacts.",
            100.0 * share
        ),
    }
}

/// What something that varies freely was found to be.
fn course(course: &Course) -> String {
    match course {
        Course::Step { change, at, unit, along_unit } => {
            format!("it changes by {} at {}", quantity(*change, unit), quantity(*at, along_unit))
        }
        Course::Wave { amplitude, period, unit, along_unit } => format!(
            "it swings by {} to either side every {}",
            quantity(*amplitude, unit),
            quantity(*period, along_unit)
        ),
        Course::Varies { range, from, to, unit, along_unit } => format!(
            "it varies over a range of {}, most of all between {} and {}",
            quantity(*range, unit),
            quantity(*from, along_unit),
            quantity(*to, along_unit)
        ),
        Course::Values { values } => super::size(values),
    }
}

/// Why effects that fit are not the cause.
pub fn no_cause(why: &NoCause) -> String {
    match why {
        NoCause::Astray { astray } => self::astray(astray),
        NoCause::PlainDoesMore { place } => format!("{} does more", pattern(place)),
        NoCause::Foretold => {
            "the errors before each sample foretell as much, as counts that beat with the samples do".to_owned()
        }
        NoCause::MostIsLeft { coordinate } => {
            format!("most of what depends on {coordinate} is left")
        }
        NoCause::LeavesForce { .. } => {
            "with it the model hardly errs more than the sensors: what is there would leave hardly any of that force".to_owned()
        }
    }
}

fn capital(words: &str) -> String {
    let mut letters = words.chars();
    letters.next().map_or_else(String::new, |first| first.to_uppercase().chain(letters).collect())
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::report::{Pattern, Where};

    #[test]
    fn what_was_refused_says_why_it_is_not_told() {
        let told = |instead_of: &[&str], refusal| {
            remains(&Remains::Outdone {
                by: vec!["backlash".into()],
                refusal,
                instead_of: instead_of.iter().map(|name| (*name).to_owned()).collect(),
                nats: 300.2,
            })
        };
        let parameter = || "backlash.b".to_owned();
        let unknown =
            Refusal::Unknown { parameter: parameter(), low: 1e-6, high: 1e-2, unit: "m".into() };
        assert_eq!(
            told(&[], unknown),
            "backlash lowers the prediction error by 300 nats, but backlash.b may be anything from 1.00 µm to 10.0 mm: \
             something is missing that acts like it, and this recording does not tell what."
        );
        assert_eq!(
            told(&["drift"], Refusal::AtLimit { parameter: parameter() }),
            "backlash predicts better than drift by 300 nats, but is not that (backlash.b ended at the limit of its search): \
             something is missing that acts like it and is not in the library."
        );
    }

    #[test]
    fn a_rival_says_instead_of_what_it_stands_and_how_it_runs() {
        let rival = |instead_of: &[&str], course| {
            remains(&Remains::Rival {
                rival: "a friction level that varies freely with time".into(),
                instead_of: instead_of.iter().map(|name| (*name).to_owned()).collect(),
                nats: 120.4,
                course,
            })
        };
        let (unit, along_unit) = ("N".to_owned(), "s".to_owned());
        let step = Course::Step { change: -1.7, at: 11.5, unit, along_unit };
        assert_eq!(
            rival(&["drift", "stribeck"], Some(step)),
            "A friction level that varies freely with time does what drift + stribeck would do (+120 nats): it changes by \
             -1.70 N at 11.5 s. Why, this recording does not show."
        );
        let (unit, along_unit) = ("N".to_owned(), "s".to_owned());
        let wave = Course::Wave { amplitude: 10.3, period: 0.435, unit, along_unit };
        assert!(
            rival(&[], Some(wave)).contains("it swings by 10.3 N to either side every 0.435 s.")
        );
        let (unit, along_unit) = ("N".to_owned(), "m".to_owned());
        let varies = Course::Varies { range: 1.7, from: 0.1, to: 0.11, unit, along_unit };
        assert!(rival(&[], Some(varies)).contains(
            "time lowers the prediction error by 120 nats: it varies over a range of 1.70 N, most of all between 100 mm and \
             110 mm."
        ));
        assert!(rival(&[], None).ends_with(
            "time lowers the prediction error by 120 nats. How large it is, and why, this recording does not show."
        ));
    }

    #[test]
    fn what_is_astray_says_how_far_and_how_to_mend_it() {
        let (parameter, unit) = ("mass".to_owned(), "kg".to_owned());
        let astray = Astray { parameter, value: 1254.6, balance: 52.0, unit };
        let why = no_cause(&NoCause::Astray { astray: astray.clone() });
        assert_eq!(why, "mass is 1255 kg, 24 times the 52.0 kg that the balance of forces gives");
        let told = remains(&Remains::Astray { astray });
        assert!(
            told.starts_with("Mass is 1255 kg, 24 times") && told.ends_with("fix it (--fix)."),
            "{told}"
        );
    }

    #[test]
    fn a_mass_that_is_astray_may_be_too_small_as_well() {
        let (parameter, unit) = ("mass".to_owned(), "kg".to_owned());
        let astray = Astray { parameter, value: 2e-3, balance: 52.0, unit };
        let told = remains(&Remains::Astray { astray });
        let begin = "Mass is 0.00200 kg, less than a third of the 52.0 kg that the balance of forces gives: ";
        assert!(told.starts_with(begin) && told.contains("has to be accelerated"), "{told}");
        let (parameter, unit) = ("mass".to_owned(), "kg".to_owned());
        let astray = Astray { parameter, value: 2e-3, balance: 2e-3, unit };
        let told = remains(&Remains::Astray { astray });
        assert!(told.starts_with("Mass is 0.00200 kg, the least that is looked for: "), "{told}");
        assert!(told.contains("has to be accelerated"), "{told}");
    }

    #[test]
    fn structure_says_its_share_and_its_pattern() {
        let place = Where {
            coordinate: "level".into(),
            share: 0.34,
            p_value: 0.001,
            unit: "m".into(),
            error_unit: "V".into(),
            pattern: Some(Pattern::Mean { error: 0.5, at: 0.02, against_motion: false }),
        };
        let more = no_cause(&NoCause::PlainDoesMore { place: place.clone() });
        assert_eq!(more, "largest mean error +0.500 V near 20.0 mm does more");
        assert!(no_cause(&NoCause::LeavesForce { band: 0.2 }).contains("would leave hardly any"));
        assert_eq!(
            remains(&Remains::Structure { place }),
            "What it leaves still depends on level (34 % of it; largest mean error +0.500 V near 20.0 mm)."
        );
    }
}
