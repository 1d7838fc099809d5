use missing_physics::Recording;
use missing_physics::diagnosis::views::disagreements;
use missing_physics::report::View;

use super::*;
use crate::axis::Axis;
use crate::closed_loop::{Pd, Setup, closed_loop};
use crate::family::Options;
use crate::reference::Profile;

fn table(stribeck: bool) -> Model {
    let model = Model::new(Axis::Linear, 33.0)
        .and_then(|m| m.with("coulomb", &[("F_C", 8.0)]))
        .and_then(|m| m.with("viscous", &[("F_v", 200.0)]))
        .unwrap();
    let hump = [("dF", 6.0), ("v_s", 5e-3)];
    if stribeck { model.with("stribeck", &hump).unwrap() } else { model }
}

fn recording() -> Recording {
    let reference = Profile::new(1e-3)
        .round_trip(0.05, 0.1, 1.0)
        .round_trip(0.02, 0.005, 0.5)
        .round_trip(0.04, 0.05, 2.0)
        .build(0.0, 0.02);
    let mut pd = Pd::new(4e5, 5e3).with_feedforward(33.0);
    let setup = Setup { encoder_resolution: 1e-7, ..Setup::default() };
    closed_loop(&table(true), &reference, &mut pd, &setup).unwrap().recording
}

fn views(model: &Model) -> Vec<View> {
    let family = FrictionFamily::new(&recording(), &Options::default()).unwrap();
    let all = family.side_by_side(&family.fitted(model).unwrap()).unwrap();
    assert!(all.missing.is_empty(), "{:?}", all.missing);
    all.views
}

#[test]
fn the_true_model_is_better_in_every_view_that_decides() {
    let (with, without) = (views(&table(true)), views(&table(false)));
    let names: Vec<&str> = with.iter().map(|view| view.name.as_str()).collect();
    let expected = [
        "force residual",
        "windows of 0.05 s",
        "windows of 0.1 s",
        "windows of 0.2 s",
        "free run",
        "closed loop",
    ];
    assert_eq!(names, expected);
    for (a, b) in with.iter().zip(&without).filter(|(a, _)| a.decides) {
        assert!(a.metrics.validation.rms < 0.7 * b.metrics.validation.rms, "{a:?} {b:?}");
        assert!(a.metrics.validation.fit_percent > b.metrics.validation.fit_percent);
    }
    let models = [("with".to_owned(), with), ("without".to_owned(), without)];
    assert!(disagreements(&models).iter().all(|between| !between.decides));
}

#[test]
fn the_closed_loop_says_that_it_hides_friction() {
    let views = views(&table(false));
    let last = views.last().unwrap();
    assert!(!last.decides && last.metrics.validation.relative.unwrap() < 0.01, "{last:?}");
    let Some(Caveat::Hidden { bare, share }) = last.caveat else { panic!("{last:?}") };
    assert!(bare > last.metrics.validation.rms && share < 0.01, "{last:?}");
}

#[test]
fn without_a_reference_the_closed_loop_is_left_out_and_said_so() {
    let whole = recording();
    let channels = ["force", "position"].map(|name| whole.channel(name).unwrap().clone());
    let bare = Recording::new("bare", whole.time().to_vec(), channels.to_vec()).unwrap();
    let family = FrictionFamily::new(&bare.with_hold(whole.hold()), &Options::default()).unwrap();
    let all = family.side_by_side(&family.fitted(&table(true)).unwrap()).unwrap();
    assert_eq!(all.views.len(), 5);
    assert_eq!(all.missing, [NoView::NoReference]);
}
