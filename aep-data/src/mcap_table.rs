//! MCAP, as ROS 2 and Foxglove record it: the joints of a topic of `sensor_msgs/JointState`, in CDR or JSON.
//!
//! One joint makes the columns `position`, `velocity`, `effort`; several make `position.elbow` and so on. The time is the
//! stamp of the messages, in s from the first one on; where nobody filled it in, the time at which they were logged.

use std::collections::HashMap;
use std::io::Read;
use std::path::Path;

use mcap::read::LinearReader;
use mcap::records::Record;

use crate::error::{DataError, Problem};
use crate::joint_state::{self, JointState};
use crate::memory_table::MemoryTable;

/// Most joints that become columns.
const MOST_JOINTS: usize = 64;
/// Most bytes of a chunk: a file can claim any size.
const MOST_BYTES: u64 = 1 << 32;

/// Whether these are the bytes of an MCAP file.
pub(crate) fn is_mcap(bytes: &[u8]) -> bool {
    bytes.starts_with(b"\x89MCAP0\r\n")
}

/// The joints of the topic called `wanted`, or of the only one with joints.
pub(crate) fn read(
    path: &Path,
    bytes: &[u8],
    wanted: Option<&str>,
) -> Result<MemoryTable<'static>, DataError> {
    let damaged =
        |what: String| DataError::new(path, Problem::Damaged { format: "MCAP file", what });
    let mut file = Contents::default();
    for record in LinearReader::new(bytes).map_err(|e| damaged(e.to_string()))? {
        match record.map_err(|e| damaged(e.to_string()))? {
            Record::Chunk { header, data } => {
                let plain = unpacked(&header.compression, &data, header.uncompressed_size)
                    .map_err(damaged)?;
                for record in LinearReader::sans_magic(&plain) {
                    file.take(record.map_err(|e| damaged(e.to_string()))?);
                }
            }
            record => file.take(record),
        }
    }
    let topic = file.topic(wanted).map_err(|problem| DataError::new(path, problem))?;
    MemoryTable::new(path, file.columns(&topic).map_err(damaged)?)
}

/// The records of a chunk. Both packers are decoded in Rust: the crate's own ways need a C compiler.
fn unpacked(packer: &str, data: &[u8], size: u64) -> Result<Vec<u8>, String> {
    let mut plain = Vec::new();
    let most = size.min(MOST_BYTES);
    let failed = |error: &dyn std::fmt::Display| format!("a chunk packed by {packer}: {error}");
    match packer {
        "" => plain.extend_from_slice(data),
        "lz4" => {
            lz4_flex::frame::FrameDecoder::new(data)
                .take(most)
                .read_to_end(&mut plain)
                .map_err(|error| failed(&error))?;
        }
        "zstd" => {
            ruzstd::decoding::StreamingDecoder::new(data)
                .map_err(|error| failed(&error))?
                .take(most)
                .read_to_end(&mut plain)
                .map_err(|error| failed(&error))?;
        }
        other => return Err(format!("its chunks are packed by '{other}', which is unknown")),
    }
    Ok(plain)
}

/// A topic as a file names it.
struct Channel {
    topic: String,
    schema: u16,
    encoding: String,
}

/// What a file holds.
#[derive(Default)]
struct Contents {
    schemas: HashMap<u16, String>,
    channels: HashMap<u16, Channel>,
    /// Channel, time of the log in ns, content; of joints only.
    messages: Vec<(u16, u64, Vec<u8>)>,
}

impl Contents {
    fn take(&mut self, record: Record<'_>) {
        match record {
            Record::Schema { header, .. } => {
                self.schemas.insert(header.id, header.name);
            }
            Record::Channel(channel) => {
                let (topic, encoding) = (channel.topic, channel.message_encoding);
                self.channels
                    .insert(channel.id, Channel { topic, schema: channel.schema_id, encoding });
            }
            Record::Message { header, data } if self.has_joints(header.channel_id) => {
                self.messages.push((header.channel_id, header.log_time, data.into_owned()));
            }
            _ => {}
        }
    }

    fn has_joints(&self, channel: u16) -> bool {
        let schema = self.channels.get(&channel).and_then(|c| self.schemas.get(&c.schema));
        schema.is_some_and(|name| name.starts_with("sensor_msgs/") && name.ends_with("/JointState"))
    }

    /// The topic to be read.
    fn topic(&self, wanted: Option<&str>) -> Result<String, Problem> {
        let mut present: Vec<String> = (self.channels.iter())
            .filter(|(id, _)| self.has_joints(**id))
            .map(|(_, channel)| channel.topic.clone())
            .collect();
        present.sort();
        present.dedup();
        match (wanted, present.as_slice()) {
            (Some(wanted), _) if present.iter().any(|topic| topic == wanted) => {
                Ok(wanted.to_owned())
            }
            (None, [only]) => Ok(only.clone()),
            (wanted, _) => Err(Problem::Topic { wanted: wanted.map(str::to_owned), present }),
        }
    }

    /// The joints as columns, in the order in which they were logged.
    fn columns(mut self, topic: &str) -> Result<Vec<(String, Vec<f64>)>, String> {
        let channels = &self.channels;
        self.messages.retain(|(channel, _, _)| channels[channel].topic == topic);
        self.messages.sort_by_key(|(_, logged, _)| *logged);
        let mut states = Vec::with_capacity(self.messages.len());
        for (k, (channel, logged, data)) in self.messages.iter().enumerate() {
            let state = joint_state::parse(&self.channels[channel].encoding, data)
                .map_err(|what| format!("message {} of {topic}: {what}", k + 1))?;
            states.push((i128::from(*logged), state));
        }
        drop(self);
        if states.iter().all(|(_, state)| state.stamp == 0) {
            for (logged, state) in &mut states {
                state.stamp = *logged;
            }
        }
        let states: Vec<JointState> = states.into_iter().map(|(_, state)| state).collect();
        as_columns(&states)
    }
}

/// What a message says of all joints.
type Values = fn(&JointState) -> &[f64];

fn as_columns(states: &[JointState]) -> Result<Vec<(String, Vec<f64>)>, String> {
    let mut joints: Vec<&str> = Vec::new();
    for state in states {
        for name in &state.names {
            if !joints.contains(&name.as_str()) {
                joints.push(name);
            }
        }
    }
    if joints.len() > MOST_JOINTS {
        return Err(format!("{} joints, more than {MOST_JOINTS}", joints.len()));
    }
    let first = states.first().map_or(0, |state| state.stamp);
    // Whole nanoseconds, divided once: as near to the decimal number as a number can be.
    let time = states.iter().map(|state| (state.stamp - first) as f64 / 1e9).collect();
    let mut columns = vec![("time_s".to_owned(), time)];
    for joint in &joints {
        let quantities: [(&str, Values); 3] = [
            ("position", |state| &state.position),
            ("velocity", |state| &state.velocity),
            ("effort", |state| &state.effort),
        ];
        for (quantity, of) in quantities {
            let value = |state: &JointState| {
                let place = state.names.iter().position(|name| name == joint)?;
                of(state).get(place).copied()
            };
            let values: Vec<Option<f64>> = states.iter().map(value).collect();
            if values.iter().any(Option::is_some) {
                let name = if joints.len() == 1 {
                    quantity.to_owned()
                } else {
                    format!("{quantity}.{joint}")
                };
                columns.push((name, values.into_iter().map(|v| v.unwrap_or(f64::NAN)).collect()));
            }
        }
    }
    Ok(columns)
}
