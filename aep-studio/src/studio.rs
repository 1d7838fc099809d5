//! The studio's page: the report's plots and styles, live. Whoever serves it answers its requests; here is nothing of a
//! network.

use missing_physics::measurement::check::DataCheck;
use missing_physics::report::{Rung, Samples, Whiteness};
use serde_json::Value;

use crate::front::{self, samples};
use crate::html::escape;
use crate::report::{self, residual};
use crate::source::Source;
use crate::words;

const PAGE: &str = include_str!("front/studio/page.html");
/// In the order in which they need each other.
const SCRIPTS: [&str; 10] = [
    include_str!("front/studio/server.js"),
    include_str!("front/studio/parts.js"),
    include_str!("front/studio/load.js"),
    include_str!("front/studio/pictures.js"),
    include_str!("front/studio/models.js"),
    include_str!("front/studio/candidates.js"),
    include_str!("front/studio/law.js"),
    include_str!("front/studio/control.js"),
    include_str!("front/studio/more.js"),
    include_str!("front/studio/studio.js"),
];

/// The page. It sends `token` with whatever changes something.
pub fn page(token: &str) -> String {
    PAGE.replace("{token}", &escape(token)).replace("{version}", env!("CARGO_PKG_VERSION"))
}

/// Its scripts, for `/studio.js`.
pub fn script() -> String {
    let own = front::PLOTS.concat() + &SCRIPTS.concat();
    format!("{}\n\"use strict\";(() => {{\n{own}}})();\n", front::LIBRARY)
}

/// Its styles, for `/studio.css`.
pub fn style() -> String {
    format!("{}{}{}", report::STYLE, front::STYLE, include_str!("front/studio/studio.css"))
}

/// The recording with the models of a ladder, each with its name, as the scripts unpack it.
pub fn course(ladder: &[(String, &Rung)], samples: &Samples) -> Value {
    samples::packed(ladder, &[], samples)
}

/// What a model errs, in words.
pub fn said(rung: &Rung) -> String {
    samples::said(rung)
}

/// What was seen in the data, as HTML: nothing of a file is markup in it.
pub fn data(check: &DataCheck, source: &Source) -> String {
    report::data::section(check, source)
}

/// Whether what a model leaves resembles itself some time later, as HTML: a sentence, and the autocorrelation with its band
/// beside that of the base model. `name` is what is compared.
pub fn whiteness(name: &str, base: Option<&Whiteness>, last: &Whiteness) -> String {
    let figure = residual::autocorrelation(base, last).unwrap_or_default();
    let said = format!("Of the {name} along the measured motion: {}", words::whiteness(last));
    format!("{figure}<p class=lead>{}</p>", escape(&said))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_page_has_its_token_and_no_script_of_its_own() {
        let page = page("a\"b");
        assert!(
            page.contains("a&quot;b") && !page.contains("{token}") && !page.contains("{version}")
        );
        assert_eq!(page.matches("<script").count(), page.matches("<script src=").count());
    }
}
