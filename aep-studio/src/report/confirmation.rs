//! What other recordings say of the ladder.

use missing_physics::Discovery;

use crate::html::{self, escape, table};
use crate::words;

/// The section of the confirmation; nothing where no other recordings were given.
pub(super) fn section(discovery: &Discovery) -> String {
    let Some(confirmed) = &discovery.confirmation else {
        return String::new();
    };
    let headings: Vec<String> = words::confirmation_headings(discovery)
        .iter()
        .map(
            |heading| {
                if heading.numbers { format!("#{}", heading.text) } else { heading.text.clone() }
            },
        )
        .collect();
    let headings: Vec<&str> = headings.iter().map(String::as_str).collect();
    let rows: Vec<Vec<String>> = words::confirmation_rows(discovery, confirmed)
        .iter()
        .map(|row| row.iter().map(|cell| escape(cell)).collect())
        .collect();
    let said = escape(&words::confirmations(confirmed).join("\n")).replace('\n', "<br>");
    let lead = format!("{}: {}.", escape(&confirmed.recording), words::CONFIRMATION);
    html::section(
        "confirmation",
        "On other recordings",
        &lead,
        &format!("{}<p>{said}</p>", table(&headings, &rows)),
    )
}

/// The section of surrogates; nothing where none were asked for.
pub(super) fn surrogates(discovery: &Discovery) -> String {
    let Some(found) = &discovery.surrogates else {
        return String::new();
    };
    let said = escape(&words::surrogates(found).join("\n")).replace('\n', "<br>");
    html::section("surrogates", "On surrogates of this recording", "", &format!("<p>{said}</p>"))
}
