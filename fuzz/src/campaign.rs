//! Many inputs for one target.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{Seek, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::Mutex;
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::thread;
use std::time::{Duration, Instant};

use rand::SeedableRng;
use rand_xoshiro::Xoshiro256PlusPlus;

use crate::{MEMORY, Target, mutated};

/// What an input may cost.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// Longest time.
    pub time: Duration,
    /// Memory beside a multiple of the input, bytes.
    pub memory: usize,
    /// That multiple.
    pub times: usize,
}

impl Default for Limits {
    fn default() -> Self {
        Self { time: Duration::from_secs(10), memory: 256 << 20, times: 64 }
    }
}

/// Why an input is a finding.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Cause {
    /// The place of a panic.
    Panic(String),
    /// It takes longer than it may.
    Hang,
    /// It needs more memory than it may.
    Memory,
}

/// An input that does what none may do.
#[derive(Clone, Debug)]
pub struct Finding {
    /// What it does.
    pub cause: Cause,
    /// It.
    pub input: Vec<u8>,
}

/// What came out.
#[derive(Clone, Debug, Default)]
pub struct Ended {
    /// Inputs that were tried.
    pub executions: u64,
    /// Different outcomes.
    pub outcomes: usize,
    /// One for each cause.
    pub findings: Vec<Finding>,
}

/// Many inputs for one target, on a thread that a hang does not stop.
#[derive(Debug)]
pub struct Campaign {
    target: &'static Target,
    limits: Limits,
    ask: Sender<Vec<u8>>,
    answers: Receiver<Answer>,
    last: Option<Mutex<File>>,
}

/// What an input did, and the memory that it needed, bytes.
type Answer = (Result<String, String>, usize);

/// Where the last panic was.
static PLACE: Mutex<String> = Mutex::new(String::new());

/// Keeps panics from being printed; where they were is told by [`Cause`].
pub fn hushed() {
    std::panic::set_hook(Box::new(|about| {
        let place = about.location().map_or_else(String::new, ToString::to_string);
        // The path on this machine is no part of the place.
        let place = place.rsplit_once("/src/").map_or(place.as_str(), |(_, file)| file);
        let mut last = PLACE.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        place.clone_into(&mut last);
    }));
}

impl Campaign {
    /// One for a target.
    pub fn new(target: &'static Target, limits: Limits) -> Self {
        let (ask, inputs) = channel::<Vec<u8>>();
        let (answer, answers) = channel();
        // It is left behind where an input hangs.
        thread::spawn(move || {
            for input in inputs {
                let before = MEMORY.current_usage();
                MEMORY.reset_peak_usage();
                let outcome = catch_unwind(AssertUnwindSafe(|| (target.run)(&input)));
                let needed = MEMORY.peak_usage().saturating_sub(before);
                let outcome = outcome.map_err(|_| {
                    PLACE.lock().unwrap_or_else(std::sync::PoisonError::into_inner).clone()
                });
                if answer.send((outcome, needed)).is_err() {
                    return;
                }
            }
        });
        Self { target, limits, ask, answers, last: None }
    }

    /// One that keeps the last input in a file: memory that cannot be had ends the process.
    #[must_use]
    pub fn keeping_last(self, file: File) -> Self {
        Self { last: Some(Mutex::new(file)), ..self }
    }

    fn keep(&self, input: &[u8]) -> std::io::Result<()> {
        let Some(last) = &self.last else { return Ok(()) };
        let mut file = last.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        file.rewind()?;
        file.write_all(input)?;
        file.set_len(input.len() as u64)
    }

    /// Tries one input: what came of it, or why none may do that. After a hang the campaign is over.
    ///
    /// # Errors
    /// The cause.
    pub fn tried(&self, input: &[u8]) -> Result<String, Cause> {
        if let Err(error) = self.keep(input) {
            eprintln!("the last input is not kept: {error}");
        }
        if self.ask.send(input.to_vec()).is_err() {
            return Err(Cause::Hang);
        }
        match self.answers.recv_timeout(self.limits.time) {
            Ok((Err(place), _)) => Err(Cause::Panic(place)),
            Ok((Ok(_), needed))
                if needed
                    > self.limits.memory
                        + self.target.reserves
                        + self.limits.times * input.len() =>
            {
                Err(Cause::Memory)
            }
            Ok((Ok(outcome), _)) => Ok(outcome),
            Err(RecvTimeoutError::Timeout | RecvTimeoutError::Disconnected) => Err(Cause::Hang),
        }
    }

    /// Tries mutated inputs until `end` says so, from the executions so far and the time that has passed.
    pub fn run(&self, seed: u64, mut end: impl FnMut(u64, Duration) -> bool) -> Ended {
        let mut random = Xoshiro256PlusPlus::seed_from_u64(seed);
        let mut seeds = (self.target.seeds)();
        let mut known: BTreeSet<String> =
            seeds.iter().filter_map(|seed| self.tried(seed).ok()).collect();
        let (mut causes, mut ended) = (BTreeSet::new(), Ended::default());
        let started = Instant::now();
        while !end(ended.executions, started.elapsed()) {
            let input = mutated(&seeds, &mut random);
            ended.executions += 1;
            match self.tried(&input) {
                Ok(outcome) => {
                    if known.insert(outcome) {
                        seeds.push(input);
                    }
                }
                Err(cause) => {
                    let hang = cause == Cause::Hang;
                    if causes.insert(cause.clone()) {
                        ended.findings.push(Finding { cause, input });
                    }
                    if hang {
                        break;
                    }
                }
            }
        }
        ended.outcomes = known.len();
        ended
    }
}
