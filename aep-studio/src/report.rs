//! A discovery as one page.

use std::fmt::Write;

use missing_physics::measurement::check::DataCheck;
use missing_physics::report::Combinations;
use missing_physics::{Discovery, Thresholds};

use crate::html::{escape, section};
use crate::plot;

mod axes;
mod compared;
mod confirmation;
mod data;
mod doubts;
mod ladder;
mod missing_force;
mod parameters;
mod ranking;
mod residual;
mod verdict;
mod views;
mod where_it_fails;

pub use axes::{AxisPage, axes};

/// Where the recording came from and what was asked of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Source {
    /// Name of the file.
    pub name: String,
    /// How each quantity was read: quantity, column in the file, unit.
    pub columns: Vec<[String; 3]>,
    /// The command that makes this page again.
    pub command: String,
    /// What an effect had to gain.
    pub thresholds: Thresholds,
    /// What parameters of the last model make together.
    pub together: Combinations,
}

const STYLE: &str = include_str!("report/style.css");

/// The page of a discovery: one file, nothing loaded from elsewhere, no scripts.
pub fn html(discovery: &Discovery, source: &Source, check: &DataCheck) -> String {
    let sections = sections(discovery, source, check);
    page(&format!("What the model lacks: {}", source.name), &sections, discovery, source)
}

/// What is told of a discovery.
fn sections(discovery: &Discovery, source: &Source, check: &DataCheck) -> [String; 12] {
    [
        verdict::head(discovery, source),
        ladder::section(discovery),
        confirmation::section(discovery),
        confirmation::surrogates(discovery),
        where_it_fails::section(discovery),
        residual::section(discovery),
        curves(discovery),
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
        views::section(discovery),
        where_it_fails::section(discovery),
        residual::section(discovery),
        curves(discovery),
        ladder::section(discovery),
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
         <title>{}</title>\n<style>\n{STYLE}</style></head>\n<body><main>\n{}{foot}</main></body></html>\n",
        escape(title),
        sections.concat(),
    )
}

fn curves(discovery: &Discovery) -> String {
    // The maps have been drawn with their bands.
    let drawn = residual::titles(discovery);
    let plots = discovery.plots.iter().filter(|plot| !drawn.contains(&plot.title));
    let figures: String = plots.filter_map(plot::figure).collect();
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
