//! Structures in MATLAB v5 files: their fields as variables called `log.q`, which no reader of arrays gives.
//!
//! The body of a structure is, after what every variable begins with, the length of a field's name (padded, the same for
//! all), their names, and then a matrix without a name for every field of every element. Fields of a structure in an
//! array of several are called `log_0.q`, `log_1.q`.

use std::io::Read;
use std::sync::Arc;

use libflate::zlib::Decoder;

use crate::mat_index::{Entry, Order, STRUCTURE, element, head_of, text};

/// Most levels of structures within structures.
const DEEPEST: usize = 8;
/// Most elements of an array of structures whose fields are listed.
const MOST_ELEMENTS: usize = 64;
/// Most fields of a structure.
const MOST_FIELDS: usize = 4096;
/// Most bytes of a structure: a file can claim any size.
const MOST_BYTES: u64 = 1 << 33;
/// A tag: type and size.
const TAG: usize = 8;
const MATRIX: u32 = 14;

/// Replaces every structure in `entries`, the variables of the file `bytes`, by its fields; what cannot be listed stays.
pub(crate) fn spread(order: Order, bytes: &[u8], entries: Vec<Entry>) -> Vec<Entry> {
    let mut all = Vec::new();
    for entry in entries {
        let found = if entry.class == STRUCTURE { fields_of(order, bytes, &entry) } else { None };
        match found {
            Some(fields) if !fields.is_empty() => all.extend(fields),
            _ => all.push(entry),
        }
    }
    without_common_name(&mut all);
    all
}

/// Where all columns are in one structure, its name tells nothing.
fn without_common_name(entries: &mut [Entry]) {
    let first = entries.first().and_then(|entry| entry.name.rsplit_once('.'));
    let Some(prefix) = first.map(|(first, _)| format!("{first}.")) else { return };
    if entries.iter().all(|entry| entry.name.starts_with(&prefix)) {
        for entry in entries {
            entry.name.drain(..prefix.len());
        }
    }
}

/// The element of a field with a name, without which the reader of arrays takes none.
pub(crate) fn named(order: Order, mut field: Vec<u8>) -> Vec<u8> {
    // An empty name is a tag without a body; one of a letter is of the same length.
    let name = head_of(order, &field, TAG).map(|(_, content)| content - TAG..content);
    if let Some(tag) = name.and_then(|name| field.get_mut(name)) {
        tag.copy_from_slice(&order.tag_of_a_letter());
    }
    field
}

fn fields_of(order: Order, bytes: &[u8], entry: &Entry) -> Option<Vec<Entry>> {
    let outer = bytes.get(entry.bytes.clone())?;
    let body = if order.word(outer, 0)? == MATRIX {
        outer.get(TAG..)?.to_vec()
    } else {
        let mut inflated = Vec::new();
        let decoder = Decoder::new(outer.get(TAG..)?).ok()?;
        decoder.take(MOST_BYTES).read_to_end(&mut inflated).ok()?;
        inflated.get(TAG..)?.to_vec()
    };
    let mut fields = Vec::new();
    list(order, &Arc::new(body), 0, &entry.name, 0, &mut fields)?;
    Some(fields)
}

/// Lists the fields of the structure whose body begins at `at`.
fn list(
    order: Order,
    body: &Arc<Vec<u8>>,
    at: usize,
    name: &str,
    depth: usize,
    out: &mut Vec<Entry>,
) -> Option<()> {
    let (head, mut next) = head_of(order, body, at)?;
    let elements = head.size.iter().try_fold(1usize, |product, size| product.checked_mul(*size))?;
    let (length, after) = element(order, body, next)?;
    let length = order.word(length, 0)? as usize;
    let (names, after) = element(order, body, after)?;
    next = after;
    if length == 0 || elements > MOST_ELEMENTS || names.len() / length > MOST_FIELDS {
        return None;
    }
    let names: Vec<String> = names.chunks_exact(length).map(text).collect();
    for k in 0..elements {
        for field in &names {
            let own = if elements == 1 { name.to_owned() } else { format!("{name}_{k}") };
            let own = format!("{own}.{field}");
            if order.word(body, next)? != MATRIX {
                return None;
            }
            let size = order.word(body, next + 4)? as usize;
            let (begin, end) = (next + TAG, (next + TAG).checked_add(size)?);
            let range = next..end;
            next = end;
            // A field that nobody has filled has no body.
            if size == 0 || body.len() < end {
                continue;
            }
            let (head, _) = head_of(order, body, begin)?;
            if head.class == STRUCTURE && depth < DEEPEST {
                let before = out.len();
                if list(order, body, begin, &own, depth + 1, out).is_some() {
                    continue;
                }
                out.truncate(before);
            }
            out.push(Entry { name: own, bytes: range, within: Some(Arc::clone(body)), ..head });
        }
    }
    Some(())
}
