//! Trial values of shape parameters, and what a term with them adds to a prediction.

use aep_core::Scale;

use super::term::{Role, Term, TermParameter};

/// Trials per shape parameter for a term with one, two and more of them.
const TRIALS: [usize; 3] = [16, 8, 5];

/// The product of one-dimensional grids over all shape parameters of `term`.
pub fn grid(term: &Term) -> Vec<Vec<f64>> {
    let shapes: Vec<&TermParameter> =
        term.parameters.iter().filter(|p| p.role == Role::Shape).collect();
    let trials = TRIALS[shapes.len().saturating_sub(1).min(2)];
    shapes.iter().fold(vec![Vec::new()], |points, parameter| {
        let line = spread(parameter, trials);
        points
            .iter()
            .flat_map(|point| line.iter().map(move |value| [point.as_slice(), &[*value]].concat()))
            .collect()
    })
}

/// `count` values from the lower to the upper limit, evenly on the parameter's scale.
pub fn spread(parameter: &TermParameter, count: usize) -> Vec<f64> {
    let (lower, upper) = (parameter.lower, parameter.upper);
    (0..count)
        .map(|k| {
            let part = k as f64 / (count.max(2) - 1) as f64;
            match parameter.scale {
                Scale::Log => lower * (upper / lower).powf(part),
                Scale::Linear => lower + (upper - lower) * part,
            }
        })
        .collect()
}

/// The values of all parameters of `term` from its shapes and amplitudes, each in their order.
pub fn assemble(term: &Term, shape: &[f64], amplitude: &[f64]) -> Vec<f64> {
    let (mut shapes, mut amplitudes) = (shape.iter(), amplitude.iter());
    term.parameters
        .iter()
        .map(|parameter| match parameter.role {
            Role::Shape => *shapes.next().unwrap_or(&parameter.start),
            Role::Amplitude => *amplitudes.next().unwrap_or(&0.0),
        })
        .collect()
}

/// Number of columns of a term: its amplitudes, or one where it has none.
pub fn amplitudes(term: &Term) -> Vec<&TermParameter> {
    term.parameters.iter().filter(|parameter| parameter.role == Role::Amplitude).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameter(role: Role) -> TermParameter {
        TermParameter {
            name: "p".into(),
            unit: "m".into(),
            role,
            lower: 0.01,
            upper: 1.0,
            scale: Scale::Log,
            start: 0.1,
        }
    }

    #[test]
    fn a_term_without_shapes_has_one_trial() {
        let term = Term {
            name: "t".into(),
            title: String::new(),
            equation: String::new(),
            parameters: vec![parameter(Role::Amplitude)],
            always: false,
        };
        assert_eq!(grid(&term), vec![Vec::<f64>::new()]);
        assert_eq!(assemble(&term, &[], &[3.0]), vec![3.0]);
    }

    #[test]
    fn a_log_grid_multiplies() {
        let line = spread(&parameter(Role::Shape), 3);
        assert!((line[1] - 0.1).abs() < 1e-12 && (line[2] - 1.0).abs() < 1e-12);
    }
}
