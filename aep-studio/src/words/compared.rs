//! The record of what was compared, in plain words.

use missing_physics::measurement::quantity::percent;
use missing_physics::report::{Decision, Outcome, Remark, Rung};
use missing_physics::{Discovery, Thresholds};

use super::{nats, times};

/// How to read the record.
pub const COMPARED: &str = "difference: what the set gains in held-out log-likelihood of the prediction errors, \
    in nats, with its standard error; x sensors: its prediction error over what the sensors alone make";

/// Headings of the record.
pub const COMPARED_HEADINGS: [&str; 6] =
    ["set", "compared with", "difference", "needed", "x sensors", "outcome"];

/// The comparisons of sets with so many effects beside the base model.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Compared {
    /// `Sets of 2 effects`.
    pub title: String,
    /// As [`COMPARED_HEADINGS`] say.
    pub rows: Vec<[String; 6]>,
}

/// The record, grouped by number of effects, in the order in which it was made.
pub fn compared(discovery: &Discovery, thresholds: &Thresholds) -> Vec<Compared> {
    let mut sizes: Vec<usize> = discovery.decisions.iter().map(|decision| decision.rung).collect();
    sizes.sort_unstable();
    sizes.dedup();
    let of = |size: usize| {
        let decisions = discovery.decisions.iter().filter(|decision| decision.rung == size);
        let title = match size {
            0 => "The base model alone".to_owned(),
            1 => "Sets of 1 effect".to_owned(),
            size => format!("Sets of {size} effects"),
        };
        let rows = decisions.map(|decision| row(discovery, decision, thresholds)).collect();
        Compared { title, rows }
    };
    sizes.into_iter().map(of).collect()
}

fn row(discovery: &Discovery, decision: &Decision, thresholds: &Thresholds) -> [String; 6] {
    [
        effects_of(discovery, &decision.candidate),
        effects_of(discovery, &decision.compared_with),
        format!(
            "{} ± {}",
            nats(decision.difference),
            nats(decision.standard_error).trim_start_matches('+')
        ),
        needed(decision, thresholds),
        times(decision.budget),
        outcome(discovery, decision, thresholds),
    ]
}

/// Effects beside those of the base model: `stribeck + drift`.
pub fn effects_of(discovery: &Discovery, effects: &[String]) -> String {
    let base = discovery.ladder.first().map_or(&[][..], |rung| &rung.effects);
    let beside: Vec<&str> =
        effects.iter().filter(|effect| !base.contains(effect)).map(String::as_str).collect();
    if beside.is_empty() { "base model".to_owned() } else { beside.join(" + ") }
}

/// Whether the candidate has an effect more than what it was compared with.
fn adds(decision: &Decision) -> bool {
    decision.candidate.len() > decision.compared_with.len()
}

/// What the difference had to exceed: an effect more must gain, an effect less or a plainer shape may lose as much.
pub fn needed(decision: &Decision, thresholds: &Thresholds) -> String {
    let sign = if adds(decision) { 1.0 } else { -1.0 };
    format!("> {}", nats(sign * thresholds.better))
}

/// What came of a comparison.
pub fn outcome(discovery: &Discovery, decision: &Decision, thresholds: &Thresholds) -> String {
    let enough = decision.difference > thresholds.better;
    // A search that is to add nothing leaves the choice to others.
    let suggested = discovery.added.is_empty() && enough;
    let words = match decision.outcome {
        Outcome::Added if adds(decision) => "added".to_owned(),
        Outcome::Added => "added in this shape".to_owned(),
        Outcome::AsGood => "as good".to_owned(),
        Outcome::TooLittle if enough && adds(decision) => {
            format!(
                "gains too little: below {} of all that is explained",
                percent(thresholds.share)
            )
        }
        Outcome::TooLittle => "gains too little".to_owned(),
        Outcome::Worse if suggested => "gains enough".to_owned(),
        Outcome::Worse => "another is better".to_owned(),
        Outcome::OtherShape => "another shape does it".to_owned(),
        Outcome::NotIdentifiable => "not identifiable".to_owned(),
        Outcome::Rival => "no effect, but does as much".to_owned(),
        Outcome::Dropped => match dropped(decision).as_slice() {
            [] => "dropped".to_owned(),
            effects => format!("{} dropped", effects.join(" + ")),
        },
    };
    match super::reason(decision) {
        None => words,
        Some(reason) => format!("{words} ({reason})"),
    }
}

/// Effects that the candidate does without.
fn dropped(decision: &Decision) -> Vec<&str> {
    let gone = decision.compared_with.iter().filter(|effect| !decision.candidate.contains(effect));
    gone.map(String::as_str).collect()
}

/// How many comparisons there were: `23 comparisons of models`; nothing where none are on record.
pub fn comparisons(discovery: &Discovery) -> Option<String> {
    match discovery.decisions.len() {
        0 => None,
        1 => Some("1 comparison of models".to_owned()),
        many => Some(format!("{many} comparisons of models")),
    }
}

/// Why nothing was added to the first `rung` effects, from what was compared; nothing where that is not on record.
pub fn why_nothing(discovery: &Discovery, rung: usize, thresholds: &Thresholds) -> Option<String> {
    if discovery.ladder.get(rung + 1).is_some() || discovery.budget.is_none() {
        return None;
    }
    if let Some(effect) = not_the_cause(discovery, rung) {
        return Some(format!("{effect} was found, but is not the cause: the notes say why"));
    }
    if let Some(decision) = taken_out(discovery, rung) {
        return Some(format!(
            "{} was taken out again: without it {} nats are lost, and an effect must be worth {}",
            dropped(decision).join(" + "),
            nats(-decision.difference).trim_start_matches('+'),
            nats(thresholds.better).trim_start_matches('+'),
        ));
    }
    if let Some(decision) = best_refused(discovery, rung, thresholds) {
        return Some(refusal(discovery, decision, thresholds));
    }
    if super::is_cut(discovery) {
        return Some("the search was stopped before anything was compared here".to_owned());
    }
    let best = discovery.ranking.get(rung)?.first()?;
    let gain = best.nats.map(|gain| {
        let needed = nats(thresholds.better);
        let needed = needed.trim_start_matches('+');
        let short = if gain > thresholds.better {
            format!(", {}", of_all(thresholds))
        } else {
            format!(" where {needed} are needed")
        };
        format!(", may gain {} nats{short}", nats(gain))
    });
    let gain = gain.unwrap_or_default();
    Some(format!("nothing promised enough to be fitted; the best, {}{gain}", best.effect))
}

/// The effect that was found after `rung` others, where all that was found was taken back.
fn not_the_cause(discovery: &Discovery, rung: usize) -> Option<&str> {
    let found = discovery.remarks.iter().find_map(|remark| match remark {
        Remark::NotTheCause { effects, .. } => effects.get(rung),
        _ => None,
    });
    found.filter(|_| discovery.added.is_empty()).map(String::as_str)
}

/// What is asked beside effects that explain much.
fn of_all(thresholds: &Thresholds) -> String {
    format!("less than {} of all that is explained", percent(thresholds.share))
}

/// An effect that was beside the first `rung` ones, and is none of them, and was not needed in the end.
fn taken_out(discovery: &Discovery, rung: usize) -> Option<&Decision> {
    let named = |effect: &&str| discovery.added.iter().any(|other| other == effect);
    let at = |decision: &&Decision| {
        let gone = dropped(decision);
        let size = decision.rung + gone.len();
        let stands = gone.iter().any(named);
        decision.outcome == Outcome::Dropped && !adds(decision) && size == rung + 1 && !stands
    };
    discovery.decisions.iter().rev().find(at)
}

/// The refused set of an effect more that says most about the refusal.
fn best_refused<'a>(
    discovery: &'a Discovery,
    rung: usize,
    thresholds: &Thresholds,
) -> Option<&'a Decision> {
    let below = discovery.ladder.get(rung).map(|rung: &Rung| &rung.effects);
    let all: Vec<&Decision> = discovery
        .decisions
        .iter()
        .filter(|d| d.rung == rung + 1 && adds(d) && d.outcome != Outcome::Added)
        .collect();
    // Beside the model of this rung, where it was the one that was extended.
    let beside = |d: &&&Decision| {
        below.is_some_and(|effects| {
            effects.len() == d.compared_with.len()
                && effects.iter().all(|e| d.compared_with.contains(e))
        })
    };
    let near: Vec<&Decision> = all.iter().filter(beside).copied().collect();
    let refused = if near.is_empty() { all } else { near };
    // Where sets gained enough at first, the last word was on the best of them.
    let gained = |d: &&Decision| d.outcome == Outcome::Worse && d.difference > thresholds.better;
    let last_word = refused.iter().rev().find(|d| d.outcome == Outcome::TooLittle);
    if let Some(last) = last_word.filter(|_| refused.iter().any(gained)) {
        return Some(last);
    }
    refused.into_iter().max_by(|a, b| a.difference.total_cmp(&b.difference))
}

fn refusal(discovery: &Discovery, decision: &Decision, thresholds: &Thresholds) -> String {
    let added: Vec<String> = decision
        .candidate
        .iter()
        .filter(|e| !decision.compared_with.contains(e))
        .cloned()
        .collect();
    let name = effects_of(discovery, if added.is_empty() { &decision.candidate } else { &added });
    let gain = nats(decision.difference);
    let best = format!("the best refused, {name}, gains {gain} nats");
    let needed = nats(thresholds.better);
    let needed = needed.trim_start_matches('+');
    let enough = decision.difference > thresholds.better;
    match decision.outcome {
        Outcome::TooLittle if enough => format!("{best}, {}", of_all(thresholds)),
        Outcome::NotIdentifiable => format!("{best}, but the data do not determine it"),
        Outcome::OtherShape => format!("{best}, which another shape of an effect does, too"),
        Outcome::Rival => format!("{name}, which stands for no effect, gains {gain} nats"),
        _ if enough && discovery.added.is_empty() => {
            format!("nothing was to be added: {name} gains {gain} nats, which is enough")
        }
        _ if enough => format!("{best}, but another set is better"),
        _ => format!("{best}, and {needed} are needed"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::report::Reason;
    use serde_json::{Value, json};

    fn decision(rung: usize, candidate: &str, with: &str, difference: f64, outcome: &str) -> Value {
        let names = |text: &str| -> Vec<String> {
            std::iter::once("coulomb")
                .chain(text.split('+').filter(|name| !name.is_empty()))
                .map(str::to_owned)
                .collect()
        };
        json!({"rung": rung, "candidate": names(candidate), "compared_with": names(with), "difference": difference,
            "standard_error": 12.0, "budget": 1.5, "outcome": outcome})
    }

    fn discovery(added: &[&str], decisions: &[Value]) -> Discovery {
        let rung = |added: Value, effects: Vec<&str>| json!({"added": added, "effects": effects, "parameters": {}, "error": {}, "p_value": null});
        let mut ladder = vec![rung(json!([]), vec!["coulomb"])];
        for (k, effect) in added.iter().enumerate() {
            ladder.push(rung(json!([effect]), [&["coulomb"], &added[..=k]].concat()));
        }
        let json = json!({
            "verdict": "effects_found", "added": added, "ladder": ladder, "where": [], "ambiguous": [],
            "ranking": [[], [{"effect": "ripple", "gain": 0.001, "p_value": 0.4, "nats": 7.3}]],
            "noise_floor": {}, "seed": 1, "wall_s": 1.0, "decisions": decisions,
            "budget": {"expected": 1e-7, "base": 9.0, "last": 1.0, "complete": true},
        });
        serde_json::from_value(json).unwrap()
    }

    #[test]
    fn the_record_is_grouped_by_number_of_effects_in_plain_words() {
        let found = discovery(
            &["stribeck"],
            &[
                decision(1, "stribeck", "", 340.0, "added"),
                decision(1, "drift", "", 3.0, "too_little"),
                decision(2, "stribeck+drift", "stribeck", 130.0, "too_little"),
                decision(1, "stribeck", "stribeck+drift", -20.0, "dropped"),
                decision(2, "stribeck+ripple", "stribeck", 20.0, "not_identifiable"),
            ],
        );
        let record = compared(&found, &Thresholds::default());
        let titles: Vec<&str> = record.iter().map(|group| group.title.as_str()).collect();
        assert_eq!(titles, ["Sets of 1 effect", "Sets of 2 effects"]);
        let first = ["stribeck", "base model", "+340 ± 12", "> +80", "1.50", "added"];
        assert_eq!(record[0].rows[0], first);
        assert_eq!(record[0].rows[1][5], "gains too little");
        assert_eq!(&record[0].rows[2][3..], ["> -80", "1.50", "drift dropped"]);
        assert_eq!(record[1].rows[0][5], "gains too little: below 2.00 % of all that is explained");
        assert_eq!(record[1].rows[1][5], "not identifiable");
        assert_eq!(comparisons(&found).unwrap(), "5 comparisons of models");
    }

    #[test]
    fn every_outcome_has_its_words() {
        let found = discovery(&["stribeck"], &[]);
        let words = [
            ("added", "added"),
            ("as_good", "as good"),
            ("too_little", "gains too little"),
            ("worse", "another is better"),
            ("other_shape", "another shape does it"),
            ("not_identifiable", "not identifiable"),
            ("rival", "no effect, but does as much"),
            ("dropped", "dropped"),
        ];
        for (name, words) in words {
            let decision: Decision =
                serde_json::from_value(decision(1, "a", "", 5.0, name)).unwrap();
            assert_eq!(outcome(&found, &decision, &Thresholds::default()), words);
            let because = Some(Reason::Rival { rival: "so".to_owned() });
            let reason = Decision { because, ..decision };
            assert_eq!(outcome(&found, &reason, &Thresholds::default()), format!("{words} (so)"));
        }
    }

    #[test]
    fn where_nothing_is_added_the_best_refused_candidate_says_why() {
        let why = |decisions: &[Value]| {
            why_nothing(&discovery(&["stribeck"], decisions), 1, &Thresholds::default()).unwrap()
        };
        let too_little = decision(2, "stribeck+drift", "stribeck", 30.0, "too_little");
        let elsewhere = decision(2, "ripple+drift", "ripple", 90.0, "too_little");
        assert_eq!(
            why(&[
                decision(2, "stribeck+ripple", "stribeck", 3.0, "too_little"),
                too_little,
                elsewhere
            ]),
            "the best refused, drift, gains +30 nats, and 80 are needed"
        );
        let share = decision(2, "stribeck+drift", "stribeck", 140.0, "too_little");
        let passed = decision(2, "stribeck+ripple", "stribeck", 150.0, "worse");
        assert!(
            why(&[passed, share])
                .ends_with("drift, gains +140 nats, less than 2.00 % of all that is explained")
        );
        let gone = decision(1, "stribeck", "stribeck+drift", -20.0, "dropped");
        assert!(why(&[gone]).starts_with("drift was taken out again: without it 20 nats are lost"));
        assert_eq!(
            why(&[]),
            "nothing promised enough to be fitted; the best, ripple, may gain +7.3 nats where 80 are needed"
        );
        let small = Thresholds { better: 1.0, ..Thresholds::default() };
        assert!(
            why_nothing(&discovery(&["stribeck"], &[]), 1, &small)
                .unwrap()
                .ends_with("may gain +7.3 nats, less than 2.00 % of all that is explained")
        );
        // The rung that was reached needs no excuse.
        assert_eq!(why_nothing(&discovery(&["stribeck"], &[]), 0, &Thresholds::default()), None);
    }

    #[test]
    fn where_names_were_taken_back_each_of_their_steps_says_so() {
        let refused = decision(1, "stribeck", "", 1024.0, "worse");
        let mut found = discovery(&[], &[refused]);
        let why = |found: &Discovery, rung| why_nothing(found, rung, &Thresholds::default());
        let words = "nothing was to be added: stribeck gains +1024 nats, which is enough";
        assert_eq!(why(&found, 0).unwrap(), words);
        let effects = vec!["asymmetry".to_owned()];
        let (lacking, because) = (None, None);
        found.remarks =
            vec![Remark::NotTheCause { effects, base: 1.75, last: 1.65, lacking, because }];
        let words = "asymmetry was found, but is not the cause: the notes say why";
        assert_eq!(why(&found, 0).unwrap(), words);
        assert!(!why(&found, 1).unwrap().contains("asymmetry"));
        // Of a look that was not told.
        found.added = vec!["drift".to_owned()];
        assert!(!why(&found, 0).unwrap_or_default().contains("asymmetry"));
    }

    #[test]
    fn a_search_that_was_cut_says_so() {
        let cut = Discovery { untried: vec!["ripple".to_owned()], ..discovery(&["stribeck"], &[]) };
        assert!(why_nothing(&cut, 1, &Thresholds::default()).unwrap().contains("stopped"));
    }
}
