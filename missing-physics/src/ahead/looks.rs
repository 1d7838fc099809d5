//! A discovery: one look at a recording or two, each in one reading of it or two.

use std::sync::Mutex;
use std::sync::atomic::Ordering;
use std::time::Instant;

use super::beam::{Climb, Search, Tell};
use super::compare::Comparison;
use super::fit::{self as fit_ahead, Fitter};
use super::found::Found;
use super::node::Node;
use super::report::Report;
use super::residuals::Residuals;
use super::{Ahead, reading};
use crate::family::{Fitted, ModelFamily};
use crate::fit;
use crate::report::Discovery;
use crate::task::{Event, Observer, Settings, Thresholds};

/// What is told where time ran out in the second look.
const CUT: &str =
    "Time ran out before it was known whether other effects, which hide each other, do as much.";

/// Fits the base model, then searches the set of effects that is missing, by prediction errors alone.
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
    let run = Run { settings, sets, started, stop: &stop, tell: &tell };
    let there = here.family.other_reading().filter(|_| !stop());
    let there = there.and_then(|(other, nats)| Some((Reading::of(other)?, nats)));
    let first = run.sought(here, there.as_ref());
    // A wrong reading takes an effect of its own to leave nothing.
    let doubtful = there.is_some() && first.found.added.len() > 1;
    if first.found.complete && !doubtful {
        return run.told(first);
    }
    if stop() {
        return run.told(first.cut());
    }
    // What is missing colours the errors, and errors that resemble their neighbours weigh little: where several strong
    // effects are missing none of them is seen beside the others. What is then found counts where it leaves nothing.
    let Some(here) = here.coloured() else { return run.told(first) };
    let there = there.as_ref().and_then(|(there, nats)| Some((there.coloured()?, *nats)));
    let mut second = run.sought(&here, there.as_ref());
    let plainer = second.found.added.len() < first.found.added.len();
    let leaves_nothing = second.found.complete && (!first.found.complete || plainer);
    let is_borne_out = first.found.added.is_empty() && first.reading.bears_out(&second.found);
    if !leaves_nothing && !is_borne_out {
        return run.told(if stop() { first.cut() } else { first });
    }
    second.found.decisions.splice(0..0, first.found.decisions);
    run.told(second)
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
        Some(Self {
            family,
            whole: family.ahead()?,
            part: family.ahead_in_part(),
            residuals: false,
        })
    }

    /// That of a family that only gives residuals, whose noise the residual of `base` shows.
    pub fn of_residuals(family: &'a F, base: &Fitted) -> Self {
        Self { family, whole: Box::new(Residuals::new(family, base)), part: None, residuals: true }
    }

    /// What is searched.
    fn searched(&self) -> &dyn Ahead {
        self.part.as_deref().unwrap_or(&*self.whole)
    }

    /// The same, its errors judged by what an autoregression leaves of them.
    fn coloured(&self) -> Option<Reading<'_, F>> {
        let part = self.part.as_ref().map(|part| part.coloured());
        let whole = self.whole.coloured()?;
        Some(Reading {
            family: self.family,
            whole,
            part: part.flatten(),
            residuals: self.residuals,
        })
    }

    /// Whether residuals as they are fall by what was found in whitened ones: noise of a colour that nobody stated leaves
    /// no model complete, and hides in them what whitened ones show.
    fn bears_out(&self, found: &Found) -> bool {
        let Some(top) = found.rungs.last().filter(|_| self.residuals) else { return false };
        let as_it_is = |node: &Node| fit_ahead::evaluated(&*self.whole, node.model.clone(), 0);
        let comparison = Comparison::new(self.family, &*self.whole);
        comparison.compare(&as_it_is(&found.base), &as_it_is(top)).nats > 0.0
    }
}

/// What was found in a reading.
struct Sought<'a, F: ModelFamily + ?Sized> {
    reading: &'a Reading<'a, F>,
    found: Found,
}

impl<F: ModelFamily + ?Sized> Sought<'_, F> {
    /// The same where time ran out before the second look was over.
    fn cut(mut self) -> Self {
        self.found.stopped = true;
        self.found.notes.push(CUT.to_owned());
        self
    }
}

/// One discovery, whatever the reading.
struct Run<'a> {
    settings: &'a Settings<'a>,
    /// Terms of the base model and those that are left out.
    sets: (&'a [usize], &'a [usize]),
    started: Instant,
    stop: &'a (dyn Fn() -> bool + Sync),
    tell: Tell<'a>,
}

impl Run<'_> {
    /// What is found in the reading that stands: on all of the recording, judged.
    fn sought<'b, F: ModelFamily + ?Sized>(
        &'b self,
        here: &'b Reading<'b, F>,
        there: Option<&'b (Reading<'b, F>, f64)>,
    ) -> Sought<'b, F> {
        let (reading, mut found) = self.found(here, there);
        let thresholds = self.thresholds(&*reading.whole);
        if reading.part.is_some() {
            found.confirm(reading.family, &*reading.whole, &thresholds);
        }
        found.judge(reading.family, &*reading.whole, &thresholds);
        Sought { reading, found }
    }

    /// What is found in the reading that stands, as far as it was searched.
    fn found<'b, F: ModelFamily + ?Sized>(
        &'b self,
        here: &'b Reading<'b, F>,
        there: Option<&'b (Reading<'b, F>, f64)>,
    ) -> (&'b Reading<'b, F>, Found) {
        let (search, climb) = self.begun(here);
        let Some((there, nats)) = there else { return (here, search.finish(climb)) };
        let (second, second_climb) = self.begun(there);
        let better = self.settings.thresholds.in_part(there.searched().share()).better;
        if reading::nats(second_climb.top(), climb.top(), better) > *nats {
            return (there, second.finish(second_climb));
        }
        let found = search.finish(climb);
        let fitter = Fitter::new(there.family, there.searched()).stopped_by(self.stop);
        if !(self.stop)() && reading::needs_less(&found, there.family, &fitter, better) {
            let second = second.finish(second_climb);
            if reading::nats(second.top(), found.top(), better) > 0.0 {
                return (there, second);
            }
        }
        (here, found)
    }

    /// A search that has looked at sets of one effect.
    fn begun<'b, F: ModelFamily + ?Sized>(
        &'b self,
        reading: &'b Reading<'b, F>,
    ) -> (Search<'b, F>, Climb) {
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
        let thresholds = self.thresholds(ahead).in_part(ahead.share());
        let mut search = Search::new(family, ahead, thresholds, candidates, self.stop, self.tell);
        let base = if let Some(near) = &self.settings.start {
            search.base_near(near.clone())
        } else {
            let everywhere = vec![1.0; family.target().len()];
            let start = fit::identify(family, base, &everywhere, self.settings.seed);
            (self.tell)(&Event::BaseFitted { evaluations: start.evaluations });
            search.base(start.fit.model)
        };
        let climb = search.begin(base);
        (search, climb)
    }

    /// Those that errors of all of the recording are asked.
    fn thresholds(&self, ahead: &dyn Ahead) -> Thresholds {
        let thresholds = self.settings.thresholds.in_part(ahead.asked());
        Thresholds { most: thresholds.most.min(self.settings.most), ..thresholds }
    }

    /// What was found, as a discovery.
    fn told<F: ModelFamily + ?Sized>(&self, sought: Sought<'_, F>) -> Discovery {
        (self.tell)(&Event::Finishing);
        let Sought { reading, found } = sought;
        let (family, ahead) = (reading.family, &*reading.whole);
        let mut discovery = Report { family, ahead, settings: self.settings, found }.discovery();
        discovery.notes.extend(family.reading());
        discovery.seed = self.settings.seed;
        discovery.wall_s = self.started.elapsed().as_secs_f64();
        discovery
    }
}

/// Whether a search was asked to end, or its time is up.
fn is_over(settings: &Settings<'_>, started: Instant) -> bool {
    let asked = settings.stop.is_some_and(|stop| stop.load(Ordering::Relaxed));
    asked || settings.time_limit.is_some_and(|limit| started.elapsed() >= limit)
}
