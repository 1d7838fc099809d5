//! Sizes and experiments in the words of an engineer.

use missing_physics::Term;

/// A value with an SI prefix: `1.20 mm/s`, `7.03 MN/m`.
pub fn engineering(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 7] =
        [(1e9, "G"), (1e6, "M"), (1e3, "k"), (1.0, ""), (1e-3, "m"), (1e-6, "u"), (1e-9, "n")];
    let prefixed = matches!(unit.chars().next(), Some('N' | 'm' | 's' | 'r' | 'H'))
        // kg has its prefix already, and 1/s, powers and plain numbers take none.
        && !unit.starts_with("kg")
        && !unit.starts_with("m^");
    let size = value.abs();
    if !prefixed || size == 0.0 || (0.1..1000.0).contains(&size) {
        return format!("{} {unit}", rounded(value)).trim_end().to_owned();
    }
    let (factor, prefix) =
        PREFIXES.iter().find(|(factor, _)| size >= *factor).unwrap_or(&PREFIXES[6]);
    format!("{} {prefix}{unit}", rounded(value / factor))
}

/// Three significant digits.
fn rounded(value: f64) -> String {
    let size = value.abs();
    match size {
        _ if size == 0.0 => "0".to_owned(),
        _ if (100.0..1e5).contains(&size) => format!("{value:.0}"),
        _ if (10.0..100.0).contains(&size) => format!("{value:.1}"),
        _ if (1.0..10.0).contains(&size) => format!("{value:.2}"),
        _ if (0.01..1.0).contains(&size) => format!("{value:.3}"),
        _ => format!("{value:.2e}"),
    }
}

/// A term with its values.
pub fn describe(term: &Term, values: &[f64]) -> String {
    let words: Vec<String> = term
        .parameters
        .iter()
        .zip(values)
        .map(|(parameter, value)| {
            format!("{} = {}", parameter.name, engineering(*value, &parameter.unit))
        })
        .collect();
    words.join(", ")
}

/// Pairs (or more) of effects that look alike in ordinary motion, and what tells them apart.
const APART: [(&[&str], &str); 10] = [
    (
        &["offset", "asymmetry"],
        "break away from rest in both directions: an offset shifts both breakaway forces the same way, asymmetry makes them differ in size; add constant speeds over the whole range",
    ),
    (
        &["viscous", "quadratic-drag", "shear-thinning"],
        "run constant speeds over a factor of ten, up to the highest the axis allows",
    ),
    (
        &["stribeck", "presliding"],
        "reverse within 5 to 50 um at several rates (only presliding is independent of rate), and creep at constant speeds from 0.05 to 5 mm/s without reversals",
    ),
    (
        &["stribeck", "frictional-memory", "rising-static-friction"],
        "rest for 0.1 to 100 s before breaking away, and cross the low speeds both slowly and fast",
    ),
    (
        &["actuator-lag", "input-delay"],
        "add a fast sine sweep (to a third of the sampling frequency): a delay turns the phase in proportion to frequency, a lag also lowers the gain",
    ),
    (
        &["load-friction", "position-friction"],
        "cover the whole stroke in both directions with two different loads, or at two accelerations: what depends on the position stays where it is",
    ),
    (
        &["offset", "spring", "gravity-pendulum"],
        "cover the whole stroke slowly in both directions: an offset is the same everywhere",
    ),
    (
        &["spring", "position-friction", "ripple", "gravity-pendulum"],
        "cover the whole stroke in both directions at two constant speeds",
    ),
    (
        &["ripple", "encoder"],
        "cover the same stroke at constant speeds a factor of three apart: a ripple keeps its force, what an error of the encoder feigns grows with the square of the speed",
    ),
    (
        &["backlash", "presliding", "flexible-coupling"],
        "reverse with high acceleration: only with backlash does the motor's inertia run free",
    ),
];

/// The experiment that tells these effects apart.
pub fn experiment(terms: &[String]) -> String {
    let main = |term: &String| term.split(':').next().unwrap_or_default().to_owned();
    let terms: Vec<String> = terms.iter().map(main).collect();
    let matching = |names: &[&str]| terms.iter().filter(|t| names.contains(&t.as_str())).count();
    let best = APART.iter().max_by_key(|(names, _)| matching(names));
    match best {
        Some((names, words)) if matching(names) > 1 => format!("{words}."),
        _ => {
            "record constant speeds from 0.5 mm/s to the highest in both directions over the whole \
              stroke, and small reversals at several rates."
                .to_owned()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sizes_read_as_engineers_write_them() {
        assert_eq!(engineering(0.0012, "m/s"), "1.20 mm/s");
        assert_eq!(engineering(7.03e6, "N/m"), "7.03 MN/m");
        assert_eq!(engineering(95.1, "kg"), "95.1 kg");
        assert_eq!(engineering(-3.16, "N"), "-3.16 N");
        assert_eq!(engineering(0.0, "N"), "0 N");
        assert_eq!(engineering(3e-4, "s"), "300 us");
    }

    #[test]
    fn confusable_effects_get_their_experiment() {
        let names = ["actuator-lag".to_owned(), "input-delay".to_owned()];
        assert!(experiment(&names).contains("sweep"));
        let forms = ["stribeck:gaussian".to_owned(), "presliding:lugre".to_owned()];
        assert!(experiment(&forms).contains("creep"));
    }
}
