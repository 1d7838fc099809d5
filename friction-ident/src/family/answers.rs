//! What a discovery asks of a recording of a drive.

use std::collections::BTreeMap;
use std::ops::Range;

use missing_physics::family::{Ahead, FullRate, Generic, OtherReading, sizes};
use missing_physics::report::{Course, NamedError, Plot, Remark};
use missing_physics::statistics::split::Split;
use missing_physics::{ComparedQuantity, Coordinate, Fitted, ModelFamily, Regime, Role, Term};
use rayon::prelude::*;

use super::{
    FrictionFamily, HoldChoice, ahead, apart, full_rate, generic, given, limits, plots, views,
};
use crate::axis::{Axis, Effort};
use crate::driven::columns_along;
use crate::effects::free::{self, RIVALS, Span};
use crate::effects::{Effect, Extent, Periodic, Repeats};
use crate::model::MASS;

impl ModelFamily for FrictionFamily {
    fn terms(&self) -> &[Term] {
        &self.terms
    }

    fn shown(&self) -> Option<&dyn ModelFamily> {
        Some(self.on_view.as_deref()?)
    }

    fn quantity(&self) -> ComparedQuantity {
        let (name, unit) = match (self.effort, self.axis) {
            (Effort::Volt, _) => ("voltage", "V"),
            (Effort::Ampere, _) => ("current", "A"),
            (Effort::Si, Axis::Linear) => ("force", "N"),
            (Effort::Si, Axis::Rotary) => ("torque", "Nm"),
        };
        ComparedQuantity { name: name.into(), unit: unit.into() }
    }

    fn time(&self) -> &[f64] {
        &self.time
    }

    fn target(&self) -> &[f64] {
        &self.target
    }

    fn doubt(&self) -> &[f64] {
        &self.doubt
    }

    fn predict(&self, fitted: &Fitted, out: &mut [f64]) {
        let possible = |place: usize| {
            let effect = self.effect(fitted.terms[place])?;
            Some(effect.is_possible(&self.values_in_full(fitted, place)?))
        };
        // A combination that is no plant predicts nothing; it then loses against every other.
        if (0..fitted.terms.len()).any(|place| possible(place) == Some(false)) {
            return out.fill(0.0);
        }
        let Ok(force) = self.required(fitted) else { return out.fill(0.0) };
        // Nor does a law that has no value somewhere.
        if !force.iter().all(|value| value.is_finite()) {
            return out.fill(0.0);
        }
        out.copy_from_slice(&self.prepared.compare(&force));
    }

    fn shapes(&self, term: usize) -> Vec<Vec<f64>> {
        let about = &self.terms[term];
        if about.parameters.iter().all(|p| p.role == Role::Amplitude) {
            return vec![Vec::new()];
        }
        if let Some(law) = self.periodic(term) {
            return limits::periods(&self.prepared, self.extent_of(law), (about, law));
        }
        let trials = self.effect(term).and_then(|effect| limits::trials(effect, about));
        trials.unwrap_or_else(|| missing_physics::family::shapes::grid(about))
    }

    fn columns(
        &self,
        model: &Fitted,
        prediction: &[f64],
        term: usize,
        shape: &[f64],
    ) -> Vec<Vec<f64>> {
        if self.periodic(term).is_some_and(|law| law.of == Repeats::Sensor) {
            return self.encoders(model, &[shape.to_vec()]).swap_remove(0);
        }
        let simple = model.terms.iter().skip(1).chain([&term]).all(|&term| self.is_simple(term));
        let about = &self.terms[term];
        let values = missing_physics::family::shapes::assemble(about, shape, &[]);
        let alone = self.bare(self.neutral()).with(term, &values);
        // Without contact and drive in play a term's columns do not depend on the rest.
        match self.model(&alone) {
            Ok(plant) if simple => {
                let split = self.driven(|motion| columns_along(&plant, motion));
                split
                    .addresses
                    .iter()
                    .zip(&split.columns)
                    .filter(|(address, _)| *address != MASS)
                    .map(|(_, column)| self.prepared.compare(column))
                    .collect()
            }
            _ => missing_physics::family::columns(self, model, prediction, term, shape),
        }
    }

    fn columns_of_shapes(
        &self,
        model: &Fitted,
        prediction: &[f64],
        term: usize,
        shapes: &[Vec<f64>],
    ) -> Vec<Vec<Vec<f64>>> {
        match self.periodic(term) {
            Some(Periodic { of: Repeats::Sensor, .. }) => self.encoders(model, shapes),
            Some(Periodic { of: Repeats::Gain, .. }) => self.gains(shapes),
            Some(Periodic { columns: Some(columns), .. }) => self.repeated(columns, shapes),
            _ => shapes
                .par_iter()
                .map(|shape| self.columns(model, prediction, term, shape))
                .collect(),
        }
    }

    fn ahead(&self) -> Option<Box<dyn Ahead + '_>> {
        if let Some(given) = &self.given {
            return Some(Box::new(given::View { family: self, given }));
        }
        let ahead = self.ahead.as_ref()?;
        Some(Box::new(ahead::View::new(self, ahead)))
    }

    fn other_reading(&self) -> Option<OtherReading<'_>> {
        let HoldChoice { nats, by_search, .. } = self.hold?;
        Some(OtherReading { family: self.other_hold.as_deref()?, nats, decided: !by_search })
    }

    fn without_noise(&self, more: usize) -> Option<&dyn ModelFamily> {
        Some(self.filtered(more)?)
    }

    fn without_lateness(&self, model: &Fitted) -> Fitted {
        self.in_time(model)
    }

    fn reading(&self) -> Vec<Remark> {
        let input = self.quantity().name;
        let smoothed = self.smoothing.map(|below| Remark::Smoothed { input: input.clone(), below });
        let read = if self.given.is_some() {
            Some(Remark::Given { input, most_shift: given::MOST_SHIFT })
        } else {
            self.hold.map(|hold| hold.remark(input))
        };
        let even = self.jitter.map(|jitter| Remark::EvenSamples { jitter });
        let together = self.ahead.as_ref().and_then(|ahead| {
            let apart = ahead.predictor.interval();
            let every = (apart / self.prepared.interval).round() as usize;
            let input = self.quantity().name;
            (every > 1).then_some(Remark::TakenTogether { input, every, apart })
        });
        let (looked_at, pieces) = (self.recording.len(), self.recording.segments().len());
        let taken_from = self.recording.taken_from();
        let in_pieces = taken_from.map(|samples| Remark::InPieces { samples, looked_at, pieces });
        read.into_iter().chain(smoothed).chain(even).chain(together).chain(in_pieces).collect()
    }

    fn in_part(&self) -> Option<&dyn ModelFamily> {
        Some(self.part.as_deref()?)
    }

    fn ahead_in_part(&self) -> Option<Box<dyn Ahead + '_>> {
        let ahead = self.thinned.as_ref()?;
        Some(Box::new(ahead::View::new(self, ahead)))
    }

    fn ahead_in_longer_part(&self) -> Option<Box<dyn Ahead + '_>> {
        let longer = || self.ahead.as_ref().and_then(ahead::OneAhead::less_thinned);
        let ahead = self.less_thinned.get_or_init(longer).as_ref()?;
        Some(Box::new(ahead::View::new(self, ahead)))
    }

    fn form_of(&self, term: usize) -> Option<usize> {
        let stem = self.terms[term].name.split_once(':')?.0;
        self.terms.iter().position(|main| main.name == stem)
    }

    fn needs(&self, term: usize, parameter: &str) -> bool {
        self.effect(term).is_none_or(|effect| !effect.whatever().contains(&parameter))
    }

    fn may_be_none(&self, term: usize, parameter: &str) -> bool {
        !self.needs(term, parameter)
    }

    fn limits(&self, model: &Fitted, term: usize, parameter: usize) -> (f64, f64) {
        let parameter = &self.terms[term].parameters[parameter];
        let most = || {
            let effect = self.effect(term)?;
            if effect.is_course_of_time() && !self.has_level(model) {
                // Where nothing is left in the end a course without end is the level itself.
                return (parameter.role == Role::Shape).then(|| self.duration());
            }
            let place = model.terms.iter().position(|t| *t == term)?;
            let values = self.values_in_full(model, place)?;
            effect.most(&parameter.name, &values, self.mass_of(model))
        };
        (parameter.lower, parameter.upper.min(most().unwrap_or(f64::INFINITY)))
    }

    fn law_of(&self, term: usize) -> Option<usize> {
        let of = self.effect(term)?.law_of()?;
        self.terms.iter().position(|term| term.name == of)
    }

    fn is_usual(&self, term: usize) -> bool {
        self.effect(term).is_some_and(Effect::is_usual)
    }

    fn joins(&self, model: &Fitted, term: usize) -> bool {
        let Some(effect) = term.checked_sub(1).map(|index| self.effects[index]) else {
            return false;
        };
        let name = effect.about().name;
        if self.given.is_some() && !effect.shows_beside_given_force() {
            return false;
        }
        if !effect.is_determined() || RIVALS.iter().any(|free| free.effect.about().name == name) {
            return false;
        }
        self.model(model).and_then(|plant| plant.with_effect(effect)).is_ok()
    }

    fn coordinates(&self) -> &[Coordinate] {
        &self.coordinates
    }

    fn regimes(&self) -> &[Regime] {
        &self.regimes
    }

    fn motion(&self) -> Vec<Vec<f64>> {
        self.motion.clone()
    }

    fn blocks(&self) -> Vec<Range<usize>> {
        self.blocks.clone()
    }

    fn views(&self, fitted: &Fitted, split: &Split) -> Vec<NamedError> {
        if self.given.is_some() {
            // Nothing can be simulated with a force that is given over time.
            return Vec::new();
        }
        let model = self.model(fitted).ok();
        let view = |model| views::views(&model, &self.recording, &self.time, split);
        model.and_then(view).into_iter().collect()
    }

    fn full_rate(&self, fitted: &Fitted) -> Option<FullRate> {
        Some(full_rate::full_rate(self, &self.required(fitted).ok()?))
    }

    fn colour(&self) -> Vec<f64> {
        self.prepared.colour()
    }

    fn noise(&self) -> BTreeMap<String, f64> {
        let unit = if self.axis == Axis::Rotary { "angle_rad" } else { "position_m" };
        BTreeMap::from([(unit.to_owned(), self.prepared.position_noise)])
    }

    fn course(&self, term: usize, values: &[f64]) -> Course {
        let about = &self.terms[term];
        let unit = about.parameters.first().map_or("", |parameter| &parameter.unit);
        let moment = |extent| self.extent(extent).unwrap_or_default();
        let (begin, end) = (moment(Extent::RecordingBegin), moment(Extent::RecordingEnd));
        let time = Span { begin, end, unit: "s" };
        let length = if self.axis == Axis::Rotary { "rad" } else { "m" };
        let stroke = Span { begin: self.stroke.0, end: self.stroke.1, unit: length };
        let course = free::course(&about.name, values, (time, stroke), unit);
        course.unwrap_or_else(|| Course::Values { values: sizes(about, values) })
    }

    fn experiment(&self, terms: &[String]) -> Option<String> {
        Some(apart::experiment(&self.effects, terms))
    }

    fn generic_term(&self, coordinate: &Coordinate, shape: &Generic) -> Option<String> {
        let unit = self.effort.unit(self.axis, crate::axis::Quantity::Force);
        generic::effect(coordinate, shape, unit)
    }

    fn plots(&self, base: &Fitted, last: &Fitted) -> Vec<Plot> {
        plots::plots(self, base, last)
    }
}
