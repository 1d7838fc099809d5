//! Running `aep` in a folder of its own.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use serde_json::Value;
use tempfile::TempDir;

/// What a run of `aep` left.
pub struct Run {
    pub code: Option<i32>,
    pub out: String,
    pub err: String,
}

impl Run {
    /// Standard output of a run that did its work.
    #[track_caller]
    pub fn done(&self) -> &str {
        assert_eq!(self.code, Some(0), "{}{}", self.out, self.err);
        &self.out
    }

    /// Standard error of a run that was refused, which must hold all `parts`.
    #[track_caller]
    pub fn refused(&self, parts: &[&str]) -> &str {
        assert_eq!(self.code, Some(2), "{}{}", self.out, self.err);
        for part in parts {
            assert!(self.err.contains(part), "'{part}' is not in:\n{}", self.err);
        }
        &self.err
    }
}

fn run(output: Output) -> Run {
    Run {
        code: output.status.code(),
        out: String::from_utf8(output.stdout).unwrap(),
        err: String::from_utf8(output.stderr).unwrap(),
    }
}

/// A folder to work in.
pub struct Desk {
    folder: TempDir,
}

impl Desk {
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap() }
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        std::fs::write(self.path(name), content).unwrap();
    }

    pub fn read(&self, name: &str) -> String {
        std::fs::read_to_string(self.path(name)).unwrap()
    }

    pub fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.read(name)).unwrap()
    }

    /// Runs `aep` with the words of `line`.
    pub fn aep(&self, line: &str) -> Run {
        let words: Vec<String> = line.split_whitespace().map(str::to_owned).collect();
        self.words(&words)
    }

    /// Runs `aep` with these words, which may hold blanks.
    pub fn words(&self, words: &[String]) -> Run {
        let output = Command::new(env!("CARGO_BIN_EXE_aep"))
            .args(words)
            .current_dir(self.folder.path())
            .env_remove("NO_COLOR")
            .output()
            .unwrap();
        run(output)
    }

    /// Runs `aep` through `sh` with a line in front of it, such as a limit or a redirection behind it.
    #[cfg(unix)]
    pub fn shell(&self, before: &str, line: &str, behind: &str) -> Run {
        let script = format!("{before}\nexec \"$AEP\" {line} {behind}");
        let output = Command::new("sh")
            .args(["-c", &script])
            .env("AEP", env!("CARGO_BIN_EXE_aep"))
            .current_dir(self.folder.path())
            .stdin(std::process::Stdio::null())
            .output()
            .unwrap();
        run(output)
    }

    /// Starts `aep` and kills it with SIGKILL as soon as `now` says so; how it ended where it was sooner.
    pub fn killed(&self, line: &str, mut now: impl FnMut() -> bool) -> Option<Run> {
        let mut command = Command::new(env!("CARGO_BIN_EXE_aep"));
        command.args(line.split_whitespace()).current_dir(self.folder.path());
        command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped());
        let mut child = command.spawn().unwrap();
        while !now() {
            if child.try_wait().unwrap().is_some() {
                return Some(run(child.wait_with_output().unwrap()));
            }
            std::thread::yield_now();
        }
        child.kill().unwrap();
        let ended = run(child.wait_with_output().unwrap());
        // It may have ended between the last look and the kill.
        ended.code.is_some().then_some(ended)
    }

    /// Runs `aep` and sends it Ctrl-C after `seconds`; sooner where it had ended by itself before that.
    #[cfg(unix)]
    pub fn interrupted(&self, line: &str, seconds: f64) -> Run {
        self.interrupted_where(line, seconds, |run| run.code != Some(0))
    }

    /// As [`interrupted`](Self::interrupted), earlier also where it was not `cut` yet.
    #[cfg(unix)]
    pub fn interrupted_where(&self, line: &str, seconds: f64, cut: impl Fn(&Run) -> bool) -> Run {
        let run = self.interrupted_once(line, seconds);
        if !cut(&run) && seconds > 0.05 {
            return self.interrupted_where(line, 0.5 * seconds, cut);
        }
        run
    }

    #[cfg(unix)]
    fn interrupted_once(&self, line: &str, seconds: f64) -> Run {
        let mut command = Command::new(env!("CARGO_BIN_EXE_aep"));
        command.args(line.split_whitespace()).current_dir(self.folder.path());
        command.stdout(std::process::Stdio::piped()).stderr(std::process::Stdio::piped());
        let child = command.spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_secs_f64(seconds));
        let process = child.id().to_string();
        assert!(Command::new("kill").args(["-INT", &process]).status().unwrap().success());
        run(child.wait_with_output().unwrap())
    }

    /// A recording with `effect` hidden in it, in the folder `name`.
    pub fn challenge(&self, effect: &str, seed: u64, name: &str) {
        self.aep(&format!("challenge --hide {effect} --seed {seed} -o {name}")).done();
    }
}

/// A file of the measured data that may lie beside the project; says so where it does not.
pub fn shared(name: &str) -> Option<PathBuf> {
    there(&Path::new("../../shared/data").join(name))
}

/// A file of the repository that the package does not have; says so where it is not there.
pub fn repository(name: &str) -> Option<PathBuf> {
    there(&Path::new("..").join(name))
}

fn there(path: &Path) -> Option<PathBuf> {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join(path);
    if path.exists() {
        return path.canonicalize().ok();
    }
    eprintln!("skipped: {} is not there", path.display());
    None
}
