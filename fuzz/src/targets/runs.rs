//! Checkpoints of runs: as they are, and with damage that no checksum shows.

use std::path::Path;

use aep_core::{Budget, Domain, Driver, FnProblem, Method, Problem, Start, methods};

use super::{Target, outline};

pub const CHECKPOINT: Target =
    Target::new("checkpoint", || METHODS.iter().map(|name| saved(name)).collect(), resumed);
pub const STATE: Target = Target::new(
    "state",
    || METHODS.iter().map(|name| saved(name)).collect(),
    |input| resumed(&with_checksum(input)),
);

const METHODS: [&str; 7] = [
    "aep-practical",
    "aep-practical-restarts",
    "aep-lineages",
    "meta-ep",
    "de",
    "de-fixed",
    "cma-es",
];
/// Where the length of the content stands, and where the content begins.
const LENGTH: usize = 12;
const CONTENT: usize = 20;

fn valley() -> impl Problem {
    let domain = Domain::cube(2, -5.0, 5.0).expect("a cube");
    FnProblem::new(domain, |x: &[f64]| x.iter().map(|x| x * x).sum())
}

fn method(name: &str) -> Box<dyn Method> {
    (methods::find(name).expect("it is one").build)(6)
}

/// A checkpoint of a few generations.
fn saved(name: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run");
    let problem = valley();
    let mut algorithm = method(name).start(&Start::new(problem.domain(), 1)).expect("it starts");
    let mut driver = Driver::new(Budget::evaluations(60)).with_checkpoint(&path, 1);
    driver.run(&mut *algorithm, &problem).expect("it runs");
    std::fs::read(path).expect("it was saved")
}

/// Goes on from a checkpoint for a few generations, as the method that it says.
fn resumed(input: &[u8]) -> String {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("run");
    std::fs::write(&path, input).expect("it is written");
    METHODS.map(|name| gone_on(name, &path)).join("; ")
}

fn gone_on(name: &str, path: &Path) -> String {
    let problem = valley();
    let mut algorithm = method(name).start(&Start::new(problem.domain(), 1)).expect("it starts");
    let mut driver = Driver::new(Budget::evaluations(120));
    match driver.resume(&mut *algorithm, &problem, path) {
        Ok(outcome) => outcome.stop.to_string(),
        // The folder is another one each time.
        Err(error) => outline(&error.to_string().replace(&format!("{}: ", path.display()), "")),
    }
}

/// With length and checksum of what is there.
fn with_checksum(input: &[u8]) -> Vec<u8> {
    let mut bytes = input.to_vec();
    bytes.truncate(bytes.len().saturating_sub(4));
    if let Some(length) = bytes.len().checked_sub(CONTENT) {
        bytes[LENGTH..CONTENT].copy_from_slice(&(length as u64).to_le_bytes());
    }
    bytes.extend_from_slice(&crc32fast::hash(&bytes).to_le_bytes());
    bytes
}
