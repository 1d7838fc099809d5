//! The loop as a person does it, on the page.

use std::path::Path;
use std::time::Instant;

use serde_json::{Value, json};

use crate::attacks::{EVIL, rows};
use crate::chromium::Tab;
use crate::server::{Server, shared};

/// A test in a browser.
type Test = fn(&str);

pub const TESTS: &[(&str, Test)] = &[
    ("load_map_fit_add_watch_the_error_fall_undo_export", whole),
    ("a_page_outlives_its_server_and_offers_what_was_cut_off", restarted),
    ("a_recording_is_chosen_mapped_and_refused_in_words", mapped),
    ("a_law_is_drawn_while_it_is_typed_and_added", law),
    ("a_regime_is_looked_at_alone_and_the_compensator_simulated", simulated),
    ("no_name_of_a_column_becomes_a_script", evil),
    ("on_a_telephone_the_studio_does_not_stick_out", narrow),
];

/// Pictures in the folder `AEP_SCREENSHOTS`.
pub const PICTURES: (&str, Test) = ("pictures_of_the_studio", pictures);

const WIDE: (u32, u32) = (1280, 900);

fn opened(chromium: &str, server: &Server) -> Tab {
    let mut tab = Tab::new(chromium, WIDE);
    tab.visit(&server.url());
    tab.until("document.documentElement.dataset.ready === 'yes'");
    tab
}

/// Presses the first button with this text in a part of the page, once it is there.
#[track_caller]
fn press(tab: &mut Tab, part: &str, label: &str) {
    let find = format!(
        "[...document.querySelectorAll('[data-part={part}] button')].find((b) => b.textContent === {label:?} && !b.disabled)"
    );
    tab.until(&format!("Boolean({find})"));
    tab.eval(&format!("{find}.click()"));
}

fn text(tab: &mut Tab, selector: &str) -> String {
    let found = tab.eval(&format!("document.querySelector({selector:?})?.innerText ?? ''"));
    found.as_str().unwrap().to_owned()
}

/// Waits until the pictures of so many models are drawn.
fn drawn(tab: &mut Tab, models: usize) {
    tab.until(&format!(
        "document.querySelectorAll('.node[data-model]').length === {models} && document.querySelector('.pictures')?.dataset.ready === 'yes' \
         && document.querySelector('[data-part=status]').hidden"
    ));
}

/// The residual as it is drawn, as a number: another one where the picture is another one.
fn picture(tab: &mut Tab) -> Value {
    settle(tab);
    tab.eval(
        "(() => { const c = document.querySelector('[data-show=residual] canvas'); const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; \
         let h = 0; for (let k = 0; k < d.length; k += 4) h = (h * 31 + d[k] * 7 + d[k + 1]) | 0; return h; })()",
    )
}

fn settle(tab: &mut Tab) {
    tab.eval(
        "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))",
    );
}

fn is_clean(tab: &Tab) {
    assert!(tab.errors.is_empty(), "{:?}", tab.errors);
}

fn whole(chromium: &str) {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), None);
    let mut tab = opened(chromium, &server);
    press(&mut tab, "load", "Try it on the example");
    press(&mut tab, "load", "Fit the base model");
    drawn(&mut tab, 1);
    let base = picture(&mut tab);
    press(&mut tab, "candidates", "Try every effect");
    tab.until("Boolean(document.querySelector('.candidate.likely'))");
    assert!(text(&mut tab, ".candidate.likely").contains("stribeck"));
    // The bar of the model in progress is seen to fall, and then stands as a model.
    tab.eval(
        "(() => { window.seen = []; new MutationObserver(() => { const b = document.querySelector('.live-fit .held, .node[data-model=\"1\"] .held'); \
         if (b) window.seen.push(parseFloat(b.style.width)); }).observe(document.querySelector('[data-part=models]'), {childList: true, subtree: true}); })()",
    );
    let began = Instant::now();
    tab.eval("document.querySelector('.candidate.likely button').click()");
    tab.until("Boolean(document.querySelector('.node.chosen[data-model=\"1\"]'))");
    println!(
        "from the click on add to the new error on the page: {:.2} s",
        began.elapsed().as_secs_f64()
    );
    drawn(&mut tab, 2);
    let seen: Vec<f64> =
        tab.eval("window.seen").as_array().unwrap().iter().map(|v| v.as_f64().unwrap()).collect();
    assert!(seen.last() < seen.first(), "the error does not fall: {seen:?}");
    assert!(text(&mut tab, ".node.chosen .value").contains("1.05"));
    // The picture changes with it; what the effect takes away is seen to go.
    tab.until("document.querySelector('.models output b').textContent === '+ stribeck'");
    let with = picture(&mut tab);
    assert_ne!(base, with);
    // Back by a key; the model stays in the tree.
    tab.eval("document.activeElement.blur()");
    tab.key("u");
    tab.until("Boolean(document.querySelector('.node.chosen[data-model=\"0\"]'))");
    drawn(&mut tab, 2);
    // Two models on one picture.
    press(&mut tab, "models", "vs");
    tab.until("document.querySelector('[data-show=fit] .curves')?.innerText.includes('model 1: + stribeck')");
    press(&mut tab, "models", "vs");
    press(&mut tab, "files", "Report");
    tab.until(
        "document.querySelector('[data-part=files]').innerText.includes('exports/report-0.html')",
    );
    // A fixed parameter.
    press(&mut tab, "parameters", "Fix it");
    drawn(&mut tab, 3);
    tab.until("document.querySelector('[data-part=parameters]').innerText.includes('fixed')");
    // Another tab sees the same.
    let mut other = opened(chromium, &server);
    drawn(&mut other, 3);
    is_clean(&other);
    is_clean(&tab);
}

fn restarted(chromium: &str) {
    let folder = tempfile::tempdir().unwrap();
    let project = folder.path().join("p");
    let server = Server::start(&project, None);
    server.example();
    let mut tab = opened(chromium, &server);
    drawn(&mut tab, 1);
    press(&mut tab, "actions", "Find all of it");
    tab.until(
        "document.querySelector('[data-part=status] .doing')?.textContent.includes('candidates')",
    );
    let port = server.port;
    server.kill();
    tab.until(
        "document.querySelector('[data-part=status]').textContent.includes('does not answer')",
    );
    let _server = Server::start_at(port, &project, None);
    // The page finds it by itself and goes on.
    tab.until("document.querySelector('[data-part=status]').textContent.includes('Everything else is as it was')");
    assert!(tab.eval("document.querySelectorAll('.node').length") == json!(1));
    press(&mut tab, "status", "Do it again");
    drawn(&mut tab, 2);
    assert!(text(&mut tab, ".said").contains("Missing effect found"));
}

fn mapped(chromium: &str) {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), None);
    let mut tab = opened(chromium, &server);
    // Chosen in the page, with names that nobody knows.
    tab.eval(
        "(() => { const rows = Array.from({length: 4000}, (_, k) => [k * 0.001, Math.sign(Math.cos(k * 0.002)) * 8 + 100 * 0.05 * Math.cos(k * 0.002), 25 * Math.sin(k * 0.002)].join(',')); \
         const file = new File(['sec,motor,enc\\n' + rows.join('\\n')], 'odd.csv'); const box = new DataTransfer(); box.items.add(file); \
         const input = document.querySelector('#file'); input.files = box.files; input.dispatchEvent(new Event('change')); })()",
    );
    tab.until("document.querySelector('.checked .doubt')?.textContent.includes('time')");
    assert!(tab.eval("[...document.querySelectorAll('[data-part=load] button')].find((b) => b.textContent === 'Fit the base model').disabled") == json!(true));
    for (role, column) in [("time", "sec"), ("force", "motor"), ("position", "enc")] {
        tab.eval(&format!(
            "(() => {{ const i = document.querySelector('input[name={role}]'); i.value = '{column}'; i.dispatchEvent(new Event('input', {{bubbles: true}})); }})()"
        ));
    }
    tab.eval("(() => { const u = document.querySelector('select[aria-label=\"unit of position\"]'); u.value = 'mm'; u.dispatchEvent(new Event('input', {bubbles: true})); })()");
    tab.until("document.querySelector('.checked section')?.textContent.includes('25.0 mm')");
    assert!(text(&mut tab, ".checked").contains("4000 samples"));
    is_clean_but_refusals(&tab);
}

/// A refused request is told on the console, too.
fn is_clean_but_refusals(tab: &Tab) {
    let own: Vec<&String> =
        tab.errors.iter().filter(|error| !error.contains("400 (Bad Request)")).collect();
    assert!(own.is_empty(), "{own:?}");
}

fn law(chromium: &str) {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), None);
    server.example();
    let mut tab = opened(chromium, &server);
    drawn(&mut tab, 1);
    let type_in = |tab: &mut Tab, label: &str, value: &str| {
        tab.eval(&format!(
            "(() => {{ const i = document.querySelector('[data-part=law] [aria-label={label:?}]'); i.value = {value:?}; i.dispatchEvent(new Event('input', {{bubbles: true}})); }})()"
        ));
    };
    type_in(&mut tab, "law", "h*s/(1+(v/w)^2");
    tab.until("document.querySelector('[data-part=law] .warn').textContent.length > 5");
    type_in(&mut tab, "law", "h*s/(1+(v/w)^2)");
    type_in(&mut tab, "unit of h", "N");
    type_in(&mut tab, "unit of w", "m/s");
    for (label, value) in [
        ("default of h", "4"),
        ("low of h", "0"),
        ("default of w", "0.002"),
        ("low of w", "0.0001"),
        ("high of w", "0.1"),
    ] {
        type_in(&mut tab, label, value);
    }
    tab.until("Boolean(document.querySelector('[data-part=law] canvas')) && document.querySelector('[data-part=law] .warn').textContent === ''");
    press(&mut tab, "law", "Add it to the model");
    drawn(&mut tab, 2);
    assert_eq!(text(&mut tab, ".node.chosen .node-name"), "+ my-law");
    is_clean_but_refusals(&tab);
}

fn simulated(chromium: &str) {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), None);
    server.example();
    let mut tab = opened(chromium, &server);
    drawn(&mut tab, 1);
    tab.until("Boolean(document.querySelector('[data-show=remains] .canvas canvas'))");
    let before = picture(&mut tab);
    tab.eval("document.querySelector('.pictures .key button').click()");
    assert!(text(&mut tab, "[data-show=region]").contains("of the squared residual"));
    assert_ne!(picture(&mut tab), before);
    press(&mut tab, "control", "Simulate");
    tab.until("document.querySelector('[data-part=control]').innerText.includes('less RMS error')");
    tab.until("Boolean(document.querySelector('[data-part=control] figure'))");
    tab.eval("document.querySelector('[data-part=control] figure').scrollIntoView()");
    tab.until("Boolean(document.querySelector('[data-part=control] .canvas canvas'))");
    // A value that is not there fixes nothing at 0.
    tab.eval("document.querySelector('[data-part=parameters] input[type=number]').value = ''");
    press(&mut tab, "parameters", "Fix it");
    tab.until("document.querySelector('[data-part=notices]').innerText.includes('at which value')");
    // The e of a number is no parameter; the curve stands beside the model that is looked at.
    tab.eval(
        "(() => { const i = document.querySelector('[data-part=law] [aria-label=law]'); i.value = '2e-3*v'; i.dispatchEvent(new Event('input', {bubbles: true})); })()",
    );
    tab.until("Boolean(document.querySelector('[data-part=law] .canvas canvas'))");
    assert_eq!(tab.eval("document.querySelectorAll('[data-part=law] tbody tr').length"), json!(0));
    tab.eval("document.querySelector('[data-part=law] .canvas').dataset.old = 'yes'");
    server.task(&json!({"task": "add", "from": 0, "effect": "stribeck"}));
    tab.until("!document.querySelector('[data-part=law] .canvas')?.dataset.old");
    is_clean(&tab);
}

fn evil(chromium: &str) {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), None);
    let rows = rows(4000);
    let file = format!("time_s,\"{EVIL}\",position_m\n{rows}");
    server.post_bytes(
        "/api/upload?name=%3Cimg%20src=x%20onerror=window.hacked=1%3E.csv",
        file.as_bytes(),
    );
    let mut tab = opened(chromium, &server);
    tab.until("Boolean(document.querySelector('.mapping'))");
    assert!(
        tab.eval("document.querySelector('[data-part=load]').textContent")
            .as_str()
            .unwrap()
            .contains("<img src=x")
    );
    server.post("/api/take", &json!({"mapping": {"force": {"column": EVIL, "unit": "N"}}}));
    server.idle();
    tab.until("document.querySelector('[data-part=data]').textContent.includes('onerror')");
    let found = tab.eval("[window.hacked ?? null, document.querySelectorAll('img').length]");
    assert_eq!(found, json!([null, 0]));
}

fn narrow(chromium: &str) {
    let folder = tempfile::tempdir().unwrap();
    let server = Server::start(&folder.path().join("p"), None);
    let mut tab = opened(chromium, &server);
    tab.size(390, 844);
    let fits = |tab: &mut Tab| {
        settle(tab);
        let outside = tab.eval(
            "[...document.querySelectorAll('body *')].filter((e) => e.getBoundingClientRect().right > 391 && !e.closest('.scroll, [hidden]')) \
             .map((e) => `${e.tagName}.${e.className} ${e.textContent.slice(0, 40)}`).slice(0, 5)",
        );
        assert_eq!(
            (tab.eval("document.documentElement.scrollWidth"), outside),
            (json!(390), json!([]))
        );
    };
    fits(&mut tab);
    server.post("/api/example", &json!({}));
    tab.until("Boolean(document.querySelector('.checked section'))");
    tab.eval("document.querySelectorAll('details').forEach((d) => (d.open = true))");
    fits(&mut tab);
    server.post("/api/take", &json!({"mapping": {"hold": "zero-order"}}));
    server.idle();
    server.task(&json!({"task": "suggest", "from": 0}));
    server.task(&json!({"task": "add", "from": 0, "effect": "stribeck"}));
    server.task(&json!({"task": "export", "from": 1, "form": "c"}));
    drawn(&mut tab, 2);
    fits(&mut tab);
}

/// Pictures in light and dark, wide and narrow, where they are asked for.
fn pictures(chromium: &str) {
    let folder = std::env::var_os("AEP_SCREENSHOTS").unwrap();
    let folder = Path::new(&folder);
    let project = tempfile::tempdir().unwrap();
    let data = shared("emps/DATA_EMPS.mat");
    let both = [("example", None), ("emps", data.as_deref())];
    for (name, data) in both.into_iter().filter(|(name, data)| *name == "example" || data.is_some())
    {
        let server = Server::start(&project.path().join(name), data);
        let mut tab = opened(chromium, &server);
        keep(&mut tab, folder, &format!("{name}-0"));
        if data.is_none() {
            server.post("/api/example", &json!({}));
        }
        tab.until("Boolean(document.querySelector('.checked section'))");
        keep(&mut tab, folder, &format!("{name}-1-mapping"));
        let mapping = if data.is_none() { json!({"hold": "zero-order"}) } else { json!({}) };
        server.post("/api/take", &json!({"mapping": mapping}));
        server.idle();
        server.task(&json!({"task": "suggest", "from": 0}));
        drawn(&mut tab, 1);
        keep(&mut tab, folder, &format!("{name}-2-base"));
        let state = server.task(&json!({"task": "discover", "from": 0}));
        let last = state["chosen"].as_u64().unwrap();
        server.task(&json!({"task": "suggest", "from": last}));
        drawn(&mut tab, state["models"].as_array().unwrap().len());
        std::thread::sleep(std::time::Duration::from_secs(1));
        keep(&mut tab, folder, &format!("{name}-3-found"));
        is_clean(&tab);
    }
}

fn keep(tab: &mut Tab, folder: &Path, name: &str) {
    for scheme in ["light", "dark"] {
        tab.scheme(scheme);
        for (width, height) in [WIDE, (390, 844)] {
            tab.size(width, height);
            settle(tab);
            std::thread::sleep(std::time::Duration::from_millis(150));
            tab.screenshot(&folder.join(format!("{name}-{width}-{scheme}.png")));
            let tall = tab.eval("document.documentElement.scrollHeight").as_u64().unwrap() as u32;
            tab.size(width, tall.min(12_000));
            settle(tab);
            tab.screenshot(&folder.join(format!("{name}-{width}-{scheme}-whole.png")));
        }
    }
    tab.scheme("light");
    tab.size(WIDE.0, WIDE.1);
    settle(tab);
}
