//! A recording as files, so that the command line can be asked.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use serde_json::json;

use super::case::{Case, Size};
use super::level::{Level, Recorded};
use super::machine::Force;

/// Writes `recording.csv` and `truth.json` into a folder below `parent`; its path.
///
/// # Errors
/// A file cannot be written.
pub fn save(
    parent: &Path,
    (case, level, seed): (&Case, Level, u64),
    recorded: &Recorded,
) -> io::Result<PathBuf> {
    let name = format!("{}-{}-{}-{seed}", case.kind, case.name, level.name());
    let folder = parent.join(name);
    fs::create_dir_all(&folder)?;
    let (force, position) =
        if recorded.rotary { ("torque_Nm", "angle_rad") } else { ("force_N", "position_m") };
    let mut text = format!("time_s,{force},{position}\n");
    let run = &recorded.run;
    for ((time, force), position) in run.time.iter().zip(&run.force).zip(&run.position) {
        let _ = writeln!(text, "{time:.9},{force:.7e},{position:.12}");
    }
    fs::write(folder.join("recording.csv"), text)?;
    let [mass, coulomb, viscous, offset, gravity] = recorded.truth;
    let truth = json!({
        "kind": case.kind,
        "hidden": case.name,
        "level": level.name(),
        "seed": seed,
        "wanted": format!("{:?}", case.wanted()).to_lowercase(),
        "answers": case.answers,
        "minor": case.minor,
        "base": case.base,
        "hold": match recorded.force {
            Force::Command => "zero-order",
            Force::Measured => "sampled",
        },
        "law": if case.size == Size::Nothing { None } else { Some(format!("{:?}", case.hidden)) },
        "size": recorded.size,
        "parameter": run.parameter.map(|(name, value)| json!({ "name": name, "value": value })),
        "visibility": recorded.visibility,
        "noise": recorded.noise,
        "machine": {
            "mass": mass,
            "coulomb": coulomb,
            "viscous": viscous,
            "offset": offset,
            "gravity": gravity,
        },
    });
    fs::write(folder.join("truth.json"), format!("{truth:#}\n"))?;
    Ok(folder)
}
