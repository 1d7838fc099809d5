//! What goes wrong while an output is written: the rows of "Faults" in docs/hard-inputs.md.

#![cfg(unix)]

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use crate::harness::Desk;
use crate::same_bytes::{content, files};

const IDENTIFY: &str = "identify c/recording.csv --effects coulomb,viscous -q";
const RUN: &str =
    "optimize rosenbrock --dimension 3 --algorithm de --evaluations 4000 --target 0 -q";

/// Every single file that the tool writes: its name, and the command, which ends with the flag.
fn outputs() -> Vec<(&'static str, String)> {
    let identify = |flag: &str| format!("{IDENTIFY} {flag}");
    let export = |to: &str| format!("export -q --to {to} -o");
    let optimize = "optimize f1 --trials 2 --evaluations 400 -q";
    vec![
        ("model.json", identify("-o")),
        ("results.json", identify("--json")),
        ("report.html", identify("--html")),
        ("series.csv", identify("--series")),
        ("series.parquet", identify("--series")),
        ("trials.json", format!("{optimize} --json")),
        ("trials.html", format!("{optimize} --html")),
        ("run.ckpt", format!("{RUN} --checkpoint")),
        ("drive.fmu", export("fmu --source-only")),
        ("drive.xml", export("mjcf")),
        ("drive.urdf", export("urdf")),
        ("exported.json", export("json")),
        ("schema.json", export("schema")),
        ("motion.csv", "simulate --model table.json --input c/recording.csv -q -o".to_owned()),
        ("tracking.csv", "control --model table.json --reference sine:5mm,0.5Hz -q -o".to_owned()),
    ]
}

/// The outputs that are folders of files.
const FOLDERS: [&str; 4] = [
    "optimize f1 --trials 2 --evaluations 400 -q -o",
    "reproduce fig4 --trials 2 --no-readings -q -o",
    "challenge --hide stribeck --seed 1 -q -o",
    "export -q --to c -o",
];

fn desk() -> Desk {
    let desk = Desk::new();
    desk.challenge("nothing", 1, "c");
    desk.aep("export -q --to json -o table.json").done();
    desk
}

/// The content of a file; of a checkpoint, which counts its seconds, what a resumed run says.
fn said(desk: &Desk, name: &str) -> Vec<u8> {
    if name != "run.ckpt" {
        return content(&desk.path(name));
    }
    let line = RUN.replace(" -q", "");
    desk.aep(&format!("{line} --resume run.ckpt")).done().as_bytes().to_vec()
}

/// Names of what lies in the folder of the desk and was not finished.
fn unfinished(folder: &Path) -> Vec<String> {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name());
    let names = names.map(|name| name.into_string().unwrap());
    let new = |name: &str| Path::new(name).extension().is_some_and(|ending| ending == "new");
    names.filter(|name| name.starts_with(".aep-") || new(name)).collect()
}

#[test]
fn a_program_killed_while_it_writes_leaves_the_old_file_or_the_new_one() {
    let mut between = 0;
    let (whole, desk) = (desk(), desk());
    for (name, command) in outputs() {
        whole.aep(&format!("{command} {name}")).done();
        let new = said(&whole, name);
        let line = format!("{command} {name}");
        let old = if name == "run.ckpt" {
            // The old one is a checkpoint, too.
            desk.aep(&format!("{line} --evaluations 2000").replace("--evaluations 4000", ""))
                .done();
            fs::read(desk.path(name)).unwrap()
        } else {
            b"old".to_vec()
        };
        for _ in 0..3 {
            fs::write(desk.path(name), &old).unwrap();
            let started = || !unfinished(&desk.path(".")).is_empty();
            if desk.killed(&line, started).is_none() {
                between += usize::from(started());
                for left in unfinished(&desk.path(".")) {
                    fs::remove_file(desk.path(&left)).unwrap();
                }
            }
            if fs::read(desk.path(name)).unwrap() != old {
                assert!(said(&desk, name) == new, "{name} is neither");
            }
        }
        // What was left beside it is in nobody's way.
        desk.aep(&line).done();
        assert!(said(&desk, name) == new, "{name}");
    }
    println!("killed {between} times between the first byte and the new name");
    assert!(between > 0, "no kill came while a file was written");
}

#[test]
fn a_program_killed_while_it_writes_a_folder_leaves_whole_files() {
    let mut killed = 0;
    for command in FOLDERS {
        let line = format!("{command} out");
        let whole = Desk::new();
        whole.aep(&line).done();
        let expected = files(&whole.path("out"));
        let desk = Desk::new();
        for count in 1..=expected.len() {
            let folder = desk.path("out");
            let there = || fs::read_dir(&folder).map_or(0, Iterator::count) >= count;
            killed += usize::from(desk.killed(&line, there).is_none());
            let found = if folder.exists() { files(&folder) } else { continue };
            for (name, bytes) in found {
                assert!(name.starts_with(".aep-") || bytes == expected[&name], "{line}: {name}");
            }
            fs::remove_dir_all(&folder).unwrap();
        }
    }
    assert!(killed > 0, "no kill came while a folder was written");
}

/// A limit of the size of files is a disk that is full after some bytes.
#[test]
fn a_disk_that_becomes_full_leaves_the_old_file_and_nothing_beside_it() {
    const FULL: &str = "trap '' XFSZ; ulimit -f 0";
    let desk = desk();
    for (name, command) in outputs() {
        desk.write(name, "old");
        let run = desk.shell(FULL, &command, name);
        assert!(matches!(run.code, Some(1 | 2)), "{name}: {:?} {}", run.code, run.err);
        assert!(run.err.contains("cannot write") && run.err.contains("too large"), "{}", run.err);
        assert_eq!(desk.read(name), "old");
        assert_eq!(unfinished(&desk.path(".")), [""; 0], "{name}");
    }
    for command in FOLDERS {
        let run = desk.shell(FULL, command, "out");
        assert!(matches!(run.code, Some(1 | 2)), "{command}: {:?} {}", run.code, run.err);
        assert!(run.err.contains("cannot write"), "{}", run.err);
        let left = files(&desk.path("out"));
        assert!(left.values().all(Vec::is_empty) && unfinished(&desk.path("out")).is_empty());
    }
    let run = desk.shell(FULL, &format!("{RUN} --trace"), "trace.csv");
    assert_eq!(run.code, Some(1));
    assert!(run.err.contains("cannot write the trace") && run.err.contains("trace.csv"));
}

#[cfg(target_os = "linux")]
#[test]
fn a_device_that_is_full_is_an_error_and_stays_a_device() {
    use std::os::unix::fs::{FileTypeExt, symlink};
    let desk = desk();
    let mut outputs = outputs();
    outputs.push(("trace.csv", format!("{RUN} --trace")));
    for (name, command) in outputs {
        symlink("/dev/full", desk.path(name)).unwrap();
        let run = desk.aep(&format!("{command} {name}"));
        assert!(matches!(run.code, Some(1 | 2)), "{name}: {:?} {}", run.code, run.err);
        assert!(run.err.contains("cannot write") && run.err.contains("No space"), "{}", run.err);
        assert!(desk.path(name).symlink_metadata().unwrap().is_symlink());
        assert!(fs::metadata("/dev/full").unwrap().file_type().is_char_device());
    }
    let run = desk.shell("", &format!("{IDENTIFY} --json -"), "> /dev/full");
    assert_eq!(run.code, Some(1), "{}", run.err);
    assert!(run.err.contains("cannot print"), "{}", run.err);
}

#[test]
fn a_folder_that_may_not_be_written_to_is_named() {
    use std::os::unix::fs::PermissionsExt;
    let desk = desk();
    fs::create_dir(desk.path("closed")).unwrap();
    fs::set_permissions(desk.path("closed"), fs::Permissions::from_mode(0o555)).unwrap();
    // Permissions do not stop the superuser; the system's own tree does.
    let may = fs::write(desk.path("closed/probe"), "").is_ok();
    let closed = if may { "/sys".to_owned() } else { "closed".to_owned() };
    for (name, command) in outputs() {
        let run = desk.aep(&format!("{command} {closed}/{name}"));
        assert!(matches!(run.code, Some(1 | 2)), "{name}: {:?} {}", run.code, run.err);
        let named = run.err.contains(&closed) && run.err.contains(name);
        assert!(run.err.contains("cannot write") && named, "{}", run.err);
    }
    for command in FOLDERS {
        let run = desk.aep(&format!("{command} {closed}/out"));
        run.refused(&["cannot make the folder", &format!("{closed}/out")]);
    }
}

#[test]
fn a_folder_in_place_of_a_file_and_the_reverse_are_refused() {
    let desk = desk();
    for (name, command) in outputs() {
        fs::create_dir(desk.path(name)).unwrap();
        let run = desk.aep(&format!("{command} {name}"));
        assert!(matches!(run.code, Some(1 | 2)), "{name}: {:?} {}", run.code, run.err);
        let named = run.err.contains("it is a directory") && run.err.contains(name);
        assert!(named && unfinished(&desk.path(".")).is_empty(), "{}", run.err);
    }
    desk.write("file", "mine");
    for command in FOLDERS {
        desk.aep(&format!("{command} file")).refused(&["cannot make the folder", "file"]);
    }
    assert_eq!(desk.read("file"), "mine");
}

#[test]
fn a_pipe_that_nobody_reads_is_no_failure() {
    let desk = desk();
    for line in
        ["identify c/recording.csv --effects coulomb --json -", "problems", "effects", "help"]
    {
        let run = desk.shell("trap '' PIPE", line, "| true; echo");
        assert!(!run.err.contains("panicked") && !run.err.contains("error"), "{line}: {}", run.err);
    }
    // Files are written all the same, whoever listens.
    let line = format!("{IDENTIFY} -o model.json").replace(" -q", "");
    for (name, behind) in [("out", "| true"), ("err", "2>&1 | true"), ("none", ">&- 2>&- <&-")] {
        desk.shell("", &line, behind);
        let started = Instant::now();
        while !desk.path("model.json").exists() && started.elapsed() < Duration::from_mins(1) {
            std::thread::sleep(Duration::from_millis(5));
        }
        assert!(desk.read("model.json").contains("viscous"), "{name}");
        fs::remove_file(desk.path("model.json")).unwrap();
    }
    let refused = desk.shell("", "discover none.csv", "2>&-");
    assert_eq!((refused.code, refused.err.as_str()), (Some(2), ""));
}

#[test]
fn without_a_terminal_the_same_is_printed_and_written() {
    let desk = desk();
    let line = format!("{IDENTIFY} -o model.json").replace(" -q", "");
    let piped = desk.aep(&line);
    let model = desk.read("model.json");
    let alone = desk.shell("unset TERM HOME; cd .", &line, "> out.txt < /dev/null");
    assert_eq!((alone.code, desk.read("model.json")), (Some(0), model));
    assert_eq!(desk.read("out.txt"), piped.done());
    assert!(!piped.out.contains('\u{1b}'), "{}", piped.out);
}
