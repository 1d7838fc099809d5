//! Whether what was found is the cause.

use super::Found;
use crate::ahead::astray::astray;
use crate::ahead::compare::Comparison;
use crate::ahead::foretold::{is_foretold, is_loss};
use crate::ahead::input_noise::InputNoise;
use crate::ahead::node::Node;
use crate::ahead::{Ahead, local};
use crate::family::ModelFamily;
use crate::report::{Lacking, NoCause, Remains, Remark};
use crate::statistics::basis::dot;
use crate::task::Thresholds;

/// Share of the squared force that a model lacks which effects may leave and still be its cause: the smaller part.
const MOST: f64 = 0.5;
/// The same where the base model hardly errs more than the sensors: there the force is all that tells.
pub const MOST_WITHIN: f64 = 0.05;
/// Share of what the base model errs beyond the sensors, squared, and of the force that it lacks, that a model leaves at most:
/// what leaves more is not what is missing.
const LEFT: f64 = 0.88;

impl Found {
    /// Where the last model fails, and whether it does at all.
    pub fn place(&mut self, family: &dyn ModelFamily, ahead: &dyn Ahead, thresholds: &Thresholds) {
        let top = self.rungs.last().unwrap_or(&self.base);
        self.places = left_by((top, ahead.budget()), family, ahead, thresholds);
        self.places.splice(0..0, self.rival.clone());
        self.complete = top.scale / ahead.budget() <= thresholds.complete && self.places.is_empty();
    }

    /// Whether noise of the input makes all that the last model leaves, where no look finds more: not where something gains
    /// clearly that is not named, as nothing follows noise.
    pub fn place_noise(
        &mut self,
        family: &dyn ModelFamily,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
    ) {
        let not_named = |remark: &Remark| matches!(remark, Remark::NotTheCause { because, .. } if *because != Some(NoCause::Foretold));
        let gains = self.rival.is_some()
            || self.alike > thresholds.better * (1.0 + f64::EPSILON.sqrt())
            || self.remarks.iter().any(not_named);
        let (top, _) = self.top();
        let beyond = top.scale > thresholds.complete * ahead.budget();
        if !beyond || gains || self.stopped {
            return;
        }
        let leaves_nothing =
            |noise: &InputNoise| left_by((top, noise.error), family, ahead, thresholds).is_empty();
        let noise = InputNoise::of(ahead, top, thresholds.complete).filter(leaves_nothing);
        if let Some(noise) = noise {
            self.places.clear();
            (self.complete, self.input_noise) = (true, Some(noise.deviation));
        }
    }

    /// Takes all names back where they are not the cause: the error does not fall with them, what is left is in a few wild
    /// samples, samples are known to be faulty, the greater part of the force that the base model lacks is still lacking
    /// beyond doubt, or what is no effect does more.
    pub fn judge(&mut self, family: &dyn ModelFamily, ahead: &dyn Ahead, thresholds: &Thresholds) {
        let Some(top) = self.rungs.last() else { return };
        let nats = Comparison::new(family, ahead).unfitted(&self.base, top).nats;
        if is_foretold(ahead, &self.base, top, nats, thresholds.better) {
            self.taken_back_as_foretold(family, ahead, thresholds);
            return;
        }
        let astray = self.places.iter().find_map(|place| match place {
            Remains::Astray { astray } => Some(NoCause::Astray { astray: astray.clone() }),
            _ => None,
        });
        let no_cause = ahead.is_no_cause(&self.base.model, &top.model).or(astray);
        // Below what the sensors make there are no shares.
        let beyond = ahead.has_shares() && top.scale > ahead.budget();
        let within = top.scale <= thresholds.complete * ahead.budget();
        let idle = beyond && leaves_most(&self.base, top, ahead.budget())
            || self.leaves_force(ahead, if within { thresholds.local } else { 0.0 });
        let falls = top.foretells_more(&self.base) && !idle;
        if self.complete && falls && no_cause.is_none() {
            if is_loss(ahead, &self.base, top) {
                self.taken_back_as_foretold(family, ahead, thresholds);
            }
            return;
        }
        let still = self.still_lacking(family, ahead, (thresholds.local, MOST));
        // A few wild samples that are left speak against what explains less than they are.
        let square = |node: &Node| dot(&node.errors, &node.errors);
        let explained = square(&self.base) - square(top);
        let wild = local::faults(&top.errors).map(|share| share * square(top));
        let faulty = wild.is_some_and(|wild| wild > explained) || ahead.faults().is_some();
        if falls && still.is_none() && !faulty && no_cause.is_none() {
            return;
        }
        let lacking = still.map(|(lacking, _)| lacking);
        self.taken_back(family, ahead, thresholds, (lacking, no_cause));
    }

    /// Takes all names back where the last model hardly errs more than the sensors, and some of the force that the base lacks
    /// is still lacking beyond doubt: where errors tell so little, what is there explains that force, and what only imitates
    /// it does so in part. What every system has is asked nothing.
    pub fn judge_force(
        &mut self,
        family: &dyn ModelFamily,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
    ) {
        let within = self.top().0.scale / ahead.budget() <= thresholds.complete;
        if !within || self.added.iter().all(|term| family.is_usual(*term)) {
            return;
        }
        let still = self.still_lacking(family, ahead, (thresholds.complete, MOST_WITHIN));
        if let Some((lacking, band)) = still {
            let because = Some(NoCause::LeavesForce { band });
            self.taken_back(family, ahead, thresholds, (Some(lacking), because));
        }
    }

    /// Whether nearly all of the force that the base model lacks, of more than so many bands, is still lacking, however well
    /// that is known of the last model. Where errors are not those of the sensors an effect lowers them by following what no
    /// force stands behind: a command that changes between two samples.
    fn leaves_force(&self, ahead: &dyn Ahead, bands: f64) -> bool {
        let both = self.top().0.lacks(ahead).zip(self.base.lacks(ahead));
        both.is_some_and(|((last, _), (base, band))| {
            base > bands * band && last * last > LEFT * base * base
        })
    }

    /// The force that is lacking before and after, and its 95 % band, where the last model leaves more than so many bands and
    /// more than a share of the square.
    fn still_lacking(
        &self,
        family: &dyn ModelFamily,
        ahead: &dyn Ahead,
        (bands, share): (f64, f64),
    ) -> Option<(Lacking, f64)> {
        let ((last, band), (base, _)) = self.top().0.lacks(ahead).zip(self.base.lacks(ahead))?;
        let still = last > bands * band && last * last > share * base * base;
        still.then(|| (Lacking { base, last, unit: family.quantity().unit }, band))
    }

    /// A search that was cut names nothing, and says of nothing that it is not in the library: more effects, fewer ones,
    /// another reading or what stands for no effect might have taken that back. Names are told as what stood so far.
    pub fn so_far(&mut self, family: &dyn ModelFamily, ahead: &dyn Ahead) {
        if !self.stopped {
            return;
        }
        if self.added.is_empty() {
            let says =
                |what: &Remains| !matches!(what, Remains::Rival { .. } | Remains::Outdone { .. });
            self.places.retain(says);
            return;
        }
        let names = self.added.iter().map(|term| family.terms()[*term].name.clone());
        self.places = vec![Remains::SoFar {
            effects: names.collect(),
            nats: self.gains.iter().map(|gain| gain.nats).sum(),
            last: self.top().0.scale / ahead.budget(),
        }];
        self.without_names();
    }

    /// Takes all names back that gain what the errors themselves foretell: that says nothing of the base.
    fn taken_back_as_foretold(
        &mut self,
        family: &dyn ModelFamily,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
    ) {
        self.taken_back(family, ahead, thresholds, (None, Some(NoCause::Foretold)));
        self.place(family, ahead, thresholds);
    }

    fn taken_back(
        &mut self,
        family: &dyn ModelFamily,
        ahead: &dyn Ahead,
        thresholds: &Thresholds,
        (lacking, because): (Option<Lacking>, Option<NoCause>),
    ) {
        let names = self.added.iter().map(|term| family.terms()[*term].name.clone());
        self.remarks.push(Remark::NotTheCause {
            effects: names.collect(),
            base: self.base.scale / ahead.budget(),
            last: self.top().0.scale / ahead.budget(),
            lacking,
            because,
        });
        self.places = left_by((&self.base, ahead.budget()), family, ahead, thresholds);
        self.without_names();
    }

    fn without_names(&mut self) {
        self.complete = false;
        self.rungs.clear();
        self.added.clear();
        self.gains.clear();
        self.costs.clear();
        self.p_values.clear();
    }
}

/// Whether a model leaves nearly all of what the base errs beyond the sensors.
pub fn leaves_most(base: &Node, node: &Node, budget: f64) -> bool {
    let beyond = |node: &Node| (node.scale / budget).powi(2) - 1.0;
    beyond(base) <= 0.0 || beyond(node) > LEFT * beyond(base)
}

/// What a model leaves beside errors of the size that noise makes, whether they show it or not.
fn left_by(
    (node, noise): (&Node, f64),
    family: &dyn ModelFamily,
    ahead: &dyn Ahead,
    thresholds: &Thresholds,
) -> Vec<Remains> {
    let shows = local::places(ahead, (node, noise), thresholds, &family.quantity().unit);
    let astray =
        astray(family, &node.model, ahead.has_shares()).map(|astray| Remains::Astray { astray });
    let hidden = ahead.remains(&node.model, thresholds.complete);
    astray.into_iter().chain(hidden).chain(shows).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::fit;
    use crate::ahead::testing::{NOISE, Plant, TONE, WAVE};
    use crate::family::Series;
    use crate::report::{Fault, Refusal};

    /// A wave that was found where it is, every model lacking a force of 2 V known to `band`.
    fn found(lacks: Option<f64>) -> (Plant, Found) {
        let mut plant = Plant::new(1, &[(WAVE, &[0.05])]);
        plant.lacks = lacks.map(|band| Series {
            time: vec![0.0, 0.1],
            force: vec![2.0, -2.0],
            deviation: vec![band / 1.96; 2],
            recorded: vec![9.0; 2],
            known: vec![true; 2],
        });
        let node = |terms| fit::evaluated(&plant, Plant::model(terms), 0);
        let (base, rung) = (node(&[]), node(&[(WAVE, &[0.05])]));
        let mut found = Found { added: vec![WAVE], rungs: vec![rung], ..Found::of(base) };
        found.place(&plant, &plant, &Thresholds::default());
        (plant, found)
    }

    /// What its models err, in units of what the sensors make.
    fn found_scales() -> (f64, f64) {
        let (_, found) = found(None);
        (found.base.scale / NOISE, found.rungs[0].scale / NOISE)
    }

    #[test]
    fn a_model_is_complete_that_errs_as_much_as_the_sensors_make_and_leaves_nothing() {
        let (plant, mut found) = found(None);
        let (_, last) = found_scales();
        for (complete, is) in [(0.99 * last, false), (1.01 * last, true)] {
            found.place(&plant, &plant, &Thresholds { complete, ..Thresholds::default() });
            assert_eq!((found.complete, found.places.len()), (is, 0), "{complete}");
        }
    }

    #[test]
    fn noise_of_the_input_is_asked_last_and_only_where_nothing_gains_without_a_name() {
        // Of a plant that says nothing of such a noise all stays as it was.
        let (plant, mut found) = found(None);
        let thresholds = Thresholds { complete: 0.5, ..Thresholds::default() };
        found.place(&plant, &plant, &thresholds);
        found.place_noise(&plant, &plant, &thresholds);
        assert_eq!((found.complete, found.input_noise), (false, None));
        // Beside one that has it and is in the way.
        let walk = crate::ahead::input_noise::testing::Walk::new(1, (0.8, 1.0), |_| 0.0);
        let base = walk.best();
        let told = |alike: f64, change: fn(&mut Found)| {
            let mut found = Found { alike, ..Found::of(base.clone()) };
            change(&mut found);
            found.place_noise(&plant, &walk, &Thresholds::default());
            (found.complete, found.input_noise.is_some())
        };
        let better = Thresholds::default().better;
        assert!(base.scale > Thresholds::default().complete);
        assert_eq!(told(better, |_| ()), (true, true));
        assert_eq!(told(1.1 * better, |_| ()), (false, false));
        assert_eq!(told(better, |found| found.stopped = true), (false, false));
        assert_eq!(told(better, |found| found.rival = Some(Remains::TooCoarse)), (false, false));
    }

    #[test]
    fn a_search_that_was_cut_tells_names_as_what_stood_so_far_and_of_nothing_that_it_is_not_in_the_library()
     {
        let (plant, whole) = found(None);
        let told = |stopped: bool, mut found: Found| {
            found.stopped = stopped;
            found.so_far(&plant, &plant);
            (found.added.len(), found.rungs.len(), found.places)
        };
        assert_eq!(told(false, whole.clone()), (1, 1, Vec::new()));
        let (added, rungs, places) = told(true, whole.clone());
        let [Remains::SoFar { effects, last, .. }] = &places[..] else { panic!("{places:?}") };
        assert_eq!((added, rungs, effects.as_slice()), (0, 0, &["wave".to_owned()][..]));
        assert!((last - found_scales().1).abs() < 1e-12);
        let outdone = Remains::Outdone {
            by: vec!["wave".into()],
            refusal: Refusal::AtLimit { parameter: "wave.a".into() },
            instead_of: Vec::new(),
            nats: 99.0,
        };
        let none = Found { places: vec![outdone, Remains::TooCoarse], ..Found::of(whole.base) };
        assert_eq!(told(true, none.clone()).2, [Remains::TooCoarse]);
        assert_eq!(told(false, none).2.len(), 2);
    }

    #[test]
    fn names_go_where_the_force_that_is_lacking_is_still_lacking() {
        let (plant, mut found) = found(Some(0.5));
        assert!(!found.complete);
        assert_eq!(
            found.places[0],
            Remains::MissingForce { rms: 2.0, band: 0.5, unit: "V".into() }
        );
        found.judge(&plant, &plant, &Thresholds::default());
        assert!(found.added.is_empty() && found.rungs.is_empty() && !found.complete);
        let [Remark::NotTheCause { effects, base, last, lacking, because }] = &found.remarks[..]
        else {
            panic!("{:?}", found.remarks)
        };
        assert_eq!((effects.as_slice(), because), (&["wave".to_owned()][..], &None));
        let (before, after) = found_scales();
        assert!((base - before).abs() < 1e-12 && (last - after).abs() < 1e-12 && before > 2.0);
        assert_eq!(lacking, &Some(Lacking { base: 2.0, last: 2.0, unit: "V".into() }));
    }

    #[test]
    fn names_stand_where_that_force_is_not_known_or_nothing_is_left() {
        for lacks in [Some(1.6), None] {
            let (plant, mut found) = found(lacks);
            found.judge(&plant, &plant, &Thresholds::default());
            assert!(found.complete, "{:?}", found.places);
            assert_eq!((found.added.as_slice(), found.remarks.len()), (&[WAVE][..], 0));
        }
    }

    #[test]
    fn names_go_where_the_error_does_not_fall_with_them() {
        let (plant, mut found) = found(None);
        let smaller = found.rungs[0].errors.iter().map(|e| 0.99 * e).collect();
        let model = found.base.model.clone();
        found.base = Node::new(&plant, model, found.base.setting, smaller);
        assert!(found.complete);
        found.judge(&plant, &plant, &Thresholds::default());
        assert!(found.added.is_empty() && !found.complete);
        assert!(matches!(&found.remarks[..], [Remark::NotTheCause { lacking: None, .. }]));
    }

    #[test]
    fn names_go_where_an_incomplete_model_leaves_nearly_all_of_a_force_that_is_in_doubt() {
        // Of a model that errs no more than the sensors where the base lacks it beyond doubt.
        let cases = [
            (1.9, 0.5, 3.0, false),
            (1.85, 0.5, 3.0, true),
            (1.9, 1.3, 3.0, true),
            (1.9, 1.3, 0.9, false),
            (1.85, 1.3, 0.9, true),
        ];
        for (left, complete, band, stays) in cases {
            let (plant, mut found) = found(Some(3.0));
            let lacks = |rms: f64, band: f64| Series {
                force: vec![rms, -rms],
                deviation: vec![band / 1.96; 2],
                ..plant.lacks.clone().unwrap()
            };
            found.base = found.base.lacking(lacks(2.0, band));
            found.rungs[0] = found.rungs[0].clone().lacking(lacks(left, 3.0));
            found.complete = complete >= 1.0;
            found.judge(&plant, &plant, &Thresholds { complete, ..Thresholds::default() });
            assert_eq!(!found.added.is_empty(), stays, "{left} {complete} {band}");
        }
    }

    #[test]
    fn names_go_where_an_incomplete_model_leaves_nearly_all_that_the_base_errs() {
        // Where effects have shares of it.
        for (last, shares, stays) in
            [(1.25, true, true), (1.28, true, false), (1.28, false, true), (0.9, true, true)]
        {
            let (mut plant, mut found) = found(None);
            plant.shares = shares;
            let scaled = |node: &Node, times: f64| {
                let factor = times * plant.budget() / node.scale;
                let errors = node.errors.iter().map(|e| factor * e).collect();
                Node::new(&plant, node.model.clone(), node.setting, errors)
            };
            found.base = scaled(&found.base, 1.29);
            found.rungs = vec![scaled(&found.rungs[0], last)];
            found.complete = false;
            found.judge(&plant, &plant, &Thresholds::default());
            let remarks = &found.remarks;
            assert_eq!(!found.added.is_empty(), stays, "{last} {shares}: {remarks:?}");
        }
    }

    #[test]
    fn names_go_and_nothing_is_complete_where_what_every_model_has_is_astray() {
        let (plant, mut found) = found(None);
        for node in std::iter::once(&mut found.base).chain(&mut found.rungs) {
            node.model.values[0] = 5.0;
        }
        found.place(&plant, &plant, &Thresholds::default());
        assert!(matches!(&found.places[..], [Remains::Astray { .. }]) && !found.complete);
        found.judge(&plant, &plant, &Thresholds::default());
        let because = |remark: &Remark| match remark {
            Remark::NotTheCause { because: Some(NoCause::Astray { astray }), .. } => astray.value,
            _ => 0.0,
        };
        assert_eq!((found.added.len(), because(&found.remarks[0])), (0, 5.0));
        assert!(matches!(&found.places[..], [Remains::Astray { .. }, ..]));
    }

    #[test]
    fn names_go_where_nearly_all_of_what_is_missing_is_left() {
        // The tone is not found.
        let stands = |tone: f64, wave: f64| {
            let plant = Plant::new(3, &[(TONE, &[tone, 5.0]), (WAVE, &[wave])]);
            let node = |terms| fit::evaluated(&plant, Plant::model(terms), 0);
            let (base, rung) = (node(&[]), node(&[(WAVE, &[wave])]));
            let mut found = Found { added: vec![WAVE], rungs: vec![rung], ..Found::of(base) };
            found.judge(&plant, &plant, &Thresholds::default());
            !found.added.is_empty()
        };
        assert!(!stands(0.1, 0.02));
        // More than a tenth of it, and all of it.
        assert!(stands(0.1, 0.1) && stands(0.0, 0.02));
    }

    #[test]
    fn names_go_where_what_is_left_is_in_a_few_wild_samples() {
        let (plant, found) = found(None);
        let square = |node: &Node| dot(&node.errors, &node.errors);
        let explained = square(&found.base) - square(found.top().0);
        // A third of what the wave explains is left in one sample, or all of it.
        for (wild, stands) in [(explained / 3.0, true), (explained, false)] {
            let mut found = found.clone();
            let top = found.rungs.pop().unwrap();
            let mut errors = top.errors.clone();
            errors[700] = wild.sqrt();
            found.rungs.push(Node::new(&plant, top.model.clone(), top.setting, errors));
            found.place(&plant, &plant, &Thresholds::default());
            let isolated = |remains: &Remains| matches!(remains, Remains::Faulty { fault: Fault::Isolated { share } } if *share > 0.5);
            assert!(found.places.iter().any(isolated), "{:?}", found.places);
            found.judge(&plant, &plant, &Thresholds::default());
            assert_eq!(!found.added.is_empty(), stands);
            let taken_back =
                matches!(&found.remarks[..], [Remark::NotTheCause { lacking: None, .. }]);
            assert_eq!(taken_back, !stands);
        }
    }

    #[test]
    fn names_stand_where_less_than_they_explain_is_in_wild_samples_though_more_is_left() {
        // Of what is left three fifths are in one sample; the wave explains a little more than those, or less.
        let plant = Plant::new(1, &[(WAVE, &[0.05])]);
        let node = |wave: f64| fit::evaluated(&plant, Plant::model(&[(WAVE, &[wave])]), 0);
        let square = |node: &Node| dot(&node.errors, &node.errors);
        let with = |mut errors: Vec<f64>, wild: f64, node: &Node| {
            errors[700] = wild;
            Node::new(&plant, node.model.clone(), node.setting, errors)
        };
        let top = node(0.05);
        let wild = (1.5 * square(&top)).sqrt();
        let top = with(top.errors.clone(), wild, &top);
        let share = local::faults(&top.errors).unwrap();
        assert!((share - 0.6).abs() < 0.02, "{share}");
        let explained = |base: &Node| (square(base) - square(&top)) / square(&top);
        for (explains, stands) in [(0.4, false), (0.7, true)] {
            let base = (1..500).map(|k| node(0.05 - 1e-4 * f64::from(k)));
            let mut base = base.map(|base| with(base.errors.clone(), wild, &base));
            let base = base.find(|base| explained(base) > explains).unwrap();
            assert!(explained(&base) < explains + 0.1);
            let mut found =
                Found { added: vec![WAVE], rungs: vec![top.clone()], ..Found::of(base) };
            found.judge(&plant, &plant, &Thresholds::default());
            assert_eq!(!found.added.is_empty(), stands, "{:?}", found.remarks);
        }
    }

    #[test]
    fn names_go_where_errors_within_the_sensors_hide_a_force_that_is_still_lacking() {
        // Every model lacks 2 V; as large as the base's errors are, the sensors' are taken to be.
        let told = |complete: f64, band: f64, usual: Vec<usize>| {
            let (mut plant, mut found) = found(Some(band));
            plant.usual = usual;
            let thresholds = Thresholds { complete, ..Thresholds::default() };
            found.judge_force(&plant, &plant, &thresholds);
            (found.added, found.remarks)
        };
        let (added, remarks) = told(30.0, 0.06, Vec::new());
        assert!(added.is_empty());
        let [Remark::NotTheCause { lacking, because, .. }] = &remarks[..] else { panic!() };
        assert_eq!(lacking, &Some(Lacking { base: 2.0, last: 2.0, unit: "V".into() }));
        let Some(NoCause::LeavesForce { band }) = because else { panic!("{because:?}") };
        assert!((band - 0.06).abs() < 1e-9);
        // So they do where the base errs more.
        assert!(told(1.3, 0.06, Vec::new()).0.is_empty());
        // Where that is in doubt, where errors tell more, of what every system has, and where little is left of it.
        assert_eq!(told(30.0, 0.07, Vec::new()).0, [WAVE]);
        assert_eq!(told(0.5, 0.06, Vec::new()).0, [WAVE]);
        assert_eq!(told(30.0, 0.06, vec![WAVE]).0, [WAVE]);
        for (left, names) in [(0.4, 1), (0.5, 0)] {
            let (plant, mut found) = found(Some(0.01));
            let lacks =
                |rms: f64| Series { force: vec![rms, -rms], ..plant.lacks.clone().unwrap() };
            found.base = found.base.lacking(lacks(2.0));
            found.rungs[0] = found.rungs[0].clone().lacking(lacks(left));
            found.judge_force(
                &plant,
                &plant,
                &Thresholds { complete: 30.0, ..Thresholds::default() },
            );
            assert_eq!(found.added.len(), names, "{left}");
        }
    }
}
