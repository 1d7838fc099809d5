//! Text into HTML, so that nothing a file contains can become markup.

/// `text` with everything escaped that means something in HTML or in a quoted attribute.
pub fn escape(text: &str) -> String {
    let mut safe = String::with_capacity(text.len() + 8);
    for character in text.chars() {
        match character {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            // Control characters have no place on a page.
            c if c.is_control() && !c.is_whitespace() => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// One text from many.
pub(crate) fn concat(parts: impl Iterator<Item = String>) -> String {
    parts.collect()
}

/// A card of the page.
pub(crate) fn section(id: &str, title: &str, lead: &str, body: &str) -> String {
    let lead = if lead.is_empty() { String::new() } else { format!("<p class=lead>{lead}</p>") };
    format!("<section id=\"{id}\"><h2>{}</h2>{lead}{body}</section>\n", escape(title))
}

/// A table; cells are HTML, columns whose heading begins with `#` hold numbers.
pub(crate) fn table(headings: &[&str], rows: &[Vec<String>]) -> String {
    let class = |column: usize| {
        if headings[column].starts_with('#') { " class=num" } else { "" }
    };
    let cells = |tag: &str, cells: &mut dyn Iterator<Item = String>| -> String {
        concat(cells.enumerate().map(|(k, cell)| format!("<{tag}{}>{cell}</{tag}>", class(k))))
    };
    let head = cells("th", &mut headings.iter().map(|h| escape(h.trim_start_matches('#'))));
    let row = |row: &Vec<String>| format!("<tr>{}</tr>\n", cells("td", &mut row.iter().cloned()));
    let body = concat(rows.iter().map(row));
    format!(
        "<div class=scroll><table><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table></div>"
    )
}

/// A bar for a share of 0..1 with its number.
pub(crate) fn bar(share: f64, class: &str) -> String {
    let width = 100.0 * if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 };
    format!("<span class=\"bar {class}\"><span style=\"width:{width:.1}%\"></span></span>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_in_a_text_becomes_markup() {
        assert_eq!(
            escape("<script>\"a\" & 'b'</script>\0"),
            "&lt;script&gt;&quot;a&quot; &amp; &#39;b&#39;&lt;/script&gt;\u{fffd}"
        );
    }

    #[test]
    fn a_bar_stays_inside_its_box() {
        assert!(bar(7.0, "a").contains("width:100.0%"));
        assert!(bar(f64::NAN, "a").contains("width:0.0%"));
    }
}
