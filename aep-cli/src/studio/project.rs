//! The folder of a project. Every file in it is written whole or not at all.
//!
//! | file | what it is | read by |
//! |---|---|---|
//! | `data/RUN.csv`, `data/RUN.toml` | the recording as it was given, and how it is read | every command |
//! | `models/ID.json` | a model | `--model` |
//! | `effects/NAME.toml` | a law of the user's | `--effects-file` |
//! | `exports/` | reports, series, C, motions | people |
//! | `studio.json` | the tree of models with their errors | the studio |
//! | `truth.json` | what a riddle hides | the studio, when it is revealed |
//! | `job.json` | the task in progress; left behind where the server was killed | the studio |

use std::collections::BTreeMap;
use std::fs::File;
use std::path::{Path, PathBuf};

use friction_ident::Model;
use missing_physics::Hold;
use serde::{Deserialize, Serialize};
use serde_json::Value;

use super::riddle::Riddle;
use super::task::Task;
use super::tree::Tree;
use crate::failure::Failure;
use crate::{output, steps};

const STATE: &str = "studio.json";
const JOB: &str = "job.json";
const LOCK: &str = "studio.lock";
/// Folders whose files may be downloaded.
const SHOWN: [&str; 4] = ["data", "models", "effects", "exports"];
/// Longest name of a file, bytes.
const LONGEST: usize = 80;
/// Version of `studio.json`.
const VERSION: u32 = 1;

/// What a search said, and of which model.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Said {
    /// The last model.
    pub id: u32,
    /// Whether that one leaves no more than the sensors make.
    pub complete: bool,
    /// The verdict in two or three words.
    pub verdict: String,
    /// The same in sentences.
    pub summary: String,
    /// What else is to be known.
    pub notes: Vec<String>,
}

/// How the force acts between samples, where nobody said it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Decided {
    /// What predicts better.
    #[serde(with = "hold")]
    pub hold: Hold,
    /// Whether the simplest model hardly tells.
    pub doubtful: bool,
}

/// What is kept of a project beside its other files.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Version of this file.
    pub version: u32,
    /// Name of the recording in `data/` that the models are of.
    pub data: Option<String>,
    /// Name of a recording there that was brought and not read yet.
    #[serde(default)]
    pub brought: Option<String>,
    /// How the force acts between samples, where that was decided by what predicts better.
    #[serde(default)]
    pub hold: Option<Decided>,
    /// The models.
    pub tree: Tree,
    /// What the last search said.
    #[serde(default)]
    pub said: Option<Said>,
    /// The riddle that is being solved.
    #[serde(default)]
    pub riddle: Option<Riddle>,
    /// Points of the riddles that were solved.
    #[serde(default)]
    pub points: u32,
}

/// What was found beside the models; it is asked for again after a restart.
#[derive(Debug, Default)]
pub struct Beside {
    /// Which effect each model lacks, as the page is told.
    pub suggestions: BTreeMap<u32, Value>,
    /// The motion to run next.
    pub motion: Option<Value>,
    /// The compensator that was simulated, as the page is told, and its card.
    pub control: Option<(Value, String)>,
    /// Why the last task ended without a result, as the page is told.
    pub failed: Option<Value>,
}

/// The folder and what is in it.
pub struct Project {
    folder: PathBuf,
    /// What is kept.
    pub state: State,
    /// What is not.
    pub beside: Beside,
    /// Held as long as the studio runs.
    _lock: File,
}

impl Project {
    /// Opens a folder; made where it is not there.
    pub fn open(folder: &Path) -> Result<Self, Failure> {
        output::make_folder(folder)?;
        let folder = folder.canonicalize().map_err(|error| {
            Failure::bad_input(format!("cannot open the project: {error}")).in_file(folder)
        })?;
        let lock = locked(&folder)?;
        let state = read_state(&folder.join(STATE))?;
        Ok(Self { folder, state, beside: Beside::default(), _lock: lock })
    }

    /// Where it is.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Writes what is kept.
    pub fn save(&self) -> Result<(), Failure> {
        output::save_json(
            &self.folder.join(STATE),
            &State { version: VERSION, ..self.state.clone() },
        )
    }

    /// A file of one of its folders, to be written; the folder is made.
    pub fn place(&self, room: &str, name: &str) -> Result<PathBuf, Failure> {
        let folder = self.folder.join(room);
        output::make_folder(&folder)?;
        Ok(folder.join(safe_name(name)))
    }

    /// A file that may be downloaded: `exports/report.html`. Nothing outside the folder, whatever the path says.
    pub fn file(&self, path: &str) -> Result<PathBuf, Failure> {
        let refused = || {
            Failure::bad_input("there is no such file in the project")
                .with_hint("files lie in data, models, effects and exports")
        };
        let found = self.folder.join(path).canonicalize().map_err(|_| refused())?;
        let room = found.strip_prefix(&self.folder).ok().and_then(|inside| inside.iter().next());
        let room = room.and_then(|room| room.to_str()).unwrap_or_default();
        if SHOWN.contains(&room) && found.is_file() { Ok(found) } else { Err(refused()) }
    }

    /// The recording that the models are of.
    pub fn recording(&self) -> Result<PathBuf, Failure> {
        let name = self.state.data.as_ref().ok_or_else(|| {
            Failure::bad_input("there is no recording yet")
                .with_hint("choose a file, or the example")
        })?;
        Ok(self.folder.join("data").join(safe_name(name)))
    }

    /// A model by its number.
    pub fn model(&self, id: u32) -> Result<Model, Failure> {
        if self.state.tree.get(id).is_none() {
            return Err(Failure::bad_input(format!("there is no model {id}")));
        }
        steps::read_model(&self.model_path(id))
    }

    /// The file of a model.
    pub fn model_path(&self, id: u32) -> PathBuf {
        self.folder.join("models").join(format!("{id}.json"))
    }

    /// The laws of the user's.
    pub fn effect_files(&self) -> Result<Vec<PathBuf>, Failure> {
        let folder = self.folder.join("effects");
        if !folder.is_dir() {
            return Ok(Vec::new());
        }
        let entries = std::fs::read_dir(&folder).map_err(|error| {
            Failure::bad_input(format!("cannot read the effects: {error}")).in_file(&folder)
        })?;
        let paths = entries.flatten().map(|entry| entry.path());
        let mut files: Vec<PathBuf> =
            paths.filter(|path| path.extension().is_some_and(|ending| ending == "toml")).collect();
        files.sort();
        Ok(files)
    }

    /// Keeps a task until it is done.
    pub fn begin(&self, task: &Task) -> Result<(), Failure> {
        output::save_json(&self.folder.join(JOB), task)
    }

    /// The task that was in progress when the server was killed.
    pub fn interrupted(&self) -> Option<Task> {
        let text = std::fs::read_to_string(self.folder.join(JOB)).ok()?;
        serde_json::from_str(&text).ok()
    }

    /// No task is in progress.
    pub fn end(&self) {
        // Where it is not there it is gone.
        let _ = std::fs::remove_file(self.folder.join(JOB));
    }
}

/// One studio a folder: two would write over each other.
fn locked(folder: &Path) -> Result<File, Failure> {
    let path = folder.join(LOCK);
    let cannot = |error: std::io::Error| {
        Failure::bad_input(format!("cannot use the folder: {error}"))
            .in_file(&path)
            .with_hint("give a folder that may be written to: --project FOLDER")
    };
    let file = File::options().create(true).append(true).open(&path).map_err(cannot)?;
    match file.try_lock() {
        Ok(()) => Ok(file),
        Err(std::fs::TryLockError::WouldBlock) => {
            Err(Failure::bad_input("another studio has this project open")
                .in_file(folder)
                .with_hint("end it first, or give another folder: --project FOLDER"))
        }
        Err(std::fs::TryLockError::Error(error)) => Err(cannot(error)),
    }
}

fn read_state(path: &Path) -> Result<State, Failure> {
    if !path.exists() {
        return Ok(State::default());
    }
    let hint = "give another folder with --project, or take this file away: models and data stay";
    let bad = |what: String| Failure::bad_input(what).in_file(path).with_hint(hint);
    let text =
        std::fs::read_to_string(path).map_err(|error| bad(format!("cannot read: {error}")))?;
    let state: State =
        serde_json::from_str(&text).map_err(|error| bad(format!("this is no project: {error}")))?;
    if state.version > VERSION {
        return Err(bad(format!("it is of a later aep (version {})", state.version)));
    }
    Ok(state)
}

/// A name without folders and whatever a system may take for more than a name.
pub fn safe_name(name: &str) -> String {
    let last = name.rsplit(['/', '\\']).next().unwrap_or_default();
    let safe = |c: char| if c.is_alphanumeric() || "._-+ ".contains(c) { c } else { '_' };
    let mut safe: String = last.chars().map(safe).collect();
    // The ending says what it is.
    while safe.len() > LONGEST {
        safe.remove(0);
    }
    let trimmed = safe.trim_matches([' ', '.']);
    if trimmed.is_empty() { "unnamed".to_owned() } else { trimmed.to_owned() }
}

/// A hold by its name.
mod hold {
    use aep_data::{hold_name, parse_hold};
    use missing_physics::Hold;
    use serde::{Deserialize, Deserializer, Serializer, de};

    #[expect(clippy::trivially_copy_pass_by_ref, reason = "serde asks so")]
    pub fn serialize<S: Serializer>(hold: &Hold, to: S) -> Result<S::Ok, S::Error> {
        to.serialize_str(hold_name(*hold))
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(from: D) -> Result<Hold, D::Error> {
        parse_hold(&String::deserialize(from)?).map_err(de::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_stays_in_its_folder() {
        for (given, safe) in [
            ("run.csv", "run.csv"),
            ("../../etc/passwd", "passwd"),
            ("..\\..\\boot.ini", "boot.ini"),
            ("..", "unnamed"),
            ("", "unnamed"),
            (".hidden", "hidden"),
            ("a\0b<script>.csv", "a_b_script_.csv"),
        ] {
            assert_eq!(safe_name(given), safe);
        }
        let long = safe_name(&format!("{}.csv", "é".repeat(300)));
        assert!(long.len() <= LONGEST && long.rsplit('.').next() == Some("csv"), "{long}");
    }

    #[test]
    fn only_files_of_its_rooms_are_handed_out() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join("secret.txt"), "s").unwrap();
        let inside = folder.path().join("p");
        let project = Project::open(&inside).unwrap();
        project.save().unwrap();
        std::fs::write(project.place("exports", "r.html").unwrap(), "r").unwrap();
        assert!(project.file("exports/r.html").is_ok());
        for path in [
            "studio.json",
            "../secret.txt",
            "exports/../studio.json",
            "exports/../../secret.txt",
            "/etc/passwd",
            "exports",
            "",
            "truth.json",
        ] {
            assert!(project.file(path).is_err(), "{path}");
        }
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(
                folder.path().join("secret.txt"),
                inside.join("exports/link"),
            )
            .unwrap();
            assert!(project.file("exports/link").is_err());
        }
    }

    #[test]
    fn one_studio_has_a_folder_and_what_it_kept_is_read_again() {
        let folder = tempfile::tempdir().unwrap();
        let mut project = Project::open(folder.path()).unwrap();
        assert!(Project::open(folder.path()).is_err());
        project.state.hold = Some(Decided { hold: Hold::ZeroOrder, doubtful: true });
        project.state.data = Some("run.csv".to_owned());
        project.save().unwrap();
        let task = Task::Suggest { from: 3 };
        project.begin(&task).unwrap();
        let state = State { version: VERSION, ..project.state.clone() };
        drop(project);
        let again = Project::open(folder.path()).unwrap();
        assert_eq!((again.state.clone(), again.interrupted()), (state, Some(task)));
        again.end();
        assert_eq!(again.interrupted(), None);
    }
}
