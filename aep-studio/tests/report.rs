//! The page of a discovery as the engine writes it.

use std::f64::consts::PI;

use aep_studio::{Source, report};
use missing_physics::measurement::check::{DataCheck, check};
use missing_physics::report::{NamedValue, Reason, Verdict};
use missing_physics::{Channel, Discovery, Recording};
use serde_json::json;

fn discovery() -> Discovery {
    serde_json::from_str(include_str!("fixtures/discovery.json")).unwrap()
}

fn data() -> DataCheck {
    let time: Vec<f64> = (0..2000).map(|k| f64::from(k) * 1e-3).collect();
    let force = time.iter().map(|t| (30.0 * (PI * t).sin()).min(25.0)).collect();
    let position = time.iter().map(|t| (1e5 * (PI * t).cos()).round() * 1e-6).collect();
    let channels = vec![Channel::new("force", "N", force), Channel::new("position", "m", position)];
    check(&Recording::new("run.csv", time, channels).unwrap())
}

fn source(name: &str) -> Source {
    let columns = vec![["force".into(), "vir*gtau".into(), "N".into()]];
    Source {
        name: name.to_owned(),
        columns,
        command: "aep discover run.csv --seed 1".to_owned(),
        ..Source::default()
    }
}

fn page(discovery: &Discovery) -> String {
    let page = report::html(discovery, &source("run.csv"), &data());
    // For a look at it: AEP_KEEP_PAGE=page.html cargo test -p aep-studio
    if let Ok(path) = std::env::var("AEP_KEEP_PAGE") {
        std::fs::write(path, &page).unwrap();
    }
    page
}

#[test]
fn everything_found_stands_on_the_page() {
    let page = page(&discovery());
    for part in [
        "Found, but ambiguous",
        "asymmetry",
        "4.08 %",
        "2.07 %",
        "constant speed",
        "largest mean error +0.600 N near 2.50 mm",
        "not determined by this data",
        "frictional-memory",
        "Speed up and slow down",
        "vir*gtau",
        "held at 25.0 N",
        "Seed 1",
    ] {
        assert!(page.contains(part), "'{part}' is not on the page");
    }
}

#[test]
fn maps_with_bands_named_lines_and_views_stand_on_the_page() {
    let mut discovery = discovery();
    let bin =
        |at: f64| json!({"at": at, "mean": at, "low": at - 1.0, "high": at + 1.0, "points": 9});
    let coordinate = discovery.where_base[0].coordinate.clone();
    let diagnosis = json!({
        "whiteness": {"interval_s": 0.008, "autocorrelation": [0.5], "expected": [0.0],
            "bound": [0.1], "statistic": 99.0, "degrees_of_freedom": 1, "p_value": 0.0001,
            "memory_s": 0.016},
        "independence": [],
        "maps": [{"coordinate": coordinate, "unit": "m/s", "against_motion": true,
            "bins": [bin(0.0), bin(1.0), bin(2.0)]}],
        "lines": [{"along": "time", "period": 0.02, "unit": "s",
            "amplitude": 0.4, "p_value": 0.001, "relation": {"kind": "seen_at", "rate": 0.125, "unit": "m/s",
                "of": {"along": "position", "period": 0.0025, "unit": "m"}}}],
    });
    discovery.diagnosis = Some(serde_json::from_value(diagnosis).unwrap());
    let metrics = json!({"rms": 1.2, "relative": 0.03, "fit_percent": 97.1,
        "variance_accounted_for_percent": null, "points": 100});
    let view = json!({"name": "free <run>", "compares": {"kind": "free_run"}, "unit": "m", "floor": null,
        "metrics": {"fit": metrics, "validation": metrics}, "decides": false,
        "caveat": {"kind": "drifted", "times": 12.0}});
    discovery.views = vec![serde_json::from_value(view).unwrap()];
    let page = page(&discovery) + &report::comparison(&discovery, &source("run.csv"), &data());
    for part in [
        "not white (p &lt; 0.001): it resembles itself for about 16.0 ms",
        "period 2.50 mm seen at 125 mm/s",
        "class=\"band",
        "97.10",
        "free &lt;run&gt;<small>position, simulated from the first sample",
        "the free run has drifted: 12 times",
    ] {
        assert!(page.contains(part), "'{part}' is not on the page");
    }
}

#[test]
fn the_missing_force_stands_where_it_fails_with_bands_and_gaps() {
    let missing = |size: f64| {
        json!({"unit": "N", "rms": size, "recorded": 14.2, "share": size / 14.2, "band": 0.12, "known": 0.9,
            "time": [0.0, 0.1, 0.2, 0.9, 1.0], "force": vec![size; 5], "half_width": vec![0.12; 5],
            "maps": [{"coordinate": "velocity", "unit": "m/s", "against_motion": false, "bins": [
                {"at": 0.0, "mean": 1.0, "low": 0.5, "high": 1.5, "points": 9},
                {"at": 1.0, "mean": 2.0, "low": 1.5, "high": 2.5, "points": 9}]}]})
    };
    let mut discovery = discovery();
    assert!(!page(&discovery).contains("Missing force"));
    discovery.missing_force_base = Some(serde_json::from_value(missing(2.31)).unwrap());
    discovery.missing_force = Some(serde_json::from_value(missing(0.31)).unwrap());
    let page = page(&discovery);
    let section = page.split("id=\"where\"").nth(1).unwrap().split("</section>").next().unwrap();
    for part in [
        "missing force: 2.31 N rms of 14.2 N (16.3 %), known to ±0.120 N; with what was found 0.310 N",
        "Missing force over time",
        "Missing force along velocity",
        "of the missing force",
        "While the model rests, 10.0 % of the time, it is not known",
        "class=\"band c2\"",
        "class=\"band c1\"",
    ] {
        assert!(section.contains(part), "'{part}' is not in the section");
    }
    // Two stretches each over time, one along the velocity.
    assert_eq!(section.matches("<polyline class=\"line c2\"").count(), 3);
}

/// The discovery with what a search by prediction errors tells besides.
fn ahead() -> Discovery {
    let mut discovery = discovery();
    for (k, rung) in discovery.ladder.iter_mut().enumerate() {
        rung.budget = Some([12.5, 3.12][k.min(1)]);
        rung.likelihood_gain = (k > 0).then_some(812.0);
    }
    for candidate in discovery.ranking.iter_mut().flatten() {
        candidate.nats = Some(81.2);
        candidate.p_value = 0.001;
    }
    let last = discovery.ladder.last().unwrap().effects.clone();
    let below = discovery.ladder.len();
    let decision = |candidate: &str, outcome: &str, rung: usize| {
        let mut with = last.clone();
        with.push(candidate.to_owned());
        json!({"rung": rung, "candidate": with, "compared_with": last, "difference": 35.0,
            "standard_error": 7.0, "budget": 3.1, "outcome": outcome, "because": {"kind": "rival", "rival": "so <it> is"}})
    };
    let decisions =
        json!([decision("cogging", "too_little", below), decision("drift", "worse", 1)]);
    discovery.decisions = serde_json::from_value(decisions).unwrap();
    let budget = json!({"expected": 1e-7, "base": 12.5, "last": 3.12, "complete": false});
    discovery.budget = Some(serde_json::from_value(budget).unwrap());
    discovery
}

#[test]
fn what_decided_stands_on_the_page() {
    let page = page(&ahead());
    for part in [
        "The model is incomplete: 3.1 times what the sensors make is left.",
        "12.5 ×",
        "Prediction error (× sensors)",
        "+812",
        "What was compared",
        "2 comparisons of models",
        "Sets of 1 effect",
        "+35 ± 7.0",
        "&gt; +80",
        "gains too little (so &lt;it&gt; is)",
        "another is better",
        "&lt;= 0.001",
        "Gain, nats",
    ] {
        assert!(page.contains(part), "'{part}' is not on the page");
    }
    assert!(page.contains("<header class=doubt>"));
    // The record is folded.
    assert!(page.contains("<details><summary>Sets of 1 effect: 1</summary>"));
}

#[test]
fn a_search_that_was_cut_claims_no_more_than_it_has() {
    let mut discovery = ahead();
    discovery.verdict = Verdict::Stopped;
    discovery.untried = vec!["drift".to_owned()];
    let page = page(&discovery);
    assert!(page.contains("before anything was certain") && !page.contains("Missing effect"));
}

/// The page without the scripts that every page has.
fn without_scripts(page: &str) -> String {
    let mut rest = page;
    let mut kept = String::new();
    while let Some((before, script)) = rest.split_once("<script") {
        kept.push_str(before);
        rest = script.split_once("</script>").unwrap().1;
    }
    kept + rest
}

#[test]
fn the_page_loads_nothing() {
    let page = page(&discovery());
    assert!(page.contains("default-src 'none'"));
    let page = without_scripts(&page);
    for part in ["<script", "http://", "https://", "src=", "@import", "url("] {
        assert!(!page.contains(part), "'{part}' is on the page");
    }
}

#[test]
fn names_from_files_cannot_become_markup() {
    let mut discovery = discovery();
    let evil = "<img src=x onerror=alert(1)>\"'";
    discovery.most_likely = Some(evil.to_owned());
    discovery.ranking[0][0].nats = Some(100.0);
    discovery.notes = vec![evil.to_owned()];
    discovery.ladder[0].effects = vec![evil.to_owned()];
    discovery.ladder[1].added = vec![evil.to_owned()];
    discovery.ranking[0][0].effect = evil.to_owned();
    discovery.where_base[0].unit = evil.to_owned();
    discovery.plots[0].title = evil.to_owned();
    let page = report::html(&discovery, &source(evil), &data());
    assert!(!page.contains("<img"));
    let mut discovery = ahead();
    discovery.ladder[1].added = vec![evil.to_owned()];
    for decision in &mut discovery.decisions {
        decision.candidate[0] = evil.to_owned();
        decision.compared_with = vec![evil.to_owned()];
        decision.because = Some(Reason::Rival { rival: evil.to_owned() });
    }
    discovery.ranking[0][0].size =
        vec![NamedValue { name: evil.to_owned(), value: 1.0, unit: evil.to_owned() }];
    let page = report::html(&discovery, &source(evil), &data());
    assert!(!page.contains("<img"));
}

#[test]
fn every_tag_that_opens_is_closed() {
    for page in [page(&discovery()), page(&ahead())] {
        tags_are_closed(&page);
    }
}

fn tags_are_closed(page: &str) {
    for tag in ["section", "div", "table", "tr", "td", "th", "figure", "svg", "details", "ul", "li"]
    {
        let count = |text: &str| page.matches(text).count();
        let opened = count(&format!("<{tag}>")) + count(&format!("<{tag} "));
        assert_eq!(opened, count(&format!("</{tag}>")), "{tag}");
    }
}

#[test]
fn a_discovery_with_hardly_anything_in_it_still_makes_a_page() {
    let mut discovery = discovery();
    discovery.added.clear();
    discovery.ladder.truncate(1);
    discovery.ladder[0].error.clear();
    discovery.ladder[0].parameters.clear();
    discovery.ranking.clear();
    discovery.plots.clear();
    discovery.noise_floor.clear();
    let page = report::html(&discovery, &source("run.csv"), &data());
    assert!(page.contains("</html>") && !without_scripts(&page).contains("NaN"));
}
