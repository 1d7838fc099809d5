//! Requests of the page with anything in them: each gets an answer that is not "failed inside", and the server lives on.
//!
//! ```sh
//! AEP_REQUESTS=20000 cargo test --release -p aep-cli --test studio mutated -- --nocapture
//! ```

use std::collections::BTreeMap;

use aep_core::random::{Purpose, Stream, Streams, index};
use serde_json::{Value, json};

use crate::server::Server;

/// A test without a browser.
type Test = fn();

pub const TESTS: &[(&str, Test)] =
    &[("mutated_requests_are_answered_and_end_no_server", mutated_requests)];

/// Requests that are sent; many by `AEP_REQUESTS`.
fn count() -> usize {
    std::env::var("AEP_REQUESTS").map_or(400, |text| text.parse().unwrap())
}

/// What the page sends: path and body. Nothing of it computes for long.
fn seeds() -> Vec<(&'static str, Value)> {
    let parameters = json!({"a": {"unit": "N s/m", "low": 0.0, "high": 10.0, "default": 1.0}});
    let law = json!({"law": {"name": "own", "force": "a*v", "parameters": parameters}, "from": 0});
    let mapping = json!({
        "hold": "zero-order",
        "time": {"column": "time_s"},
        "force": {"column": "force_N", "unit": "N", "gain": 1.0},
        "position": "position_m",
        "regressors": {"load": "cos(position_m)"},
    });
    vec![
        ("GET /api/state", Value::Null),
        ("GET /api/effects", Value::Null),
        ("GET /api/preview", Value::Null),
        ("GET /api/data", Value::Null),
        ("GET /api/course?of=0", Value::Null),
        ("GET /api/course?of=0&with=0", Value::Null),
        ("GET /api/remains?of=0&with=0", Value::Null),
        ("GET /api/control", Value::Null),
        ("GET /api/file?path=data/run.csv", Value::Null),
        ("POST /api/check", json!({"mapping": mapping})),
        ("POST /api/take", json!({"mapping": mapping, "effects": ["coulomb", "viscous"]})),
        ("POST /api/choose", json!({"model": 0})),
        ("POST /api/law", law.clone()),
        ("POST /api/effect", law),
        ("POST /api/guess", json!({"effect": "stribeck"})),
        ("POST /api/riddle", json!({"size": "clear"})),
        ("POST /api/cancel", json!({})),
        ("POST /api/discard", json!({})),
        ("POST /api/task", json!({"task": "base", "effects": ["coulomb"]})),
        ("POST /api/task", json!({"task": "add", "from": 0, "effect": "stribeck"})),
        ("POST /api/task", json!({"task": "remove", "from": 0, "effect": "coulomb"})),
        (
            "POST /api/task",
            json!({"task": "fix", "from": 0, "parameter": "coulomb.F_C", "value": 5.0}),
        ),
        ("POST /api/task", json!({"task": "export", "from": 0, "form": "mjcf"})),
        (
            "POST /api/task",
            json!({"task": "control", "from": 0, "plant": 0, "reference": "sine:5mm,2Hz"}),
        ),
        ("POST /api/upload?name=run.csv", Value::Null),
    ]
}

/// What stands where something else was expected.
fn anything(random: &mut Stream) -> Value {
    let values = [
        json!(null),
        json!(true),
        json!(0),
        json!(-1),
        json!(u64::MAX),
        json!(4_294_967_296_u64),
        json!(1e308),
        json!(-1e308),
        json!(5e-324),
        json!(1e-300),
        json!(""),
        json!("\u{0}"),
        json!("../../etc/passwd"),
        json!("<script>"),
        json!("1/0"),
        json!("coulomb.F_C"),
        json!("a".repeat(5_000)),
        json!("(".repeat(500)),
        json!([]),
        json!({}),
        json!([[[[1]]]]),
        json!("stribeck"),
    ];
    values[index(random, values.len())].clone()
}

/// Something in `value` changed.
fn change(value: &mut Value, random: &mut Stream) {
    let deeper = index(random, 4) > 0;
    match value {
        Value::Object(fields) if deeper && !fields.is_empty() => {
            let name = fields.keys().nth(index(random, fields.len())).cloned().unwrap_or_default();
            match index(random, 5) {
                0 => drop(fields.remove(&name)),
                1 => drop(fields.insert("more".to_owned(), anything(random))),
                _ => change(&mut fields[&name], random),
            }
        }
        Value::Array(values) if deeper && !values.is_empty() => {
            let k = index(random, values.len());
            change(&mut values[k], random);
        }
        other => *other = anything(random),
    }
}

/// A path with other numbers and bytes behind the question mark.
fn changed_path(path: &str, random: &mut Stream) -> String {
    let parts =
        ["%00", "-1", "99999999999999999999", "NaN", "1e308", "=", "&", "%ff", "of=0", ".."];
    let mut bytes = path.to_owned();
    let from = path.find(['=', '?']).unwrap_or(path.len());
    for _ in 0..=index(random, 3) {
        let at = from + index(random, bytes.len() - from + 1);
        bytes.insert_str(at, parts[index(random, parts.len())]);
    }
    bytes
}

fn mutated_requests() {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), None);
    server.example();
    let seeds = seeds();
    let mut outcomes: BTreeMap<String, usize> = BTreeMap::new();
    for k in 0..count() {
        let random = &mut Streams::new(5, Purpose::Trial, 0).stream(k);
        let (request, body) = seeds[index(random, seeds.len())].clone();
        let (method, path) = request.split_once(' ').unwrap();
        let (mut path, mut body) = (path.to_owned(), body);
        for _ in 0..index(random, 3) {
            change(&mut body, random);
        }
        let mut bytes = if body.is_null() { Vec::new() } else { body.to_string().into_bytes() };
        match index(random, 4) {
            0 => path = changed_path(&path, random),
            1 if !bytes.is_empty() => {
                let at = index(random, bytes.len());
                bytes[at] = index(random, 256) as u8;
            }
            _ => {}
        }
        let answer =
            if method == "GET" { server.get(&path) } else { server.post_bytes(&path, &bytes) };
        let said = format!("{method} {path} {}", String::from_utf8_lossy(&bytes));
        assert!(answer.status > 0, "no answer: {said}");
        assert!(!answer.text().contains("failed inside"), "{said}: {}", answer.text());
        *outcomes.entry(format!("{request} {}", answer.status)).or_default() += 1;
        let state = server.state();
        let failed = state["failed"]["what"].as_str().unwrap_or_default();
        assert!(!failed.contains("failed inside"), "{said}: {failed}");
        if !state["job"].is_null() && index(random, 3) > 0 {
            // Some tasks are left to their end, the others are not waited for.
            server.post_bytes("/api/cancel", b"{}");
        }
    }
    server.post_bytes("/api/cancel", b"{}");
    assert!(server.idle()["models"].is_array());
    println!("{} requests, {} different outcomes", count(), outcomes.len());
    assert!(outcomes.len() > 30, "{outcomes:#?}");
}
