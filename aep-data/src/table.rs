//! A file as named columns of numbers, whatever its format.

use crate::error::{DataError, Problem};

/// The first value of a column that is no number by mistake: a text, where an empty field says that there is none.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Bad {
    /// Sample, from 0.
    pub sample: usize,
    /// What stands there.
    pub text: String,
}

/// A column or variable.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Column {
    /// Its name in the file.
    pub name: String,
    /// One value a sample, or a single one that holds for all; not finite where there is none.
    pub values: Vec<f64>,
    /// The first value that is no number by mistake, if there is one.
    pub bad: Option<Bad>,
}

/// A file that has been opened.
pub(crate) trait Table {
    /// Names of all columns with numbers, in the file's order.
    fn names(&self) -> Vec<String>;

    /// The column called `name`, which is one of [`names`](Table::names).
    fn column(&self, name: &str) -> Result<Column, DataError>;

    /// Line of a sample, where the file has lines.
    fn line(&self, sample: usize) -> Option<u64>;

    /// The error for a column that is not there.
    fn missing(&self, role: &str, column: Option<&str>) -> Problem;
}

/// The name among `names` that was probably meant by `wanted`.
pub(crate) fn nearest(wanted: &str, names: &[String]) -> Option<String> {
    let best = names.iter().max_by(|a, b| likeness(wanted, a).total_cmp(&likeness(wanted, b)))?;
    (likeness(wanted, best) > 0.8).then(|| best.clone())
}

/// How much a name, or a word in it, is like the wanted one: 0..1.
fn likeness(wanted: &str, name: &str) -> f64 {
    let (wanted, name) = (wanted.to_lowercase(), name.to_lowercase());
    let words = name.split(['_', ' ', '-', '.']).filter(|word| word.len() > 2);
    let similar = |word: &str| strsim::jaro_winkler(&wanted, word);
    words.map(similar).fold(similar(&name), f64::max)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_name_is_one_that_could_be_meant() {
        let names: Vec<String> =
            ["time_s", "forse_N", "duty", "q_rad"].iter().map(|n| (*n).to_owned()).collect();
        assert_eq!(nearest("force", &names).as_deref(), Some("forse_N"));
        assert_eq!(nearest("Time", &names).as_deref(), Some("time_s"));
        assert_eq!(nearest("position", &names), None);
    }
}
