//! A formula that was parsed: steps on a stack.

use crate::error::FormulaError;
use crate::functions::Call;

/// A step of the evaluation.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Step {
    Number(f64),
    Name(usize),
    Negate,
    Call(Call, usize),
}

/// A formula.
#[derive(Clone, Debug)]
pub struct Formula {
    pub(crate) text: String,
    pub(crate) names: Vec<String>,
    pub(crate) steps: Vec<Step>,
    /// Most values on the stack.
    pub(crate) depth: usize,
}

impl Formula {
    /// Reads a formula.
    ///
    /// # Errors
    /// [`FormulaError`] with what is wrong and where; also for one that is too long or too deep.
    pub fn parse(text: &str) -> Result<Self, FormulaError> {
        crate::parse::parse(text)
    }

    /// The text that it was read from.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// The names in it, each once, in the order in which they come first.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// Its value, with one value for each of [`Formula::names`]; it may be infinite or no number.
    ///
    /// # Panics
    /// There are fewer values than names.
    pub fn value(&self, values: &[f64]) -> f64 {
        self.value_on(values, &mut Vec::with_capacity(self.depth))
    }

    /// The same with a stack of the caller's, which saves an allocation per value.
    ///
    /// # Panics
    /// There are fewer values than names.
    pub fn value_on(&self, values: &[f64], stack: &mut Vec<f64>) -> f64 {
        assert!(values.len() >= self.names.len(), "a value for every name");
        stack.clear();
        for step in &self.steps {
            match *step {
                Step::Number(number) => stack.push(number),
                Step::Name(k) => stack.push(values[k]),
                Step::Negate => {
                    if let Some(last) = stack.last_mut() {
                        *last = -*last;
                    }
                }
                Step::Call(call, arguments) => {
                    let first = stack.len() - arguments;
                    let a = &stack[first..];
                    let value = match call {
                        Call::One(f) => f(a[0]),
                        Call::Two(f) => f(a[0], a[1]),
                        Call::Three(f) => f(a[0], a[1], a[2]),
                        Call::Many(f) => a[1..].iter().fold(a[0], |left, right| f(left, *right)),
                    };
                    stack.truncate(first);
                    stack.push(value);
                }
            }
        }
        stack.pop().unwrap_or(f64::NAN)
    }
}
