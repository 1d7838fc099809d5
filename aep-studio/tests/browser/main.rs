//! The page in a real browser. Where no Chromium is installed the tests are skipped and counted as ignored.
//!
//! `AEP_PAGE=report.html` looks at that page in the place of one made for the test; `AEP_SCREENSHOTS=folder` keeps pictures
//! of it. Times are printed, not asserted: they belong to the machine.

mod chromium;
mod page;

use std::path::{Path, PathBuf};

use chromium::Tab;
use libtest_mimic::{Arguments, Trial};
use serde_json::{Value, json};

/// A test of a page in a tab.
type Test = fn(&mut Tab, &Path);

/// A test that makes its page.
type OwnPage = fn(&mut Tab);

const WIDE: (u32, u32) = (1280, 900);

fn main() {
    let arguments = Arguments::from_args();
    let browser = chromium::installed();
    if browser.is_none() {
        println!("SKIPPED: no Chromium (apt-get install chromium, or AEP_CHROMIUM=/path/to/it)");
    }
    let tests: [(&str, Test); 10] = [
        ("the_page_opens_from_disk_without_an_error_and_draws", opens),
        ("the_slider_moves_every_picture", slides),
        ("a_drag_zooms_all_plots_over_time_and_a_key_shows_all_again", zooms),
        ("a_curve_is_switched_off_and_on", switches),
        ("what_is_shown_is_downloaded_as_csv_and_svg", downloads),
        ("without_scripts_the_drawings_stand", still),
        ("on_a_telephone_nothing_sticks_out", narrow),
        ("a_part_of_the_residual_is_looked_at_alone", alone),
        ("on_paper_all_is_unfolded_and_in_the_colours_of_paper", prints),
        ("times_of_drawing", times),
    ];
    let mut trials: Vec<Trial> = Vec::new();
    for (name, test) in tests {
        let browser = browser.clone();
        let skipped = browser.is_none();
        let run = move || {
            let folder = tempfile::tempdir().unwrap();
            let samples = if name == "times_of_drawing" { 100_000 } else { 20_000 };
            let page =
                page::given().unwrap_or_else(|| page::made(folder.path(), samples, "run.csv"));
            let mut tab = Tab::new(browser.as_deref().unwrap_or_default(), WIDE);
            test(&mut tab, &page);
            assert!(tab.errors.is_empty(), "{}: {:?}", page.display(), tab.errors);
            Ok(())
        };
        trials.push(Trial::test(name, run).with_ignored_flag(skipped));
    }
    let skipped = browser.is_none();
    let of_script = browser.clone();
    trials.push(
        Trial::test("no_text_of_a_file_becomes_a_script", move || {
            let folder = tempfile::tempdir().unwrap();
            let mut tab = Tab::new(of_script.as_deref().unwrap_or_default(), WIDE);
            tab.open(&page::made(folder.path(), 20_000, page::EVIL));
            reveal(&mut tab);
            assert_eq!(
                tab.eval("[window.hacked ?? null, document.querySelectorAll('img').length]"),
                json!([null, 0])
            );
            assert!(tab.errors.is_empty(), "{:?}", tab.errors);
            Ok(())
        })
        .with_ignored_flag(skipped),
    );
    let tests: [(&str, OwnPage); 2] =
        [("every_axis_of_a_page_has_its_pictures", axes), ("a_page_of_tables_and_plots", plain)];
    for (name, test) in tests {
        let browser = browser.clone();
        let run = move || {
            let mut tab = Tab::new(browser.as_deref().unwrap_or_default(), WIDE);
            test(&mut tab);
            assert!(tab.errors.is_empty(), "{:?}", tab.errors);
            Ok(())
        };
        trials.push(Trial::test(name, run).with_ignored_flag(skipped));
    }
    libtest_mimic::run(&arguments, trials).exit();
}

/// A canvas as a number: another one where the picture is another one.
const PICTURES: &str = "[...document.querySelectorAll('.screen canvas')].map((c) => { \
    const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data; let h = 0; \
    for (let k = 0; k < d.length; k += 4) h = (h * 31 + d[k] * 7 + d[k + 1] * 3 + d[k + 2]) | 0; return h; })";

fn pictures(tab: &mut Tab) -> Vec<Value> {
    settle(tab);
    tab.eval(PICTURES).as_array().unwrap().clone()
}

fn settle(tab: &mut Tab) {
    tab.eval(
        "new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(() => done(1))))",
    );
}

/// Scrolls through the page, so that every figure is drawn.
fn reveal(tab: &mut Tab) {
    tab.eval("document.querySelectorAll('details').forEach((d) => (d.open = true))");
    tab.eval(
        "(async () => { for (let y = 0; y < document.body.scrollHeight; y += 500) { scrollTo(0, y); \
         await new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done))); } scrollTo(0, 0); })()",
    );
    tab.until("[...document.querySelectorAll('figure[data-plot]')].every((f) => f.querySelector('canvas'))");
}

/// Middle of an element, and its width.
fn place(tab: &mut Tab, selector: &str) -> ((f64, f64), f64) {
    let found = tab.eval(&format!(
        "(() => {{ const r = document.querySelector({selector:?}).getBoundingClientRect(); \
         return [r.left + r.width / 2, r.top + r.height / 2, r.width]; }})()"
    ));
    let at = |k: usize| found[k].as_f64().unwrap();
    ((at(0), at(1)), at(2))
}

/// The text that an element shows.
fn text(tab: &mut Tab, selector: &str) -> String {
    tab.eval(&format!("document.querySelector({selector:?}).textContent"))
        .as_str()
        .unwrap()
        .to_owned()
}

fn opens(tab: &mut Tab, page: &Path) {
    tab.open(page);
    let drawn = pictures(tab);
    assert_eq!(drawn.len(), 4, "measured, residual, along a coordinate, map");
    // What the question is stands on the first screen.
    for show in ["fit", "residual", "profile", "map"] {
        let bottom = tab.eval(&format!(
            "document.querySelector('[data-show={show}] canvas').getBoundingClientRect().bottom"
        ));
        assert!(bottom.as_f64().unwrap() <= f64::from(WIDE.1), "{show} ends at {bottom}");
    }
    reveal(tab);
    if let Some(folder) = std::env::var_os("AEP_SCREENSHOTS") {
        keep(tab, page, &PathBuf::from(folder));
    }
}

/// Pictures in light and dark, wide and narrow.
fn keep(tab: &mut Tab, page: &Path, folder: &Path) {
    let name = page.file_stem().unwrap().to_string_lossy().into_owned();
    for scheme in ["light", "dark"] {
        tab.scheme(scheme);
        for (width, height) in [WIDE, (390, 844)] {
            tab.size(width, height);
            tab.open(page);
            tab.screenshot(&folder.join(format!("{name}-{width}-{scheme}.png")));
            reveal(tab);
            let tall = tab.eval("document.documentElement.scrollHeight").as_u64().unwrap() as u32;
            tab.size(width, tall.min(16_000));
            settle(tab);
            tab.screenshot(&folder.join(format!("{name}-{width}-{scheme}-whole.png")));
        }
    }
    tab.size(WIDE.0, WIDE.1);
    tab.scheme("light");
}

fn slides(tab: &mut Tab, page: &Path) {
    tab.open(page);
    let last = pictures(tab);
    let said = text(tab, ".models output");
    tab.eval("document.querySelector('.models input').focus()");
    tab.key("ArrowLeft");
    tab.eval("(() => { const i = document.querySelector('.models input'); i.value = 0; i.dispatchEvent(new Event('input')); })()");
    let base = pictures(tab);
    for (k, (last, base)) in last.iter().zip(&base).enumerate() {
        assert_ne!(last, base, "picture {k} stays");
    }
    assert!(
        text(tab, ".models output").starts_with("base model")
            && said != text(tab, ".models output")
    );
    // Arrow keys do the same wherever no plot has the focus.
    tab.eval("document.querySelector('.rung').focus()");
    tab.key("ArrowRight");
    assert_ne!(pictures(tab)[1], base[1]);
    // What it leaves is told with its size: without the effect it is larger.
    let rms = |tab: &mut Tab, k: usize| {
        tab.eval(&format!("document.querySelectorAll('.rung')[{k}].click()"));
        settle(tab);
        tab.eval("document.querySelector('.moments button').textContent")
            .as_str()
            .unwrap()
            .to_owned()
    };
    let (base, next) = (rms(tab, 0), rms(tab, 1));
    assert!(base.contains(" rms") && base != next, "{base}, {next}");
}

fn zooms(tab: &mut Tab, page: &Path) {
    tab.open(page);
    let ((x, y), width) = place(tab, "[data-show=residual] .u-over");
    let here = |tab: &mut Tab| {
        tab.mouse("mouseMoved", (x + 0.3 * width, y), json!({}));
        settle(tab);
        text(tab, "[data-show=residual] .at")
    };
    let whole = pictures(tab);
    let before = here(tab);
    assert!(before.contains(" s"), "no time under the cursor: '{before}'");
    // The cursor is in all plots over time.
    let time = |text: &str| text.split(" · ").next().map(str::to_owned);
    assert_eq!(time(&before), time(&text(tab, "[data-show=fit] .at")));
    tab.mouse("mouseMoved", (x - 0.2 * width, y), json!({}));
    tab.mouse("mousePressed", (x - 0.2 * width, y), json!({"buttons": 1}));
    tab.mouse("mouseMoved", (x, y), json!({"buttons": 1}));
    tab.mouse("mouseReleased", (x, y), json!({}));
    let near = here(tab);
    assert_ne!(before, near);
    let drawn = pictures(tab);
    assert!(drawn[0] != whole[0] && drawn[1] != whole[1]);
    // The wheel comes nearer after a click; a key shows all.
    tab.mouse("mouseWheel", (x, y), json!({"deltaX": 0, "deltaY": -120}));
    assert_ne!(here(tab), near);
    tab.key("0");
    assert_eq!(here(tab), before);
    tab.mouse("mouseMoved", (1.0, 1.0), json!({}));
    // A worst moment is one click away.
    tab.eval("document.querySelector('.moments button').click()");
    assert_ne!(here(tab), before);
}

fn switches(tab: &mut Tab, page: &Path) {
    tab.open(page);
    let before = pictures(tab);
    let click = "(() => { const b = document.querySelector('[data-show=fit] .curves button'); b.click(); return b.getAttribute('aria-pressed'); })()";
    assert_eq!(tab.eval(click), json!("false"));
    let without = pictures(tab);
    assert!(without[0] != before[0] && without[1] == before[1]);
    assert_eq!(tab.eval(click), json!("true"));
    assert_eq!(pictures(tab)[0], before[0]);
}

fn downloads(tab: &mut Tab, page: &Path) {
    tab.open(page);
    // What would be saved is caught on its way.
    tab.eval(
        "(() => { window.saved = []; URL.createObjectURL = (blob) => { window.saved.push(blob.text()); return '#'; }; \
         HTMLAnchorElement.prototype.click = () => {}; })()",
    );
    tab.eval("[...document.querySelectorAll('[data-show=residual] .tools button')].filter((b) => /CSV|SVG/.test(b.textContent)).forEach((b) => b.click())");
    let saved = tab.eval("Promise.all(window.saved)");
    let csv = saved[0].as_str().unwrap();
    let mut lines = csv.lines();
    let head = lines.next().unwrap();
    assert!(head.starts_with("time / s,base model / "), "{head}");
    let columns = head.split(',').count();
    assert!(csv.lines().count() > 1000 && lines.all(|line| line.split(',').count() == columns));
    let svg = saved[1].as_str().unwrap();
    assert!(svg.starts_with("<svg") && svg.contains("<polyline") && !svg.contains("NaN"));
}

fn still(tab: &mut Tab, page: &Path) {
    tab.scripts(false);
    tab.open(page);
    let seen =
        "(q) => [...document.querySelectorAll(q)].filter((e) => e.getClientRects().length).length";
    let count =
        |tab: &mut Tab, query: &str| tab.eval(&format!("({seen})('{query}')")).as_u64().unwrap();
    assert!(count(tab, "svg") > 0 && count(tab, ".screen .rung") > 0);
    assert_eq!((count(tab, ".live"), count(tab, "canvas")), (0, 0));
}

/// Words that are broken where nothing allows it, with the element that they stand in.
const BROKEN: &str = r"(() => { const found = []; const texts = document.createTreeWalker(document.body, NodeFilter.SHOW_TEXT);
    while (texts.nextNode()) { const { data, parentElement: e } = texts.currentNode;
      if (!e.getClientRects().length || e.closest('script, style, svg, .still, option, code')) continue;
      for (const word of data.matchAll(/[\p{L}\p{N}_]{2,}/gu)) { const range = document.createRange();
        range.setStart(texts.currentNode, word.index); range.setEnd(texts.currentNode, word.index + word[0].length);
        if (new Set([...range.getClientRects()].filter((r) => r.width).map((r) => Math.round(r.top))).size > 1) found.push(`${word[0]} in ${e.tagName}.${e.className}`); } }
    return found.slice(0, 5); })()";

fn narrow(tab: &mut Tab, page: &Path) {
    tab.size(390, 844);
    tab.open(page);
    reveal(tab);
    assert_eq!(tab.eval(BROKEN), json!([]));
    let outside = tab.eval(
        "[...document.querySelectorAll('body *')].filter((e) => e.getBoundingClientRect().right > 391 && !e.closest('.scroll')) \
         .map((e) => `${e.tagName}.${e.className} ${e.textContent.slice(0, 40)}`).slice(0, 5)",
    );
    assert_eq!(
        (tab.eval("document.documentElement.scrollWidth"), outside),
        (json!(390), json!([]))
    );
}

fn alone(tab: &mut Tab, page: &Path) {
    tab.open(page);
    tab.eval("document.querySelectorAll('.rung')[0].click()");
    let all = pictures(tab);
    let said = |tab: &mut Tab| text(tab, "[data-show=region]");
    let hidden = "document.querySelector('[data-show=region]').hidden";
    assert_eq!(tab.eval(hidden), json!(true));
    // A regime: its share is told before and after, and every picture of the residual is another one.
    let chip = "document.querySelector('.key button')";
    let share = tab.eval(&format!("{chip}.querySelector('small').textContent"));
    let name = tab.eval(&format!("{chip}.childNodes[1].textContent"));
    tab.eval(&format!("{chip}.click()"));
    let told = said(tab);
    let share = format!("{} of the squared residual", share.as_str().unwrap());
    assert!(told.starts_with(name.as_str().unwrap()) && told.contains(&share), "{told}");
    let regime = pictures(tab);
    assert!(regime[0] == all[0] && (1..4).all(|k| regime[k] != all[k]));
    tab.eval(&format!("{chip}.click()"));
    assert_eq!((tab.eval(hidden), pictures(tab)), (json!(true), all.clone()));
    // A click on the plot: the stretch of that regime, near; a double click shows all again.
    let ((x, y), width) = place(tab, "[data-show=residual] .u-over");
    let at = (x + 0.21 * width, y);
    let click = |tab: &mut Tab, count: u32| {
        for kind in ["mousePressed", "mouseReleased"] {
            tab.mouse(kind, at, json!({"clickCount": count}));
        }
    };
    tab.mouse("mouseMoved", at, json!({}));
    click(tab, 1);
    let stretch = said(tab);
    assert!(stretch.contains(" to ") && stretch.contains(" s "), "{stretch}");
    assert_ne!(pictures(tab)[0], all[0], "it is not shown nearer");
    click(tab, 2);
    tab.mouse("mouseMoved", (1.0, 1.0), json!({}));
    assert_eq!((tab.eval(hidden), pictures(tab)), (json!(true), all.clone()));
    // A worst moment, and cells of the map.
    tab.eval("document.querySelector('.moments button').click()");
    assert!(said(tab).contains("% of the squared residual"));
    tab.eval("[...document.querySelectorAll('[data-show=region] button')].at(-1).click()");
    let ((x, y), _) = place(tab, "[data-show=map] canvas");
    for (dx, dy) in [(0.0, 0.0), (-20.0, 10.0), (30.0, -12.0), (-60.0, 0.0)] {
        for kind in ["mouseMoved", "mousePressed", "mouseReleased"] {
            tab.mouse(kind, (x + dx, y + dy), json!({}));
        }
    }
    assert!(said(tab).starts_with("position ") && said(tab).contains("velocity "), "{}", said(tab));
}

fn prints(tab: &mut Tab, page: &Path) {
    tab.scheme("dark");
    tab.open(page);
    reveal(tab);
    tab.eval("document.querySelectorAll('details').forEach((d) => (d.open = false))");
    let folded = "document.querySelectorAll('details:not([open])').length";
    let card = "getComputedStyle(document.documentElement).getPropertyValue('--card').trim()";
    let (closed, dark) = (tab.eval(folded), pictures(tab));
    assert!(closed.as_u64().unwrap() > 0 && tab.eval(card) != json!("#ffffff"));
    tab.eval("dispatchEvent(new Event('beforeprint'))");
    assert_eq!((tab.eval(folded), tab.eval(card)), (json!(0), json!("#ffffff")));
    let paper = pictures(tab);
    tab.eval("dispatchEvent(new Event('afterprint'))");
    assert_eq!((tab.eval(folded), pictures(tab)), (closed.clone(), dark));
    tab.scheme("light");
    tab.eval("document.querySelector('.models input').dispatchEvent(new Event('input'))");
    assert_eq!(pictures(tab), paper);
    // Folded parts are on paper: with nothing in them there are fewer pages.
    let whole = tab.pages();
    assert_eq!(tab.eval(folded), closed);
    tab.eval("document.querySelectorAll('details').forEach((d) => d.remove())");
    assert!(tab.pages() < whole, "{whole}");
}

fn axes(tab: &mut Tab) {
    let folder = tempfile::tempdir().unwrap();
    tab.visit(&format!("file://{}", page::two_axes(folder.path()).display()));
    let ready =
        "[...document.querySelectorAll('section.screen')].map((s) => s.dataset.ready ?? '')";
    tab.until("document.querySelector('section.screen').dataset.ready === 'yes'");
    assert_eq!(tab.eval(ready), json!(["yes", ""]), "what is not seen is not drawn yet");
    let above = "document.querySelector('table').compareDocumentPosition(document.querySelector('section.screen')) & 4";
    assert_eq!(tab.eval(above), json!(4), "the table comes first");
    let twice = "(() => { const ids = [...document.querySelectorAll('[id]')].map((e) => e.id); \
                 const dead = [...document.querySelectorAll('a[href^=\"#\"]')].map((a) => a.hash.slice(1)).filter((id) => !ids.includes(id)); \
                 return [ids.filter((id, k) => ids.indexOf(id) !== k), dead]; })()";
    assert_eq!(tab.eval(twice), json!([[], []]));
    tab.eval("document.querySelector('header a[href=\"#axis-wrist\"]').click()");
    tab.until("[...document.querySelectorAll('section.screen')].every((s) => s.dataset.ready)");
}

fn plain(tab: &mut Tab) {
    let folder = tempfile::tempdir().unwrap();
    tab.visit(&format!("file://{}", page::plain(folder.path()).display()));
    reveal(tab);
    assert!(text(tab, "figure .bar-of-plot").contains("a curve"));
    tab.size(390, 844);
    settle(tab);
    assert_eq!(
        (tab.eval("document.documentElement.scrollWidth"), tab.eval(BROKEN)),
        (json!(390), json!([]))
    );
}

fn times(tab: &mut Tab, page: &Path) {
    tab.open(page);
    let first =
        tab.eval("performance.getEntriesByName('first-picture')[0].startTime").as_f64().unwrap();
    let frames = tab.eval(
        "(async () => { const host = document.querySelector('[data-show=residual]'); const taken = []; \
         const frame = () => new Promise(requestAnimationFrame); \
         const press = (key) => host.dispatchEvent(new KeyboardEvent('keydown', {key, bubbles: true})); \
         for (const key of [...'+'.repeat(4), ...Array(20).fill('ArrowRight'), ...Array(20).fill('ArrowLeft'), ...'-'.repeat(4)]) { \
         await frame(); const begin = performance.now(); press(key); await frame(); taken.push(performance.now() - begin); } \
         return taken.sort((a, b) => a - b); })()",
    );
    let frames: Vec<f64> =
        frames.as_array().unwrap().iter().map(|ms| ms.as_f64().unwrap()).collect();
    assert!(first > 0.0 && frames.len() == 48);
    println!(
        "{}: first picture after {first:.0} ms; a frame of pan and zoom takes {:.1} ms (median), {:.1} ms (longest)",
        page.file_name().unwrap().to_string_lossy(),
        frames[frames.len() / 2],
        frames[frames.len() - 1],
    );
}
