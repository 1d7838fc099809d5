//! A model that was written and read again is the same plant.

use friction_ident::{Library, Model};

use super::table::{plain, record};

#[test]
fn a_model_file_keeps_every_bit_of_a_plant() {
    let plant = plain()
        .with("stribeck", &[("dF", 3.1), ("v_s", 0.0123)])
        .and_then(|model| model.with("ripple", &[("a_1", 0.7), ("l", 5.5e-4)]))
        .unwrap();
    let text = plant.to_json().unwrap();
    let again = Model::from_json(&text, &Library::builtin()).unwrap();
    assert_eq!(again.to_json().unwrap(), text);
    assert_eq!(record(&again), record(&plant));
}
