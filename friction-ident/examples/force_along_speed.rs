//! Time of one force evaluation along 25,000 samples, without and with a contact.

use std::hint::black_box;
use std::time::Instant;

use friction_ident::{Axis, MeasuredMotion, Model, ModelError, columns_along, force_along};

fn model() -> Result<Model, ModelError> {
    Model::new(Axis::Linear, 30.0)?
        .with("coulomb", &[])?
        .with("viscous", &[])?
        .with("offset", &[])?
        .with("asymmetry", &[])?
        .with("stribeck", &[])?
        .with("actuator-lag", &[])
}

fn median_ms(mut call: impl FnMut()) -> f64 {
    let mut times: Vec<f64> = (0..51)
        .map(|_| {
            let start = Instant::now();
            call();
            start.elapsed().as_secs_f64() * 1e3
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[25]
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let time: Vec<f64> = (0..25_000).map(|k| f64::from(k) * 1e-3).collect();
    let x: Vec<f64> = time.iter().map(|t| 0.1 * t.sin()).collect();
    let v: Vec<f64> = time.iter().map(|t| 0.1 * t.cos()).collect();
    let a: Vec<f64> = x.iter().map(|x| -x).collect();
    let motion = MeasuredMotion::new(&time, &x, &v, &a)?;
    let plain = model()?;
    let ripple = model()?.with("ripple", &[])?.with("position-friction", &[])?;
    let contact = model()?.with("presliding", &[])?;
    for (name, model) in [("memoryless", plain), ("two more", ripple), ("contact", contact)] {
        let force = median_ms(|| drop(black_box(force_along(black_box(&model), &motion))));
        let columns = median_ms(|| drop(black_box(columns_along(black_box(&model), &motion))));
        println!("{name}: force {force:.3} ms, columns {columns:.3} ms");
    }
    Ok(())
}
