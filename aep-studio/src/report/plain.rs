//! A page of tables and plots of any subject: what a command has to show that is no discovery.

use missing_physics::report::{Curve, Plot};
use serde::{Deserialize, Serialize};

use super::{foot_of, page_of};
use crate::html::{concat, escape, section, table};
pub use crate::plot::Band;
use crate::plot::figure_with_bands;

/// A plot with the bands of its curves.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Figure {
    /// The plot.
    pub plot: Plot,
    /// Areas behind curves of the same label.
    pub bands: Vec<Band>,
}

/// A card of the page.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Part {
    /// Its id on the page.
    pub id: String,
    /// Heading.
    pub title: String,
    /// What is to be known of it, a paragraph each.
    pub notes: Vec<String>,
    /// Headings of a table; those that begin with `#` are of numbers. None for no table.
    pub headings: Vec<String>,
    /// Its rows.
    pub rows: Vec<Vec<String>>,
    /// Plots below it.
    pub figures: Vec<Figure>,
}

/// A card as HTML. Nothing of a text is markup.
pub fn part(part: &Part) -> String {
    let notes = part.notes.iter().map(|note| format!("<p class=lead>{}</p>", escape(note)));
    let headings: Vec<&str> = part.headings.iter().map(String::as_str).collect();
    let rows: Vec<Vec<String>> =
        part.rows.iter().map(|row| row.iter().map(|cell| escape(cell)).collect()).collect();
    let cells = if headings.is_empty() { String::new() } else { table(&headings, &rows) };
    let drawn =
        part.figures.iter().filter_map(|one| figure_with_bands(&thinned(&one.plot), &one.bands));
    let drawn = concat(drawn);
    let figures =
        if drawn.is_empty() { drawn } else { format!("<div class=figures>{drawn}</div>") };
    section(&escape(&part.id), &part.title, "", &(concat(notes) + &cells + &figures))
}

/// Most points of a curve; of more, each stretch keeps its ends and extremes.
const MOST: usize = 20_000;

fn thinned(plot: &Plot) -> Plot {
    let thin = |curve: &Curve| {
        let count = curve.x.len().min(curve.y.len());
        if count <= MOST {
            return curve.clone();
        }
        let size = (4 * count).div_ceil(MOST);
        let mut kept = Vec::with_capacity(MOST);
        for start in (0..count).step_by(size) {
            let stretch = start..(start + size).min(count);
            let by_value = |a: &usize, b: &usize| curve.y[*a].total_cmp(&curve.y[*b]);
            let extremes = [stretch.clone().min_by(by_value), stretch.clone().max_by(by_value)];
            let mut here: Vec<usize> = [stretch.start, stretch.end - 1]
                .into_iter()
                .chain(extremes.into_iter().flatten())
                .collect();
            here.sort_unstable();
            here.dedup();
            kept.extend(here);
        }
        let at = |values: &[f64]| kept.iter().map(|k| values[*k]).collect();
        Curve { label: curve.label.clone(), x: at(&curve.x), y: at(&curve.y) }
    };
    Plot { curves: plot.curves.iter().map(thin).collect(), ..plot.clone() }
}

/// The page: one file, nothing loaded from elsewhere. `command` makes it again.
pub fn page(title: &str, summary: &str, parts: &[Part], command: &str) -> String {
    let head = format!(
        "<header><h1>{}</h1><p class=summary>{}</p></header>\n",
        escape(title),
        escape(summary)
    );
    let cards: Vec<String> = std::iter::once(head).chain(parts.iter().map(part)).collect();
    page_of(title, &cards, &foot_of("", command))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_in_a_long_curve_is_kept() {
        let count = 3 * MOST + 7;
        let mut y = vec![0.0; count];
        y[12_345] = 5.0;
        let x = (0..count).map(|k| k as f64).collect();
        let curve = Curve { label: String::new(), x, y };
        let empty = String::new;
        let plot = Plot { title: empty(), x_label: empty(), y_label: empty(), curves: vec![curve] };
        let thin = &thinned(&plot).curves[0];
        assert!(thin.x.len() <= MOST && thin.y.contains(&5.0) && thin.x.contains(&12_345.0));
        assert_eq!(thin.x.last(), Some(&(count as f64 - 1.0)));
    }

    #[test]
    fn a_page_has_its_tables_and_plots_and_nothing_of_a_text_is_markup() {
        let evil = "<img src=x onerror=alert(1)>";
        let curve = Curve { label: evil.into(), x: vec![0.0, 1.0], y: vec![1.0, 2.0] };
        let plot = Plot {
            title: evil.into(),
            x_label: "time / s".into(),
            y_label: evil.into(),
            curves: vec![curve],
        };
        let part = Part {
            id: "a".into(),
            title: evil.into(),
            notes: vec![evil.into()],
            headings: vec!["name".into(), "#number".into()],
            rows: vec![vec![evil.into(), "3".into()]],
            figures: vec![Figure { plot, bands: Vec::new() }],
        };
        let page = page(evil, evil, &[part], evil);
        assert!(!page.contains("<img") && page.contains("&lt;img"));
        assert!(page.contains("<td class=num>3</td>") && page.contains("<polyline class"));
        assert!(page.contains("data-plot="), "it can be zoomed");
    }
}
