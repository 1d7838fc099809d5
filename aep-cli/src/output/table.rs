//! Tables: a heading, a line, rows; numbers to the right.

use aep_studio::report::plain::Part;
use comfy_table::{
    Attribute, Cell, CellAlignment, Color, ColumnConstraint, ContentArrangement, LineStyle,
    TableStyle,
};

use super::heading;

/// Characters of a line.
pub const LINE: u16 = 100;

/// Where the cells of a column stand.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Align {
    /// Words.
    Left,
    /// Numbers.
    Right,
    /// Bars, which are words in colour.
    Bar,
}

/// A table in the making.
pub struct Table {
    table: comfy_table::Table,
    columns: Vec<Align>,
}

/// A line under the headings and nothing else.
const STYLE: TableStyle =
    TableStyle::new().header_separator(LineStyle::none().fill('─').junction('─'));
/// Width of a table where there is no terminal to ask.
const WIDTH: u16 = 110;

impl Table {
    /// A table with these headings.
    pub fn new(headings: &[(&str, Align)]) -> Self {
        let mut table = comfy_table::Table::new();
        table.load_style(STYLE);
        table.set_content_arrangement(ContentArrangement::Dynamic);
        table.enforce_styling();
        if !table.is_tty() {
            table.set_width(WIDTH);
        }
        let columns: Vec<Align> = headings.iter().map(|(_, align)| *align).collect();
        table.set_header(headings.iter().map(|(text, align)| {
            Cell::new(text).set_alignment(alignment(*align)).add_attribute(Attribute::Dim)
        }));
        Self { table, columns }
    }

    /// The table of a card of a page, below its heading.
    pub fn of(part: &Part) -> String {
        let align = |name: &str| if name.starts_with('#') { Align::Right } else { Align::Left };
        let headings: Vec<(&str, Align)> =
            part.headings.iter().map(|name| (name.trim_start_matches('#'), align(name))).collect();
        let mut table = Self::new(&headings);
        for row in &part.rows {
            table.row(row.iter().cloned());
        }
        heading(&part.title) + &table.text()
    }

    /// The table no wider than this where there is no terminal to ask, the margin included.
    pub fn at_most(mut self, width: u16) -> Self {
        if !self.table.is_tty() {
            self.table.set_width(width.saturating_sub(1).min(WIDTH));
        }
        self
    }

    /// One row more.
    pub fn row(&mut self, cells: impl IntoIterator<Item = String>) {
        let cells = cells.into_iter().zip(&self.columns).map(|(text, align)| {
            let cell = Cell::new(text).set_alignment(alignment(*align));
            if *align == Align::Bar { cell.fg(Color::Blue) } else { cell }
        });
        self.table.add_row(cells.collect::<Vec<Cell>>());
    }

    /// Whether no cell has to wrap.
    pub fn fits(&self) -> bool {
        // A blank on either side of a cell, and one before it.
        let widths = self.table.column_max_content_widths();
        widths.iter().map(|width| width + 3).sum::<u16>() <= self.table.width().unwrap_or(WIDTH)
    }

    /// The table as text, one line at the end.
    pub fn text(mut self) -> String {
        // Names stay on one line; what wraps are the words to their right.
        if let Some(names) = self.table.column_mut(0) {
            names.set_constraint(ColumnConstraint::ContentWidth);
        }
        let text = self.table.to_string();
        let lines: Vec<String> =
            text.lines().map(|line| format!(" {}\n", line.trim_end())).collect();
        lines.concat()
    }
}

fn alignment(align: Align) -> CellAlignment {
    match align {
        Align::Right => CellAlignment::Right,
        Align::Left | Align::Bar => CellAlignment::Left,
    }
}
