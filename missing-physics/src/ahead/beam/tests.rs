mod conclude;
mod grow;
mod led;
mod other_law;
mod race;
mod rivals;
mod shape;
mod simpler;
mod usual;

use std::sync::atomic::{AtomicBool, Ordering};

use super::*;
use crate::ahead::fit;
use crate::ahead::refused::refused;
use crate::ahead::testing::{BEAT, BENT, BOTH, DRIVE, PUSH, Plant, RIVAL, TONE, TONES, TWIN, WAVE};
use crate::report::{Course, Verdict};
use crate::{Observer, Settings, discover};

const ALL: [usize; 5] = [WAVE, BEAT, BOTH, TONE, PUSH];

fn never() -> bool {
    false
}

fn found(plant: &Plant, thresholds: Thresholds, most: usize) -> Found {
    among(&ALL, plant, thresholds, most)
}

/// A search that begins with nothing compared.
fn search(plant: &Plant, thresholds: Thresholds) -> Search<'_> {
    Search::new(plant, plant, thresholds, ALL.to_vec(), &never, &|_| ())
}

/// A model as it is.
fn node(plant: &Plant, terms: &[(usize, &[f64])]) -> Node {
    fit::evaluated(plant, Plant::model(terms), 0)
}

/// The base model, and sets of one effect, of two and so on.
fn climb(plant: &Plant, sizes: Vec<Vec<Node>>) -> Climb {
    let base = node(plant, &[]);
    Climb {
        nodes: std::iter::once(vec![base.clone()]).chain(sizes).collect(),
        ranking: Vec::new(),
        screened: Vec::new(),
        refused: Vec::new(),
        beam: Vec::new(),
        base,
        elsewhere: Vec::new(),
        led: None,
        ended: true,
    }
}

fn among(candidates: &[usize], plant: &Plant, thresholds: Thresholds, most: usize) -> Found {
    let thresholds = Thresholds { most, ..thresholds };
    let candidates = candidates.to_vec();
    let mut search = Search::new(plant, plant, thresholds, candidates, &never, &|_| ());
    let base = search.base(Plant::model(&[]));
    let climb = search.begin(base, Vec::new());
    search.finish(climb)
}

/// Without the wave that none can be told from.
fn settings<'a>() -> Settings<'a> {
    Settings { exclude: vec!["twin".to_owned()], ..Settings::default() }
}

/// As few and as short as a test needs.
fn narrow() -> Thresholds {
    Thresholds { better: 20.0, beam: 1, ..Thresholds::default() }
}

#[test]
fn two_hidden_effects_are_found_and_no_third_one() {
    let plant = Plant::new(1, &[(WAVE, &[0.03]), (TONE, &[0.02, 5.0])]);
    let found = found(&plant, Thresholds::default(), 4);
    let mut added = found.added.clone();
    added.sort_unstable();
    assert_eq!(added, [WAVE, TONE]);
    assert!(found.complete && !found.stopped && found.untried.is_empty());
    assert_eq!((found.rungs.len(), found.gains.len(), found.costs.len()), (2, 2, 2));
    assert!(found.gains.iter().chain(&found.costs).all(|gain| gain.nats > 100.0));
    assert!(found.p_values.iter().all(|p| (1e-3..=0.01).contains(p)), "{:?}", found.p_values);
    let last = found.rungs.last().unwrap();
    let place = last.model.terms.iter().position(|term| *term == TONE).unwrap();
    let tone = &last.model.values[last.model.range(&plant, place)];
    assert!((tone[0] / 0.02 - 1.0).abs() < 0.1 && (tone[1] / 5.0 - 1.0).abs() < 0.01, "{tone:?}");
    let names: Vec<&str> = found
        .decisions
        .iter()
        .filter(|decision| decision.outcome == Outcome::Added && decision.rung == 2)
        .flat_map(|decision| decision.candidate.iter().map(String::as_str))
        .collect();
    assert!(names.contains(&"wave") && names.contains(&"tone"), "{names:?}");
}

#[test]
fn an_effect_that_is_the_only_candidate_is_judged_by_chance_all_the_same() {
    let plant = Plant::new(1, &[(TONE, &[0.02, 5.0])]);
    let told = among(&[TONE], &plant, Thresholds::default(), 4);
    assert_eq!(told.added, [TONE]);
    assert!(told.p_values.iter().all(|p| (1e-3..=0.01).contains(p)), "{:?}", told.p_values);
    let nothing = (40..60).filter(|seed| {
        let told = among(&[TONE], &Plant::new(*seed, &[]), narrow(), 4);
        !told.added.is_empty()
    });
    assert_eq!(nothing.count(), 0);
}

#[test]
fn where_nothing_is_hidden_nothing_is_added() {
    for seed in 40..60 {
        let found = found(&Plant::new(seed, &[]), narrow(), 4);
        assert!(found.added.is_empty() && found.rungs.is_empty() && found.complete, "seed {seed}");
        assert!(found.ranking[0].rows.iter().all(|row| row.nats < 20.0), "seed {seed}");
    }
}

#[test]
fn an_effect_that_later_ones_make_idle_is_dropped() {
    // Nearly the sum of both is the best single one, and of no use beside both.
    let plant = Plant::new(2, &[(WAVE, &[0.2]), (BEAT, &[0.12])]);
    let found = found(&plant, narrow(), 4);
    let first = found
        .decisions
        .iter()
        .find(|d| d.rung == 1 && d.because == Some(Reason::BestOfSize))
        .unwrap();
    assert_eq!(first.candidate, ["both"]);
    let mut added = found.added.clone();
    added.sort_unstable();
    assert_eq!(added, [WAVE, BEAT], "{:#?}", found.decisions);
    let idle = |d: &&Decision| d.because == Some(Reason::AsGoodWithout);
    let dropped: Vec<&Decision> = found.decisions.iter().filter(idle).collect();
    assert_eq!(dropped.len(), 1);
    assert_eq!(dropped[0].compared_with.len(), 3);
    assert!(!dropped[0].candidate.contains(&"both".to_owned()), "{dropped:?}");
}

#[test]
fn followed_side_by_side_both_are_named_without_the_detour() {
    let plant = Plant::new(2, &[(WAVE, &[0.05]), (BEAT, &[0.05])]);
    let found = found(&plant, Thresholds { better: 20.0, ..Thresholds::default() }, 2);
    let mut added = found.added.clone();
    added.sort_unstable();
    assert_eq!(added, [WAVE, BEAT]);
}

#[test]
fn the_flexible_form_of_an_effect_stands_only_where_it_is_needed() {
    for (hidden, expected) in [((WAVE, &[0.05][..]), WAVE), ((BENT, &[0.05, 0.05][..]), BENT)] {
        let found = found(&Plant::new(3, &[hidden]), narrow(), 1);
        assert_eq!(found.added, [expected]);
        assert!(found.complete);
    }
}

#[test]
fn a_model_of_which_more_is_left_than_the_sensors_make_is_incomplete() {
    // A frequency that no tone can have.
    let plant = Plant::new(4, &[(TONE, &[0.05, 30.0])]);
    let found = found(&plant, narrow(), 2);
    assert!(!found.complete, "{:?}", found.added);
    let discovery = discover(&plant, &settings(), &mut ()).unwrap();
    assert!(!discovery.budget.unwrap().complete);
    assert_ne!(discovery.verdict, Verdict::NothingMissing);
}

#[test]
fn what_a_part_of_the_recording_showed_is_taken_back_where_the_whole_does_not() {
    let part = Plant::new(5, &[(WAVE, &[0.05]), (BEAT, &[0.03])]);
    let whole = Plant::new(5, &[(WAVE, &[0.05])]);
    let found = found(&part, Thresholds { beam: 3, ..narrow() }, 2);
    assert_eq!(found.added, [WAVE, BEAT]);
    let found = found.confirmed(&whole, &whole, &narrow(), &never).unwrap();
    assert_eq!(found.added, [WAVE]);
    assert_eq!((found.rungs.len(), found.gains.len(), found.costs.len()), (1, 1, 1));
    assert!(found.complete);
    assert_eq!(found.remarks, [Remark::FoundInPartOnly { effect: "beat".into() }]);
}

#[test]
fn what_pieces_of_the_recording_do_not_show_is_looked_for_in_more_of_it() {
    let named = |hidden: &[(usize, &[f64])], more: Option<&[(usize, &[f64])]>| {
        let mut plant = Plant::new(5, hidden);
        plant.pieces = Some((Box::new(Plant::new(6, &[])), 0.1));
        plant.more_pieces = more.map(|shown| (Box::new(Plant::new(7, shown)), 0.4));
        let discovery = discover(&plant, &settings(), &mut ()).unwrap();
        (discovery.verdict, discovery.added)
    };
    let wave: &[(usize, &[f64])] = &[(WAVE, &[0.05])];
    let found = (Verdict::EffectsFound, vec!["wave".to_owned()]);
    assert_eq!(named(wave, None), found);
    assert_eq!(named(wave, Some(wave)), found);
    // All of a very long recording would take too long.
    assert_eq!(named(wave, Some(&[])), (Verdict::Unexplained, Vec::new()));
    assert_eq!(named(&[], None), (Verdict::NothingMissing, Vec::new()));
}

#[test]
fn effects_that_a_rival_makes_up_for_are_not_named() {
    let plant = Plant::new(11, &[(WAVE, &[0.05]), (BEAT, &[-0.02]), (TONE, &[0.15, 5.0])]);
    let without_tone = Plant::new(11, &[(WAVE, &[0.05]), (BEAT, &[-0.02])]);
    let exclude = ["twin", "both"].map(str::to_owned).to_vec();
    let thresholds = Thresholds { better: 20.0, ..Thresholds::default() };
    let settings = Settings { exclude, thresholds, ..Settings::default() };
    let alone = discover(&without_tone, &settings, &mut ()).unwrap();
    assert_eq!((alone.verdict, alone.added.len()), (Verdict::Unexplained, 0));
    let Some(Remains::Rival { rival, instead_of, .. }) = alone.remains.first() else {
        panic!("{:?}", alone.remains);
    };
    assert_eq!((rival.as_str(), instead_of.len()), ("a wave less a beat", 2));
    // What is needed beside it stays.
    let found = discover(&plant, &settings, &mut ()).unwrap();
    assert_eq!(found.added, ["tone"], "{:?}", found.remains);
    assert!(!found.budget.unwrap().complete);
}

#[test]
fn effects_that_predict_better_than_a_rival_stand() {
    let plant = Plant::new(12, &[(WAVE, &[0.05]), (BEAT, &[0.02])]);
    let found = found(&plant, Thresholds { better: 20.0, ..Thresholds::default() }, 2);
    let mut added = found.added.clone();
    added.sort_unstable();
    assert_eq!((added, found.rival), (vec![WAVE, BEAT], None));
}

#[test]
fn a_rival_is_told_where_nothing_else_is_found() {
    let plant = Plant::new(13, &[(RIVAL, &[0.05])]);
    let exclude = ["wave", "beat", "both", "tone", "push", "twin"].map(str::to_owned).to_vec();
    let found = discover(&plant, &Settings { exclude, ..Settings::default() }, &mut ()).unwrap();
    assert_eq!((found.verdict, found.added.len()), (Verdict::Unexplained, 0));
    let Some(Remains::Rival { instead_of, nats, course, .. }) = found.remains.first() else {
        panic!("{:?}", found.remains);
    };
    assert!(instead_of.is_empty() && *nats > 100.0, "{nats}");
    let Some(Course::Values { values }) = course else { panic!("{course:?}") };
    assert!((values[0].value - 0.05).abs() < 0.005, "{values:?}");
}

#[test]
fn a_rival_is_told_beside_an_effect_that_stands() {
    let plant = Plant::new(14, &[(TONE, &[0.2, 5.0]), (RIVAL, &[0.04])]);
    let exclude = ["wave", "beat", "both", "push", "twin"].map(str::to_owned).to_vec();
    let found = discover(&plant, &Settings { exclude, ..Settings::default() }, &mut ()).unwrap();
    assert_eq!(found.added, ["tone"], "{:?}", found.remains);
    let Some(Remains::Rival { instead_of, nats, .. }) = found.remains.first() else {
        panic!("{:?}", found.remains);
    };
    assert!(instead_of.is_empty() && *nats > 100.0, "{nats}");
    assert!(!found.budget.unwrap().complete);
}

#[test]
fn an_amplitude_whose_search_ended_at_a_limit_is_known() {
    let plant = Plant::new(6, &[(WAVE, &[0.05])]);
    let base = fit::evaluated(&plant, Plant::model(&[]), 0);
    let search = Search::new(&plant, &plant, narrow(), ALL.to_vec(), &never, &|_| ());
    for (amplitude, known) in [(10.0, true), (0.05, false), (0.0, false)] {
        let node = fit::evaluated(&plant, Plant::model(&[(WAVE, &[amplitude])]), 0);
        assert_eq!(
            refused(search.family, search.ahead, &base, &node).is_some(),
            known,
            "{amplitude}"
        );
    }
    // What every model has is not given up for an effect, however much of it there was.
    let with =
        |terms: Vec<usize>, values: Vec<f64>| fit::evaluated(&plant, Fitted { terms, values }, 0);
    // One that ended at the limit of its search says nothing of what there was.
    for (before, drive, known) in [
        (1.0, 0.5, false),
        (1.0, 0.005, false),
        (1.0, 0.0005, true),
        (8.0, 0.005, true),
        (10.0, 0.005, false),
    ] {
        let base = with(vec![DRIVE], vec![before]);
        let node = with(vec![DRIVE, WAVE], vec![drive, 0.05]);
        let why = refused(search.family, search.ahead, &base, &node).map(|(_, why)| why);
        let parameter = "drive.size".to_owned();
        assert_eq!(why, known.then_some(Refusal::NothingLeft { parameter }));
    }
}

#[test]
fn an_effect_is_not_told_whose_shape_the_data_do_not_tell() {
    let plant = Plant::new(6, &[(TONE, &[0.05, 5.0])]);
    let base = node(&plant, &[]);
    let told = |size: f64, omega: f64| {
        let node = node(&plant, &[(TONE, &[size, omega])]);
        not_told(&plant, &plant, &base, &node).map(|(term, why)| {
            assert_eq!(term, TONE);
            why
        })
    };
    assert_eq!(told(0.05, 5.0), None);
    // So small a tone may have any frequency, and one at the end of its search another one.
    for (size, omega) in [(1e-5, 5.0), (0.05, TONES.1)] {
        let Some(Refusal::Unknown { parameter, low, high, .. }) = told(size, omega) else {
            panic!("{size} {omega}")
        };
        assert_eq!(parameter, "tone.omega");
        assert!(low < omega && high == TONES.1, "{low} {high}");
    }
    // What may be 0 may not be there.
    let wave = |size: f64| {
        let node = node(&plant, &[(WAVE, &[size])]);
        not_told(&plant, &plant, &base, &node).map(|(_, why)| why)
    };
    assert_eq!(wave(0.05), None);
    assert!(matches!(wave(1e-5), Some(Refusal::Unknown { parameter, low, high, .. })
        if parameter == "wave.size" && low < 0.0 && high > 0.0));
    // Unless it is that effect without it, too.
    let mut optional = Plant::new(6, &[(TONE, &[0.05, 5.0])]);
    optional.optional = vec![WAVE];
    assert_eq!(not_told(&optional, &optional, &base, &node(&optional, &[(WAVE, &[1e-5])])), None);
    // What may be more than it may be at most: beside its twin the data do not tell how large it is.
    let plant = Plant::new(6, &[(WAVE, &[9.9])]);
    let large = |terms: &[(usize, &[f64])]| {
        let base = node(&plant, &[]);
        not_told(&plant, &plant, &base, &node(&plant, terms))
    };
    assert_eq!(large(&[(WAVE, &[9.9])]), None);
    let parameter = "wave.size".to_owned();
    let twins: [(usize, &[f64]); 2] = [(WAVE, &[9.9]), (TWIN, &[0.05])];
    assert_eq!(large(&twins), Some((WAVE, Refusal::AtLimit { parameter })));
    // More than makes sense in this model, though less than was searched.
    let of_most = |most: f64| {
        let mut plant = Plant::new(6, &[(WAVE, &[0.05])]);
        plant.most = Some((WAVE, most));
        let (base, node) = (node(&plant, &[]), node(&plant, &[(WAVE, &[0.05])]));
        not_told(&plant, &plant, &base, &node).map(|(_, why)| why)
    };
    assert_eq!(of_most(0.06), None);
    let parameter = "wave.size".to_owned();
    for most in [0.0501, 0.04] {
        let parameter = parameter.clone();
        assert_eq!(of_most(most), Some(Refusal::AtLimit { parameter }), "{most}");
    }
    // What the base has is not asked.
    let small = node(&plant, &[(TONE, &[1e-5, 5.0])]);
    assert_eq!(not_told(&plant, &plant, &small, &small), None);
}

#[test]
fn what_the_data_do_not_tell_apart_from_another_law_is_missing_all_the_same() {
    // Beyond the search of its frequency: the tone ends at its limit and predicts better all the same.
    let plant = Plant::new(6, &[(TONE, &[0.3, TONES.1 + 0.04])]);
    let found = among(&[TONE], &plant, narrow(), 4);
    assert!(found.added.is_empty() && !found.complete);
    let Some(Remains::Outdone { by, refusal: Refusal::Unknown { .. }, instead_of, nats }) =
        found.rival
    else {
        panic!("{:?}", found.rival)
    };
    assert_eq!((by, instead_of), (vec!["tone".to_owned()], Vec::new()));
    assert!(nats > 100.0, "{nats}");
}

/// Asks to stop when the candidates of a rung have been looked at.
struct StopAt<'a>(&'a AtomicBool, usize);

impl Observer for StopAt<'_> {
    fn event(&mut self, event: &Event<'_>) {
        if let Event::Screening { rung, .. } = event {
            self.0.fetch_or(*rung == self.1, Ordering::Relaxed);
        }
    }
}

/// The stages of a search, as they come.
#[derive(Default)]
struct Stages(Vec<&'static str>);

impl Observer for Stages {
    fn event(&mut self, event: &Event<'_>) {
        self.0.push(match event {
            Event::BaseFitted { .. } => "base",
            Event::Screening { .. } | Event::Compared { .. } => "growing",
            Event::Concluding => "concluding",
            _ => "finishing",
        });
        self.0.dedup();
    }
}

#[test]
fn what_is_told_while_it_runs_is_what_is_done() {
    let plant = Plant::new(7, &[(WAVE, &[0.05])]);
    let mut stages = Stages::default();
    let settings = Settings { thresholds: narrow(), ..settings() };
    discover(&plant, &settings, &mut stages).unwrap();
    assert_eq!(stages.0, ["base", "growing", "concluding", "finishing"]);
}

#[test]
fn a_stopped_search_says_so_keeps_what_it_has_and_lists_what_was_not_tried() {
    let plant = Plant::new(7, &[(WAVE, &[0.05]), (TONE, &[0.02, 5.0])]);
    for rung in [1, 2] {
        let stop = AtomicBool::new(false);
        let settings = Settings { stop: Some(&stop), thresholds: narrow(), ..settings() };
        let discovery = discover(&plant, &settings, &mut StopAt(&stop, rung)).unwrap();
        assert!(discovery.stopped && discovery.verdict == Verdict::Stopped);
        assert!(!discovery.untried.is_empty());
        // What more effects, or what stands for none, might take back is no name.
        assert!(discovery.added.is_empty() && discovery.ladder.len() == 1);
        let so_far = discovery.remains.iter().find_map(|remains| match remains {
            Remains::SoFar { effects, nats, last } => Some((effects, *nats, *last)),
            _ => None,
        });
        if rung == 1 {
            assert!(discovery.untried.iter().any(|effect| effect == "wave"));
            assert_eq!(so_far, None);
        } else {
            let (effects, nats, last) = so_far.unwrap();
            assert_eq!(effects.len(), 1);
            assert!(nats > 80.0 && last < discovery.budget.unwrap().base);
        }
    }
}

#[test]
fn threads_do_not_change_what_is_found() {
    let plant = Plant::new(8, &[(WAVE, &[0.03]), (TONE, &[0.02, 5.0])]);
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let mut found = pool.install(|| discover(&plant, &settings(), &mut ()).unwrap());
        found.wall_s = 0.0;
        found
    };
    let one = on(1);
    assert_eq!(one, on(2));
    assert_eq!(one.added.len(), 2, "{:?}", one.remains);
}

#[test]
fn what_the_data_cannot_tell_apart_is_ambiguous_beside_whatever_base() {
    for base in [vec![], vec!["push".to_owned()]] {
        let push = if base.is_empty() { 0.0 } else { 0.05 };
        let plant = Plant::new(9, &[(PUSH, &[push]), (WAVE, &[0.05])]);
        let exclude = ["both", "tone"].map(str::to_owned).to_vec();
        // The twin is a little off: it does as well within this margin.
        let thresholds = Thresholds { better: 100.0, ..Thresholds::default() };
        let settings = Settings { base, exclude, thresholds, ..Settings::default() };
        let found = discover(&plant, &settings, &mut ()).unwrap();
        assert_eq!(found.verdict, Verdict::Ambiguous, "{:?}", found.remains);
        let mut rivals = found.ambiguous[0].effects.clone();
        rivals.sort();
        assert_eq!(rivals, ["twin", "wave"]);
    }
}

#[test]
fn what_would_not_be_told_is_no_alternative_to_what_is() {
    let thresholds = Thresholds { better: 100.0, ..Thresholds::default() };
    let exclude = ["both", "tone"].map(str::to_owned).to_vec();
    let settings = Settings { exclude, thresholds, ..Settings::default() };
    for (most, alternatives) in [(0.06, 1), (0.0501, 0)] {
        let mut plant = Plant::new(9, &[(WAVE, &[0.05])]);
        // A twin of that size makes no sense, or may be larger than makes sense.
        plant.most = Some((TWIN, most));
        let found = discover(&plant, &settings, &mut ()).unwrap();
        assert_eq!(found.added, ["wave"], "{:?}", found.remains);
        assert_eq!(found.ambiguous.len(), alternatives, "{most}: {:?}", found.ambiguous);
    }
}

#[test]
fn an_effect_whose_plain_form_is_none_is_not_named_where_that_form_is_as_good() {
    let mut plant = Plant::new(5, &[(BENT, &[0.05, 0.0008])]);
    assert_eq!(found(&plant, Thresholds::default(), 1).added, [WAVE]);
    plant.none = Some(WAVE);
    let found = found(&plant, Thresholds::default(), 1);
    assert_eq!(found.added, [0; 0]);
    let is_none = |d: &&Decision| matches!(d.because, Some(Reason::Refused { .. }));
    let refused = found.decisions.iter().find(is_none).unwrap();
    assert_eq!(refused.outcome, Outcome::NotIdentifiable);
}

#[test]
fn an_effect_that_predicts_less_than_a_refused_one_is_not_the_cause() {
    let mut plant = Plant::new(9, &[(WAVE, &[0.1])]);
    let close = Thresholds { share: 0.0, ..narrow() };
    let search = |plant: &Plant| among(&[WAVE, TWIN], plant, close, 1);
    assert_eq!(search(&plant).added, [WAVE]);
    plant.none = Some(WAVE);
    let found = search(&plant);
    assert_eq!((found.added.len(), found.complete), (0, false));
    let Some(Remains::Outdone { by, instead_of, nats, .. }) = found.rival else {
        panic!("{:?}", found.rival)
    };
    assert_eq!((by, instead_of), (vec!["wave".to_owned()], vec!["twin".to_owned()]));
    assert!(nats > 20.0, "{nats}");
}
