//! Files that a command is to write: none may be one that it reads, and no two may be the same.

use std::path::{Path, PathBuf};

use crate::failure::Failure;

/// Refuses to write over what is read, before anything was computed. `outputs` are flags with their files.
pub fn check(inputs: &[PathBuf], outputs: &[(&str, Option<&Path>)]) -> Result<(), Failure> {
    let mut seen: Vec<(&str, PathBuf)> = Vec::new();
    for (flag, path) in outputs.iter().filter_map(|(flag, path)| Some((*flag, (*path)?))) {
        // A terminal or a device has no content to lose.
        if path.as_os_str() == "-" || (path.exists() && !path.is_file()) {
            continue;
        }
        let place = place(path);
        if inputs.iter().any(|input| self::place(input) == place) {
            let what = format!("{flag} would write over a file that is read");
            return Err(Failure::bad_input(what).in_file(path).with_hint("give it another name"));
        }
        if let Some((other, _)) = seen.iter().find(|(_, other)| *other == place) {
            let what = format!("{other} and {flag} name the same file");
            return Err(Failure::bad_input(what).in_file(path).with_hint("give each its own name"));
        }
        seen.push((flag, place));
    }
    Ok(())
}

/// Where a file is, or would be: links followed.
fn place(path: &Path) -> PathBuf {
    if let Ok(there) = path.canonicalize() {
        return there;
    }
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    let folder = parent.unwrap_or_else(|| Path::new(".")).canonicalize();
    match (folder, path.file_name()) {
        (Ok(folder), Some(name)) => folder.join(name),
        _ => path.to_owned(),
    }
}
