//! What was seen in the data before any model.

use missing_physics::measurement::check::{ChannelCheck, DataCheck, Severity};
use missing_physics::measurement::quantity::{percent, quantity};

use crate::html::{self, concat, escape, table};
use crate::source::Source;
use crate::words;

/// The section of the data.
pub(crate) fn section(check: &DataCheck, source: &Source) -> String {
    let lead = format!(
        "{} samples in {} over {}, one every {}.",
        check.samples,
        if check.segments == 1 {
            "one piece".to_owned()
        } else {
            format!("{} pieces", check.segments)
        },
        quantity(check.sampling.duration_s, "s"),
        quantity(check.sampling.interval_s, "s"),
    );
    let rows: Vec<Vec<String>> =
        check.channels.iter().map(|channel| row(channel, source)).collect();
    let channels = table(
        &["Channel", "Read from", "#Smallest", "#Largest", "#rms", "#One count", "Held at"],
        &rows,
    );
    html::section("data", "The data", &escape(&lead), &(findings(check) + &channels))
}

fn findings(check: &DataCheck) -> String {
    let items = concat(check.findings.iter().map(|finding| {
        let class = match finding.severity() {
            Severity::Info => "info",
            Severity::Warning => "warning",
            Severity::Serious => "serious",
        };
        format!("<li class={class}>{}</li>", escape(&words::finding(finding)))
    }));
    if items.is_empty() { items } else { format!("<ul class=findings>{items}</ul>") }
}

fn row(channel: &ChannelCheck, source: &Source) -> Vec<String> {
    let column = source.columns.iter().find(|column| column[0] == channel.name);
    let value = |value: f64| escape(&quantity(value, &channel.unit));
    let limits = channel.saturation.iter();
    let limits = limits.map(|limit| format!("{} ({})", value(limit.level), percent(limit.share)));
    vec![
        escape(&channel.name),
        column.map(|column| format!("<code>{}</code>", escape(&column[1]))).unwrap_or_default(),
        value(channel.min),
        value(channel.max),
        value(channel.rms),
        channel.quantum.map(value).unwrap_or_default(),
        limits.collect::<Vec<String>>().join(", "),
    ]
}
