//! A recording in strips that are simulated side by side.
//!
//! A step costs nearly the same for one plant as for eight: what a filter does to a recording is a long chain of short
//! steps. But it forgets where it began within some tenths of a second. So a long piece is cut into strips, each of
//! which runs in over the end of the one before, and strips are plants beside each other.

use std::ops::Range;

/// Length of a strip, s, at least, and time over which it runs in. It begins where the axis moves fastest nearby: what
/// its contacts and memories are at rest is not known, in motion it is.
const STRIP: f64 = 7.0;
const RUN_IN: f64 = 1.0;
/// Share of a strip over which its begin is looked for, on either side.
const NEARBY: f64 = 0.1;
/// Most strips side by side.
const TEAM: usize = 8;

/// Samples that are simulated one after the other.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Strip {
    /// Where the simulation starts.
    pub from: usize,
    /// Samples whose errors it tells.
    pub tells: Range<usize>,
}

impl Strip {
    /// All of a piece: every sample but the first is told.
    pub fn whole(segment: &Range<usize>) -> Self {
        Self { from: segment.start, tells: segment.start + 1..segment.end }
    }
}

/// The pieces of a recording as strips, in teams that are simulated side by side, all in order; `speed` is that of the axis at a
/// sample.
pub(super) fn teams(
    segments: &[Range<usize>],
    time: &[f64],
    speed: impl Fn(usize) -> f64,
) -> Vec<Vec<Strip>> {
    let told = segments.iter().filter(|segment| segment.len() > 1);
    let strips: Vec<Strip> = told.flat_map(|s| cut(s, time, &speed)).collect();
    let teams = strips.len().div_ceil(TEAM).max(1);
    strips.chunks(strips.len().div_ceil(teams).max(1)).map(<[Strip]>::to_vec).collect()
}

/// The strips of a piece.
fn cut(segment: &Range<usize>, time: &[f64], speed: impl Fn(usize) -> f64) -> Vec<Strip> {
    let mut strips = vec![Strip::whole(segment)];
    let duration = time[segment.end - 1] - time[segment.start];
    let count = ((duration / STRIP) as usize).clamp(1, TEAM);
    let length = segment.len() / count;
    let reach = (NEARBY * length as f64) as usize;
    for k in 1..count {
        let told = segment.start + k * length;
        let latest = time[..told].partition_point(|t| *t < time[told] - RUN_IN);
        let around = latest.saturating_sub(reach).max(segment.start)..latest + reach;
        let Some(from) = around.max_by(|a, b| speed(*a).total_cmp(&speed(*b))) else { continue };
        let first = time[..segment.end].partition_point(|t| *t < time[from] + RUN_IN);
        if first > from + 1 && first < segment.end {
            if let Some(before) = strips.last_mut() {
                before.tells.end = first;
            }
            strips.push(Strip { from, tells: first..segment.end });
        }
    }
    strips
}

#[cfg(test)]
mod tests {
    use super::*;

    fn time(samples: u32, interval: f64) -> Vec<f64> {
        (0..samples).map(|k| f64::from(k) * interval).collect()
    }

    #[test]
    fn every_sample_but_the_first_of_a_piece_is_told_once_and_in_order() {
        let time = time(9000, 5e-3);
        let segments = [0..30, 30..1200, 1200..1201, 1201..9000];
        let teams = teams(&segments, &time, |k| (k as f64 * 0.01).sin().abs());
        let told: Vec<usize> = teams.iter().flatten().flat_map(|s| s.tells.clone()).collect();
        let all = segments.iter().flat_map(|s| s.start + 1..s.end).collect::<Vec<_>>();
        assert_eq!(told, all);
        assert_eq!(teams.iter().map(Vec::len).collect::<Vec<_>>(), [7]);
        for strip in teams.iter().flatten() {
            let inside =
                segments.iter().any(|s| s.contains(&strip.from) && s.end >= strip.tells.end);
            assert!(inside, "{strip:?}");
        }
    }

    #[test]
    fn a_strip_runs_in_from_where_the_axis_moves_fastest() {
        let time = time(4000, 5e-3);
        let speed = |k: usize| if k == 1750 { 2.0 } else { 1.0 };
        let teams = teams(std::slice::from_ref(&(0..4000)), &time, speed);
        assert_eq!(teams.len(), 1);
        let strip = &teams[0][1];
        assert_eq!((strip.from, strip.tells.clone()), (1750, 1950..4000));
    }

    #[test]
    fn short_pieces_are_strips_as_they_are_in_teams_of_even_size() {
        let time = time(4000, 1e-3);
        let segments: Vec<Range<usize>> = (0..10).map(|k| 400 * k..400 * (k + 1)).collect();
        let teams = teams(&segments, &time, |_| 1.0);
        assert_eq!(teams.iter().map(Vec::len).collect::<Vec<_>>(), [5, 5]);
        assert_eq!(teams[1][0], Strip::whole(&segments[5]));
    }
}
