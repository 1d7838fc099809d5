// The first screen: every picture of a recording and its models, moved together by one slider over the models.

// A page of several axes has one for each: the first is drawn at once, others when they come into view.
function watchScreens() {
  const sections = [...document.querySelectorAll("section.screen")];
  if (sections.length) screen(sections.shift());
  whenSeen(sections, (section) => screen(section));
}

const BASE = "c2";
const CHOSEN = "c1";
const MOMENTS = 5;
const REGIME_TINTS = ["t0", "t1", "t2", "t3", "t4", "t5", "t6"];

function screen(section, raw = JSON.parse(section.querySelector("script.course").textContent)) {
  const course = courseOf(raw);
  const decides = course.compared.findIndex((compared) => compared.decides);
  const state = { course, section, residuals: new Map(), region: null, model: course.models.length - 1, compared: 0, decides: Math.max(decides, 0), group: `time-${section.id || Math.random()}`, regimes: false };
  // Between pieces nothing is known: an instant without values.
  state.rows = rowsOf(course);
  state.time = state.rows.map(([k, next]) => (next == null ? course.time[k] : (course.time[k] + course.time[next]) / 2));
  build(state);
  return state;
}

function rowsOf(course) {
  const rows = [];
  const ends = new Set(breaksOf(course));
  for (let k = 0; k < course.time.length; k++) {
    if (ends.has(k) && course.time[k] > course.time[k - 1]) rows.push([k - 1, k]);
    rows.push([k, null]);
  }
  return rows;
}

const drawn = (state, values) => state.rows.map(([k, next]) => (next == null && isFinite(values[k]) ? values[k] : null));

const predictedOf = (state, model) => {
  const { measured, residuals } = state.course.compared[state.compared];
  return measured.map((value, k) => value - residuals[model][k]);
};

function build(state) {
  const { section, course } = state;
  const at = (name) => section.querySelector(`[data-show=${name}]`);
  slider(state, at("models"));
  choices(state, at("choices"));
  const group = state.group;
  const compared = () => course.compared[state.compared];
  const base = { label: course.models[0].name, colour: BASE, width: 1.2 };
  const chosen = { label: course.models[state.model].name, colour: CHOSEN, width: 1.4 };
  const note = (row) => noteOf(state, row);
  const behind = (chart, pen) => background(state, chart, pen);
  const time = { label: "time", unit: "s" };
  const clicks = { onClick: (instant) => lookAround(state, instant), onWhole: () => state.region && lookAt(state, null) };
  const several = course.models.length > 1;
  const seriesOf = (first) => [...first, ...(several ? [{ ...base }] : []), { ...chosen }];
  state.fit = chart(at("fit"), {
    title: `Measured and predicted ${compared().name}`, x: time, y: { label: compared().name, unit: compared().unit },
    data: fitData(state), series: seriesOf([{ label: "measured", colour: "c0", width: 2.6 }]), group, height: 250, behind, note, ...clicks,
  });
  state.left = chart(at("residual"), {
    title: `Residual: measured less predicted ${compared().name}`, x: time, y: { label: "residual", unit: compared().unit },
    data: leftData(state), series: seriesOf([]), group, height: 196, behind, note, ...clicks,
    held: () => state.heldLeft,
    get marks() { return state.moments?.map(({ at: where }, k) => ({ at: where, label: String(k + 1) })) ?? []; },
  });
  section.addEventListener("keydown", (event) => keys(state, event));
  choose(state, state.model);
  // What takes longer comes after the first picture.
  requestAnimationFrame(() => {
    performance.mark("first-picture");
    setTimeout(() => {
      state.profile = profile(state, at("profile"));
      state.map = map(state, at("map"));
      choose(state, state.model);
      section.dataset.ready = "yes";
    });
  });
}

const fitData = (state) => {
  const { measured } = state.course.compared[state.compared];
  const several = state.course.models.length > 1;
  return [state.time, drawn(state, measured), ...(several ? [drawn(state, predictedOf(state, 0))] : []), drawn(state, predictedOf(state, state.model))];
};

const leftData = (state) => {
  const several = state.course.models.length > 1;
  return [state.time, ...(several ? [drawn(state, residualOf(state, 0))] : []), drawn(state, residualOf(state, state.model))];
};

// Slider and buttons over the models.
function slider(state, host) {
  const { models } = state.course;
  const input = element("input", { type: "range", min: 0, max: models.length - 1, step: 1, value: state.model, "aria-label": "model" });
  state.input = input;
  state.output = element("output", { "aria-live": "polite" });
  input.addEventListener("input", () => choose(state, Number(input.value)));
  const step = (by, name, sign) => element("button", { type: "button", title: name, "aria-label": name, onclick: () => choose(state, state.model + by) }, sign);
  host.replaceChildren(
    element("span", { class: "slide" }, step(-1, "one effect less", "◀"), input, step(1, "one effect more", "▶")),
    state.output,
  );
  host.hidden = models.length < 2;
  // The bars of the models are chosen, too.
  state.bars = [...state.section.querySelectorAll(".rung")];
  state.bars.forEach((bar, k) => {
    if (k >= models.length) return;
    bar.tabIndex = 0;
    bar.setAttribute("role", "button");
    bar.addEventListener("click", () => choose(state, k));
    bar.addEventListener("keydown", (event) => {
      if (event.key !== "Enter" && event.key !== " ") return;
      event.preventDefault();
      choose(state, k);
    });
  });
}

// What is compared, and whether regimes are shown.
function choices(state, host) {
  const { compared } = state.course;
  const pick = (k) => {
    state.compared = k;
    state.fit.spec.title = `Measured and predicted ${compared[k].name}`;
    state.fit.spec.y = { label: compared[k].name, unit: compared[k].unit };
    state.left.spec.title = `Residual: measured less predicted ${compared[k].name}`;
    state.left.spec.y = { label: "residual", unit: compared[k].unit };
    for (const made of [state.fit, state.left]) made.host.querySelector("h3").textContent = made.spec.title;
    choose(state, state.model);
  };
  const buttons = compared.map((one, k) =>
    element("button", { type: "button", "aria-pressed": String(k === state.compared), title: one.about }, one.decides && compared.length > 1 ? `${one.name}, one sample ahead (decides)` : `${one.name} along the motion`),
  );
  buttons.forEach((button, k) =>
    button.addEventListener("click", () => {
      buttons.forEach((other, n) => other.setAttribute("aria-pressed", String(n === k)));
      pick(k);
    }),
  );
  const keyOf = element("span", { class: "key", role: "group", "aria-label": "regimes" }, ...regimeButtons(state));
  const bands = element("button", { type: "button", "aria-pressed": "false", title: "Colour the regimes of the motion" }, "regimes");
  bands.addEventListener("click", () => {
    state.regimes = !state.regimes;
    bands.setAttribute("aria-pressed", String(state.regimes));
    state.fit.redraw();
    state.left.redraw();
  });
  const children = compared.length > 1 ? [element("span", { class: "choice", role: "group", "aria-label": "what is compared" }, ...buttons)] : [];
  host.replaceChildren(...children, bands, keyOf);
}

// Arrow keys move over the models wherever no plot or field has the focus.
function keys(state, event) {
  if (event.target.matches("input, select, .chart")) return;
  const by = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 }[event.key];
  if (!by || event.ctrlKey || event.metaKey || event.altKey) return;
  event.preventDefault();
  choose(state, state.model + by);
}

function choose(state, wanted) {
  const { models } = state.course;
  const model = Math.min(Math.max(wanted, 0), models.length - 1);
  state.model = model;
  state.input.value = model;
  state.input.setAttribute("aria-valuetext", models[model].name);
  state.output.replaceChildren(element("b", {}, models[model].name), ` ${models[model].said}`);
  state.bars.forEach((bar, k) => {
    bar.classList.toggle("chosen", k === model);
    bar.setAttribute("aria-pressed", String(k === model));
  });
  state.heldLeft = limits(residualOf(state, 0));
  for (const made of [state.fit, state.left, state.profile?.chart]) {
    if (!made) continue;
    const last = made.spec.series.length;
    made.spec.series[last - 1].label = models[model].name;
    made.buttons[last - 1].querySelector(".of-curve").textContent = models[model].name;
    // The base model would be drawn over itself.
    if (last > 1 && models.length > 1) {
      const asked = made.spec.series[last - 2].asked ?? true;
      made.plot.setSeries(last - 2 + 1, { show: asked && model > 0 });
      made.buttons[last - 2].setAttribute("aria-pressed", String(asked && model > 0));
      made.buttons[last - 2].disabled = model === 0;
    }
  }
  moments(state);
  drawRegion(state, state.section.querySelector("[data-show=region]"));
  state.tellRegimes();
  redata(state.fit, fitData(state));
  redata(state.left, leftData(state));
  state.profile?.update();
  state.map?.update();
}

// All but an outermost share on either side, so that one spike does not flatten the picture of all others.
function limits(values, tail = 0.001) {
  const known = Float64Array.from(values).filter(isFinite).sort();
  if (!known.length) return null;
  return [known[Math.floor(known.length * tail)], known[Math.ceil(known.length * (1 - tail)) - 1]];
}

// Where a model errs most in all of the recording: stretches of a hundredth of its length with the largest rms.
function moments(state) {
  const { time, regime, regimes } = state.course;
  const residual = residualWhere(state, state.model, everywhere);
  const length = (time[time.length - 1] - time[0]) / 100;
  const found = [];
  let [from, sum, count] = [0, 0, 0];
  const all = [];
  const square = (k) => (isFinite(residual[k]) ? residual[k] ** 2 : 0);
  const one = (k) => (isFinite(residual[k]) ? 1 : 0);
  for (let to = 0; to < time.length; to++) {
    sum += square(to);
    count += one(to);
    while (time[to] - time[from] > length) {
      sum -= square(from);
      count -= one(from++);
    }
    if (count > 0.5 * (to - from + 1) && to - from > 4) all.push([Math.sqrt(Math.max(sum, 0) / count), from, to]);
  }
  all.sort((a, b) => b[0] - a[0]);
  for (const [rms, start, end] of all) {
    if (found.length === MOMENTS) break;
    if (found.some((other) => start <= other.end + (end - start) && other.start <= end + (end - start))) continue;
    const middle = (start + end) >> 1;
    found.push({ rms, start, end, at: time[middle], regime: regimes[regime[middle]] ?? "" });
  }
  state.moments = found;
  const { unit } = state.course.compared[state.compared];
  const host = state.section.querySelector("[data-show=moments]");
  const button = (moment, k) =>
    element(
      "button",
      { type: "button", title: "look at this stretch alone", onclick: () => lookAtStretch(state, moment.start, moment.end) },
      element("b", {}, `${k + 1}`),
      ` ${number(moment.at, 4)} s: ${quantity(moment.rms, unit)} rms${moment.regime ? `, ${moment.regime}` : ""}`,
    );
  host.replaceChildren(element("span", { class: "lead-in" }, "It errs most at"), ...found.map(button));
}

function noteOf(state, row) {
  const [k, next] = state.rows[row];
  const { course } = state;
  if (next != null) return "between two pieces of the recording: nothing is known";
  const regime = course.regimes[course.regime[k]];
  const reason = course.reasons[course.compared[state.compared].leftOut[k]];
  return [regime, reason ? `left out: ${reason}` : null].filter(Boolean).join(" · ");
}

// Behind the curves: what takes no part, gaps, and regimes where they are asked for.
function background(state, made, pen) {
  const { plot } = made;
  const { course } = state;
  const { left, top, width, height } = plot.bbox;
  const { min, max } = plot.scales.x;
  const x = (value) => Math.min(Math.max(plot.valToPos(value, "x", true), left), left + width);
  const rect = (from, to, ink) => {
    const [a, b] = [x(course.time[from]), x(course.time[to])];
    pen.fillStyle = ink;
    pen.fillRect(a, top, Math.max(b - a, 0.5), height);
  };
  const runs = (values, draw) => {
    let start = 0;
    for (let k = 1; k <= values.length; k++) {
      if (k < values.length && values[k] === values[start] && course.piece[k] === course.piece[start]) continue;
      const end = Math.min(k, values.length - 1);
      if (course.time[end] >= min && course.time[start] <= max) draw(values[start], start, course.piece[end] === course.piece[start] ? end : k - 1);
      start = k;
    }
  };
  pen.save();
  if (state.regimes) runs(course.regime, (regime, from, to) => regime >= 0 && rect(from, to, colour(REGIME_TINTS[regime % 7])));
  runs(course.compared[state.compared].leftOut, (reason, from, to) => reason >= 0 && rect(from, to, through(colour("soft"), 0.13)));
  for (const k of breaksOf(course)) {
    if (course.time[k] > course.time[k - 1]) rect(k - 1, k, through(colour("soft"), 0.3));
  }
  pen.restore();
}

// The mean residual along a coordinate, in as many stretches as there are points for.
function profile(state, host) {
  const { course } = state;
  const picker = element("select", { "aria-label": "coordinate" }, ...course.tracks.map((track, k) => element("option", { value: k }, track.name)));
  const holder = element("div");
  host.replaceChildren(holder);
  const several = course.models.length > 1;
  const made = { track: 0 };
  const means = (model) => binned(course, course.tracks[made.track], residualOf(state, model));
  const data = () => {
    const last = means(state.model);
    return several ? [last.at, means(0).mean, last.mean] : [last.at, last.mean];
  };
  const axes = () => {
    const track = course.tracks[made.track];
    const { unit } = course.compared[state.compared];
    return { x: { label: track.name, unit: track.unit }, y: { label: `mean residual${track.against ? ", against the motion" : ""}`, unit } };
  };
  made.chart = chart(holder, {
    title: "Where it fails along", ...axes(), data: data(), height: 170, beside: [picker],
    series: [...(several ? [{ label: course.models[0].name, colour: BASE, width: 1.2 }] : []), { label: course.models[state.model].name, colour: CHOSEN, width: 1.5 }],
    behind: zeroLine,
    held: () => made.held,
  });
  made.update = () => {
    Object.assign(made.chart.spec, axes());
    made.held = several ? limits(means(0).mean) : null;
    redata(made.chart, data());
  };
  picker.addEventListener("change", () => {
    made.track = Number(picker.value);
    made.update();
    whole(made.chart);
  });
  return made;
}

function zeroLine(made, pen) {
  const { left, width } = made.plot.bbox;
  const y = made.plot.valToPos(0, "y", true);
  pen.save();
  pen.strokeStyle = colour("soft");
  pen.lineWidth = devicePixelRatio || 1;
  pen.setLineDash([]);
  pen.beginPath();
  pen.moveTo(left, y);
  pen.lineTo(left + width, y);
  pen.stroke();
  pen.restore();
}

const PER_STRETCH = 24;
const STRETCHES = [24, 800];

// Means over stretches of about as many samples each, fine enough for a ripple.
function binned(course, track, residual) {
  track.order ??= Array.from(track.values.keys())
    .filter((k) => isFinite(track.values[k]))
    .sort((a, b) => track.values[a] - track.values[b]);
  course.velocity ??= course.coordinates.find((other) => other.name === "velocity")?.values;
  const sign = (k) => (track.against ? Math.sign(course.velocity?.[k] ?? 1) : 1);
  const known = track.order.filter((k) => isFinite(residual[k]));
  const count = Math.min(Math.max(Math.floor(known.length / PER_STRETCH), STRETCHES[0]), STRETCHES[1]);
  const size = Math.max(1, Math.ceil(known.length / count));
  const [at, mean] = [[], []];
  for (let start = 0; start < known.length; start += size) {
    const part = known.slice(start, start + size);
    at.push(part.reduce((sum, k) => sum + track.values[k], 0) / part.length);
    mean.push(part.reduce((sum, k) => sum + sign(k) * residual[k], 0) / part.length);
  }
  return { at, mean };
}

// The residual over position and velocity.
function map(state, host) {
  const { course } = state;
  const of = (name) => course.coordinates.find((track) => track.name === name);
  const [position, velocity] = [of("position"), of("velocity")];
  if (!position || !velocity) {
    host.hidden = true;
    return { update: () => {} };
  }
  const z = { label: "mean residual" };
  const made = heatmap(host, {
    title: "Residual over position and velocity",
    x: { label: "position", unit: position.unit },
    y: { label: "velocity", unit: velocity.unit },
    z,
    height: 186,
    onClick: (area, name) => lookAt(state, { name, holds: (k) => area(position.values[k], velocity.values[k]) }),
  });
  const cells = (model) => cellsOf(position.values, velocity.values, residualOf(state, model), 72, 36);
  return {
    update: () => {
      z.unit = course.compared[state.compared].unit;
      const chosen = cells(state.model);
      // One scale for all models: what falls is seen to fall.
      const [low, high] = limits(cells(0).mean, 0.02) ?? [-1, 1];
      const limit = Math.max(-low, high) || 1;
      made.paint(chosen, limit, `Map of the mean residual of ${course.models[state.model].name} over position and velocity; colours end at ${quantity(limit, z.unit)}.`);
    },
  };
}

