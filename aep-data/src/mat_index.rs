//! The table of contents of a MATLAB v5 file.
//!
//! The reader of arrays, `matfile`, skips structures, cells and text without a word and gives up on
//! a whole file for one object it does not know. So the variables are listed here first, fields of structures among
//! them (`mat_fields.rs`), and only the numeric ones that are needed go to it, one at a time.
//!
//! Layout: 128 bytes of header; then one element a variable, a tag (type, size) and its body, which
//! is a matrix (14) or a matrix compressed by zlib (15). A matrix begins with its flags (class in
//! the lowest byte), its dimensions and its name, each an element of its own. Source:
//! "MAT-File Format" by its maker, version 5.

use std::io::Read;
use std::ops::Range;
use std::sync::Arc;

use libflate::zlib::Decoder;

use crate::mat_fields;

/// Length of the file's header.
pub(crate) const HEADER: usize = 128;
const MATRIX: u32 = 14;
const COMPRESSED: u32 = 15;
/// Flags, dimensions and name of any reasonable variable fit in here.
const HEAD: usize = 1024;

/// A variable as the file lists it.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Entry {
    /// Name.
    pub name: String,
    /// MATLAB class in words.
    pub class: &'static str,
    /// Whether its values are numbers.
    pub numeric: bool,
    /// Dimensions.
    pub size: Vec<usize>,
    /// Where its element lies, tag included: in the file, or in `within`.
    pub bytes: Range<usize>,
    /// The structure that it is a field of, unpacked.
    pub within: Option<Arc<Vec<u8>>>,
}

impl Entry {
    /// Name with class and size, e.g. `qm (1000x1)` or `log (struct)`.
    pub fn label(&self) -> String {
        if !self.numeric {
            return format!("{} ({})", self.name, self.class);
        }
        let size: Vec<String> = self.size.iter().map(usize::to_string).collect();
        format!("{} ({})", self.name, size.join("x"))
    }
}

/// Whether the file begins as a MATLAB v5 file does: its version and the mark of its byte order.
pub(crate) fn is_mat5(bytes: &[u8]) -> bool {
    bytes.len() >= HEADER && matches!(&bytes[124..128], b"\x00\x01IM" | b"\x01\x00MI")
}

/// Whether it is an HDF5 file, as version 7.3 is: the signature stands at 0 or after a user block.
pub(crate) fn is_hdf5(bytes: &[u8]) -> bool {
    const SIGNATURE: &[u8] = b"\x89HDF\r\n\x1a\n";
    let at = |offset: usize| bytes.get(offset..).is_some_and(|rest| rest.starts_with(SIGNATURE));
    at(0) || at(512) || bytes.starts_with(b"MATLAB 7.3")
}

/// Lists the variables of a v5 file, or says where it is damaged.
pub(crate) fn list(bytes: &[u8]) -> Result<Vec<Entry>, String> {
    let order = Order::of(bytes);
    let mut entries = Vec::new();
    let mut at = HEADER;
    // A few bytes of padding at the very end are no element.
    while at + 8 <= bytes.len() {
        let kind = order.word(bytes, at).unwrap_or_default();
        let size = order.word(bytes, at + 4).unwrap_or_default() as usize;
        let body = at + 8..(at + 8).saturating_add(size);
        let Some(content) = bytes.get(body.clone()) else {
            let missing = body.end - bytes.len();
            return Err(format!("it ends {missing} bytes early"));
        };
        let head = match kind {
            MATRIX => content[..content.len().min(HEAD)].to_vec(),
            COMPRESSED => inflate_head(content)?,
            other => return Err(format!("unknown element {other} at byte {at}")),
        };
        let head = if kind == COMPRESSED { head.get(8..).unwrap_or_default() } else { &head };
        let entry = entry(order, head, at..body.end);
        entries.push(entry.ok_or_else(|| format!("the variable at byte {at} is cut off"))?);
        at = body.end;
    }
    // The data of objects are stored without a name; nobody could ask for them.
    entries.retain(|entry| !entry.name.is_empty());
    Ok(mat_fields::spread(order, bytes, entries))
}

/// Order of the bytes of a number.
#[derive(Clone, Copy)]
pub(crate) enum Order {
    Little,
    Big,
}

impl Order {
    /// The order that the header of a v5 file states.
    pub(crate) fn of(header: &[u8]) -> Self {
        if header.get(126..128) == Some(b"IM") { Self::Little } else { Self::Big }
    }

    /// The element of the text "q", type and size in one word.
    pub(crate) fn tag_of_a_letter(self) -> [u8; 8] {
        match self {
            Self::Little => [1, 0, 1, 0, b'q', 0, 0, 0],
            Self::Big => [0, 1, 0, 1, b'q', 0, 0, 0],
        }
    }

    pub(crate) fn word(self, bytes: &[u8], at: usize) -> Option<u32> {
        let word: [u8; 4] = bytes.get(at..at.checked_add(4)?)?.try_into().ok()?;
        Some(match self {
            Self::Little => u32::from_le_bytes(word),
            Self::Big => u32::from_be_bytes(word),
        })
    }
}

fn inflate_head(content: &[u8]) -> Result<Vec<u8>, String> {
    let mut head = Vec::with_capacity(HEAD);
    let damaged = |error: std::io::Error| format!("a compressed variable: {error}");
    let decoder = Decoder::new(content).map_err(damaged)?;
    decoder.take(HEAD as u64).read_to_end(&mut head).map_err(damaged)?;
    Ok(head)
}

fn entry(order: Order, head: &[u8], bytes: Range<usize>) -> Option<Entry> {
    head_of(order, head, 0).map(|(entry, _)| Entry { bytes, ..entry })
}

/// What the body of a matrix that begins at `at` says of itself, and where its content begins.
pub(crate) fn head_of(order: Order, body: &[u8], at: usize) -> Option<(Entry, usize)> {
    let (flags, at) = element(order, body, at)?;
    let class = order.word(flags, 0)? & 0xff;
    let (class, numeric) = class_name(class);
    // An opaque object has its name where others have their dimensions.
    if class == "object" {
        let (name, at) = element(order, body, at)?;
        let name = text(name);
        return Some((Entry { name, class, numeric, size: vec![], bytes: 0..0, within: None }, at));
    }
    let (dimensions, at) = element(order, body, at)?;
    let size = (0..dimensions.len() / 4).filter_map(|k| order.word(dimensions, 4 * k));
    let size = size.map(|dimension| dimension as usize).collect();
    let (name, at) = element(order, body, at)?;
    Some((Entry { name: text(name), class, numeric, size, bytes: 0..0, within: None }, at))
}

/// The body of the element at `at`, and where the next one begins. A body of up to four bytes may
/// stand inside the tag.
pub(crate) fn element(order: Order, bytes: &[u8], at: usize) -> Option<(&[u8], usize)> {
    let tag = order.word(bytes, at)?;
    if tag >> 16 != 0 {
        let size = (tag >> 16) as usize;
        return Some((bytes.get(at + 4..at + 4 + size.min(4))?, at + 8));
    }
    let size = order.word(bytes, at + 4)? as usize;
    let body = bytes.get(at + 8..(at + 8).checked_add(size)?)?;
    Some((body, at + 8 + size.next_multiple_of(8)))
}

/// A name, up to the zeros that fill it up.
pub(crate) fn text(bytes: &[u8]) -> String {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    String::from_utf8_lossy(&bytes[..end]).into_owned()
}

/// The class of structures, in words.
pub(crate) const STRUCTURE: &str = "structure";

fn class_name(class: u32) -> (&'static str, bool) {
    match class {
        1 => ("cell array", false),
        2 => (STRUCTURE, false),
        4 => ("text", false),
        5 => ("sparse matrix", false),
        6..=15 => ("numeric array", true),
        16 => ("function", false),
        _ => ("object", false),
    }
}
