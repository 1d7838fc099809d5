//! The first screen: the recording, what the models leave of it, where, and how it falls from model to model.

use missing_physics::Discovery;

use super::ladder;
use crate::front;
use crate::plot;
use crate::source::Source;

/// The section; nothing where the course of the recording is not known.
pub(super) fn section(discovery: &Discovery, source: &Source) -> String {
    let data = front::data(discovery, source);
    if data.is_empty() {
        return String::new();
    }
    // Without scripts the drawings of the engine stand here.
    let still: String = discovery.plots.iter().take(STILL).filter_map(plot::still).collect();
    format!(
        "<section id=\"screen\" class=screen aria-label=\"the models on the recording\">{data}\
         <div class=steer><div class=\"models live\" data-show=models></div>\
         <div class=\"choices live\" data-show=choices></div></div>\
         <div class=panes><div>\
         <div class=live data-show=fit></div><div class=live data-show=residual></div>\
         <div class=\"region live\" data-show=region aria-live=polite></div>\
         <div class=\"moments live\" data-show=moments></div>\
         <div class=\"figures fallback\">{still}</div></div>\
         <div><h3>Error from model to model</h3>{}\
         <div class=live data-show=profile></div><div class=live data-show=map></div></div></div></section>\n",
        ladder::bars(discovery),
    )
}

/// Plots of the engine over time, which the first screen draws anew.
pub(super) const STILL: usize = 2;
