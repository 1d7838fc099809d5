//! Files that are either written completely or not at all.

use std::fs::File;
use std::io::Write;
use std::path::{Path, PathBuf};

use tempfile::Builder;

/// Why a file could not be written. What was there before is still there.
#[derive(Debug, thiserror::Error)]
#[error("cannot write {}: {source}", .path.display())]
pub struct SaveError {
    /// The file.
    pub path: PathBuf,
    /// What the system says.
    #[source]
    pub source: std::io::Error,
}

/// Writes `bytes` to `path`: to a new file beside it first, which then takes its name. A full disk or
/// a stopped program leaves the old file as it was.
///
/// # Errors
/// The path and what the system says.
pub fn save(path: &Path, bytes: &[u8]) -> Result<(), SaveError> {
    save_with(path, |file| file.write_all(bytes))
}

/// Like [`save`], of what `write` writes piece by piece: a table of millions of rows need not be made in memory.
///
/// # Errors
/// Like [`save`].
pub fn save_with(
    path: &Path,
    write: impl FnOnce(&mut File) -> std::io::Result<()>,
) -> Result<(), SaveError> {
    replace(path, write)
        .map_err(|error| SaveError { path: path.to_owned(), source: without_path(error) })
}

/// What the system says: the name of the file in between, which `tempfile` adds, means nothing to
/// the user.
fn without_path(error: std::io::Error) -> std::io::Error {
    match error.to_string().split_once(" at path ") {
        Some((said, _)) => std::io::Error::new(error.kind(), said),
        None => error,
    }
}

fn replace(
    path: &Path,
    write: impl FnOnce(&mut File) -> std::io::Result<()>,
) -> std::io::Result<()> {
    // Through a link to the file it names, so that the link stays one.
    let target = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    if target.is_dir() {
        return Err(std::io::Error::new(std::io::ErrorKind::IsADirectory, "it is a directory"));
    }
    // A device or a pipe has no content to protect, and must not be replaced by a file.
    if target.exists() && !target.is_file() {
        return write(&mut File::options().write(true).truncate(true).open(&target)?);
    }
    let parent = target.parent().filter(|parent| !parent.as_os_str().is_empty());
    let mut file = builder().tempfile_in(parent.unwrap_or_else(|| Path::new(".")))?;
    write(file.as_file_mut())?;
    file.as_file().sync_all()?;
    if let Ok(old) = target.metadata() {
        file.as_file().set_permissions(old.permissions())?;
    }
    file.persist(&target)?;
    Ok(())
}

#[cfg(unix)]
fn builder() -> Builder<'static, 'static> {
    use std::os::unix::fs::PermissionsExt;
    let mut builder = Builder::new();
    // As any other new file; the user's mask still applies.
    builder.prefix(".aep-").permissions(std::fs::Permissions::from_mode(0o666));
    builder
}

#[cfg(not(unix))]
fn builder() -> Builder<'static, 'static> {
    let mut builder = Builder::new();
    builder.prefix(".aep-");
    builder
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_replaced_and_nothing_is_left_beside_it() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.json");
        save(&path, b"old").unwrap();
        save(&path, b"new").unwrap();
        assert_eq!(std::fs::read(&path).unwrap(), b"new");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
    }

    #[test]
    fn a_folder_that_is_not_there_is_named() {
        let error = save(Path::new("/no/such/folder/out.json"), b"x").unwrap_err();
        assert!(error.to_string().contains("/no/such/folder/out.json"));
        assert!(!error.to_string().contains(".aep-"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn a_link_stays_a_link_and_a_new_file_can_be_read_by_others() {
        use std::os::unix::fs::PermissionsExt;
        let folder = tempfile::tempdir().unwrap();
        let (file, link) = (folder.path().join("file"), folder.path().join("link"));
        save(&file, b"old").unwrap();
        assert_ne!(file.metadata().unwrap().permissions().mode() & 0o044, 0);
        std::os::unix::fs::symlink(&file, &link).unwrap();
        save(&link, b"new").unwrap();
        assert!(link.symlink_metadata().unwrap().is_symlink());
        assert_eq!(std::fs::read(&file).unwrap(), b"new");
    }
}
