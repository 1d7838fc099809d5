//! A discovery: one look at a recording or two, each in one reading of it or two.

use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::astray::elsewhere;
use super::beam::{Climb, Search, Tell};
use super::compare::Comparison;
use super::fit::{Fitter, best_setting, evaluated};
use super::found::{Found, IN_FULL};
use super::node::Node;
use super::refused::refused;
use super::report::Report;
use super::residuals::Residuals;
use super::{Ahead, reading};
use crate::family::{Fitted, ModelFamily, OtherReading};
use crate::fit;
use crate::report::{Decision, Discovery, Remark};
use crate::task::{Event, Observer, Settings, Thresholds};

/// Fits the base model, then searches the set of effects that is missing, by prediction errors alone.
///
/// What is missing colours the errors, and errors that resemble their neighbours weigh little: where several strong
/// effects are missing none of them is seen beside the others. A second look judges what an autoregression leaves of the
/// errors. What it finds counts where it leaves nothing.
pub fn discover<F: ModelFamily + ?Sized>(
    here: &Reading<'_, F>,
    settings: &Settings<'_>,
    sets: (&[usize], &[usize]),
    observer: &mut (dyn Observer + Send),
) -> Discovery {
    let started = Instant::now();
    let stop = move || is_over(settings, started);
    let observer = Mutex::new(observer);
    let tell = |event: &Event<'_>| {
        if let Ok(mut observer) = observer.lock() {
            observer.event(event);
        }
    };
    let thresholds = settings.thresholds;
    let most = thresholds.most.min(settings.most);
    let thresholds = Thresholds { most, ..thresholds };
    let all_or_nothing = false;
    let run = Run { settings, sets, thresholds, started, stop: &stop, tell: &tell, all_or_nothing };
    let there = here.family.other_reading().filter(|_| !stop());
    let there = there.and_then(|OtherReading { family, nats, decided }| {
        Some(Other { reading: Reading::of(family)?, nats, decided })
    });
    run.looked(here, there.as_ref(), |sought| {
        let Some((all, share)) = sought.unsearched(&thresholds) else { return run.told(sought) };
        let in_pieces = Remark::SearchedInPieces { share };
        if !leaves_time(settings.time_limit, started.elapsed(), share) {
            return run.told(sought.but(in_pieces));
        }
        let there = there.as_ref().and_then(Other::in_full);
        run.looked(&all, there.as_ref(), |again| {
            if again.found.stopped && again.found.added.is_empty() {
                return run.told(sought.cut(in_pieces));
            }
            run.told(again.after(sought.found.decisions))
        })
    })
}

/// A recording as it is read: how its input acts between samples.
pub struct Reading<'a, F: ModelFamily + ?Sized> {
    family: &'a F,
    whole: Box<dyn Ahead + 'a>,
    part: Option<Box<dyn Ahead + 'a>>,
    /// Whether the errors are residuals.
    residuals: bool,
}

impl<'a, F: ModelFamily + ?Sized> Reading<'a, F> {
    /// That of a family that predicts one sample ahead.
    pub fn of(family: &'a F) -> Option<Self> {
        let (whole, part) = (family.ahead()?, family.ahead_in_part());
        Some(Self { family, whole, part, residuals: false })
    }

    /// The same, all of it searched.
    fn in_full(family: &'a F) -> Option<Self> {
        Some(Self { family, whole: family.ahead()?, part: None, residuals: false })
    }

    /// That of a family that only gives residuals, whose noise the residual of `base` shows.
    pub fn of_residuals(family: &'a F, base: &Fitted) -> Self {
        Self { family, whole: Box::new(Residuals::new(family, base)), part: None, residuals: true }
    }

    /// What is searched.
    fn searched(&self) -> &dyn Ahead {
        self.asked(true)
    }

    /// All of it, or what is searched.
    fn asked(&self, on_part: bool) -> &dyn Ahead {
        self.part.as_deref().filter(|_| on_part).unwrap_or(&*self.whole)
    }

    /// The same, its errors judged by what an autoregression leaves of them.
    fn coloured(&self) -> Option<Reading<'_, F>> {
        let part = self.part.as_ref().map(|part| part.coloured());
        let whole = self.whole.coloured()?;
        let part = part.flatten();
        Some(Reading { family: self.family, whole, part, residuals: self.residuals })
    }

    /// Whether residuals as they are fall by what was found in whitened ones: noise of a colour that nobody stated leaves
    /// no model complete, and hides in them what whitened ones show.
    fn bears_out(&self, found: &Found) -> bool {
        let Some(top) = found.rungs.last().filter(|_| self.residuals) else { return false };
        let as_it_is = |node: &Node| evaluated(&*self.whole, node.model.clone(), 0);
        let comparison = Comparison::new(self.family, &*self.whole);
        comparison.compare(&as_it_is(&found.base), &as_it_is(top)).nats > 0.0
    }
}

/// The other way to read a recording.
struct Other<'a, F: ModelFamily + ?Sized> {
    reading: Reading<'a, F>,
    /// By how many nats the simplest model prefers the first, and whether that decides until effects say otherwise.
    nats: f64,
    decided: bool,
}

impl<F: ModelFamily + ?Sized> Other<'_, F> {
    fn coloured(&self) -> Option<Other<'_, F>> {
        Some(Other { reading: self.reading.coloured()?, ..*self })
    }

    /// The same, all of it searched.
    fn in_full(&self) -> Option<Other<'_, F>> {
        Some(Other { reading: Reading::in_full(self.reading.family)?, ..*self })
    }
}

/// A search in one reading that has looked at sets of one effect.
struct Pursuit<'a, F: ModelFamily + ?Sized> {
    reading: &'a Reading<'a, F>,
    search: Search<'a, F>,
    climb: Climb,
}

impl<F: ModelFamily + ?Sized> Pursuit<'_, F> {
    fn is_complete(&self) -> bool {
        self.search.is_complete(self.climb.top().0)
    }

    /// Whether the best model with an effect, which leaves more than the sensors make, predicts better in another reading.
    fn is_better_in(&self, other: &Reading<'_, F>, stop: &(dyn Fn() -> bool + Sync)) -> bool {
        let (top, effects) = self.climb.top();
        let fitter = Fitter::new(other.family, other.searched()).stopped_by(stop);
        effects > 0 && !self.is_complete() && !stop() && reading::is_better(top, &fitter)
    }
}

/// The same in each reading that the recording allows.
struct Begun<'a, F: ModelFamily + ?Sized> {
    here: Pursuit<'a, F>,
    /// The other one, and by how many nats the simplest model prefers the first.
    there: Option<(Pursuit<'a, F>, f64)>,
    thresholds: Thresholds,
    stop: &'a (dyn Fn() -> bool + Sync),
    /// When time is up.
    until: Option<Instant>,
}

impl<'a, F: ModelFamily + ?Sized> Begun<'a, F> {
    /// Whether one effect, or none, leaves no more than the sensors make.
    fn is_complete(&self) -> bool {
        self.here.is_complete() || self.there.as_ref().is_some_and(|(there, _)| there.is_complete())
    }

    /// What was compared so far.
    fn decisions(self) -> Vec<Decision> {
        let there = self.there.map(|(there, _)| there.search.decisions);
        self.here.search.decisions.into_iter().chain(there.into_iter().flatten()).collect()
    }

    /// What is found in the reading that stands: on all of the recording, judged.
    fn finished(self) -> Sought<'a, F> {
        let (thresholds, until, stop) = (self.thresholds, self.until, self.stop);
        let (reading, found) = self.found();
        let (family, whole) = (reading.family, &*reading.whole);
        let Some(part) = &reading.part else {
            return Sought { reading, found, on_part: false }.judged(&thresholds);
        };
        // No less than this is asked of all of the recording, and takes so much longer there.
        let models = (1 + found.rungs.len()) as u32;
        let in_time = until.is_none_or(|until| {
            let began = Instant::now();
            best_setting(&**part, &found.top().0.model);
            let each = began.elapsed().div_f64(part.share().max(f64::MIN_POSITIVE));
            Instant::now() + LEAST_ASKED * models * each < until
        });
        let confirmed =
            in_time.then(|| found.clone().confirmed(family, whole, &thresholds, stop)).flatten();
        let on_part = confirmed.is_none();
        let found = confirmed.unwrap_or_else(|| found.unconfirmed(part.share()));
        Sought { reading, found, on_part }.judged(&thresholds)
    }

    /// What is found in the reading that stands, as far as it was searched.
    fn found(self) -> (&'a Reading<'a, F>, Found) {
        let Self { here, there, thresholds, stop, .. } = self;
        let Some((there, nats)) = there else {
            return (here.reading, here.search.finish(here.climb));
        };
        let better = thresholds.in_part(there.reading.searched().share()).better;
        let turned = reading::nats(there.climb.top(), here.climb.top(), better) > nats;
        let (mut first, second) = if turned { (there, here) } else { (here, there) };
        let other = second.reading;
        let fitter = Fitter::new(other.family, other.searched()).stopped_by(stop);
        let less = |(top, added): (&Node, &[usize])| {
            if stop() { None } else { reading::with_less(top, added, &fitter, better) }
        };
        // What is found there, where that is to be preferred.
        let there = |second: Pursuit<'a, F>, led: Node, top: (&Node, usize)| {
            let there = second.search.finish_led(second.climb, led);
            Some(there).filter(|there| reading::nats(there.top(), top, better) > 0.0)
        };
        // To look at a set more closely takes as long as the way to it.
        let grown = first.search.grown(&mut first.climb);
        let added = first.climb.added(&grown);
        let mut second = Some(second);
        if let Some(led) = less((&grown, &added))
            && let Some(second) = second.take()
            && let Some(there) = there(second, led, (&grown, added.len()))
        {
            return (other, there);
        }
        let mut found = first.search.finish_grown(first.climb, grown);
        if stop() && !found.added.is_empty() {
            found.stopped = true;
            found.remarks.push(Remark::OtherReadingUnasked);
            return (first.reading, found);
        }
        if let Some(second) = second
            && let Some(led) = less((found.top().0, &found.added))
            && let Some(there) = there(second, led, found.top())
        {
            return (other, there);
        }
        (first.reading, found)
    }
}

/// Effects that a second look goes up to.
const PAIR: usize = 2;
/// To bring a model to all of the recording takes at least so many times as long as to find its setting there.
const LEAST_ASKED: u32 = 4;

/// Share of a recording that a search must have seen for all of it to be searched.
const LEAST_SHARE: f64 = 0.25;

/// What was found in a reading.
struct Sought<'a, F: ModelFamily + ?Sized> {
    reading: &'a Reading<'a, F>,
    found: Found,
    /// Whether it was not asked of all of the recording.
    on_part: bool,
}

impl<'a, F: ModelFamily + ?Sized> Sought<'a, F> {
    /// The same without names that are not the cause.
    fn judged(mut self, thresholds: &Thresholds) -> Self {
        let Reading { family, .. } = self.reading;
        self.found.judge(*family, self.reading.asked(self.on_part), thresholds);
        self
    }

    /// All of a recording, where a search on a part of it names nothing although something is missing, and that part as a share
    /// of it: what shows in few places may not be among the pieces.
    fn unsearched(&self, thresholds: &Thresholds) -> Option<(Reading<'a, F>, f64)> {
        let Reading { family, whole, part, .. } = self.reading;
        let share = part.as_ref().filter(|_| !self.on_part)?.share();
        let mut found = self.found.clone();
        found.judge_force(*family, &**whole, thresholds);
        let silent = found.added.is_empty() && !found.complete && !found.stopped;
        Some((Reading::in_full(*family)?, share)).filter(|_| silent && share >= LEAST_SHARE)
    }

    /// Whether so few effects leave nothing that no other look can do with less.
    fn is_pair(&self) -> bool {
        self.found.complete && self.found.added.len() <= PAIR
    }

    /// Whether it leaves nothing where the other does, or does so with fewer effects that do as much.
    fn is_plainer_than(&self, other: &Self, thresholds: &Thresholds) -> bool {
        let fewer = self.found.added.len() < other.found.added.len();
        self.found.complete
            && (!other.found.complete || fewer && !self.misses(&other.found, thresholds))
    }

    /// Whether what was found elsewhere does more here than what was found here.
    fn misses(&self, other: &Found, thresholds: &Thresholds) -> bool {
        let Reading { family, .. } = *self.reading;
        let ahead = self.reading.asked(self.on_part);
        let model = other.top().0.model.clone().within(family);
        let setting = best_setting(ahead, &model);
        let other = Fitter::new(family, ahead).refit(model, setting, IN_FULL);
        let compare = |from, to| Comparison::new(family, ahead).compare(from, to).nats;
        let share = if self.on_part { ahead.share() } else { 1.0 };
        let clear = thresholds.in_part(share).clear(compare(&self.found.base, &other));
        compare(self.found.top().0, &other) > clear
            && refused(family, ahead, &self.found.base, &other).is_none()
    }

    /// Whether it names nothing, and bears out what the other look found.
    fn is_silent_on(&self, other: &Self) -> bool {
        self.found.added.is_empty() && self.reading.bears_out(&other.found)
    }

    /// The same with what was compared before.
    fn after(mut self, decisions: Vec<Decision>) -> Self {
        self.found.decisions.splice(0..0, decisions);
        self
    }

    /// The same with a remark.
    fn but(mut self, remark: Remark) -> Self {
        self.found.remarks.push(remark);
        self
    }

    /// The same where time ran out before what might have told better was over.
    fn cut(mut self, remark: Remark) -> Self {
        self.found.stopped = true;
        self.but(remark)
    }
}

/// One discovery, whatever the reading.
#[derive(Clone, Copy)]
struct Run<'a> {
    settings: &'a Settings<'a>,
    /// Terms of the base model and those that are left out.
    sets: (&'a [usize], &'a [usize]),
    thresholds: Thresholds,
    started: Instant,
    stop: &'a (dyn Fn() -> bool + Sync),
    tell: Tell<'a>,
    /// Whether only what leaves nothing counts.
    all_or_nothing: bool,
}

impl<'a> Run<'a> {
    /// What one look finds, or two.
    fn looked<F: ModelFamily + ?Sized, R>(
        &self,
        here: &Reading<'_, F>,
        there: Option<&Other<'_, F>>,
        tell: impl FnOnce(Sought<'_, F>) -> R,
    ) -> R {
        let (most, stop) = (self.thresholds.most, self.stop);
        let coloured = here.coloured();
        let coloured = coloured.as_ref().map(|here| (here, there.and_then(Other::coloured)));
        let asked = self.thresholds.in_part(here.whole.asked());
        let look = |most: usize| {
            let (here, there) = coloured.as_ref().filter(|_| most > 0 && !stop())?;
            let thresholds = Thresholds { most, ..self.thresholds };
            // Of residuals it may bear out the first one.
            let run = Run { thresholds, all_or_nothing: !here.residuals, ..*self };
            Some(run.begun(here, there.as_ref()).finished())
        };

        // Two are the fewest that hide each other, and more are seldom all of it.
        let most = if here.residuals { most } else { most.min(PAIR) };
        let begun = self.begun(here, there);
        // Where one effect leaves something two may hide each other: the second look tells sooner.
        let second = if begun.is_complete() || here.residuals { None } else { look(most) };
        let second = match second {
            Some(second) if second.is_pair() => return tell(second.after(begun.decisions())),
            other => other,
        };
        let first = begun.finished();
        // A wrong reading takes an effect of its own to leave nothing.
        let doubtful = there.is_some() && first.found.added.len() > 1;
        if first.found.complete && !doubtful {
            return tell(first);
        }
        // Beside a complete one only fewer effects count.
        let fewer = if first.found.complete { first.found.added.len() - 1 } else { most };
        let second = second.or_else(|| look(fewer.min(most)));
        match second {
            Some(second)
                if second.is_plainer_than(&first, &asked) || first.is_silent_on(&second) =>
            {
                tell(second.after(first.found.decisions))
            }
            Some(second) if !second.found.stopped => tell(first),
            None if !stop() => tell(first),
            _ => tell(first.cut(Remark::SecondLookCut)),
        }
    }

    /// A search in either reading that has looked at sets of one effect.
    fn begun<F: ModelFamily + ?Sized>(
        &self,
        here: &'a Reading<'a, F>,
        there: Option<&'a Other<'a, F>>,
    ) -> Begun<'a, F> {
        let first = || self.pursuit(here, Search::base);
        let second = |there: &'a Other<'a, F>| self.pursuit(&there.reading, Search::base_in_time);
        let (first, second) = match there {
            Some(there) if !there.decided => {
                let (first, second) = rayon::join(first, || second(there));
                (first, Some((second, there.nats)))
            }
            // What a model lacks may decide for the wrong one: beside what it lacked most it is asked once more.
            _ => {
                let first = first();
                let asked = there.filter(|there| first.is_better_in(&there.reading, self.stop));
                (first, asked.map(|there| (second(there), 0.0)))
            }
        };
        Begun {
            here: first,
            there: second,
            thresholds: self.thresholds.in_part(here.whole.asked()),
            stop: self.stop,
            until: self.settings.time_limit.and_then(|limit| self.started.checked_add(limit)),
        }
    }

    fn pursuit<F: ModelFamily + ?Sized>(
        &self,
        reading: &'a Reading<'a, F>,
        base_of: fn(&Search<'a, F>, Fitted) -> Node,
    ) -> Pursuit<'a, F> {
        let (family, ahead) = (reading.family, reading.searched());
        let (base, excluded) = self.sets;
        let candidates: Vec<usize> = (0..family.terms().len())
            .filter(|&term| {
                let main = family.form_of(term).unwrap_or(term);
                !family.terms()[term].always
                    && ahead.is_candidate(term)
                    && ![term, main].iter().any(|t| excluded.contains(t))
            })
            .collect();
        let thresholds = self.thresholds.in_part(ahead.asked()).in_part(ahead.share());
        let mut search = Search::new(family, ahead, thresholds, candidates, self.stop, self.tell);
        search.all_or_nothing = self.all_or_nothing;
        let (base, elsewhere) = if let Some(near) = &self.settings.start {
            (search.base_near(near.clone()), Vec::new())
        } else {
            // A start needs no more than a part.
            let near = family.in_part().unwrap_or(family);
            let everywhere = vec![1.0; near.target().len()];
            let (searched, more) = search.parted(base);
            let start = fit::identify(near, &searched, &everywhere, self.settings.seed);
            (self.tell)(&Event::BaseFitted { evaluations: start.evaluations });
            let start = start.fit.model.within(family);
            let begun = base_of(&search, start.clone());
            let elsewhere = elsewhere(family, &start, &begun.model);
            let elsewhere = elsewhere.into_iter().map(|start| search.base_holding(start));
            let elsewhere = elsewhere.map(|node| search.joined(node, &more, base)).collect();
            (search.joined(begun, &more, base), elsewhere)
        };
        let climb = search.begin(base, elsewhere);
        Pursuit { reading, search, climb }
    }

    /// What was found, as a discovery.
    fn told<F: ModelFamily + ?Sized>(&self, sought: Sought<'_, F>) -> Discovery {
        (self.tell)(&Event::Finishing);
        let Sought { reading, mut found, on_part } = sought;
        let (family, ahead, settings) = (reading.family, reading.asked(on_part), self.settings);
        // Only what is told: another look must not stand for want of this one.
        found.judge_force(family, ahead, &self.thresholds);
        let report = Report { family, ahead, settings, found, brief: on_part, stop: self.stop };
        let mut discovery = report.discovery();
        discovery.remarks.extend(family.reading());
        discovery.seed = self.settings.seed;
        discovery.wall_s = self.started.elapsed().as_secs_f64();
        discovery
    }
}

/// Whether all of a recording can be searched within a limit after a search of this share of it took so long.
fn leaves_time(limit: Option<Duration>, took: Duration, share: f64) -> bool {
    limit.is_none_or(|limit| took + took.div_f64(share) <= limit)
}

/// Whether a search was asked to end, or its time is up.
fn is_over(settings: &Settings<'_>, started: Instant) -> bool {
    let asked = settings.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
    asked || settings.time_limit.is_some_and(|limit| started.elapsed() >= limit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::testing::{BEAT, Plant, WAVE};

    fn plant() -> Plant {
        Plant::new(1, &[(WAVE, &[0.05])])
    }

    /// A result with so many effects.
    fn sought<'a>(
        reading: &'a Reading<'a, Plant>,
        plant: &Plant,
        effects: usize,
        complete: bool,
    ) -> Sought<'a, Plant> {
        let base = Fitter::new(plant, plant).refit(Plant::model(&[]), 0, IN_FULL);
        let found = Found { added: vec![WAVE; effects], complete, ..Found::of(base) };
        Sought { reading, found, on_part: false }
    }

    #[test]
    fn what_leaves_nothing_with_fewer_effects_is_plainer_and_what_leaves_something_never_is() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let of = |effects, complete| sought(&reading, &plant, effects, complete);
        let is_plainer = |effects, complete, other: &Sought<'_, Plant>| {
            of(effects, complete).is_plainer_than(other, &Thresholds::default())
        };
        assert!(is_plainer(1, true, &of(2, true)));
        assert!(is_plainer(3, true, &of(1, false)));
        assert!(!is_plainer(2, true, &of(2, true)));
        assert!(!is_plainer(1, false, &of(2, false)));
    }

    #[test]
    fn a_look_that_misses_what_another_found_is_not_plainer() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let other = |size: f64| {
            let model = Plant::model(&[(WAVE, &[size]), (BEAT, &[1e-3])]);
            let mut other = sought(&reading, &plant, 2, true);
            other.found.rungs = vec![evaluated(&plant, model, 0)];
            other
        };
        let is_plainer = |first: &Sought<'_, Plant>, wave: &[f64]| {
            let mut second = sought(&reading, &plant, wave.len(), true);
            let nodes = wave.iter().map(|size| Plant::model(&[(WAVE, &[*size])]));
            second.found.rungs = nodes.map(|model| evaluated(&plant, model, 0)).collect();
            second.is_plainer_than(first, &Thresholds::default())
        };
        // A wave is there and no beat.
        assert!(is_plainer(&other(0.05), &[0.05]));
        assert!(!is_plainer(&other(0.05), &[]));
        // What was found elsewhere is asked at its best here.
        assert!(!is_plainer(&other(0.01), &[]));
    }

    #[test]
    fn two_effects_that_leave_nothing_are_a_pair_and_three_are_none() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let is_pair = |effects, complete| sought(&reading, &plant, effects, complete).is_pair();
        assert!(is_pair(2, true) && is_pair(0, true));
        assert!(!is_pair(3, true) && !is_pair(2, false));
    }

    #[test]
    fn a_cut_second_look_is_told_and_what_was_compared_before_stands_first() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let cut = sought(&reading, &plant, 1, false).cut(Remark::SecondLookCut);
        assert!(cut.found.stopped);
        assert_eq!(cut.found.remarks, [Remark::SecondLookCut]);
        let decision = |rung| Decision {
            rung,
            candidate: Vec::new(),
            compared_with: Vec::new(),
            difference: 0.0,
            standard_error: 0.0,
            budget: 1.0,
            outcome: crate::report::Outcome::TooLittle,
            because: None,
        };
        let mut later = sought(&reading, &plant, 1, true);
        later.found.decisions = vec![decision(2)];
        let all = later.after(vec![decision(1)]).found.decisions;
        assert_eq!(all.iter().map(|d| d.rung).collect::<Vec<_>>(), [1, 2]);
    }

    #[test]
    fn a_family_that_predicts_bears_nothing_out_for_residuals() {
        let plant = plant();
        let reading = Reading::of(&plant).unwrap();
        let silent = sought(&reading, &plant, 0, false);
        let mut other = sought(&reading, &plant, 1, true);
        other.found.rungs = vec![evaluated(&plant, Plant::model(&[(WAVE, &[0.05])]), 0)];
        assert!(!silent.is_silent_on(&other));
        // The same errors, as those of a family that only gives residuals.
        let residuals = Reading { residuals: true, ..Reading::of(&plant).unwrap() };
        assert!(sought(&residuals, &plant, 0, false).is_silent_on(&other));
        assert!(!sought(&residuals, &plant, 1, false).is_silent_on(&other));
        // What changes nothing lowers nothing.
        other.found.rungs = vec![evaluated(&plant, Plant::model(&[]), 0)];
        assert!(!sought(&residuals, &plant, 0, false).is_silent_on(&other));
    }

    #[test]
    fn all_of_a_recording_is_searched_where_the_limit_leaves_as_much_longer_as_there_is_more() {
        let leaves = |limit: Option<u64>, took, share| {
            leaves_time(limit.map(Duration::from_secs), Duration::from_secs(took), share)
        };
        assert!(leaves(None, 100, 0.25) && leaves(Some(60), 12, 0.25));
        assert!(!leaves(Some(60), 13, 0.25) && leaves(Some(60), 13, 0.5));
    }

    #[test]
    fn a_search_is_over_when_it_was_asked_to_end_or_its_time_is_up() {
        let started = Instant::now();
        assert!(!is_over(&Settings::default(), started));
        let flag = std::sync::atomic::AtomicBool::new(false);
        let asked = Settings { stop: Some(&flag), ..Settings::default() };
        assert!(!is_over(&asked, started));
        flag.store(true, Ordering::Relaxed);
        assert!(is_over(&asked, started));
        let time_limit = Some(Duration::ZERO);
        assert!(is_over(&Settings { time_limit, ..Settings::default() }, started));
    }
}
