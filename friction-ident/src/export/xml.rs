//! XML, as far as exports need it.

/// Text within quotes or between tags.
pub(super) fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

/// A comment of several lines; `--` may not stand in one.
pub(super) fn comment(lines: &[String]) -> String {
    let lines: Vec<String> =
        lines.iter().map(|line| format!("  {}\n", line.replace("--", "- -"))).collect();
    format!("<!--\n{}-->\n", lines.concat())
}
