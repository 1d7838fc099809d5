// Unpacks what the page carries. Series come as typed arrays; what is not known is NaN.

const bytesOf = (text) => {
  const raw = atob(text);
  const bytes = new Uint8Array(raw.length);
  for (let k = 0; k < raw.length; k++) bytes[k] = raw.charCodeAt(k);
  return bytes;
};

const floatsOf = (text) => {
  const view = new DataView(bytesOf(text).buffer);
  return Float64Array.from({ length: view.byteLength / 4 }, (_, k) => view.getFloat32(4 * k, true));
};

const doublesOf = (text) => {
  const view = new DataView(bytesOf(text).buffer);
  return Float64Array.from({ length: view.byteLength / 8 }, (_, k) => view.getFloat64(8 * k, true));
};

// A series in 65,535 steps; the highest code is a value that is not known.
const stepsOf = ({ low, step, codes }) => {
  const bytes = bytesOf(codes);
  const values = new Float64Array(bytes.length / 2);
  for (let k = 0; k < values.length; k++) {
    const code = bytes[2 * k] | (bytes[2 * k + 1] << 8);
    values[k] = code === 0xffff ? NaN : low + step * code;
  }
  return values;
};

// [[value, count], ...] as one value for each sample.
const runsOf = (runs, length) => {
  const values = new Int32Array(length);
  let at = 0;
  for (const [value, count] of runs) {
    values.fill(value, at, at + count);
    at += count;
  }
  return values;
};

// The course of a recording: see `src/front/samples.rs` for what is in it.
function courseOf(raw) {
  const time = doublesOf(raw.time);
  const count = time.length;
  const course = {
    ...raw,
    time,
    piece: runsOf(raw.piece, count),
    regime: runsOf(raw.regime, count),
    compared: raw.compared.map((compared) => ({
      ...compared,
      measured: stepsOf(compared.measured),
      residuals: compared.residuals.map(stepsOf),
      leftOut: runsOf(compared.left_out, count),
    })),
    coordinates: raw.coordinates.map((track) => ({ ...track, values: stepsOf(track.values) })),
  };
  course.tracks = tracksOf(course);
  return course;
}

// What a residual can be drawn along. Some are others without their sign, or with that of the motion.
function tracksOf(course) {
  const of = (name) => course.coordinates.find((track) => track.name === name);
  const tracks = [...course.coordinates];
  const velocity = of("velocity");
  const position = of("position");
  if (velocity) {
    tracks.push({ ...velocity, name: "speed", values: velocity.values.map(Math.abs), against: true });
  }
  if (position) tracks.push({ ...position, name: "position (against motion)", against: true });
  const time = { name: "time", unit: "s", values: course.time, against: false };
  tracks.push(time);
  const rank = (track) => {
    const at = course.order.indexOf(track.name);
    return at < 0 ? course.order.length : at;
  };
  return tracks.sort((a, b) => rank(a) - rank(b));
}

// Indices at which another piece begins.
function breaksOf(course) {
  const breaks = [];
  for (let k = 1; k < course.time.length; k++) {
    if (course.piece[k] !== course.piece[k - 1]) breaks.push(k);
  }
  return breaks;
}
