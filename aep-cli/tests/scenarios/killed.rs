//! Killed at random moments and gone on with: what comes out is what an uninterrupted run gives, to the byte.
//!
//! ```sh
//! AEP_KILLED_RUNS=200 cargo test --release -p aep-cli --test scenarios killed -- --nocapture
//! ```

use std::time::{Duration, Instant};

use aep_core::random::{self, Purpose, Stream, Streams};

use crate::harness::Desk;
use crate::same_bytes::files;

/// `usual` runs, or as many as `AEP_KILLED_RUNS` says.
fn runs(usual: usize) -> usize {
    std::env::var("AEP_KILLED_RUNS").map_or(usual, |text| text.parse().unwrap())
}

/// Most kills of one run.
const MOST: usize = 4;

/// Whether a random moment of a run that takes so long has come.
fn moment(whole: Duration, random: &mut Stream) -> impl FnMut() -> bool {
    let after = whole.mul_f64(random::uniform::<f64>(random));
    let started = Instant::now();
    move || started.elapsed() >= after
}

fn timed<T>(work: impl FnOnce() -> T) -> (T, Duration) {
    let started = Instant::now();
    (work(), started.elapsed())
}

fn any<'a>(of: &[&'a str], random: &mut Stream) -> &'a str {
    of[random::index(random, of.len())]
}

#[test]
fn a_run_that_was_killed_several_times_ends_where_the_uninterrupted_one_does() {
    let methods = ["aep", "aep-practical", "aep-practical-restarts", "meta-ep", "de", "cma-es"];
    let problems = [
        ("rosenbrock --dimension 5", methods.as_slice(), 15_000),
        ("rastrigin --dimension 8 --shift", &["aep-lineages", "cma-es", "de"], 20_000),
        ("f4", &methods, 15_000),
        ("failing-rod", &["aep-lineages", "de"], 2_000),
    ];
    let (mut killed, mut resumed) = (0, 0);
    let count = runs(10);
    for round in 0..count {
        let random = &mut Streams::new(7, Purpose::Trial, 0).stream(round);
        let (problem, methods, evaluations) = problems[random::index(random, problems.len())];
        let (method, threads) = (any(methods, random), any(&["1", "2", "7"], random));
        let line = format!(
            "optimize {problem} --algorithm {method} --target 0 --evaluations {evaluations} \
             --seed {round} --threads {threads}"
        );
        let whole = Desk::new();
        let (run, time) = timed(|| whole.aep(&format!("{line} --checkpoint run.ckpt")));
        let expected = run.done().to_owned();
        let desk = Desk::new();
        for kill in 0..=MOST {
            let there = desk.path("run.ckpt").exists();
            resumed += usize::from(there);
            let saved = if there { "--resume" } else { "--checkpoint" };
            let line = format!("{line} {saved} run.ckpt");
            let mut now = moment(time, random);
            // The last one is left to its end.
            let Some(ended) = desk.killed(&line, || kill < MOST && now()) else {
                killed += 1;
                continue;
            };
            assert_eq!(ended.done(), expected, "{line}");
            break;
        }
    }
    println!("{count} runs: {killed} kills, gone on with from a file {resumed} times");
    assert!(killed > 0 && resumed > 0, "no run was killed in the middle");
}

/// The same command again after kills leaves the same files as once without.
fn ends_alike(lines: &[&str]) {
    let mut killed = 0;
    let count = runs(3);
    for round in 0..count {
        let random = &mut Streams::new(8, Purpose::Trial, 0).stream(round);
        let line = format!("{} --seed {round}", any(lines, random));
        let desks = [Desk::new(), Desk::new()];
        for desk in &desks {
            desk.challenge("stribeck", 1, "c");
        }
        let [whole, desk] = desks;
        let (run, time) = timed(|| whole.aep(&line));
        run.done();
        let expected = files(&whole.path("."));
        for _ in 0..=random::index(random, MOST) {
            killed += usize::from(desk.killed(&line, moment(time, random)).is_none());
            // What is there has its name, and is whole.
            for (name, bytes) in files(&desk.path(".")) {
                assert!(name.contains(".aep-") || bytes == expected[&name], "{line}: {name}");
            }
        }
        desk.aep(&line).done();
        for (name, bytes) in &expected {
            assert!(files(&desk.path("."))[name] == *bytes, "{line}: {name}");
        }
    }
    println!("{count} runs: {killed} kills");
    assert!(killed > 0, "no run was killed in the middle");
}

#[test]
fn figures_of_the_paper_are_made_on() {
    ends_alike(&[
        "reproduce fig2 fig4 --trials 3 --no-readings -o paper",
        "reproduce fig3 fig4 --trials 4 -o paper",
    ]);
}

#[test]
fn an_identification_is_made_again() {
    ends_alike(&[
        "identify c/recording.csv --effects coulomb,viscous --json r.json --html p.html -o m.json",
        "identify c/recording.csv --effects coulomb,stribeck --series s.csv -o m.json",
    ]);
}
