//! A discovery: one look at a recording or two, each in one reading of it or two, and where its pieces name nothing the same on all of it.

use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use super::astray::{elsewhere, seen};
use super::beam::{Climb, Search, Tell};
use super::fit::{Fitter, best_setting};
use super::found::{Found, IN_FULL};
use super::node::Node;
use super::reading::{Other, Reading};
use super::refused::as_read;
use super::report::Report;
use super::sought::{PAIR, Sought};
use super::which_reading;
use crate::family::{Fitted, OtherReading};
use crate::fit;
use crate::report::{Decision, Discovery, Remark};
use crate::task::{Event, Observer, Settings, Thresholds};

/// Fits the base model, then searches the set of effects that is missing, by prediction errors alone.
///
/// What is missing colours the errors, and errors that resemble their neighbours weigh little: where several strong
/// effects are missing none of them is seen beside the others. A second look judges what an autoregression leaves of the
/// errors. What it finds counts where it leaves nothing.
pub fn discover(
    here: &Reading<'_>,
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
    let refused = &[];
    let run = Run {
        settings,
        sets,
        refused,
        thresholds,
        started,
        stop: &stop,
        tell: &tell,
        all_or_nothing,
    };
    let there = here.family.other_reading().filter(|_| !stop());
    let there = there.and_then(|OtherReading { family, nats, decided }| {
        Some(Other { reading: Reading::of(family)?, nats, decided })
    });
    run.looked(here, there.as_ref(), |sought| {
        let in_vain = if stop() { None } else { sought.searched_in_vain(&thresholds) };
        let longer = in_vain.zip(Reading::longer(here.family));
        let Some((share, longer)) = longer else { return run.told(sought) };
        let in_pieces = Remark::SearchedInPieces { share };
        let times = longer.searched().share() / share;
        if !leaves_time(settings.time_limit, started.elapsed(), times) {
            return run.told(sought.but(in_pieces));
        }
        let there = there.as_ref().and_then(Other::longer);
        let before = sought.found.refused.clone();
        let run = Run { refused: &before, ..run };
        run.looked(&longer, there.as_ref(), |again| {
            if again.found.stopped && again.found.added.is_empty() {
                return run.told(sought.but(in_pieces).cut());
            }
            let Found { decisions, refused, .. } = sought.found;
            run.told(again.after(decisions, refused))
        })
    })
}

/// A search in one reading that has looked at sets of one effect.
struct Pursuit<'a> {
    reading: &'a Reading<'a>,
    search: Search<'a>,
    climb: Climb,
}

impl Pursuit<'_> {
    fn is_complete(&self) -> bool {
        self.search.is_complete(self.climb.top().0)
    }

    /// Whether the best effect may do no more than the other reading.
    fn is_of_reading(&self) -> bool {
        let Reading { family, .. } = *self.reading;
        let (top, effects) = self.climb.top();
        let as_read = || as_read(family, self.reading.searched(), &self.climb.base, top);
        effects > 0 && as_read().is_some()
    }

    /// Whether the best model with an effect, which leaves more than the sensors make, predicts better in another reading.
    fn is_better_in(&self, other: &Reading<'_>, stop: &(dyn Fn() -> bool + Sync)) -> bool {
        let (top, effects) = self.climb.top();
        let fitter = Fitter::new(other.family, other.searched()).stopped_by(stop);
        effects > 0 && !self.is_complete() && !stop() && which_reading::is_better(top, &fitter)
    }
}

/// To bring a model to all of the recording takes at least so many times as long as to find its setting there.
const LEAST_ASKED: u32 = 4;

/// The same in each reading that the recording allows.
struct Begun<'a> {
    here: Pursuit<'a>,
    /// The other one, and by how many nats the simplest model prefers the first.
    there: Option<(Pursuit<'a>, f64)>,
    thresholds: Thresholds,
    stop: &'a (dyn Fn() -> bool + Sync),
    /// When time is up.
    until: Option<Instant>,
}

impl<'a> Begun<'a> {
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
    fn finished(self) -> Sought<'a> {
        let (thresholds, until, stop) = (self.thresholds, self.until, self.stop);
        let all_or_nothing = self.here.search.all_or_nothing;
        let (reading, found) = self.found();
        let (family, whole) = (reading.family, &*reading.whole);
        let Some(part) = &reading.part else {
            return Sought { reading, found, on_part: false }.judged(&thresholds);
        };
        // What leaves something there does not count, and was not asked whether chance gains as much.
        if all_or_nothing && !found.complete {
            return Sought { reading, found, on_part: true }.judged(&thresholds);
        }
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
    fn found(self) -> (&'a Reading<'a>, Found) {
        let Self { here, there, thresholds, stop, .. } = self;
        let reading = here.reading;
        let Some((there, nats)) = there else {
            return (reading, here.search.finish(here.climb));
        };
        let better = thresholds.in_part(there.reading.searched().share()).better;
        let preferred = |there: (&Node, usize), here: (&Node, usize)| {
            which_reading::nats(reading.searched(), there, here, better)
        };
        let by = preferred(there.climb.top(), here.climb.top()) - nats;
        let of_reading = (there.is_of_reading(), here.is_of_reading());
        let turned = which_reading::stands(by, of_reading, better);
        let (mut first, second) = if turned { (there, here) } else { (here, there) };
        let other = second.reading;
        let fitter = Fitter::new(other.family, other.searched()).stopped_by(stop);
        let less = |(top, added): (&Node, &[usize])| {
            if stop() { None } else { which_reading::with_less(top, added, &fitter, better) }
        };
        // What is found there, where that is to be preferred.
        let there = |second: Pursuit<'a>, led: Node, top: (&Node, usize)| {
            let there = second.search.finish_led(second.climb, led);
            Some(there).filter(|there| preferred(there.top(), top) > 0.0)
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
        let found = first.search.finish_grown(first.climb, grown);
        if let Some(second) = second
            && let Some(led) = less((found.top().0, &found.added))
            && let Some(there) = there(second, led, found.top())
        {
            return (other, there);
        }
        (first.reading, found)
    }
}

/// One discovery, whatever the reading.
#[derive(Clone, Copy)]
struct Run<'a> {
    settings: &'a Settings<'a>,
    /// Terms of the base model and those that are left out.
    sets: (&'a [usize], &'a [usize]),
    /// Models that looks before this one refused.
    refused: &'a [Fitted],
    thresholds: Thresholds,
    started: Instant,
    stop: &'a (dyn Fn() -> bool + Sync),
    tell: Tell<'a>,
    /// Whether only what leaves nothing counts.
    all_or_nothing: bool,
}

impl<'a> Run<'a> {
    /// What one look finds, or two.
    fn looked<R>(
        &self,
        here: &Reading<'_>,
        there: Option<&Other<'_>>,
        tell: impl FnOnce(Sought<'_>) -> R,
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
            Some(second) if second.is_pair() => {
                return tell(second.after(begun.decisions(), Vec::new()));
            }
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
                tell(second.after(first.found.decisions, first.found.refused))
            }
            Some(second) if second.found.stopped => tell(first.cut()),
            _ => tell(first),
        }
    }

    /// A search in either reading that has looked at sets of one effect.
    fn begun(&self, here: &'a Reading<'a>, there: Option<&'a Other<'a>>) -> Begun<'a> {
        let first = || self.pursuit(here, Search::base);
        let second = |there: &'a Other<'a>| self.pursuit(&there.reading, Search::base_in_time);
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

    fn pursuit(
        &self,
        reading: &'a Reading<'a>,
        base_of: fn(&Search<'a>, Fitted) -> Node,
    ) -> Pursuit<'a> {
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
            let start = seen(family, start.fit.model.within(family));
            let begun = base_of(&search, start.clone());
            let elsewhere = elsewhere(family, &start, &begun.model).into_iter();
            let held: Vec<Node> = elsewhere.map(|start| search.base_holding(start)).collect();
            // The way from much process noise may have led into another valley than the lowest.
            let freed = held.iter().map(|node| search.base_near_in_time(node.model.clone()));
            let lower = freed.filter(|node| node.deviation < begun.deviation);
            let lowest = lower.min_by(|a, b| a.deviation.total_cmp(&b.deviation)).unwrap_or(begun);
            let held = held.into_iter().map(|node| search.joined(node, &more, base)).collect();
            (search.joined(lowest, &more, base), held)
        };
        let mut climb = search.begin(base, elsewhere);
        for model in self.refused {
            search.ask_again(&mut climb, &model.clone().within(family));
        }
        Pursuit { reading, search, climb }
    }

    /// What was found, as a discovery; once more where noise of the input is in the way.
    fn told(&self, sought: Sought<'_>) -> Discovery {
        // Only what is told: another look must not stand for want of this one.
        let judged = |sought: &Sought<'_>| {
            let mut found = sought.found.clone();
            let ahead = sought.reading.asked(sought.on_part);
            found.judge_force(sought.reading.family, ahead, &self.thresholds);
            found
        };
        let found = judged(&sought);
        let Some(reading) = self.without_noise(&sought, found.complete) else {
            return self.reported(Sought { found, ..sought });
        };
        let Found { decisions, refused, .. } = sought.found;
        let run = Run { refused: &refused, ..*self };
        run.looked(&reading, None, |again| {
            let again = again.after(decisions, Vec::new());
            self.reported(Sought { found: judged(&again), ..again })
        })
    }

    /// The reading in which noise of the input is smoothed away, as much of it as lets a model predict best, where that is better
    /// than with effects that make the input late, or than where something is left.
    fn without_noise<'f>(&self, sought: &Sought<'f>, nothing_is_left: bool) -> Option<Reading<'f>> {
        let Sought { reading, found, on_part } = sought;
        let (top, effects) = found.top();
        let without = reading.family.without_lateness(&top.model);
        // What the base model has stays.
        let is_kept = found.base.model.terms.iter().all(|term| without.terms.contains(term));
        let late = top.model.terms.len() - without.terms.len();
        if !is_kept || late == 0 && nothing_is_left {
            return None;
        }
        let mut best: Option<(Reading<'f>, f64)> = None;
        let families = (0..).map_while(|more| reading.family.without_noise(more));
        for family in families {
            let smoothed = Reading::of(family).filter(|_| !(self.stop)())?;
            let ahead = smoothed.asked(*on_part);
            let fitter = Fitter::new(family, ahead).stopped_by(self.stop);
            let setting = best_setting(ahead, &without);
            let node = fitter.refit(without.clone(), setting, IN_FULL);
            let better = self.thresholds.in_part(ahead.share()).better;
            let nats = which_reading::nats(ahead, (&node, effects - late), (top, effects), better);
            let gain = nats - if late == 0 { better } else { 0.0 };
            // More takes away what acted.
            if best.as_ref().is_some_and(|(_, before)| gain <= *before) {
                break;
            }
            best = Some((smoothed, gain));
        }
        best.filter(|(_, gain)| *gain > 0.0).map(|(smoothed, _)| smoothed)
    }

    fn reported(&self, sought: Sought<'_>) -> Discovery {
        (self.tell)(&Event::Finishing);
        let Sought { reading, mut found, on_part } = sought;
        let (family, ahead, settings) = (reading.family, reading.asked(on_part), self.settings);
        found.stopped |= (self.stop)();
        found.so_far(family, ahead);
        found.place_noise(family, ahead, &self.thresholds);
        let report = Report { family, ahead, settings, found, brief: on_part, stop: self.stop };
        let mut discovery = report.discovery();
        discovery.remarks.extend(family.reading());
        discovery.seed = self.settings.seed;
        discovery.wall_s = self.started.elapsed().as_secs_f64();
        discovery
    }
}

/// Whether so many times as much of a recording can be searched within a limit after a search took so long.
fn leaves_time(limit: Option<Duration>, took: Duration, times: f64) -> bool {
    limit.is_none_or(|limit| took + took.mul_f64(times) <= limit)
}

/// Whether a search was asked to end, or its time is up.
fn is_over(settings: &Settings<'_>, started: Instant) -> bool {
    let asked = settings.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
    asked || settings.time_limit.is_some_and(|limit| started.elapsed() >= limit)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ahead::testing::{BEAT, BOTH, DRIVE, PUSH, Plant, TONE, TWIN, WAVE};

    #[test]
    fn more_of_a_recording_is_searched_where_the_limit_leaves_as_much_longer_as_there_is_more() {
        let leaves = |limit: Option<u64>, took, times| {
            leaves_time(limit.map(Duration::from_secs), Duration::from_secs(took), times)
        };
        assert!(leaves(None, 100, 4.0) && leaves(Some(60), 12, 4.0));
        assert!(!leaves(Some(60), 13, 4.0) && leaves(Some(60), 13, 2.0));
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

    #[test]
    fn of_a_look_that_leaves_something_on_a_part_nothing_is_asked_of_the_whole() {
        // A frequency that no tone can have, in the pieces alone.
        let mut plant = Plant::new(5, &[(WAVE, &[0.05])]);
        let pieces = Plant::new(6, &[(WAVE, &[0.05]), (TONE, &[0.02, 30.0])]);
        plant.pieces = Some((Box::new(pieces), 0.1));
        let reading = Reading::of(&plant).unwrap();
        let (settings, never) = (Settings::default(), || false);
        let finished = |all_or_nothing| {
            let run = Run {
                settings: &settings,
                sets: (&[DRIVE], &[BEAT, BOTH, TONE, PUSH, TWIN]),
                refused: &[],
                thresholds: settings.thresholds,
                started: Instant::now(),
                stop: &never,
                tell: &|_| {},
                all_or_nothing,
            };
            let sought = run.begun(&reading, None).finished();
            (sought.on_part, sought.found.complete, sought.found.added, sought.found.stopped)
        };
        assert_eq!(finished(false), (false, true, vec![WAVE], false));
        // The same as it was found: not taken back for want of what chance gains, which was not asked.
        assert_eq!(finished(true), (true, false, vec![WAVE], false));
    }
}
