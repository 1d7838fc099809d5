//! Several files as one measurement: each is a piece of its own.

use std::path::{Path, PathBuf};

use missing_physics::{Channel, Recording};

use crate::assemble::Loaded;
use crate::error::{DataError, Problem};
use crate::mapping::{Mapping, hold_name};
use crate::read;

/// Sampling intervals of files that belong together differ by at most this factor.
const RATES: f64 = 3.0;

/// The recordings in `paths`, all read by one mapping, as the pieces of one recording. It has the
/// channels that all of them have.
///
/// # Errors
/// Like [`read`]; and where the files are not of one axis, differ in how the force is held, or widely in
/// their sampling.
pub fn read_all(paths: &[PathBuf], mapping: &Mapping) -> Result<Loaded, DataError> {
    join(paths.iter().map(|path| Ok((path, read(path, mapping)?))))
}

/// Pieces, each with its file, as one recording.
pub(crate) fn join<'a>(
    mut pieces: impl Iterator<Item = Result<(&'a PathBuf, Loaded), DataError>>,
) -> Result<Loaded, DataError> {
    let Some(first) = pieces.next() else {
        return Err(DataError::new(Path::new(""), Problem::Absent));
    };
    let (first, mut all) = first?;
    for piece in pieces {
        let (path, next) = piece?;
        agree(&all.recording, &next.recording).map_err(|problem| DataError::new(path, problem))?;
        all.recording = joined(&all.recording, &next.recording)
            .map_err(|error| DataError::new(path, Problem::Recording(error)))?;
        all.switched_off += next.switched_off;
        all.left_out.missing += next.left_out.missing;
        all.left_out.repeated += next.left_out.repeated;
        all.unused.retain(|name| next.unused.contains(name));
    }
    let present = |name: &str| name == "time" || all.recording.channel(name).is_some();
    all.origins.retain(|origin| present(origin.channel) || origin.channel == "enabled");
    let by_time = |name: &str| name == "model_force" || name.contains(' ');
    if all.recording.channels().iter().any(|channel| by_time(&channel.name)) {
        all.recording = one_after_another(&all.recording)
            .map_err(|error| DataError::new(first, Problem::Recording(error)))?;
    }
    Ok(all)
}

/// The same with pieces moved in time, where they overlap: what is looked up by time must be found once.
fn one_after_another(recording: &Recording) -> Result<Recording, missing_physics::RecordingError> {
    let mut time = recording.time().to_vec();
    let mut segment = vec![0; time.len()];
    let mut last = f64::NEG_INFINITY;
    for (number, piece) in (0..).zip(recording.segments()) {
        segment[piece.clone()].fill(number);
        let late = last + recording.interval() - time[piece.start];
        if late > 0.0 {
            time[piece.clone()].iter_mut().for_each(|t| *t += late);
        }
        last = time[piece.end - 1];
    }
    let channels = recording.channels().to_vec();
    let moved = Recording::with_segments(recording.name(), time, channels, segment)?;
    Ok(moved.with_hold_of(recording))
}

fn agree(first: &Recording, next: &Recording) -> Result<(), Problem> {
    let unit = |recording: &Recording, channel: &str| {
        recording.channel(channel).map_or_else(String::new, |channel| channel.unit.clone())
    };
    for channel in ["force", "position"] {
        let (here, there) = (unit(next, channel), unit(first, channel));
        if here != there {
            return Err(Problem::Differs { what: channel, here, there });
        }
    }
    let (here, there) = (next.hold(), first.hold());
    if here != there {
        let (here, there) = (hold_name(here).to_owned(), hold_name(there).to_owned());
        return Err(Problem::Differs { what: "hold", here, there });
    }
    let (here, there) = (next.interval(), first.interval());
    if here > RATES * there || there > RATES * here {
        let words = |interval: f64| format!("one sample every {interval:.2e} s");
        return Err(Problem::Differs { what: "sampling", here: words(here), there: words(there) });
    }
    Ok(())
}

fn joined(
    first: &Recording,
    next: &Recording,
) -> Result<Recording, missing_physics::RecordingError> {
    let both = first.channels().iter().filter_map(|channel| {
        let more = next.channel(&channel.name).filter(|more| more.unit == channel.unit)?;
        let values = [channel.values.as_slice(), &more.values].concat();
        Some(Channel::new(&channel.name, &channel.unit, values))
    });
    let channels = both.collect();
    let time = [first.time(), next.time()].concat();
    let pieces = first.segments().iter().chain(next.segments());
    let segment =
        (0i64..).zip(pieces).flat_map(|(number, piece)| piece.clone().map(move |_| number));
    let name = format!("{}, {}", first.name(), next.name());
    let recording = Recording::with_segments(name, time, channels, segment.collect())?;
    Ok(recording.with_hold_of(first))
}
