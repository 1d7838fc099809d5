//! Files of measurements.

use std::path::{Path, PathBuf};

use aep_data::{Mapping, parse};
use missing_physics::measurement::check::check;

use super::{Target, outline};

/// The length of a text is reserved before it is read (binrw, 32 bits of length), and never touched where it is not there.
const RESERVED: usize = 1 << 33;

pub const CSV: Target = Target::new("csv", tables, |input| read("run.csv", input));
pub const MAT: Target = Target::new(
    "mat",
    || beside(&["fixtures/plain.mat", "fixtures/mixed.mat", "fixtures/structures.mat"]),
    |input| read("run.mat", input),
);
pub const HDF5: Target = Target::new(
    "hdf5",
    || beside(&["fixtures/plain.h5", "fixtures/v73.mat"]),
    |input| read("run.h5", input),
);
pub const NPZ: Target = Target::new(
    "npz",
    || beside(&["formats/run.npz", "formats/packed.npz"]),
    |input| read("run.npz", input),
);
pub const PARQUET: Target = Target::new(
    "parquet",
    || beside(&["formats/run.parquet", "formats/lerobot.parquet"]),
    |input| read("run.parquet", input),
);
pub const XLSX: Target =
    Target::new("xlsx", || beside(&["formats/run.xlsx"]), |input| read("run.xlsx", input));
pub const MCAP: Target =
    Target::new("mcap", super::joints::seeds, |input| read("run.mcap", input)).reserving(RESERVED);

/// Files among the tests of the crate that reads them.
fn beside(names: &[&str]) -> Vec<Vec<u8>> {
    let folder: PathBuf = [env!("CARGO_MANIFEST_DIR"), "..", "aep-data", "tests"].iter().collect();
    names
        .iter()
        .map(|name| {
            let path = folder.join(name);
            std::fs::read(&path).unwrap_or_else(|error| panic!("{}: {error}", path.display()))
        })
        .collect()
}

/// Ways to write a table as text.
fn tables() -> Vec<Vec<u8>> {
    let rows = |separator: &str, point: &str, end: &str| -> String {
        let number = |value: f64| format!("{value:.4}").replace('.', point);
        (0..60)
            .map(|k| {
                let t = 0.001 * f64::from(k);
                let cells = [number(t), number((40.0 * t).sin()), number((40.0 * t).cos())];
                cells.join(separator) + end
            })
            .collect()
    };
    let plain = format!("time_s,force_N,position_m\n{}", rows(",", ".", "\n"));
    let preamble = format!("Drive 7\n\nt;F;x\ns;N;mm\n{}", rows(";", ",", "\r\n"));
    let rows: Vec<String> =
        (0..60).map(|k| format!("2026-03-01T10:00:00.{k:03}Z\t{k}\t{}\n", 2 * k)).collect();
    let stamped = format!("time\tforce_N\tposition_m\n{}", rows.concat());
    let wide = std::iter::once(0xfeff).chain(plain.encode_utf16()).flat_map(u16::to_le_bytes);
    let wide: Vec<u8> = wide.collect();
    vec![plain.into_bytes(), preamble.into_bytes(), stamped.into_bytes(), wide]
}

/// Reads a file and looks at what it holds.
fn read(name: &str, input: &[u8]) -> String {
    match parse(Path::new(name), input.to_vec(), &Mapping::default()) {
        Ok(loaded) => {
            let findings = check(&loaded.recording).findings;
            let kinds = findings.iter().map(|finding| outline(&format!("{finding:?}")));
            kinds.collect::<Vec<_>>().join(", ")
        }
        Err(error) => outline(&error.to_string()),
    }
}
