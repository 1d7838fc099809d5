//! The course of a recording as the data of a page: no more points than a screen can show.

use missing_physics::report::{Compared, Rung, Samples, Track};
use serde_json::{Value, json};

use super::packed::{doubles, runs, steps};
use crate::words;

/// Most samples of a page; of more, each stretch keeps the extremes of every series that is drawn over time.
const MOST: usize = 100_000;

/// All that the first screen draws: the recording with the models of a ladder, each with its name. Coordinates stand in `order`,
/// others after them.
pub(crate) fn packed(ladder: &[(String, &Rung)], order: &[&str], course: &Samples) -> Value {
    let kept = kept(course, MOST);
    let at = |values: &[f64]| {
        steps(
            kept.iter()
                .map(|k| values.get(*k).copied().unwrap_or(f64::NAN))
                .collect::<Vec<_>>()
                .into_iter(),
        )
    };
    let compared: Vec<Value> = course.compared.iter().map(|compared| {
        let residuals: Vec<Value> =
            compared.predicted.iter().map(|predicted| at(&residual(compared, predicted))).collect();
        json!({
            "name": compared.name, "about": compared.about, "unit": compared.unit, "decides": compared.decides,
            "measured": at(&compared.measured), "residuals": residuals,
                "left_out": runs(kept.iter().map(|k| {
                    compared.left_out.get(*k).copied().flatten().map_or(-1, |reason| reason as i64)
                })),
        })
    }).collect();
    let track = |track: &Track| json!({"name": track.name, "unit": track.unit, "against": track.against_motion, "values": at(&track.values)});
    let tracks: Vec<Value> = course.coordinates.iter().map(track).collect();
    let models = ladder.iter().map(|(name, rung)| json!({"name": name, "said": said(rung)}));
    let models: Vec<Value> = models.collect();
    json!({
        "samples": course.time.len(),
        "kept": kept.len(),
        "time": doubles(kept.iter().map(|k| course.time[*k])),
        "piece": runs(kept.iter().map(|k| course.piece.get(*k).copied().unwrap_or(1))),
        "regimes": course.regimes,
        "regime": runs(kept.iter().map(|k| course.regime.get(*k).map_or(-1, |r| *r as i64))),
        "reasons": course.reasons,
        "coordinates": tracks,
        "compared": compared,
        "models": models,
        "order": order,
    })
}

/// What a model errs, in words: `1.65 times what the sensors make, force error 4.31 %`.
pub(crate) fn said(rung: &Rung) -> String {
    let ahead = rung.budget.map(|times| {
        format!("prediction error {} times what the sensors make", words::times(times))
    });
    let name = words::errors_of(rung).into_iter().next();
    let along = name.and_then(|name| {
        let error = rung.error.get(&name.key)?;
        Some(format!("{} error {} on held-out data", name.quantity, name.value(error.validation)))
    });
    ahead.into_iter().chain(along).collect::<Vec<_>>().join(", ")
}

fn residual(compared: &Compared, predicted: &[f64]) -> Vec<f64> {
    compared
        .measured
        .iter()
        .zip(predicted)
        .map(|(measured, predicted)| measured - predicted)
        .collect()
}

/// The samples that are kept: all, or of each stretch the extremes of what is drawn over time.
fn kept(course: &Samples, most: usize) -> Vec<usize> {
    let count = course.time.len();
    if count <= most {
        return (0..count).collect();
    }
    let mut drawn: Vec<Vec<f64>> = Vec::new();
    for compared in &course.compared {
        drawn.push(compared.measured.clone());
        let (first, last) = (compared.predicted.first(), compared.predicted.last());
        drawn.extend(first.into_iter().chain(last).map(|predicted| residual(compared, predicted)));
    }
    // Both extremes of each, and the ends of the stretch.
    let each = 2 * drawn.len() + 2;
    let size = count.div_ceil((most / each).max(1));
    let mut kept = Vec::with_capacity(most);
    for start in (0..count).step_by(size) {
        let stretch = start..(start + size).min(count);
        let mut here = vec![stretch.start, stretch.end - 1];
        for series in &drawn {
            let known = || stretch.clone().filter(|k| series[*k].is_finite());
            here.extend(known().min_by(|a, b| series[*a].total_cmp(&series[*b])));
            here.extend(known().max_by(|a, b| series[*a].total_cmp(&series[*b])));
        }
        here.sort_unstable();
        here.dedup();
        kept.extend(here);
    }
    kept
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spike_of_a_residual_survives_and_no_more_points_than_asked_are_kept() {
        let count = 5000;
        let mut measured = vec![0.0; count];
        measured[3210] = 7.0;
        measured[77] = f64::NAN;
        let course = Samples {
            time: (0..count).map(|k| k as f64).collect(),
            piece: vec![1; count],
            compared: vec![Compared {
                name: "force".into(),
                about: String::new(),
                unit: "N".into(),
                measured,
                predicted: vec![vec![0.0; count]; 2],
                left_out: Vec::new(),
                decides: true,
            }],
            ..Samples::default()
        };
        let kept = kept(&course, 400);
        assert!(kept.len() <= 400 && kept.contains(&3210), "{}", kept.len());
        assert!(kept.windows(2).all(|pair| pair[0] < pair[1]));
        assert_eq!(super::kept(&course, count).len(), count);
    }
}
