//! The axes of one file on one page: a table, then each axis with all its sections.

use missing_physics::Discovery;
use missing_physics::measurement::check::DataCheck;

use super::{foot_of, page_of, sections};
use crate::html::{escape, table};
use crate::source::Source;
use crate::words::{AXES_HEADINGS, AxisResult, axis_row};

/// An axis of the page.
#[derive(Clone, Copy, Debug)]
pub struct AxisPage<'a> {
    /// Its name.
    pub name: &'a str,
    /// What became of it.
    pub result: AxisResult<'a>,
    /// How it was read, and what was seen in its data.
    pub source: &'a Source,
    /// What was seen in its data.
    pub check: &'a DataCheck,
}

/// The page of several axes; `command` makes it again.
pub fn axes(file: &str, axes: &[AxisPage<'_>], command: &str) -> String {
    let row = |axis: &AxisPage<'_>| {
        let mut cells = axis_row(axis.name, axis.result).map(|cell| escape(&cell)).to_vec();
        if matches!(axis.result, AxisResult::Found(_)) {
            cells[0] = format!("<a href=\"#{}\">{}</a>", place(axis.name), cells[0]);
        }
        cells
    };
    let rows: Vec<Vec<String>> = axes.iter().map(row).collect();
    let head = format!(
        "<header><p class=file>{}</p><h1>What each axis lacks</h1>{}</header>\n",
        escape(file),
        table(&AXES_HEADINGS, &rows),
    );
    let each = axes.iter().filter_map(|axis| match axis.result {
        AxisResult::Found(discovery) => Some(article(axis, discovery)),
        _ => None,
    });
    let body: Vec<String> = std::iter::once(head).chain(each).collect();
    page_of(&format!("What each axis lacks: {file}"), &body, &foot_of("", command))
}

fn article(axis: &AxisPage<'_>, discovery: &Discovery) -> String {
    let place = place(axis.name);
    // Every axis has the same sections and effects, but an id stands on a page once. Texts of users are escaped: in them
    // there is no such quotation mark.
    let sections = sections(discovery, axis.source, axis.check)
        .concat()
        .replace(" id=\"", &format!(" id=\"{place}-"))
        .replace(" href=\"#", &format!(" href=\"#{place}-"));
    format!("<article id=\"{place}\">{sections}</article>\n")
}

/// The id of an axis.
fn place(name: &str) -> String {
    let safe = |c: char| if c.is_ascii_alphanumeric() { c } else { '-' };
    format!("axis-{}", name.chars().map(safe).collect::<String>())
}
