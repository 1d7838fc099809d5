//! A run killed with SIGKILL resumes from its last checkpoint and ends as if nothing had happened.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Duration;

use aep_core::{
    Aep, Algorithm, Budget, Domain, Driver, FnProblem, Method, Problem, Progress, Start,
};

const PATH: &str = "AEP_TEST_CHECKPOINT";

fn valley() -> impl Problem {
    let domain = Domain::cube(2, -6.0, 6.0).unwrap();
    FnProblem::new(domain, |x: &[f64]| 100.0 * (x[0] * x[0] - x[1]).powi(2) + (1.0 - x[0]).powi(2))
}

fn fresh(problem: &dyn Problem) -> Box<dyn Algorithm> {
    Aep::practical().start(&Start::new(problem.domain(), 23)).unwrap()
}

fn driver<'a>() -> Driver<'a> {
    Driver::new(Budget::generations(400))
}

/// The run to be killed, in a process of its own; slow enough to be caught in the middle.
#[test]
#[ignore = "started by the other test"]
fn the_run_to_be_killed() {
    let Some(path) = std::env::var_os(PATH) else { return };
    let problem = valley();
    driver()
        .with_checkpoint(PathBuf::from(path), 1)
        .with_observer(|_: &Progress| std::thread::sleep(Duration::from_millis(20)))
        .run(&mut *fresh(&problem), &problem)
        .unwrap();
}

fn start_and_kill(checkpoint: &Path) {
    let mut child = Command::new(std::env::current_exe().unwrap())
        .args(["the_run_to_be_killed", "--exact", "--ignored"])
        .env(PATH, checkpoint)
        .stdout(Stdio::null())
        .spawn()
        .unwrap();
    while !checkpoint.exists() && child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(5));
    }
    std::thread::sleep(Duration::from_millis(200));
    // SIGKILL on Unix.
    child.kill().unwrap();
    assert!(!child.wait().unwrap().success(), "the run ended before it could be killed");
}

#[test]
fn a_run_killed_in_the_middle_ends_as_the_uninterrupted_one() {
    let folder = tempfile::tempdir().unwrap();
    let checkpoint = folder.path().join("run.ckpt");
    start_and_kill(&checkpoint);

    let problem = valley();
    let mut first = None;
    let resumed = driver()
        .with_observer(|progress: &Progress| {
            first.get_or_insert(progress.generation);
        })
        .resume(&mut *fresh(&problem), &problem, &checkpoint)
        .unwrap();
    let whole = driver().run(&mut *fresh(&problem), &problem).unwrap();

    assert!(first.is_some_and(|generation| (2..400).contains(&generation)), "{first:?}");
    assert_eq!(resumed.position, whole.position);
    assert_eq!(resumed.cost.to_bits(), whole.cost.to_bits());
    assert_eq!(resumed.evaluations, whole.evaluations);
}
