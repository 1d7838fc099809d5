//! What tells effects apart that look alike in ordinary motion.

use missing_physics::report::Explained;

use crate::effects::{Apart, Effect, Library};

/// What is said where no effect knows what it looks like.
const USUAL: &str = "record constant speeds from 0.5 mm/s to the highest in both directions over the whole stroke, and small \
                     reversals at several rates.";

/// Effects that look like another one in ordinary motion, and what tells them apart.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alike {
    /// The other effects.
    pub effects: Vec<&'static str>,
    /// The experiment that tells them apart, in words.
    pub experiment: &'static str,
}

/// What the effect called `name` is mistaken for, by what `effects` say of themselves; a form is what its effect is.
pub fn mistaken_for(effects: &[&dyn Effect], name: &str) -> Vec<Alike> {
    let main = name.split(':').next().unwrap_or_default();
    let all = effects.iter().flat_map(|effect| {
        let of = effect.about().name;
        effect.told_apart().iter().map(move |apart| (of, apart))
    });
    let named = all.filter(|(of, apart)| *of == main || apart.from.contains(&main));
    let alike = named.map(|(of, apart)| Alike {
        effects: std::iter::once(of)
            .chain(apart.from.iter().copied())
            .filter(|n| *n != main)
            .collect(),
        experiment: apart.experiment,
    });
    alike.collect()
}

/// What is known of every effect of a library and its forms, for a reader.
pub fn explained(library: &Library) -> Vec<Explained> {
    let each = library.effects().iter().flat_map(|effect| {
        let forms = effect.forms().iter().map(|form| form.about());
        std::iter::once(effect.about()).chain(forms).collect::<Vec<_>>()
    });
    let explained = each.map(|about| Explained {
        name: about.name.to_owned(),
        title: about.title.to_owned(),
        equation: about.equation.to_owned(),
        shows: about.shows.to_owned(),
        reference: about.reference.to_owned(),
        parameters: (about.parameters.iter())
            .map(|parameter| [parameter.name.to_owned(), parameter.meaning.to_owned()])
            .collect(),
        mistaken_for: (mistaken_for(library.effects(), about.name).into_iter())
            .map(|alike| [alike.effects.join(", "), alike.experiment.to_owned()])
            .collect(),
    });
    explained.collect()
}

/// The experiment that tells the effects called `terms` apart, by what `effects` say of themselves: the one for most of
/// them.
pub fn experiment(effects: &[&dyn Effect], terms: &[String]) -> String {
    let main = |term: &String| term.split(':').next().unwrap_or_default().to_owned();
    let terms: Vec<String> = terms.iter().map(main).collect();
    let has = |name: &str| terms.iter().any(|term| term == name);
    let alike = effects.iter().flat_map(|effect| {
        let name = effect.about().name;
        effect.told_apart().iter().map(move |apart| (name, apart))
    });
    let matching = |name: &str, apart: &Apart| {
        usize::from(has(name)) + apart.from.iter().filter(|other| has(other)).count()
    };
    let best = alike.max_by_key(|(name, apart)| matching(name, apart));
    match best {
        Some((name, apart)) if matching(name, apart) > 1 => format!("{}.", apart.experiment),
        _ => USUAL.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::effects::{ALL, About};

    /// An effect of a user's own, which says what it looks like.
    struct Own;

    static OWN: About = About {
        name: "own",
        title: "own",
        equation: "0",
        parameters: &[],
        slots: &[],
        shows: "nothing",
        reference: "none",
    };

    impl Effect for Own {
        fn about(&self) -> &'static About {
            &OWN
        }

        fn told_apart(&self) -> &'static [Apart] {
            &[Apart { from: &["ripple"], experiment: "turn it off" }]
        }
    }

    #[test]
    fn an_effect_is_mistaken_for_others_and_never_for_itself() {
        let alike = mistaken_for(ALL, "stribeck:gaussian");
        assert!(alike.iter().any(|alike| alike.effects.contains(&"presliding")), "{alike:?}");
        assert!(alike.iter().all(|alike| !alike.effects.contains(&"stribeck")));
        assert!(mistaken_for(ALL, "drift").is_empty());
    }

    #[test]
    fn an_effect_of_a_user_says_what_tells_it_apart() {
        let names = ["ripple".to_owned(), "own".to_owned()];
        let mut effects = ALL.to_vec();
        assert_eq!(experiment(&effects, &names), USUAL);
        effects.push(&Own);
        assert_eq!(experiment(&effects, &names), "turn it off.");
    }

    #[test]
    fn confusable_effects_get_their_experiment() {
        let told = |names: &[&str]| {
            experiment(ALL, &names.iter().map(|name| (*name).to_owned()).collect::<Vec<_>>())
        };
        assert!(told(&["actuator-lag", "input-delay"]).contains("sweep"));
        assert!(told(&["stribeck:gaussian", "presliding:lugre"]).contains("creep"));
        // Two alike of three; of two sentences on the same two the one said later.
        assert!(told(&["gravity-pendulum", "drift", "spring"]).contains("two constant speeds"));
        assert_eq!(told(&["drift", "encoder"]), USUAL);
    }
}
