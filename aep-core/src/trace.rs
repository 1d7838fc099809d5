//! Writing a run's course to a file.

use std::io::{self, Write};

use serde_json::json;

use crate::{Domain, Observer, Outcome, Progress, Scalar};

/// Form of a trace.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TraceFormat {
    /// One line per generation under a header: generation, evaluations, failures, `elapsed_s`,
    /// cost, then the best position by component name.
    Csv,
    /// One JSON object per line with the same fields, the position as an array. A cost that is not
    /// known yet is null. A last object tells why the run stopped.
    JsonLines,
}

/// An observer that writes every generation.
///
/// Writing must not endanger the run: the first error ends the trace and waits in
/// [`Trace::error`].
///
/// ```
/// use aep_core::{Aep, Budget, Domain, Driver, FnProblem, Method, Problem, Start};
/// use aep_core::{Trace, TraceFormat};
///
/// let domain = Domain::cube(2, -6.0, 6.0)?.with_names(["mass", "friction"])?;
/// let bowl = FnProblem::new(domain, |x: &[f64]| x[0].powi(2) + x[1].powi(2));
/// let mut bytes = Vec::new();
/// let trace = Trace::new(&mut bytes, TraceFormat::Csv, bowl.domain());
/// let mut aep = Aep::paper().start(&Start::new(bowl.domain(), 1))?;
/// Driver::new(Budget::generations(2)).with_observer(trace).run(&mut *aep, &bowl)?;
/// let text = String::from_utf8(bytes)?;
/// assert!(text.starts_with("generation,evaluations,failures,elapsed_s,cost,mass,friction\n0,40,0,"));
/// assert_eq!(text.lines().count(), 4);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct Trace<W> {
    writer: W,
    format: TraceFormat,
    names: Vec<String>,
    begun: bool,
    error: Option<io::Error>,
}

impl<W: Write> Trace<W> {
    /// A trace of runs in `domain`. Give a buffered writer.
    pub fn new<T: Scalar>(writer: W, format: TraceFormat, domain: &Domain<T>) -> Self {
        let names = (0..domain.dimension()).map(|j| domain.name(j)).collect();
        Self { writer, format, names, begun: false, error: None }
    }

    /// What went wrong while writing, if anything.
    pub fn error(&self) -> Option<&io::Error> {
        self.error.as_ref()
    }

    fn attempt(&mut self, write: impl FnOnce(&mut Self) -> io::Result<()>) {
        if self.error.is_none() {
            self.error = write(self).err();
        }
    }

    fn csv<T: Scalar>(&mut self, progress: &Progress<'_, T>) -> io::Result<()> {
        if !self.begun {
            let names: Vec<String> = self.names.iter().map(|name| quoted(name)).collect();
            let fixed = "generation,evaluations,failures,elapsed_s,cost";
            writeln!(self.writer, "{fixed},{}", names.join(","))?;
            self.begun = true;
        }
        let (generation, evaluations) = (progress.generation, progress.evaluations);
        let (failures, seconds) = (progress.failures.total(), progress.elapsed.as_secs_f64());
        write!(self.writer, "{generation},{evaluations},{failures},{seconds:.6},")?;
        match progress.best {
            None => writeln!(self.writer, "{}", ",".repeat(self.names.len())),
            Some(best) => {
                write!(self.writer, "{}", best.cost)?;
                best.position.iter().try_for_each(|x| write!(self.writer, ",{x}"))?;
                writeln!(self.writer)
            }
        }
    }

    fn json<T: Scalar>(&mut self, progress: &Progress<'_, T>) -> io::Result<()> {
        let line = json!({
            "generation": progress.generation,
            "evaluations": progress.evaluations,
            "failures": progress.failures.total(),
            "elapsed_s": progress.elapsed.as_secs_f64(),
            "cost": progress.best.map(|best| best.cost.as_f64()),
            "position": progress.best.map(|best| as_f64(best.position)),
        });
        writeln!(self.writer, "{line}")
    }

    fn last<T: Scalar>(&mut self, outcome: &Outcome<T>) -> io::Result<()> {
        if self.format == TraceFormat::JsonLines {
            let line = json!({
                "stop": outcome.stop,
                "failures": outcome.failures,
                "evaluations": outcome.evaluations,
            });
            writeln!(self.writer, "{line}")?;
        }
        self.writer.flush()
    }
}

fn as_f64<T: Scalar>(position: &[T]) -> Vec<f64> {
    position.iter().map(|x| x.as_f64()).collect()
}

/// A name as a CSV field.
fn quoted(name: &str) -> String {
    if name.contains([',', '"', '\n']) {
        format!("\"{}\"", name.replace('"', "\"\""))
    } else {
        name.into()
    }
}

impl<T: Scalar, W: Write> Observer<T> for Trace<W> {
    fn generation(&mut self, progress: &Progress<'_, T>) {
        self.attempt(|trace| match trace.format {
            TraceFormat::Csv => trace.csv(progress),
            TraceFormat::JsonLines => trace.json(progress),
        });
    }

    fn finished(&mut self, outcome: &Outcome<T>) {
        self.attempt(|trace| trace.last(outcome));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Aep, Budget, Driver, FnProblem, Method, Problem, Start};

    #[test]
    fn json_lines_parse_and_end_with_the_stop_reason() {
        let domain = Domain::cube(2, -1.0, 1.0).unwrap();
        let problem = FnProblem::new(domain, |_: &[f64]| f64::NAN);
        let mut bytes = Vec::new();
        let trace = Trace::new(&mut bytes, TraceFormat::JsonLines, problem.domain());
        let mut aep = Aep::paper().start(&Start::new(problem.domain(), 1)).unwrap();
        Driver::new(Budget::generations(1)).with_observer(trace).run(&mut *aep, &problem).unwrap();
        let lines: Vec<serde_json::Value> = String::from_utf8(bytes)
            .unwrap()
            .lines()
            .map(|line| serde_json::from_str(line).unwrap())
            .collect();
        assert_eq!(lines.len(), 3);
        assert!(lines[0]["cost"].is_null());
        assert_eq!(lines[2]["stop"], "generations");
        assert_eq!(lines[2]["failures"]["non_finite"], 80);
    }

    #[test]
    fn an_error_while_writing_does_not_end_the_run() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::Error::other("disk full"))
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let domain = Domain::cube(2, -1.0, 1.0).unwrap();
        let problem = FnProblem::new(domain, |x: &[f64]| x[0].abs());
        let trace = Trace::new(Full, TraceFormat::Csv, problem.domain());
        let mut aep = Aep::paper().start(&Start::new(problem.domain(), 1)).unwrap();
        let mut driver = Driver::new(Budget::generations(3)).with_observer(trace);
        assert_eq!(driver.run(&mut *aep, &problem).unwrap().generations, 3);
    }
}
