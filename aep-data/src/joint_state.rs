//! `sensor_msgs/JointState`, as CDR (what ROS 2 sends) and as JSON.

use serde::Deserialize;

/// A message: one value a joint, or none at all.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct JointState {
    /// ns.
    pub stamp: i128,
    /// Names of the joints.
    pub names: Vec<String>,
    /// rad or m.
    pub position: Vec<f64>,
    /// rad/s or m/s.
    pub velocity: Vec<f64>,
    /// N m or N.
    pub effort: Vec<f64>,
}

/// The message in `bytes`.
pub(crate) fn parse(encoding: &str, bytes: &[u8]) -> Result<JointState, String> {
    match encoding {
        "cdr" => cdr(bytes).ok_or_else(|| "no JointState in CDR".to_owned()),
        "json" => json(bytes),
        other => Err(format!("its encoding '{other}' is neither cdr nor json")),
    }
}

#[derive(Deserialize)]
struct Text {
    header: Header,
    #[serde(default)]
    name: Vec<String>,
    #[serde(default)]
    position: Vec<f64>,
    #[serde(default)]
    velocity: Vec<f64>,
    #[serde(default)]
    effort: Vec<f64>,
}

#[derive(Deserialize)]
struct Header {
    stamp: Stamp,
}

#[derive(Deserialize)]
struct Stamp {
    sec: i64,
    #[serde(alias = "nsec")]
    nanosec: u32,
}

fn json(bytes: &[u8]) -> Result<JointState, String> {
    let text: Text = serde_json::from_slice(bytes).map_err(|error| error.to_string())?;
    let Text { header: Header { stamp }, name, position, velocity, effort } = text;
    let stamp = i128::from(stamp.sec) * 1_000_000_000 + i128::from(stamp.nanosec);
    Ok(JointState { stamp, names: name, position, velocity, effort })
}

/// A place in a message; numbers are aligned to their size from the begin of the content.
struct Cursor<'a> {
    content: &'a [u8],
    at: usize,
    little: bool,
}

impl Cursor<'_> {
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let at = self.at.checked_next_multiple_of(N)?;
        let bytes = self.content.get(at..at.checked_add(N)?)?;
        self.at = at + N;
        let mut own: [u8; N] = bytes.try_into().ok()?;
        if !self.little {
            own.reverse();
        }
        Some(own)
    }

    fn word(&mut self) -> Option<u32> {
        self.bytes().map(u32::from_le_bytes)
    }

    fn text(&mut self) -> Option<String> {
        let length = self.word()? as usize;
        let bytes = self.content.get(self.at..self.at.checked_add(length)?)?;
        self.at += length;
        let bytes = bytes.strip_suffix(&[0]).unwrap_or(bytes);
        String::from_utf8(bytes.to_vec()).ok()
    }

    fn numbers(&mut self) -> Option<Vec<f64>> {
        (0..self.word()?).map(|_| self.bytes().map(f64::from_le_bytes)).collect()
    }
}

fn cdr(bytes: &[u8]) -> Option<JointState> {
    let (head, content) = bytes.split_at_checked(4)?;
    // Plain CDR, big or little endian; the second version aligns otherwise.
    let little = match head {
        [0, 0, ..] => false,
        [0, 1, ..] => true,
        _ => return None,
    };
    let mut cursor = Cursor { content, at: 0, little };
    let seconds = cursor.word()?.cast_signed();
    let nanoseconds = cursor.word()?;
    let _frame = cursor.text()?;
    let names = (0..cursor.word()?).map(|_| cursor.text()).collect::<Option<_>>()?;
    Some(JointState {
        stamp: i128::from(seconds) * 1_000_000_000 + i128::from(nanoseconds),
        names,
        position: cursor.numbers()?,
        velocity: cursor.numbers()?,
        effort: cursor.numbers()?,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// As `rmw` writes it on a little-endian machine: two joints, no velocity.
    const LITTLE: &[u8] = &[
        0, 1, 0, 0, // plain CDR, little endian
        7, 0, 0, 0, 0, 0xca, 0x9a, 0x3b, // 7 s and 10^9 ns
        2, 0, 0, 0, b'b', 0, 0, 0, // frame "b", padded
        2, 0, 0, 0, 2, 0, 0, 0, b'u', 0, 0, 0, 2, 0, 0, 0, b'v', 0, 0, 0, // "u", "v"
        2, 0, 0, 0, // two positions, at a multiple of 8
        0, 0, 0, 0, 0, 0, 0xf0, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0xc0, // 1, -2
        0, 0, 0, 0, // no velocity
        1, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0xe0, 0x3f, // one effort, 0.5
    ];

    #[test]
    fn a_message_in_cdr_is_read_with_its_padding() {
        let state = parse("cdr", LITTLE).unwrap();
        assert_eq!(state.stamp, 8_000_000_000);
        assert_eq!(state.names, ["u", "v"]);
        assert_eq!((state.position, state.velocity), (vec![1.0, -2.0], vec![]));
        assert_eq!(state.effort, [0.5]);
    }

    #[test]
    fn the_same_message_in_json_is_the_same() {
        let text = br#"{"header":{"stamp":{"sec":7,"nsec":1000000000},"frame_id":"b"},
            "name":["u","v"],"position":[1.0,-2.0],"velocity":[],"effort":[0.5]}"#;
        assert_eq!(parse("json", text).unwrap(), parse("cdr", LITTLE).unwrap());
    }

    #[test]
    fn what_is_cut_off_or_of_another_kind_is_refused() {
        for length in 0..LITTLE.len() {
            assert!(parse("cdr", &LITTLE[..length]).is_err(), "{length}");
        }
        assert!(parse("protobuf", LITTLE).unwrap_err().contains("neither cdr nor json"));
        let second = [&[0, 7, 0, 0], &LITTLE[4..]].concat();
        assert!(parse("cdr", &second).is_err());
        let endless = [&LITTLE[..20], &[0xff; 4]].concat();
        assert!(parse("cdr", &endless).is_err());
    }
}
