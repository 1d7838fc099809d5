//! Optimizers of Python, in processes that ask for every cost.

use std::io::{BufRead, BufReader, Read, Write};
use std::process::{Child, ChildStdin, ChildStdout, Command, Stdio};
use std::sync::{Mutex, PoisonError};

use serde_json::{Value, json};

type Result<T> = std::result::Result<T, Box<dyn std::error::Error>>;

const SCRIPT: &str = include_str!("peers.py");
/// What a process asks with.
const EVALUATE: u8 = b'E';
const RESIDUALS: u8 = b'R';
/// What it says at the end of a run.
const DONE: u8 = b'D';

/// A run that is asked for.
pub struct Request<'a> {
    /// The method, by the name that [`Pool::new`] gave.
    pub peer: &'a str,
    /// Seed.
    pub seed: u64,
    /// Evaluations.
    pub budget: u64,
    /// Residuals of a position; 0 where there are none.
    pub residuals: usize,
    /// First step, in widths of the cube.
    pub sigma: f64,
    /// Components that are whole numbers, and how many each can be.
    pub whole: &'a [(usize, u32)],
    /// Where to begin, in the cube of width 1: enough for the initial population of every method.
    pub population: Vec<Vec<f64>>,
}

/// What a method asks for, by positions in the cube of width 1.
pub trait Asked {
    /// The cost.
    fn cost(&mut self, unit: &[f64]) -> f64;
    /// The residuals; none where there are none.
    fn residuals(&mut self, unit: &[f64]) -> Vec<f64>;
    /// Whether the target was reached or the budget used.
    fn is_over(&self) -> bool;
}

/// Individuals of an initial population per component.
pub const INDIVIDUALS: usize = 15;

/// Processes that wait for work; as many as are asked for at once.
pub struct Pool {
    python: String,
    idle: Mutex<Vec<Process>>,
}

struct Process {
    child: Child,
    requests: ChildStdin,
    answers: BufReader<ChildStdout>,
}

impl Pool {
    /// One without methods.
    pub fn none() -> (Self, Vec<String>) {
        (Self { python: String::new(), idle: Mutex::default() }, Vec::new())
    }

    /// A pool, and the names of what is installed; what is not is said.
    pub fn new(python: &str) -> (Self, Vec<String>) {
        let pool = Self { python: python.into(), idle: Mutex::default() };
        match Process::start(python) {
            Ok((process, peers)) => {
                let mut names = Vec::new();
                for (name, version) in peers {
                    match version.as_str() {
                        Some(version) => {
                            eprintln!("{name}: {version}");
                            names.push(name);
                        }
                        None => eprintln!("{name}: skipped, not installed"),
                    }
                }
                pool.idle().push(process);
                (pool, names)
            }
            Err(error) => {
                eprintln!("methods of Python: skipped, {python} does not run: {error}");
                (pool, Vec::new())
            }
        }
    }

    fn idle(&self) -> std::sync::MutexGuard<'_, Vec<Process>> {
        self.idle.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// One run, until it is over or the method gives up.
    ///
    /// # Errors
    /// When the process ends before the run does.
    pub fn run(&self, request: &Request<'_>, asked: &mut dyn Asked) -> Result<()> {
        let waiting = self.idle().pop();
        let mut process = match waiting {
            Some(process) => process,
            None => Process::start(&self.python)?.0,
        };
        process.run(request, asked)?;
        self.idle().push(process);
        Ok(())
    }
}

impl Process {
    /// A process, and its methods with their versions.
    fn start(python: &str) -> Result<(Self, serde_json::Map<String, Value>)> {
        let mut child = Command::new(python)
            .args(["-c", SCRIPT])
            .envs([("OMP_NUM_THREADS", "1"), ("OPENBLAS_NUM_THREADS", "1")])
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let requests = child.stdin.take().ok_or("no pipe")?;
        let mut answers = BufReader::new(child.stdout.take().ok_or("no pipe")?);
        let mut line = String::new();
        answers.read_line(&mut line)?;
        let peers = serde_json::from_str(&line)?;
        Ok((Self { child, requests, answers }, peers))
    }

    fn run(&mut self, request: &Request<'_>, asked: &mut dyn Asked) -> Result<()> {
        let Request { peer, seed, budget, residuals, sigma, whole, population } = request;
        let n = population.first().ok_or("a run without a start")?.len();
        let line = json!({"peer": peer, "seed": seed % (1 << 31), "budget": budget, "residuals": residuals,
            "sigma": sigma, "whole": whole, "population": population});
        writeln!(self.requests, "{line}")?;
        loop {
            let mut kind = [0];
            self.answers.read_exact(&mut kind)?;
            match kind[0] {
                EVALUATE | RESIDUALS => {
                    let mut bytes = vec![0; 8 * n];
                    self.answers.read_exact(&mut bytes)?;
                    let unit: Vec<f64> = bytes
                        .as_chunks()
                        .0
                        .iter()
                        .map(|bytes| f64::from_le_bytes(*bytes))
                        .collect();
                    let numbers = match kind[0] {
                        EVALUATE => vec![asked.cost(&unit)],
                        _ => asked.residuals(&unit),
                    };
                    let mut answer: Vec<u8> =
                        numbers.iter().flat_map(|number| number.to_le_bytes()).collect();
                    answer.push(u8::from(asked.is_over()));
                    self.requests.write_all(&answer)?;
                }
                DONE => return Ok(()),
                other => return Err(format!("{peer} answered with {other}").into()),
            }
        }
    }
}

impl Drop for Process {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
