//! What the name of a column says: which quantity, in which unit.

use crate::role::{ColumnRole, Facts};
use crate::unit::{self, Dimension, Unit};

/// The name of a column, taken apart.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Header<'a> {
    /// The name without its unit, lower case, blanks as underscores.
    pub base: String,
    /// The unit, where it is known.
    pub unit: Option<&'static Unit>,
    /// The unit as written in brackets, known or not.
    pub bracketed: Option<&'a str>,
}

impl<'a> Header<'a> {
    /// Takes apart `force_N`, `Force [N]`, `force (N)`, `force`.
    pub fn parse(name: &'a str) -> Self {
        if let Some((base, text)) = brackets(name) {
            let base = plain(base);
            return Self { unit: unit_of(&base, text), base, bracketed: Some(text) };
        }
        // The leftmost underscore first: `speed_m_s` is in m/s, not in s.
        let endings = name.match_indices('_').map(|(at, _)| name.split_at(at));
        let known = endings.filter(|(base, _)| !base.is_empty()).find_map(|(base, rest)| {
            let base = plain(base);
            unit_of(&base, &rest[1..]).map(|unit| (base, unit))
        });
        match known {
            Some((base, unit)) => Self { base, unit: Some(unit), bracketed: None },
            None => Self { base: plain(name), unit: None, bracketed: None },
        }
    }

    fn suits(&self, role: ColumnRole) -> bool {
        self.unit.is_none_or(|unit| role.accepts(unit.quantity))
    }
}

/// The unit written `text` behind a name. Many programs write all names in lower case: what is called a force is not in
/// nanometres, `force_n` is in N and `torque_nm` in Nm.
fn unit_of(base: &str, text: &str) -> Option<&'static Unit> {
    if !ColumnRole::Force.facts().aliases.contains(&base) {
        return unit::find(text);
    }
    let known = unit::find(text).filter(|unit| unit.quantity != Dimension::Length);
    known.or_else(|| unit::find_lower(text))
}

/// The column among `names` that holds `role`, by the names it is known under.
pub(crate) fn recognise(role: ColumnRole, names: &[String]) -> Option<&String> {
    let headers: Vec<Header> = names.iter().map(|name| Header::parse(name)).collect();
    role.facts().aliases.iter().find_map(|alias| {
        let index =
            headers.iter().position(|header| header.base == *alias && header.suits(role))?;
        names.get(index)
    })
}

/// A column that is called like `role` but ends in something that is no unit: `force_foo`.
pub(crate) fn unit_unknown(role: ColumnRole, names: &[String]) -> Option<(&str, &str)> {
    names.iter().find_map(|name| ending(role.facts(), name).map(|unit| (name.as_str(), unit)))
}

fn ending<'a>(facts: &Facts, name: &'a str) -> Option<&'a str> {
    let (base, ending) = name.split_once('_')?;
    let long_name = facts.aliases.iter().any(|a| a.len() >= 4 && base.eq_ignore_ascii_case(a));
    let like_a_unit = (1..=4).contains(&ending.len()) && !ending.contains('_');
    (long_name && like_a_unit && Header::parse(name).unit.is_none()).then_some(ending)
}

fn brackets(name: &str) -> Option<(&str, &str)> {
    let name = name.trim();
    let (open, close) = if name.ends_with(']') { ('[', ']') } else { ('(', ')') };
    let (base, text) = name.strip_suffix(close)?.split_once(open)?;
    let text = text.trim();
    // A number is an index, no unit: `position[0]`.
    let is_index = !text.is_empty() && text.bytes().all(|byte| byte.is_ascii_digit());
    (!base.trim().is_empty() && !is_index).then_some((base, text))
}

fn plain(base: &str) -> String {
    base.trim().to_lowercase().replace([' ', '-', '.'], "_")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn names(list: &[&str]) -> Vec<String> {
        list.iter().map(|name| (*name).to_owned()).collect()
    }

    #[test]
    fn units_are_read_from_endings_and_brackets() {
        for (name, base, unit) in [
            ("force_N", "force", "N"),
            ("Motor Force [mN]", "motor_force", "mN"),
            ("speed_m_s", "speed", "m/s"),
            ("q_ref_m", "q_ref", "m"),
            ("angle (deg)", "angle", "deg"),
            ("x [\u{b5}m]", "x", "um"),
            ("force_n", "force", "N"),
            ("torque_nm", "torque", "Nm"),
            ("motor torque [mnm]", "motor_torque", "mNm"),
            ("position_nm", "position", "nm"),
        ] {
            let header = Header::parse(name);
            assert_eq!((header.base.as_str(), header.unit.map(|u| u.name)), (base, Some(unit)));
        }
        for without in ["position", "force_KN", "x_n"] {
            assert_eq!(Header::parse(without).unit, None, "{without}");
        }
    }

    #[test]
    fn the_best_name_wins_and_a_wrong_unit_disqualifies() {
        let columns = names(&["t_s", "x_ref_m", "x_mm", "position_V", "tau_Nm"]);
        assert_eq!(recognise(ColumnRole::Position, &columns).unwrap(), "x_mm");
        assert_eq!(recognise(ColumnRole::Reference, &columns).unwrap(), "x_ref_m");
        assert_eq!(recognise(ColumnRole::Force, &columns).unwrap(), "tau_Nm");
        assert_eq!(recognise(ColumnRole::Velocity, &columns), None);
    }

    #[test]
    fn an_unknown_unit_is_noticed() {
        assert_eq!(
            unit_unknown(ColumnRole::Force, &names(&["t", "force_foo"])),
            Some(("force_foo", "foo"))
        );
        assert_eq!(unit_unknown(ColumnRole::Force, &names(&["t", "x_foo"])), None);
    }
}
