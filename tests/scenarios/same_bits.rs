//! The same seed gives the same bits, whatever the number of threads.

use friction_ident::family::{FrictionFamily, Options};
use missing_physics::discover;
use serde_json::Value;

use super::table::{among, plain, record};

#[test]
fn a_discovery_is_the_same_to_the_bit_on_one_two_and_seven_threads() {
    let recording = record(&plain().with("quadratic-drag", &[("c", 900.0)]).unwrap());
    let on = |threads: usize| -> Value {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let family = FrictionFamily::new(&recording, &Options::default()).unwrap();
            let settings = among(&family, &["stribeck", "quadratic-drag", "ripple"]);
            let mut found = discover(&family, &settings, &mut ()).unwrap();
            found.wall_s = 0.0;
            serde_json::to_value(&found).unwrap()
        })
    };
    let one = on(1);
    assert_eq!(one["added"][0], "quadratic-drag", "{}", one["remains"]);
    assert!(on(2) == one && on(7) == one);
}
