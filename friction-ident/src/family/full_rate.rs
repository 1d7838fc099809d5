//! The residual force sample by sample, above the bandwidth of the comparison, for spectra.

use std::ops::Range;

use missing_physics::Coordinate;
use missing_physics::family::FullRate;

use super::FrictionFamily;
use crate::axis::Quantity;

/// Samples around rest that are left out: the smoother still rings there.
const RINGING: usize = 20;

/// Recorded force less `force`, what a model requires along the measured motion, with the positions along which
/// it may be periodic. Up to the smoother's cut-off, twice the comparison's, the motion is known.
pub fn full_rate(family: &FrictionFamily, force: &[f64]) -> FullRate {
    let p = &family.prepared;
    let residual: Vec<f64> = p.force.iter().zip(force).map(|(a, b)| a - b).collect();
    let finite = residual.iter().all(|value| value.is_finite());
    let residual = if finite { residual } else { vec![0.0; force.len()] };
    let mut used: Vec<bool> = p.moving.iter().map(|moving| *moving > 0.0).collect();
    for k in 0..used.len() {
        if p.moving[k] == 0.0 {
            used[k.saturating_sub(RINGING)..(k + RINGING + 1).min(p.moving.len())].fill(false);
        }
    }
    // So does the smoother at the ends of a recording.
    for range in &p.segments {
        let end = range.end.min(range.start + RINGING);
        used[range.start..end].fill(false);
        used[range.end.saturating_sub(RINGING).max(range.start)..range.end].fill(false);
    }
    let unit = family.axis.unit(Quantity::Length);
    let direction = p.velocity.iter().map(|v| v.signum()).collect();
    let coordinate = |name: &str, parity| Coordinate {
        name: name.to_owned(),
        unit: unit.to_owned(),
        values: p.position.clone(),
        parity,
        state: true,
    };
    FullRate {
        interval: p.interval,
        residual,
        used,
        pieces: pieces(family),
        coordinates: vec![
            coordinate("position", None),
            coordinate("position (against motion)", Some(direction)),
        ],
    }
}

/// Samples of the cycles of a motion that repeats itself, else of the segments.
fn pieces(family: &FrictionFamily) -> Vec<Range<usize>> {
    let p = &family.prepared;
    if family.blocks.is_empty() {
        return p.segments.clone();
    }
    let sample = |point: usize| p.grid.get(point).copied().unwrap_or(p.time.len());
    family.blocks.iter().map(|block| sample(block.start)..sample(block.end)).collect()
}
