//! MCAP: the same recording gives the same numbers as the CSV, in every encoding and packing.

use std::collections::BTreeMap;
use std::io::{Cursor, Write as _};
use std::path::{Path, PathBuf};

use aep_data::{Axes, Mapping, Source, parse, read_axes};
use mcap::records::{MessageHeader, Record};
use mcap::{WriteOptions, Writer};
use missing_physics::Recording;
use proptest::prelude::*;

/// Time in ns, position, effort.
type Row = (u64, f64, f64);

fn rows() -> Vec<Row> {
    let csv = include_str!("formats/run.csv");
    let number = |text: &str| text.parse::<f64>().unwrap();
    csv.lines()
        .skip(1)
        .map(|line| {
            let fields: Vec<&str> = line.split(',').collect();
            let time = (number(fields[0]) * 1e9).round() as u64;
            (time, number(fields[2]), number(fields[1]))
        })
        .collect()
}

/// A message of CDR: numbers at multiples of their size.
struct Cdr(Vec<u8>);

impl Cdr {
    fn bytes<const N: usize>(&mut self, bytes: [u8; N]) {
        self.0.resize((self.0.len() - 4).next_multiple_of(N) + 4, 0);
        self.0.extend(bytes);
    }

    fn text(&mut self, text: &str) {
        self.bytes((text.len() as u32 + 1).to_le_bytes());
        self.0.extend(text.bytes().chain([0]));
    }

    fn numbers(&mut self, numbers: &[f64]) {
        self.bytes((numbers.len() as u32).to_le_bytes());
        for number in numbers {
            self.bytes(number.to_le_bytes());
        }
    }
}

fn cdr(stamp: u64, names: &[&str], position: &[f64], effort: &[f64]) -> Vec<u8> {
    let mut message = Cdr(vec![0, 1, 0, 0]);
    message.bytes(((stamp / 1_000_000_000) as u32).to_le_bytes());
    message.bytes(((stamp % 1_000_000_000) as u32).to_le_bytes());
    message.text("base_link");
    message.bytes((names.len() as u32).to_le_bytes());
    for name in names {
        message.text(name);
    }
    message.numbers(position);
    message.numbers(&[]);
    message.numbers(effort);
    message.0
}

fn json(stamp: u64, names: &[&str], position: &[f64], effort: &[f64]) -> Vec<u8> {
    let (sec, nsec) = (stamp / 1_000_000_000, stamp % 1_000_000_000);
    format!(
        r#"{{"header":{{"stamp":{{"sec":{sec},"nsec":{nsec}}},"frame_id":""}},"name":{names:?},"position":{position:?},"velocity":[],"effort":{effort:?}}}"#
    )
    .into_bytes()
}

type Encode = fn(u64, &[&str], &[f64], &[f64]) -> Vec<u8>;

/// A file with these joints on each topic; `start` is the first stamp.
fn written(
    topics: &[&str],
    names: &[&str],
    (encoding, encode): (&str, Encode),
    start: u64,
) -> Vec<u8> {
    let mut file = Cursor::new(Vec::new());
    let options = WriteOptions::new().compression(None).chunk_size(Some(4096));
    let mut writer = options.create(&mut file).unwrap();
    put(&mut writer, topics, names, (encoding, encode), start);
    writer.finish().unwrap();
    drop(writer);
    file.into_inner()
}

fn put(
    writer: &mut Writer<&mut Cursor<Vec<u8>>>,
    topics: &[&str],
    names: &[&str],
    (encoding, encode): (&str, Encode),
    start: u64,
) {
    let schema = writer.add_schema("sensor_msgs/msg/JointState", "ros2msg", b"").unwrap();
    let other = writer.add_schema("std_msgs/msg/String", "ros2msg", b"").unwrap();
    let chatter = writer.add_channel(other, "/chatter", "cdr", &BTreeMap::new()).unwrap();
    let channels: Vec<u16> = (topics.iter())
        .map(|topic| writer.add_channel(schema, topic, encoding, &BTreeMap::new()).unwrap())
        .collect();
    for (k, (time, position, effort)) in rows().into_iter().enumerate() {
        let log_time = start + time + 5;
        let header = |channel_id| MessageHeader {
            channel_id,
            sequence: k as u32,
            log_time,
            publish_time: log_time,
        };
        for channel in &channels {
            let of = |value: f64| names.iter().map(|_| value).collect::<Vec<f64>>();
            let message = encode(start + time, names, &of(position), &of(effort));
            writer.write_to_known_channel(&header(*channel), &message).unwrap();
        }
        writer.write_to_known_channel(&header(chatter), b"no joints").unwrap();
    }
}

/// The same file with its chunks packed.
fn packed(bytes: &[u8], name: &str, pack: impl Fn(&[u8]) -> Vec<u8>) -> Vec<u8> {
    let mut out = mcap::MAGIC.to_vec();
    let mut record = |op: u8, body: &[u8]| {
        out.push(op);
        out.extend((body.len() as u64).to_le_bytes());
        out.extend(body);
    };
    for found in mcap::read::LinearReader::new(bytes).unwrap() {
        let Record::Chunk { header, data } = found.unwrap() else { continue };
        let small = pack(&data);
        let mut body = Vec::new();
        for number in [header.message_start_time, header.message_end_time, header.uncompressed_size]
        {
            body.extend(number.to_le_bytes());
        }
        body.extend(0u32.to_le_bytes());
        body.extend((name.len() as u32).to_le_bytes());
        body.extend(name.as_bytes());
        body.extend((small.len() as u64).to_le_bytes());
        body.extend(small);
        record(0x06, &body);
    }
    record(0x02, &[0; 20]);
    out.extend(mcap::MAGIC);
    out
}

fn bits(recording: &Recording) -> Vec<(String, Vec<u64>)> {
    let channel = |name: &str, values: &[f64]| {
        (name.to_owned(), values.iter().map(|value| value.to_bits()).collect())
    };
    let channels = recording.channels().iter().map(|c| channel(&c.name, &c.values));
    std::iter::once(channel("time", recording.time())).chain(channels).collect()
}

fn loaded(bytes: Vec<u8>) -> Vec<(String, Vec<u64>)> {
    let loaded = parse(Path::new("run.mcap"), bytes, &Mapping::default());
    bits(&loaded.unwrap_or_else(|error| panic!("{error}")).recording)
}

fn csv() -> Vec<(String, Vec<u64>)> {
    let path = Path::new("run.csv");
    let bytes = include_bytes!("formats/run.csv").to_vec();
    bits(&parse(path, bytes, &Mapping::default()).unwrap().recording)
}

const ONE: &[&str] = &["/joint_states"];
const CDR: (&str, Encode) = ("cdr", cdr);
const JSON: (&str, Encode) = ("json", json);

#[test]
fn the_same_recording_is_the_same_to_the_bit() {
    for encoding in [CDR, JSON] {
        let plain = written(ONE, &["slide"], encoding, 0);
        assert_eq!(loaded(plain.clone()), csv(), "{}", encoding.0);
        // A stamp since 1970: times count from the first one on, in whole nanoseconds.
        assert_eq!(loaded(written(ONE, &["slide"], encoding, 1_790_000_000_123_456_789)), csv());
        let lz4 = |data: &[u8]| {
            let mut encoder = lz4_flex::frame::FrameEncoder::new(Vec::new());
            encoder.write_all(data).unwrap();
            encoder.finish().unwrap()
        };
        assert_eq!(loaded(packed(&plain, "lz4", lz4)), csv());
        let zstd = |data: &[u8]| {
            ruzstd::encoding::compress_to_vec(data, ruzstd::encoding::CompressionLevel::Fastest)
        };
        assert_eq!(loaded(packed(&plain, "zstd", zstd)), csv());
    }
}

#[test]
fn several_joints_are_axes() {
    let folder = std::env::temp_dir().join(format!("aep-mcap-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path: PathBuf = folder.join("arm.mcap");
    std::fs::write(&path, written(ONE, &["shoulder_pan_joint", "elbow"], CDR, 7)).unwrap();
    let axes = read_axes(std::slice::from_ref(&path), &Mapping::default(), &Axes::All);
    std::fs::remove_dir_all(&folder).unwrap();
    let axes = axes.unwrap_or_else(|error| panic!("{error}")).axes;
    assert_eq!(axes.len(), 2);
    assert!(axes.iter().any(|(name, _)| name == "elbow"));
    for (_, loaded) in &axes {
        assert_eq!(bits(&loaded.recording), csv());
    }
}

#[test]
fn a_topic_is_chosen_where_there_are_several() {
    let two = written(&["/left/joint_states", "/right/joint_states"], &["slide"], CDR, 0);
    let read = |bytes: &[u8], topic: Option<&str>| {
        let mapping = Mapping { topic: topic.map(str::to_owned), ..Mapping::default() };
        parse(Path::new("run.mcap"), bytes.to_vec(), &mapping)
    };
    let error = read(&two, None).unwrap_err();
    assert!(error.to_string().contains("/left/joint_states, /right/joint_states"), "{error}");
    assert_eq!(error.hint().as_deref(), Some("choose one of them: --topic /left/joint_states"));
    let right = read(&two, Some("/right/joint_states")).unwrap();
    assert_eq!(bits(&right.recording), csv());
    let error = read(&two, Some("/chatter")).unwrap_err().to_string();
    assert!(error.contains("no topic '/chatter' with joints"), "{error}");
    let none = written(&[], &["slide"], CDR, 0);
    assert!(read(&none, None).unwrap_err().to_string().contains("no topic of sensor_msgs"));
    let csv = include_bytes!("formats/run.csv");
    assert!(read(csv, Some("/x")).unwrap_err().to_string().contains("no topics"));
    let mapping = Mapping { force: Source::column("2*effort"), ..Mapping::default() };
    let doubled = parse(Path::new("run.mcap"), written(ONE, &["slide"], CDR, 0), &mapping);
    let force = doubled.unwrap().recording.require("force").unwrap()[3];
    assert_eq!(force, 2.0 * rows()[3].2);
}

proptest! {
    #[test]
    fn damaged_files_are_refused_and_never_panic(
        pack in any::<bool>(),
        cuts in prop::collection::vec((0.0f64..1.0, any::<u8>()), 1..6),
        length in 0.5f64..1.2,
    ) {
        let plain = written(ONE, &["slide"], CDR, 0);
        let mut bytes = if pack {
            packed(&plain, "zstd", |data| {
                ruzstd::encoding::compress_to_vec(data, ruzstd::encoding::CompressionLevel::Fastest)
            })
        } else {
            plain
        };
        let size = bytes.len();
        for (place, byte) in cuts {
            bytes[(place * size as f64) as usize] = byte;
        }
        bytes.truncate((length * size as f64) as usize);
        let _ = parse(Path::new("run.mcap"), bytes, &Mapping::default());
    }
}
