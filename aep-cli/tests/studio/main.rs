//! The studio as its users and its attackers meet it: a server of its own for every test, requests byte by byte, and a real
//! browser. Where no Chromium is installed those tests are skipped and counted as ignored.
//!
//! `AEP_SCREENSHOTS=folder` keeps pictures. Times are printed, not asserted: they belong to the machine.

mod attacks;
mod browser;
#[path = "../../../aep-studio/tests/browser/chromium.rs"]
#[allow(dead_code, reason = "the report's tests use all of it")]
mod chromium;
mod mutated;
mod server;
mod steps;

use libtest_mimic::{Arguments, Trial};

fn main() {
    let arguments = Arguments::from_args();
    let browser = chromium::installed();
    if browser.is_none() {
        println!("SKIPPED: no Chromium (apt-get install chromium, or AEP_CHROMIUM=/path/to/it)");
    }
    let mut trials = Vec::new();
    // Pictures are for people: no test where nobody asks for them.
    let wanted = std::env::var_os("AEP_SCREENSHOTS").map(|_| &browser::PICTURES);
    for (name, test) in browser::TESTS.iter().chain(wanted) {
        let browser = browser.clone();
        let skipped = browser.is_none();
        let run = move || {
            test(browser.as_deref().unwrap_or_default());
            Ok(())
        };
        trials.push(Trial::test(*name, run).with_ignored_flag(skipped));
    }
    for (name, test) in attacks::TESTS.iter().chain(mutated::TESTS).chain(steps::TESTS) {
        let run = || {
            test();
            Ok(())
        };
        trials.push(Trial::test(*name, run));
    }
    libtest_mimic::run(&arguments, trials).exit();
}
