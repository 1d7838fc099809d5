//! Runs on disk: what a checkpoint holds and how it is kept from being mistaken.
//!
//! Layout: 8 bytes magic, 4 bytes version, 8 bytes length of the contents (little endian), the
//! contents (postcard), 4 bytes CRC-32 of everything before. A file is written beside its place and
//! renamed into it, so that a run killed at any moment leaves the last whole checkpoint.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use serde::{Deserialize, Serialize, de::DeserializeOwned};

const MAGIC: &[u8; 8] = b"AEP-CKPT";
const VERSION: u32 = 3;
const HEADER: usize = 20;

/// Why a checkpoint could not be written or is refused.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum CheckpointError {
    /// The file could not be read or written.
    #[error("{path}: {source}")]
    File {
        /// Which file.
        path: PathBuf,
        /// What the system said.
        source: io::Error,
    },
    /// The file is something else.
    #[error("{path}: not a checkpoint\n  give the file that the run wrote")]
    Foreign {
        /// Which file.
        path: PathBuf,
    },
    /// The file was written by another version.
    #[error("{path}: checkpoint of version {found}, this program reads version {VERSION}")]
    Version {
        /// Which file.
        path: PathBuf,
        /// Its version.
        found: u32,
    },
    /// The file is cut off or damaged.
    #[error("{path}: truncated or damaged ({what})\n  use an earlier copy or start the run again")]
    Damaged {
        /// Which file.
        path: PathBuf,
        /// What was found.
        what: &'static str,
    },
    /// The checkpoint belongs to a run on another problem.
    #[error(
        "the checkpoint is of a run on another problem\n  checkpoint: {checkpoint}\n  this run:   {run}\n  \
         resume with the problem that it was started with"
    )]
    OtherProblem {
        /// Problem of the checkpoint ([`crate::Problem::identity`]).
        checkpoint: String,
        /// Problem of this run.
        run: String,
    },
    /// The checkpoint belongs to another configuration.
    #[error(
        "the checkpoint belongs to another run\n  checkpoint: {}\n  this run:   {}\n  \
         resume with the configuration and the seed it was started with",
        differing(.checkpoint, .run),
        differing(.run, .checkpoint)
    )]
    OtherRun {
        /// Configuration in the checkpoint.
        checkpoint: String,
        /// Configuration of this run.
        run: String,
    },
    /// The state does not fit the algorithm.
    #[error("the checkpoint does not fit this run: {what} differs")]
    Mismatch {
        /// What differs.
        what: &'static str,
    },
    /// The state could not be encoded or decoded.
    #[error("the state of the run cannot be encoded or decoded: {0}")]
    Encoding(#[from] postcard::Error),
}

/// The parts of a configuration that another one does not have.
fn differing(of: &str, other: &str) -> String {
    let others: Vec<&str> = other.split(", ").collect();
    let own: Vec<&str> = of.split(", ").filter(|part| !others.contains(part)).collect();
    if own.is_empty() { of.into() } else { own.join(", ") }
}

/// Bytes of `state`, exact to the bit.
///
/// # Errors
/// [`CheckpointError::Encoding`] when `state` serialises to something without a known length.
pub fn encode<S: Serialize>(state: &S) -> Result<Vec<u8>, CheckpointError> {
    Ok(postcard::to_allocvec(state)?)
}

/// The state encoded in `bytes`.
///
/// # Errors
/// [`CheckpointError::Encoding`] when `bytes` hold something else.
pub fn decode<S: DeserializeOwned>(bytes: &[u8]) -> Result<S, CheckpointError> {
    Ok(postcard::from_bytes(bytes)?)
}

/// Writes `contents` to `path` so that the file is always whole: the old one or the new one.
///
/// # Errors
/// When `contents` cannot be encoded or the file not be written.
pub fn write<C: Serialize>(path: &Path, contents: &C) -> Result<(), CheckpointError> {
    let bytes = frame(&encode(contents)?);
    replace(path, &bytes).map_err(|source| CheckpointError::File { path: path.into(), source })
}

fn replace(path: &Path, bytes: &[u8]) -> io::Result<()> {
    // Through a link to the file it names, so that the link stays one.
    let path = path.canonicalize().unwrap_or_else(|_| path.into());
    if path.is_dir() {
        return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a directory"));
    }
    // A device has no content to protect, and must not be replaced by a file.
    if path.exists() && !path.is_file() {
        return File::options().write(true).open(&path)?.write_all(bytes);
    }
    // Always the same name: a run that is killed again and again leaves one such file, not many.
    let mut beside = path.as_os_str().to_owned();
    beside.push(".new");
    let beside = PathBuf::from(beside);
    let written = write_synced(&beside, bytes).and_then(|()| fs::rename(&beside, path));
    if written.is_err() {
        // What cannot be used must not take room on a full disk.
        let _ = fs::remove_file(&beside);
    }
    written
}

fn write_synced(path: &Path, bytes: &[u8]) -> io::Result<()> {
    let mut file = File::create(path)?;
    file.write_all(bytes)?;
    file.sync_all()
}

fn frame(payload: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(payload.len() + HEADER + 4);
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(&VERSION.to_le_bytes());
    bytes.extend_from_slice(&(payload.len() as u64).to_le_bytes());
    bytes.extend_from_slice(payload);
    bytes.extend_from_slice(&crc32fast::hash(&bytes).to_le_bytes());
    bytes
}

/// Reads what [`write()`] wrote; everything else is refused.
///
/// # Errors
/// When the file cannot be read, is no checkpoint, is one of another version, or is damaged.
pub fn read<C: DeserializeOwned>(path: &Path) -> Result<C, CheckpointError> {
    let bytes =
        fs::read(path).map_err(|source| CheckpointError::File { path: path.into(), source })?;
    decode(payload(path, &bytes)?)
}

fn payload<'a>(path: &Path, bytes: &'a [u8]) -> Result<&'a [u8], CheckpointError> {
    let path = || path.to_path_buf();
    if bytes.len() < MAGIC.len() || !bytes.starts_with(MAGIC) {
        return Err(CheckpointError::Foreign { path: path() });
    }
    let damaged = |what| CheckpointError::Damaged { path: path(), what };
    let found = u32::from_le_bytes(array(bytes, 8).ok_or_else(|| damaged("no version"))?);
    if found != VERSION {
        return Err(CheckpointError::Version { path: path(), found });
    }
    let length = u64::from_le_bytes(array(bytes, 12).ok_or_else(|| damaged("no length"))?);
    if bytes.len() as u64 != length.saturating_add(HEADER as u64 + 4) {
        return Err(damaged("wrong length"));
    }
    let (content, checksum) = bytes.split_at(bytes.len() - 4);
    if crc32fast::hash(content).to_le_bytes() != *checksum {
        return Err(damaged("wrong checksum"));
    }
    Ok(&content[HEADER..])
}

fn array<const N: usize>(bytes: &[u8], from: usize) -> Option<[u8; N]> {
    bytes.get(from..from + N)?.try_into().ok()
}

/// The contents of a run's checkpoint.
#[derive(Debug, Serialize, Deserialize)]
pub(crate) struct RunState {
    /// [`crate::Problem::identity`] of the problem.
    pub problem: String,
    /// Configuration, seed and domain of the run.
    pub signature: String,
    /// State of the algorithm.
    pub algorithm: Vec<u8>,
    /// State of the driver.
    pub ledger: Vec<u8>,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn another_run_is_told_by_what_differs() {
        let run = |seed: u64| format!("aep, seed {seed}, population 40, f64, Domain {{ a, b }}");
        let error = CheckpointError::OtherRun { checkpoint: run(1), run: run(2) };
        let text = error.to_string();
        assert!(
            text.contains("checkpoint: seed 1\n") && text.contains("run:   seed 2\n"),
            "{text}"
        );
    }

    #[test]
    fn what_cannot_be_written_leaves_nothing_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let inner = folder.path().join("folder");
        fs::create_dir(&inner).unwrap();
        let error = write(&inner, &1u64).unwrap_err().to_string();
        assert!(error.contains("folder") && error.contains("it is a directory"), "{error}");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
        assert!(write(&folder.path().join("none/run"), &1u64).is_err());
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn a_link_stays_a_link_and_a_device_a_device() {
        use std::os::unix::fs::{FileTypeExt, symlink};
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        write(&at("file"), &1u64).unwrap();
        symlink(at("file"), at("link")).unwrap();
        write(&at("link"), &2u64).unwrap();
        assert!(at("link").symlink_metadata().unwrap().is_symlink());
        assert_eq!(read::<u64>(&at("file")).unwrap(), 2);
        // A device that is always full, seen through a link: a rename would replace the link only.
        symlink("/dev/full", at("full")).unwrap();
        assert!(write(&at("full"), &1u64).is_err());
        assert!(at("full").symlink_metadata().unwrap().is_symlink());
        assert!(fs::metadata("/dev/full").unwrap().file_type().is_char_device());
    }

    #[test]
    fn every_truncation_and_every_flipped_byte_is_refused() {
        let path = Path::new("run.ckpt");
        let bytes = frame(&encode(&(1u64, f64::INFINITY, "text")).unwrap());
        assert!(payload(path, &bytes).is_ok());
        for length in 0..bytes.len() {
            assert!(payload(path, &bytes[..length]).is_err(), "cut to {length}");
        }
        for i in 0..bytes.len() {
            let mut damaged = bytes.clone();
            damaged[i] ^= 0x10;
            assert!(payload(path, &damaged).is_err(), "byte {i}");
        }
    }
}
