//! What tests of exported C code share.

use std::path::{Path, PathBuf};
use std::process::Command;

/// A folder that is gone with the test.
pub(crate) struct Folder(PathBuf);

impl Folder {
    pub fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("aep-export-{}-{name}", std::process::id()));
        std::fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Where it is.
    pub fn path(&self) -> &Path {
        &self.0
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = std::fs::remove_dir_all(&self.0);
    }
}

/// The C compiler, `CC` or `cc`; none where there is none.
pub(crate) fn compiler() -> Option<String> {
    let name = std::env::var("CC").unwrap_or_else(|_| "cc".into());
    if Command::new(&name).arg("--version").output().is_ok_and(|out| out.status.success()) {
        return Some(name);
    }
    eprintln!(
        "SKIPPED: there is no C compiler '{name}', so that the exported C code was not compiled"
    );
    None
}
