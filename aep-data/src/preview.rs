//! What is in a file before anybody has said how to read it: its columns, their first values, and what they seem to be.

use std::path::Path;

use crate::error::DataError;
use crate::header::{Header, recognise};
use crate::layouts::Layout;
use crate::mapping::Mapping;
use crate::role::{self, ColumnRole};

/// First values of a column that are shown.
const SHOWN: usize = 5;
/// Most columns that are shown: a file may have thousands.
const MOST: usize = 500;

/// What is in a file.
#[derive(Clone, Debug, PartialEq)]
pub struct Preview {
    /// The columns with numbers, in the file's order.
    pub columns: Vec<PreviewColumn>,
    /// Columns beyond those shown.
    pub more: usize,
    /// For each role the column or formula that is taken for it where nobody says another one.
    pub guesses: Vec<(ColumnRole, String)>,
    /// The published data set whose names were recognised.
    pub layout: Option<&'static str>,
}

/// A column of a file.
#[derive(Clone, Debug, PartialEq)]
pub struct PreviewColumn {
    /// Its name.
    pub name: String,
    /// The unit that the name says.
    pub unit: Option<&'static str>,
    /// Its first values, in the unit of the file; not finite where there is no number.
    pub first: Vec<f64>,
    /// How many values it has; a single one holds for all rows.
    pub len: usize,
}

/// Looks into `path`. Of `mapping` only what opens the file counts (the topic of an MCAP file).
///
/// # Errors
/// Like [`load`](crate::load): the file cannot be read or is none that is known.
pub fn preview(path: &Path, mapping: &Mapping) -> Result<Preview, DataError> {
    let (table, _) = crate::open(path, mapping)?;
    let names = table.names();
    let layout = Layout::of(&names);
    let known = layout.map(Layout::mapping).unwrap_or_default();
    let guesses = role::ALL.iter().filter_map(|facts| {
        let column = known.source(facts.role).column.clone();
        Some((facts.role, column.or_else(|| recognise(facts.role, &names).cloned())?))
    });
    let guesses = guesses.collect();
    let columns = names.iter().take(MOST).map(|name| {
        let values = table.column(name)?.values;
        Ok(PreviewColumn {
            name: name.clone(),
            unit: Header::parse(name).unit.map(|unit| unit.name),
            first: values.iter().take(SHOWN).copied().collect(),
            len: values.len(),
        })
    });
    let columns = columns.collect::<Result<_, DataError>>()?;
    let layout = layout.map(|known| known.name);
    Ok(Preview { columns, more: names.len().saturating_sub(MOST), guesses, layout })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn previewed(name: &str, text: &str) -> Preview {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join(name);
        std::fs::write(&path, text).unwrap();
        preview(&path, &Mapping::default()).unwrap()
    }

    #[test]
    fn columns_come_with_units_and_what_they_seem_to_be() {
        let seen = previewed("run.csv", "t_ms,u_V,enc_mm,x_um\n0,1,2,3\n1,1,,4\n");
        let column = |name: &str| seen.columns.iter().find(|column| column.name == name).unwrap();
        assert_eq!((column("t_ms").unit, column("enc_mm").len), (Some("ms"), 2));
        assert!(column("enc_mm").first[1].is_nan());
        let guess = |role| seen.guesses.iter().find(|(r, _)| *r == role).map(|(_, c)| c.as_str());
        assert_eq!(guess(ColumnRole::Time), Some("t_ms"));
        assert_eq!(guess(ColumnRole::Position), Some("x_um"));
        assert_eq!(guess(ColumnRole::Force), None);
    }

    #[test]
    fn a_known_data_set_is_read_as_it_is() {
        let seen = previewed("a.csv", "t,qm,qg,vir,gtau\n0,1,1,2,35\n1,1,1,2,35\n");
        assert_eq!(seen.layout, Some("EMPS"));
        assert!(seen.guesses.contains(&(ColumnRole::Force, "vir*gtau".to_owned())));
    }
}
