//! Whether a fitted effect is that effect, and whether the data tell so.

use aep_core::Scale;

use super::node::Node;
use super::{Ahead, intervals, scales};
use crate::family::{ModelFamily, Role, TermParameter};
use crate::report::{Estimate, Refusal};

/// Share of an amplitude of every model below which nothing of it is left.
const GONE: f64 = 0.001;

/// The effect of a model that is not one as it was fitted, and why, if any: an amplitude ended at the limit of its
/// search, what makes it that effect is gone (a gap of no width), or it left nothing of what every model has (a mass).
pub fn refused(
    family: &dyn ModelFamily,
    ahead: &dyn Ahead,
    base: &Node,
    node: &Node,
) -> Option<(usize, Refusal)> {
    let moved = scales::of(family, &node.model);
    for (place, index) in node.model.terms.iter().enumerate() {
        let term = &family.terms()[*index];
        for (k, parameter) in node.model.range(family, place).zip(&term.parameters) {
            if parameter.role != Role::Amplitude {
                continue;
            }
            let key = || term.key(parameter);
            // What ended at the limit of its search says nothing of what there was.
            let known = || !scales::of(family, &base.model)[k].is_at_far_limit();
            let gone = |before: f64| node.model.values[k].abs() < GONE * before.abs() && known();
            match base.model.values.get(k) {
                Some(before) if term.always && parameter.lower >= 0.0 && gone(*before) => {
                    let last = *node.model.terms.last()?;
                    return Some((last, Refusal::NothingLeft { parameter: key() }));
                }
                None if moved[k].is_at_far_limit() => {
                    return Some((*index, Refusal::AtLimit { parameter: key() }));
                }
                _ => {}
            }
        }
    }
    ahead.vanishes(&node.model, &base.model)
}

/// The effect of a model that is not told, and why, if any: it is none as it was fitted, stands for how the recording is
/// read, or the data do not tell what makes it one.
pub fn not_told(
    family: &dyn ModelFamily,
    ahead: &dyn Ahead,
    base: &Node,
    node: &Node,
) -> Option<(usize, Refusal)> {
    refused(family, ahead, base, node)
        .or_else(|| as_read(family, ahead, base, node))
        .or_else(|| unknown(family, ahead, base, node))
}

/// The effect of a model that may do no more than another way to read the recording would, if any: the data leave how late it
/// makes the input open down to the low ends of its parameters' intervals.
pub fn as_read(
    family: &dyn ModelFamily,
    ahead: &dyn Ahead,
    base: &Node,
    node: &Node,
) -> Option<(usize, Refusal)> {
    let intervals = intervals::of((family, ahead), node);
    let mut model = node.model.clone();
    let parameters: Vec<_> = node.model.parameters(family).collect();
    for (value, (term, parameter)) in model.values.iter_mut().zip(parameters) {
        let is = &intervals[&term.key(parameter)];
        if is.identifiable {
            *value = is.low;
        }
    }
    ahead.of_reading(&model, &base.model)
}

/// The effect of a model of which the data do not tell what makes it that effect, if any: a length, a speed or a time that
/// may be anything, or lie beyond where it was looked for, is a limit of its law, which then is another one; and what may be
/// 0 in all of its amplitudes may not be there.
pub fn unknown(
    family: &dyn ModelFamily,
    ahead: &dyn Ahead,
    base: &Node,
    node: &Node,
) -> Option<(usize, Refusal)> {
    let added = node.added_to(base);
    if added.is_empty() {
        return None;
    }
    let intervals = intervals::of((family, ahead), node);
    added.into_iter().find_map(|index| {
        let term = &family.terms()[index];
        let lost = term.parameters.iter().enumerate().find(|(k, parameter)| {
            let is = &intervals[&term.key(parameter)];
            let needed = parameter.scale == Scale::Log && family.needs(index, &parameter.name);
            let (lower, upper) = family.limits(&node.model, index, *k);
            let beyond = is.low <= lower || is.high >= upper;
            // Where it makes no sense it is another law, however little its value matters.
            let senseless = upper < parameter.upper && is.high >= upper;
            let lost = needed && (beyond || !is.identifiable) || senseless;
            parameter.role != Role::Amplitude && lost
        });
        let lost = lost.map(|(_, parameter)| parameter);
        let unknown = |parameter: &TermParameter, is: &Estimate| {
            let (low, high, unit) = (is.low, is.high, is.unit.clone());
            (index, Refusal::Unknown { parameter: term.key(parameter), low, high, unit })
        };
        if let Some(parameter) = lost {
            return Some(unknown(parameter, &intervals[&term.key(parameter)]));
        }
        // A shape that hardly matters lets an amplitude be anything, and so does another amplitude: they are asked at these
        // shapes and proportions; whether there is any of the effect of all of them, whether more of it than was looked for
        // would do as well of those of each unit.
        let place = node.model.terms.iter().position(|term| *term == index)?;
        let size_of = |those: &[usize]| intervals::of_size((family, ahead), node, place, those);
        let mut amplitudes = amplitudes(&term.parameters);
        amplitudes.retain(|k| !family.may_be_none(index, &term.parameters[*k].name));
        let (largest, is) = size_of(&amplitudes)?;
        if is.low <= 0.0 && is.high >= 0.0 {
            return Some(unknown(&term.parameters[largest], &is));
        }
        let unit = |k: &usize| &term.parameters[*k].unit;
        let sizes = amplitudes.chunk_by(|a, b| unit(a) == unit(b)).filter_map(size_of);
        sizes.into_iter().find_map(|(k, is)| {
            // One that may be 0 is not determined by itself: an offset makes up for it.
            let known = is.low > 0.0 || is.high < 0.0;
            let (lower, upper) = family.limits(&node.model, index, k);
            let beyond = known && (is.low <= lower || is.high >= upper);
            beyond.then(|| (index, Refusal::AtLimit { parameter: term.key(&term.parameters[k]) }))
        })
    })
}

/// The places of the amplitudes among the parameters of an effect, those of one unit together.
fn amplitudes(parameters: &[TermParameter]) -> Vec<usize> {
    let is_one = |k: &usize| parameters[*k].role == Role::Amplitude;
    let mut amplitudes: Vec<usize> = (0..parameters.len()).filter(is_one).collect();
    amplitudes.sort_by_key(|k| &parameters[*k].unit);
    amplitudes
}
