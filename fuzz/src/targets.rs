//! The ways in.

mod files;
mod joints;
mod runs;
mod texts;

/// A way in.
#[derive(Debug)]
pub struct Target {
    /// Its name.
    pub name: &'static str,
    /// Inputs that are as they should be.
    pub seeds: fn() -> Vec<Vec<u8>>,
    /// Takes an input and says how far it came, without the numbers in it.
    pub run: fn(&[u8]) -> String,
    /// Bytes that a reader of others' reserves and does not touch.
    pub reserves: usize,
}

impl Target {
    /// One that reserves no more than it needs.
    pub const fn new(
        name: &'static str,
        seeds: fn() -> Vec<Vec<u8>>,
        run: fn(&[u8]) -> String,
    ) -> Self {
        Self { name, seeds, run, reserves: 0 }
    }

    const fn reserving(mut self, bytes: usize) -> Self {
        self.reserves = bytes;
        self
    }
}

/// All of them.
pub static ALL: [Target; 13] = [
    files::CSV,
    files::MAT,
    files::HDF5,
    files::NPZ,
    files::PARQUET,
    files::XLSX,
    files::MCAP,
    texts::MAPPING,
    texts::FORMULA,
    texts::EFFECT,
    texts::MODEL,
    runs::CHECKPOINT,
    runs::STATE,
];

/// The one called `name`.
///
/// # Errors
/// There is none.
pub fn find(name: &str) -> anyhow::Result<&'static Target> {
    ALL.iter().find(|target| target.name == name).ok_or_else(|| {
        let all: Vec<&str> = ALL.iter().map(|target| target.name).collect();
        anyhow::anyhow!("there is no target '{name}'\n  there are: {}", all.join(", "))
    })
}

/// A sentence without what differs from input to input: numbers, what is quoted, and lists of what there is.
fn outline(sentence: &str) -> String {
    let sentence = sentence.split([':', ';', '\n']).next().unwrap_or_default();
    let mut quoted = false;
    let kept = sentence.chars().filter(|c| {
        quoted ^= matches!(c, '\'' | '"' | '`');
        !quoted && (c.is_ascii_alphabetic() || *c == ' ')
    });
    kept.take(80).collect()
}
