//! Words of a command as a shell takes them.

/// A word as it has to be typed: quoted where a shell would read more into it.
pub fn quoted(word: &str) -> String {
    let plain = |c: char| c.is_alphanumeric() || "-_./:,+=@%".contains(c);
    if !word.is_empty() && word.chars().all(plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

/// ` --flag VALUE`, or nothing.
pub fn flag(name: &str, value: Option<impl ToString>) -> String {
    value.map_or_else(String::new, |value| format!(" --{name} {}", quoted(&value.to_string())))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_a_shell_would_change_is_quoted() {
        assert_eq!(quoted("run_1.csv"), "run_1.csv");
        assert_eq!(quoted("force_N - 9.81*m"), "'force_N - 9.81*m'");
        assert_eq!(quoted("it's"), r"'it'\''s'");
        assert_eq!(quoted(""), "''");
        assert_eq!(quoted("$HOME/a"), "'$HOME/a'");
        assert_eq!(
            flag("force", Some("duty*v")) + &flag("hold", None::<String>),
            " --force 'duty*v'"
        );
    }
}
