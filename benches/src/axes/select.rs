//! Which cases and seeds are asked for.

/// First seed that is kept for judging: whoever develops looks at the ones below only.
pub const LOCKED: u64 = 1001;

/// Whether `text` fits `pattern`, in which `*` stands for anything.
pub fn fits(pattern: &str, text: &str) -> bool {
    match pattern.split_once('*') {
        None => pattern == text,
        Some((head, rest)) => text.strip_prefix(head).is_some_and(|tail| {
            (0..=tail.len()).any(|k| tail.is_char_boundary(k) && fits(rest, &tail[k..]))
        }),
    }
}

/// Seeds from `FROM..TO`, both included, or a single one.
///
/// # Errors
/// In words.
pub fn seeds(text: &str) -> Result<(u64, u64), String> {
    let (from, to) = text.split_once("..").unwrap_or((text, text));
    let number = |part: &str| {
        part.trim_start_matches('=').parse::<u64>().map_err(|error| format!("'{part}': {error}"))
    };
    let (from, to) = (number(from)?, number(to)?);
    if from > to { Err(format!("{from} is larger than {to}")) } else { Ok((from, to)) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_star_stands_for_anything() {
        assert!(fits("table/stri*", "table/stribeck"));
        assert!(fits("*", ""));
        assert!(fits("*beck*", "table/stribeck-tanh"));
        assert!(!fits("table", "table/stribeck"));
    }

    #[test]
    fn seeds_are_a_range_or_one() {
        assert_eq!(seeds("3..7"), Ok((3, 7)));
        assert_eq!(seeds("12"), Ok((12, 12)));
        assert!(seeds("7..3").is_err() && seeds("a").is_err());
    }
}
