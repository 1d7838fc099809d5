//! An effect of a user's own is looked for as one of the library is.

use friction_ident::Library;
use friction_ident::effects::formula;
use friction_ident::family::{FrictionFamily, Options};
use missing_physics::suggest;

use super::table::{among, plain, record};

/// A ripple as a user writes it into a file.
const COGGING: &str = r#"
name = "cogging"
force = "a * sin(2 * pi * x / p) + b * cos(2 * pi * x / p)"
[parameters]
a = { unit = "N", low = -20.0, high = 20.0, default = 1.0, linear = true }
b = { unit = "N", low = -20.0, high = 20.0, default = 0.0, linear = true }
p = { unit = "m", low = 2e-4, high = 2e-2, default = 5e-3 }
"#;

#[test]
fn a_fine_ripple_from_a_file_promises_as_much_as_that_of_the_library() {
    let hidden = [("a_1", 2.0), ("l", 5.5e-4)];
    let recording = record(&plain().with("ripple", &hidden).unwrap());
    let library = Library::builtin().with(formula::read(COGGING).unwrap());
    let options = Options { library, ..Options::default() };
    let family = FrictionFamily::new(&recording, &options).unwrap();
    let mut settings = among(&family, &["ripple"]);
    // Form against form: another one of the library would stand in the place of the plain one.
    settings.exclude.extend(["ripple:harmonics", "ripple:direction"].map(str::to_owned));
    let found = suggest(&family, &settings, &mut ()).unwrap();
    let gain = |name: &str| {
        let candidate = found.ranking[0].iter().find(|c| c.effect == name).unwrap();
        let period = candidate.size.iter().find(|size| ["l", "p"].contains(&size.name.as_str()));
        (candidate.gain, period.unwrap().value)
    };
    let (ours, users) = (gain("ripple"), gain("cogging"));
    println!("share of the squared error: library {:.4}, file {:.4}", ours.0, users.0);
    assert!(ours.0 > 0.5, "{ours:?}");
    assert!((users.0 / ours.0 - 1.0).abs() < 0.02, "{users:?} {ours:?}");
    assert!((users.1 / 5.5e-4 - 1.0).abs() < 0.01, "{users:?}");
}
