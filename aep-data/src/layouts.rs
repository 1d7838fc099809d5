//! Published data sets whose variables have names of their own.
//!
//! | layout | recognised by | read as |
//! |---|---|---|
//! | EMPS (Janot, Gautier, Brunot 2019) | `t, qm, qg, vir, gtau` | time `t` s, position `qm` m, reference `qg` m, force `vir*gtau` N |

use crate::mapping::{Mapping, Source};

/// A data set that is known by the names in it.
#[derive(Debug)]
pub struct Layout {
    /// Name of the data set.
    pub name: &'static str,
    /// Names that must all be there.
    pub names: &'static [&'static str],
    /// Time, force and position.
    columns: [&'static str; 3],
    reference: &'static str,
}

/// Every known data set.
pub const LAYOUTS: &[Layout] = &[Layout {
    name: "EMPS",
    names: &["t", "qm", "qg", "vir", "gtau"],
    columns: ["t", "vir*gtau", "qm"],
    reference: "qg",
}];

impl Layout {
    /// The layout that `names` belong to.
    pub fn of(names: &[String]) -> Option<&'static Self> {
        let has = |wanted: &str| names.iter().any(|name| name == wanted);
        LAYOUTS.iter().find(|layout| layout.names.iter().all(|name| has(name)))
    }

    /// Its mapping.
    pub fn mapping(&self) -> Mapping {
        let [time, force, position] = self.columns.map(Source::column);
        let reference = Source::column(self.reference);
        Mapping { time, force, position, reference, ..Mapping::default() }
    }
}
