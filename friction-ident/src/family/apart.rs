//! What tells effects apart that look alike in ordinary motion.

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
        "reverse within 5 to 50 µm at several rates (only presliding is independent of rate), and creep at constant speeds from 0.05 to 5 mm/s without reversals",
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
    fn confusable_effects_get_their_experiment() {
        let names = ["actuator-lag".to_owned(), "input-delay".to_owned()];
        assert!(experiment(&names).contains("sweep"));
        let forms = ["stribeck:gaussian".to_owned(), "presliding:lugre".to_owned()];
        assert!(experiment(&forms).contains("creep"));
    }
}
