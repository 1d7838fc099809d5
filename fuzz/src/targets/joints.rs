//! Joint states of ROS 2 in MCAP, in CDR and in JSON.

use std::collections::BTreeMap;
use std::io::Cursor;

use mcap::WriteOptions;
use mcap::records::MessageHeader;

/// A file in each encoding.
pub fn seeds() -> Vec<Vec<u8>> {
    vec![file("cdr", cdr), file("json", json)]
}

fn file(encoding: &str, message: fn(u32, f64) -> Vec<u8>) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let options = WriteOptions::new().compression(None).chunk_size(Some(1024));
    let mut writer = options.create(&mut file).expect("it is in memory");
    let schema = writer.add_schema("sensor_msgs/msg/JointState", "ros2msg", b"").expect("a schema");
    let channel = writer.add_channel(schema, "/joint_states", encoding, &BTreeMap::new());
    let channel_id = channel.expect("a channel");
    for sequence in 0..40 {
        let log_time = u64::from(sequence) * 1_000_000;
        let header = MessageHeader { channel_id, sequence, log_time, publish_time: log_time };
        let message = message(sequence, (0.3 * f64::from(sequence)).sin());
        writer.write_to_known_channel(&header, &message).expect("it is in memory");
    }
    writer.finish().expect("it is in memory");
    drop(writer);
    file.into_inner()
}

fn json(k: u32, q: f64) -> Vec<u8> {
    let stamp = format!(r#"{{"sec":0,"nanosec":{}}}"#, k * 1_000_000);
    let joints =
        format!(r#""name":["elbow"],"position":[{q}],"velocity":[],"effort":[{}]"#, 2.0 * q);
    format!(r#"{{"header":{{"stamp":{stamp},"frame_id":""}},{joints}}}"#).into_bytes()
}

/// Numbers at multiples of their size, little endian.
fn cdr(k: u32, q: f64) -> Vec<u8> {
    let mut bytes = vec![0, 1, 0, 0];
    let mut put = |size: usize, content: &[u8]| {
        bytes.resize((bytes.len() - 4).next_multiple_of(size) + 4, 0);
        bytes.extend_from_slice(content);
    };
    put(4, &0_u32.to_le_bytes());
    put(4, &(k * 1_000_000).to_le_bytes());
    for text in ["base\0", "elbow\0"] {
        if text.starts_with('e') {
            put(4, &1_u32.to_le_bytes());
        }
        put(4, &(text.len() as u32).to_le_bytes());
        put(1, text.as_bytes());
    }
    for values in [&[q][..], &[], &[2.0 * q]] {
        put(4, &(values.len() as u32).to_le_bytes());
        for value in values {
            put(8, &value.to_le_bytes());
        }
    }
    bytes
}
