//! Parameters that are known from a drawing or a data sheet.

use friction_ident::Known;

use super::shell::flag;
use crate::failure::Failure;

/// What is known of parameters.
#[derive(clap::Args, Clone, Debug, Default)]
#[command(next_help_heading = "What is known already")]
pub struct KnownArgs {
    /// A parameter that is not fitted, SI: `mass=95.1`, `viscous.F_v=120`. May be given several times
    #[arg(long, value_name = "PARAMETER=VALUE", value_parser = fixed)]
    fix: Vec<(String, f64)>,
    /// Least and largest value of a parameter, SI: `viscous.F_v=0..300`. May be given several times
    #[arg(long, value_name = "PARAMETER=LOW..HIGH", value_parser = bounds)]
    bound: Vec<(String, (f64, f64))>,
}

impl KnownArgs {
    /// The flags that were given, as they stand in a command.
    pub fn words(&self) -> String {
        let fixed =
            self.fix.iter().map(|(name, value)| flag("fix", Some(format!("{name}={value}"))));
        let bounds = self
            .bound
            .iter()
            .map(|(name, (low, high))| flag("bound", Some(format!("{name}={low}..{high}"))));
        fixed.chain(bounds).collect()
    }

    /// What the flags say.
    pub fn known(&self) -> Result<Known, Failure> {
        let known = Known {
            fixed: self.fix.iter().cloned().collect(),
            bounds: self.bound.iter().cloned().collect(),
        };
        let both = known.fixed.keys().find(|address| known.bounds.contains_key(*address));
        match both {
            None => Ok(known),
            Some(address) => {
                let what = format!("'{address}' is both fixed and bounded");
                Err(Failure::bad_input(what).with_hint("keep one of --fix and --bound"))
            }
        }
    }
}

fn address(text: &str, form: &str) -> Result<(String, String), String> {
    let parts = text.split_once('=').map(|(name, value)| (name.trim(), value.trim()));
    let parts = parts.filter(|(name, value)| !name.is_empty() && !value.is_empty());
    let (name, value) = parts.ok_or_else(|| format!("write {form}"))?;
    Ok((name.to_owned(), value.to_owned()))
}

fn number(text: &str) -> Result<f64, String> {
    let number: f64 = text.parse().map_err(|_| format!("'{text}' is no number"))?;
    if number.is_finite() { Ok(number) } else { Err(format!("{text} is not finite")) }
}

fn fixed(text: &str) -> Result<(String, f64), String> {
    let (name, value) = address(text, "PARAMETER=VALUE, e.g. mass=95.1")?;
    Ok((name, number(&value)?))
}

fn bounds(text: &str) -> Result<(String, (f64, f64)), String> {
    let form = "PARAMETER=LOW..HIGH, e.g. viscous.F_v=0..300";
    let (name, range) = address(text, form)?;
    let (low, high) = range.split_once("..").ok_or_else(|| format!("write {form}"))?;
    let (low, high) = (number(low.trim())?, number(high.trim())?);
    if low < high { Ok((name, (low, high))) } else { Err(format!("{low} is not below {high}")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_and_ranges_are_read() {
        assert_eq!(fixed("mass=95.1"), Ok(("mass".to_owned(), 95.1)));
        assert_eq!(bounds("viscous.F_v = 0 .. 300"), Ok(("viscous.F_v".to_owned(), (0.0, 300.0))));
        assert_eq!(bounds("offset.F_0=-3..-1"), Ok(("offset.F_0".to_owned(), (-3.0, -1.0))));
        for text in ["mass", "mass=", "=3", "mass=x", "mass=inf"] {
            assert!(fixed(text).is_err(), "{text}");
        }
        for text in ["mass=3", "mass=3..", "mass=3..2", "mass=1..nan"] {
            assert!(bounds(text).is_err(), "{text}");
        }
    }
}
