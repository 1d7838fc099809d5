//! The verdict in one or two sentences.

use std::fmt::Write;

use missing_physics::Discovery;
use missing_physics::report::{Ambiguity, Budget, Candidate, Rung, Verdict};

use super::places::pattern;
use super::remains::remains;
use super::{chance, is_cut, main_error, nats, noise_of_input};

/// The verdict in one or two sentences; empty where nothing was looked for.
pub fn summary(discovery: &Discovery) -> String {
    if let Some(said) = most_likely(discovery) {
        return said;
    }
    let Some(budget) = discovery.budget else {
        return if is_cut(discovery) { NOTHING_CERTAIN.to_owned() } else { String::new() };
    };
    let mut text = verdict(discovery, &budget);
    if !budget.complete {
        if !discovery.added.is_empty() {
            // How much is left has been said.
            text.push_str(" The model is still incomplete.");
        }
        text.push_str(&left(discovery));
    }
    for choice in &discovery.ambiguous {
        let effects = choice.effects.join(" from ");
        // Writing to a string cannot fail.
        let _ = write!(text, " This data cannot tell {effects} apart: {}", experiment(choice));
    }
    if discovery.stopped && !discovery.untried.is_empty() {
        let _ = write!(text, " Not tried: {}.", discovery.untried.join(", "));
    }
    text
}

const NOTHING_CERTAIN: &str =
    "Stopped: the search was cut before anything could be said for certain.";

fn verdict(discovery: &Discovery, budget: &Budget) -> String {
    match discovery.verdict {
        Verdict::NothingMissing => format!(
            "Nothing is missing: one sample ahead the base model errs {:.2} times as much as the sensors make it{}, and no \
             effect of the library lowers that by more than chance.",
            budget.base,
            noise_of_input(discovery)
        ),
        Verdict::Unexplained if budget.last <= budget.allowed => format!(
            "One sample ahead the model errs {:.2} times as much as the sensors make it, but something is left that no \
             effect of the library explains.",
            budget.last
        ),
        Verdict::Unexplained => format!(
            "One sample ahead the model errs {:.1} times as much as the sensors make it, and no effect of the library \
             explains that.",
            budget.last
        ),
        Verdict::Stopped => NOTHING_CERTAIN.to_owned(),
        Verdict::EffectsFound | Verdict::Ambiguous => format!(
            "Missing: {}. With {} the prediction error falls from {:.2} to {:.2} times what the sensors make{}.",
            discovery.added.join(", "),
            if discovery.added.len() > 1 { "them" } else { "it" },
            budget.base,
            budget.last,
            shown(discovery)
        ),
    }
}

/// The error that is shown to people beside it: `, that of the force from 4.0 % to 2.1 %`.
fn shown(discovery: &Discovery) -> String {
    let Some(name) = main_error(discovery).filter(super::ErrorName::is_relative) else {
        return String::new();
    };
    let per_cent = |rung: Option<&Rung>| {
        let error = rung.and_then(|rung| rung.error.get(&name.key));
        error.map_or(0.0, |error| 100.0 * error.validation)
    };
    let (first, last) = (per_cent(discovery.ladder.first()), per_cent(discovery.ladder.last()));
    format!(", that of the {} from {first:.2} % to {last:.2} %", name.quantity)
}

/// Where what is left lies.
fn left(discovery: &Discovery) -> String {
    if let Some(first) = discovery.remains.first() {
        return format!(" {}", remains(first));
    }
    let likely = discovery.where_it_fails.iter().find(|place| place.is_structure());
    likely.map_or_else(String::new, |place| {
        format!(" It depends most on {}: {}.", place.coordinate, pattern(place))
    })
}

/// The experiment that would tell effects apart.
pub fn experiment(choice: &Ambiguity) -> String {
    choice.experiment.clone().unwrap_or_else(|| {
        let effects = choice.effects.join(" and ");
        format!("repeat the experiment with more varied motion to separate {effects}.")
    })
}

/// What the effect promises that is most likely missing, where it was asked for.
fn most_likely(discovery: &Discovery) -> Option<String> {
    let name = discovery.most_likely.as_ref()?;
    let ranking = discovery.ranking.first()?;
    suggestion(ranking.iter().find(|candidate| candidate.effect == *name)?)
}

/// What a candidate that was not to be added promises; nothing where it is not told in nats.
fn suggestion(best: &Candidate) -> Option<String> {
    let gain = nats(best.nats?);
    let chance = chance(best.p_value);
    let equals = if chance.starts_with('<') { "" } else { "= " };
    Some(format!(
        "Most likely missing: {}. One sample ahead the model with it gains {gain} nats (p {equals}{chance}). Nothing \
         was added.",
        best.effect
    ))
}

#[cfg(test)]
mod tests {
    use super::*;
    use missing_physics::report::Remains;
    use serde_json::{Value, json};

    fn discovery(change: &[(&str, Value)]) -> Discovery {
        let rung = |added: &[&str], error: f64| {
            let error = json!({"force_relative": {"quantity": "force", "unit": null, "fit": error, "validation": error}});
            json!({"added": added, "effects": [], "parameters": {}, "error": error, "p_value": null})
        };
        let mut json = json!({
            "verdict": "effects_found", "added": ["stribeck"],
            "ladder": [rung(&[], 0.05), rung(&["stribeck"], 0.02)],
            "ranking": [[{"effect": "drift", "gain": 0.1, "p_value": 0.001, "nats": 340.2}]],
            "where": [{"coordinate": "position", "share": 0.3, "p_value": 0.001, "unit": "m", "error_unit": "N",
                "pattern": {"kind": "mean", "error": 0.5, "at": 0.1, "against_motion": false}}],
            "ambiguous": [], "noise_floor": {}, "seed": 1, "wall_s": 1.0,
            "budget": {"expected": 1e-7, "base": 9.0, "last": 1.05, "allowed": 1.3, "complete": true},
        });
        for (key, value) in change {
            json[*key] = value.clone();
        }
        serde_json::from_value(json).unwrap()
    }

    fn budget(last: f64) -> (&'static str, Value) {
        let budget = json!({"expected": 1e-7, "base": last, "last": last, "allowed": 1.3, "complete": false});
        ("budget", budget)
    }

    #[test]
    fn what_was_found_is_told_with_both_errors() {
        assert_eq!(
            summary(&discovery(&[])),
            "Missing: stribeck. With it the prediction error falls from 9.00 to 1.05 times what the sensors make, that of \
             the force from 5.00 % to 2.00 %."
        );
    }

    #[test]
    fn several_effects_are_them() {
        let said = summary(&discovery(&[("added", json!(["stribeck", "drift"]))]));
        assert!(said.starts_with("Missing: stribeck, drift. With them the prediction"), "{said}");
    }

    #[test]
    fn a_search_that_was_cut_says_what_was_not_tried() {
        let cut = discovery(&[
            ("verdict", json!("stopped")),
            ("added", json!([])),
            ("stopped", json!(true)),
            ("untried", json!(["drift", "ripple"])),
            budget(3.0),
        ]);
        assert!(!summary(&cut).contains("so far"), "{}", summary(&cut));
        let so_far =
            json!([{"kind": "so_far", "effects": ["stribeck"], "nats": 830.0, "last": 1.1}]);
        let cut = Discovery { remains: serde_json::from_value(so_far).unwrap(), ..cut };
        let said = summary(&cut);
        assert!(said.starts_with(NOTHING_CERTAIN), "{said}");
        assert!(said.contains("Found so far: stribeck (+830 nats; 1.10 times"), "{said}");
        assert!(said.ends_with("Not tried: drift, ripple."), "{said}");
    }

    #[test]
    fn what_is_left_is_told_by_place_or_by_what_it_depends_on() {
        let unexplained = [("verdict", json!("unexplained")), ("added", json!([]))];
        let far = summary(&discovery(&[&unexplained[..], &[budget(3.0)]].concat()));
        assert!(far.starts_with("One sample ahead the model errs 3.0 times"), "{far}");
        assert!(
            far.ends_with("It depends most on position: largest mean error +0.500 N near 100 mm."),
            "{far}"
        );
        let mut near = discovery(&[&unexplained[..], &[budget(1.2)]].concat());
        assert!(summary(&near).contains("but something is left"));
        near.remains = vec![Remains::TooCoarse];
        assert!(summary(&near).contains("this is too coarse to tell noise"));
    }

    #[test]
    fn effects_that_cannot_be_told_apart_come_with_their_experiment() {
        let told = |choice| {
            summary(&discovery(&[("verdict", json!("ambiguous")), ("ambiguous", json!([choice]))]))
        };
        let known = told(json!({"effects": ["a", "b"], "experiment": "run it faster."}));
        assert!(known.ends_with("This data cannot tell a from b apart: run it faster."), "{known}");
        let unknown = told(json!({"effects": ["a", "b"]}));
        assert!(unknown.ends_with("more varied motion to separate a and b."), "{unknown}");
    }

    #[test]
    fn a_suggestion_names_the_effect_and_what_it_gains() {
        let said = summary(&discovery(&[("most_likely", json!("drift"))]));
        assert!(said.starts_with("Most likely missing: drift."), "{said}");
        assert!(said.contains("gains +340 nats (p <= 0.001)"), "{said}");
    }
}
