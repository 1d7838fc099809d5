//! What a discovery looks like on a terminal.

use missing_physics::report::{Budget, Remains, Verdict};
use missing_physics::{Discovery, Thresholds};
use serde_json::{Value, json};

use super::{Columns, compared, comparisons, ladder, ranking, verdict, why};

fn estimate(value: f64) -> Value {
    json!({"value": value, "low": value, "high": value, "unit": "N", "identifiable": true})
}

/// A ladder of one effect; `budget` where it is judged by prediction errors.
fn discovery(budget: bool) -> Discovery {
    let both = |quantity: &str, unit: Option<&str>, value: f64| {
        json!({"quantity": quantity, "unit": unit, "fit": value,
        "validation": value})
    };
    let rung = |added: Option<&str>, effects: &[&str], error: f64, times: f64| {
        let mut rung = json!({"added": added.as_slice(), "effects": effects, "parameters": {"coulomb.F_C": estimate(3.0)},
            "error": {"force_relative": both("force", None, error), "force_rms_N": both("force", Some("N"), 10.0 * error),
                "window_rms_m": both("window", Some("m"), 1e-5 * error)},
            "p_value": added.map(|_| 0.001)});
        if budget {
            rung["budget"] = times.into();
            rung["likelihood_gain"] = if added.is_some() { 812.3.into() } else { Value::Null };
        }
        rung
    };
    let sizes: Vec<Value> = (1..=4)
        .map(|k| json!({"name": format!("K_{k}"), "value": f64::from(k), "unit": "N/um"}))
        .collect();
    let candidate = json!({"effect": "presliding:free", "gain": 0.31, "p_value": 0.001,
        "size": sizes, "nats": budget.then_some(812.3)});
    let decision = |set: &[&str], outcome: &str, difference: f64| {
        json!({"rung": set.len() - 1, "candidate": set, "compared_with": ["coulomb"], "difference": difference,
            "standard_error": 15.0, "budget": 1.04, "outcome": outcome, "because": {"kind": "best_of_size"}})
    };
    let mut json = json!({
        "verdict": "effects_found",
        "added": ["position-friction:fine"],
        "ladder": [rung(None, &["coulomb"], 0.05, 12.52),
            rung(Some("position-friction:fine"), &["coulomb", "position-friction:fine"], 0.02, 1.04)],
        "ranking": [[candidate]], "where": [], "ambiguous": [], "noise_floor": {"force_N": 0.1}, "seed": 1,
        "wall_s": 1.0,
    });
    if budget {
        json["budget"] = json!({"expected": 1e-7, "base": 12.52, "last": 1.04, "complete": true});
        json["decisions"] = json!([
            decision(&["coulomb", "position-friction:fine"], "added", 812.3),
            decision(&["coulomb", "drift"], "worse", 402.0),
            decision(&["coulomb", "position-friction:fine", "reversal-decay"], "too_little", 9.0),
        ]);
    }
    serde_json::from_value(json).unwrap()
}

fn plain(text: &str) -> String {
    anstream::adapter::strip_str(text).to_string()
}

#[track_caller]
fn fits(text: &str) {
    for line in plain(text).lines() {
        assert!(line.chars().count() <= 100, "{}: {line}", line.chars().count());
    }
}

#[test]
fn the_ladder_is_judged_by_prediction_errors_and_fits_a_terminal() {
    let text = plain(&ladder(&discovery(true), "base model"));
    for part in
        ["prediction", "(x sensors)", "12.5", "1.04", "+812", "<= 0.001", "2.00 %", "██████████"]
    {
        assert!(text.contains(part), "'{part}' is not in\n{text}");
    }
    assert!(!text.contains("noise floor"), "{text}");
    fits(&text);
}

#[test]
fn without_prediction_errors_the_ladder_is_judged_by_the_force() {
    let text = plain(&ladder(&discovery(false), "base model"));
    assert!(text.contains("noise floor") && text.contains("0.001"), "{text}");
    assert!(!text.contains("sensors"), "{text}");
}

#[test]
fn candidates_are_ranked_in_nats_where_they_have_them() {
    let text = plain(&ranking(&discovery(true).ranking[0], Columns::All));
    for part in [
        "(nats)",
        "share",
        "chance",
        "+812",
        "31.0 %",
        "<= 0.001",
        "K_1 = 1.00 N/um, K_2 = 2.00 N/um, ...",
    ] {
        assert!(text.contains(part), "'{part}' is not in\n{text}");
    }
    fits(&text);
    let text = plain(&ranking(&discovery(false).ranking[0], Columns::Best));
    assert!(text.contains("p-value") && !text.contains("nats"), "{text}");
}

#[test]
fn the_record_is_a_table_for_each_number_of_effects() {
    let found = discovery(true);
    let text = plain(&compared(&found, &Thresholds::default()));
    for part in [
        "Sets of 1 effect",
        "Sets of 2 effects",
        "+812 ± 15",
        "> +80",
        "another is better",
        "gains too little",
    ] {
        assert!(text.contains(part), "'{part}' is not in\n{text}");
    }
    fits(&text);
    assert!(plain(&comparisons(&found)).contains("3 comparisons of models: --explain shows them"));
    assert_eq!(comparisons(&discovery(false)), "");
}

#[test]
fn the_verdict_says_how_complete_the_model_is_and_whether_the_search_was_cut() {
    let mut found = discovery(true);
    let text = plain(&verdict(&found));
    assert!(
        text.contains("MISSING EFFECT FOUND: position-friction:fine\n complete: 1.04 times"),
        "{text}"
    );
    found.verdict = Verdict::Stopped;
    let effects = std::mem::take(&mut found.added);
    found.remains = vec![Remains::SoFar { effects, nats: 900.0, last: 1.04 }];
    found.budget = found.budget.map(|budget| Budget { complete: false, ..budget });
    let text = plain(&verdict(&found));
    assert!(
        text.contains("STOPPED BEFORE ANYTHING WAS CERTAIN\n incomplete")
            && text.contains("Found so far:\n position-friction:fine (+900 nats; 1.04 times"),
        "{text}"
    );
    fits(&why(&"a long reason ".repeat(20)));
}
