//! A discovery as one page.

use std::fmt::Write;

use missing_physics::Discovery;
use missing_physics::measurement::check::DataCheck;

use crate::front;
use crate::html::{escape, section};
use crate::source::Source;

mod axes;
mod compared;
mod confirmation;
pub(crate) mod data;
mod doubts;
mod effects;
mod ladder;
mod missing_force;
mod parameters;
pub mod plain;
mod ranking;
pub(crate) mod residual;
mod screen;
mod verdict;
mod views;
mod where_it_fails;

pub use axes::{AxisPage, axes};

pub(crate) const STYLE: &str = include_str!("report/style.css");
/// Nothing is loaded: what the page shows is inside it.
const POLICY: &str = "default-src 'none'; style-src 'unsafe-inline'; script-src 'unsafe-inline'; img-src data: blob:";

/// The page of a discovery: one file, nothing loaded from elsewhere.
pub fn html(discovery: &Discovery, source: &Source, check: &DataCheck) -> String {
    let sections = sections(discovery, source, check);
    page(&format!("What the model lacks: {}", source.name), &sections, discovery, source)
}

/// What is told of a discovery.
fn sections(discovery: &Discovery, source: &Source, check: &DataCheck) -> [String; 14] {
    [
        verdict::head(discovery, source),
        screen::section(discovery, source),
        ladder::section(discovery, source),
        confirmation::section(discovery),
        confirmation::surrogates(discovery),
        effects::section(discovery, source),
        where_it_fails::section(discovery),
        residual::section(discovery),
        curves(discovery, source),
        ranking::section(discovery, source),
        compared::section(discovery, source),
        parameters::section(discovery, source),
        doubts::section(discovery),
        data::section(check, source),
    ]
}

/// The page of a model on data, without a verdict.
pub fn comparison(discovery: &Discovery, source: &Source, check: &DataCheck) -> String {
    let sections = [
        verdict::plain_head(discovery, source),
        screen::section(discovery, source),
        views::section(discovery),
        where_it_fails::section(discovery),
        residual::section(discovery),
        curves(discovery, source),
        ladder::section(discovery, source),
        parameters::section(discovery, source),
        data::section(check, source),
    ];
    page(&format!("How well the model fits: {}", source.name), &sections, discovery, source)
}

fn page(title: &str, sections: &[String], discovery: &Discovery, source: &Source) -> String {
    let how = format!("Seed {}, {:.1} s, ", discovery.seed, discovery.wall_s);
    page_of(title, sections, &foot_of(&how, &source.command))
}

fn page_of(title: &str, sections: &[String], foot: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=en>\n<head><meta charset=utf-8>\
         <meta name=viewport content=\"width=device-width, initial-scale=1\">\
         <meta name=color-scheme content=\"light dark\">\n\
         <meta http-equiv=Content-Security-Policy content=\"{POLICY}\">\
         <title>{}</title>\n<style>\n{STYLE}{}</style></head>\n<body><main>\n{}{foot}</main>{}</body></html>\n",
        escape(title),
        front::STYLE,
        sections.concat(),
        front::scripts(),
    )
}

fn curves(discovery: &Discovery, source: &Source) -> String {
    // The maps have been drawn with their bands, and the first screen has what runs over time.
    let drawn = residual::titles(discovery);
    let above = if source.samples.time.is_empty() { 0 } else { screen::STILL };
    let plots = discovery.plots.iter().skip(above).filter(|plot| !drawn.contains(&plot.title));
    let figures: String = plots.filter_map(|plot| residual::curves(discovery, plot)).collect();
    if figures.is_empty() {
        return String::new();
    }
    section("curves", "Curves", "", &format!("<div class=figures>{figures}</div>"))
}

fn foot_of(how: &str, command: &str) -> String {
    let mut foot = format!("<footer>{how}aep {}.", env!("CARGO_PKG_VERSION"));
    if !command.is_empty() {
        // Writing to a string cannot fail.
        let _ = write!(foot, " Made by <code>{}</code>", escape(command));
    }
    foot + "</footer>"
}
