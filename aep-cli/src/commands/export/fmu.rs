//! An FMU: the sources of the library, compiled where there is a C compiler, packed into one archive.

use std::io::{Cursor, Write as _};
use std::path::Path;
use std::process::Command;

use friction_ident::Model;
use friction_ident::export::{File, to_fmu};
use zip::result::ZipError;
use zip::write::SimpleFileOptions;

use super::Args;
use super::simulators::{name, said};
use crate::failure::Failure;
use crate::output::written;

/// Options of the compiler. Nothing is fused, so that the motion is that of the library to the last digits.
const FLAGS: [&str; 6] =
    ["-std=c99", "-O2", "-ffp-contract=off", "-fPIC", "-shared", "-fvisibility=hidden"];

/// Folder and ending of the binary, as FMI 2.0 names the platforms that it knows; none on others.
const PLATFORM: Option<(&str, &str)> =
    if cfg!(all(target_os = "linux", target_arch = "x86_64")) {
        Some(("linux64", "so"))
    } else if cfg!(all(target_os = "macos", target_arch = "x86_64")) {
        Some(("darwin64", "dylib"))
    } else if cfg!(all(target_os = "windows", target_arch = "x86_64")) {
        Some(("win64", "dll"))
    } else {
        None
    };

/// Writes the FMU of `model`.
pub fn write(model: &Model, args: &Args, path: &Path) -> Result<String, Failure> {
    if path.as_os_str() == "-" {
        return Err(Failure::bad_input("an FMU is an archive: it cannot go to the terminal")
            .with_hint("name a file: --to fmu drive.fmu"));
    }
    let name = name(args, path);
    let exported = to_fmu(model, &name, args.max_step)?;
    let binary = if args.source_only {
        Err("left out, as asked".to_owned())
    } else {
        compiled(&exported.files, &name)
    };
    let archive = packed(&exported.files, binary.as_ref().ok())
        .map_err(|error| Failure::failed(format!("cannot pack the FMU: {error}")))?;
    aep_data::save(path, &archive)?;
    let said_of_binary = match &binary {
        Ok(binary) => format!("binary: {}\n", binary.name),
        Err(why) => format!("no binary: {why}; whoever imports it compiles sources/fmi2.c and sources/plant.c\n"),
    };
    Ok(said(&exported) + &said_of_binary + &written("FMU", path))
}

struct Binary {
    /// Its place in the archive.
    name: String,
    bytes: Vec<u8>,
}

/// The shared library of the sources, or why there is none.
fn compiled(files: &[File], name: &str) -> Result<Binary, String> {
    let (folder, ending) = PLATFORM.ok_or("FMI 2.0 has no name for this kind of machine")?;
    let compiler = std::env::var("CC").unwrap_or_else(|_| "cc".to_owned());
    let failed = |error: std::io::Error| format!("cannot compile: {error}");
    let room = tempfile::tempdir().map_err(failed)?;
    let sources = files.iter().filter_map(|f| Some((f.name.strip_prefix("sources/")?, &f.text)));
    for (name, text) in sources {
        std::fs::write(room.path().join(name), text).map_err(failed)?;
    }
    let library = format!("{name}.{ending}");
    let run = Command::new(&compiler)
        .current_dir(room.path())
        .args(FLAGS)
        .args(["fmi2.c", "plant.c", "-o", &library, "-lm"])
        .output()
        .map_err(|_| format!("there is no C compiler '{compiler}'"))?;
    if !run.status.success() {
        let said = String::from_utf8_lossy(&run.stderr);
        return Err(format!("'{compiler}' says: {}", said.lines().next().unwrap_or("nothing")));
    }
    let bytes = std::fs::read(room.path().join(&library)).map_err(failed)?;
    Ok(Binary { name: format!("binaries/{folder}/{library}"), bytes })
}

/// The archive; the same contents make the same bytes.
fn packed(files: &[File], binary: Option<&Binary>) -> Result<Vec<u8>, ZipError> {
    let mut archive = zip::ZipWriter::new(Cursor::new(Vec::new()));
    let options = SimpleFileOptions::default().last_modified_time(zip::DateTime::default());
    for file in files {
        archive.start_file(&file.name, options.unix_permissions(0o644))?;
        archive.write_all(file.text.as_bytes())?;
    }
    if let Some(binary) = binary {
        archive.start_file(&binary.name, options.unix_permissions(0o755))?;
        archive.write_all(&binary.bytes)?;
    }
    Ok(archive.finish()?.into_inner())
}
