//! Several views of one error side by side, and what to make of them where they disagree.

use crate::report::{Disagreement, View};

/// Views that differ by less than this factor do not prefer one model to another.
const CLEARLY: f64 = 1.05;

/// Where two views prefer different models: for each pair of models and each view that contradicts
/// the first view that decides. `models` are names with their views.
pub fn disagreements(models: &[(String, Vec<View>)]) -> Vec<Disagreement> {
    let mut said = Vec::new();
    for (k, (name, views)) in models.iter().enumerate() {
        for (other, others) in &models[k + 1..] {
            said.extend(between((name, views), (other, others)));
        }
    }
    said
}

fn between(a: (&str, &[View]), b: (&str, &[View])) -> Vec<Disagreement> {
    let pairs: Vec<(&View, &View)> =
        a.1.iter()
            .filter_map(|view| Some((view, b.1.iter().find(|other| other.name == view.name)?)))
            .collect();
    let Some((judge, better)) = pairs
        .iter()
        .filter(|pair| pair.0.decides)
        .find_map(|pair| Some((pair.0, preferred(pair)?)))
    else {
        return Vec::new();
    };
    let name = |first: bool| if first { a.0 } else { b.0 };
    pairs
        .iter()
        .filter(|pair| preferred(pair).is_some_and(|first| first != better))
        .map(|(view, _)| Disagreement {
            judge: judge.name.clone(),
            prefers: name(better).to_owned(),
            view: view.name.clone(),
            instead: name(!better).to_owned(),
            decides: view.decides,
        })
        .collect()
}

/// Whether the first of two views is clearly better on held-out data; nothing where neither is.
fn preferred((a, b): &(&View, &View)) -> Option<bool> {
    let (a, b) = (a.metrics.validation.rms, b.metrics.validation.rms);
    if a * CLEARLY < b {
        Some(true)
    } else if b * CLEARLY < a {
        Some(false)
    } else {
        None
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::report::{Compares, Metrics, SplitMetrics};

    fn view(name: &str, rms: f64, decides: bool) -> View {
        let metrics = Metrics::of(&[rms; 10], &[1.0; 10]);
        View {
            name: name.into(),
            compares: Compares::FreeRun,
            unit: "N".into(),
            metrics: SplitMetrics { fit: metrics, validation: metrics },
            floor: None,
            decides,
            caveat: None,
        }
    }

    #[test]
    fn views_that_prefer_different_models_are_named_with_the_one_to_trust() {
        let a = ("a".to_owned(), vec![view("force", 1.0, true), view("free run", 2.0, false)]);
        let b = ("b".to_owned(), vec![view("force", 1.5, true), view("free run", 1.0, false)]);
        let between = Disagreement {
            judge: "force".into(),
            prefers: "a".into(),
            view: "free run".into(),
            instead: "b".into(),
            decides: false,
        };
        assert_eq!(disagreements(&[a, b]), [between]);
    }

    #[test]
    fn views_that_agree_or_hardly_differ_say_nothing() {
        let a = ("a".to_owned(), vec![view("force", 1.0, true), view("free run", 1.02, false)]);
        let b = ("b".to_owned(), vec![view("force", 1.5, true), view("free run", 1.0, false)]);
        assert!(disagreements(&[a.clone(), b]).is_empty());
        assert!(disagreements(&[a]).is_empty());
    }

    #[test]
    fn a_view_that_is_not_a_number_prefers_nothing() {
        let a = ("a".to_owned(), vec![view("force", f64::NAN, true)]);
        let b = ("b".to_owned(), vec![view("force", 1.0, true)]);
        assert!(disagreements(&[a, b]).is_empty());
    }
}
