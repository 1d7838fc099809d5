//! Inputs that were findings once.

use std::path::PathBuf;

use crate::Target;

/// The folder of a target's.
pub fn corpus(target: &Target) -> PathBuf {
    [env!("CARGO_MANIFEST_DIR"), "corpus", target.name].iter().collect()
}

/// Where an input is kept: by what is in it, so that none is kept twice.
pub fn kept(target: &Target, input: &[u8]) -> PathBuf {
    corpus(target).join(format!("{:08x}", crc32fast::hash(input)))
}

/// The inputs of a target, each with its place.
pub fn read(target: &Target) -> Vec<(PathBuf, Vec<u8>)> {
    let entries = std::fs::read_dir(corpus(target)).into_iter().flatten().flatten();
    let mut inputs: Vec<_> = entries
        .map(|entry| entry.path())
        .filter_map(|path| Some((path.clone(), std::fs::read(path).ok()?)))
        .collect();
    inputs.sort();
    inputs
}
