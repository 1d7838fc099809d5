// A plot with zoom, pan, linked cursors, curves on and off, and downloads.
//
// spec: {title, x: {label, unit, log, inverse}, y: {label, unit, log}, data: [x, ...y], series: [{label, colour, width,
// alpha, dots, hidden, quiet, unit}], bands: [{of: [high, low], colour}], marks: [{at, label}], group, height,
// behind(chart, pen), note(index), onClick(x), onWhole()}. Values are in SI units; null is a gap.
// `inverse` is a unit: the abscissa is a frequency and its ticks are told as periods in it.

const element = (tag, attributes = {}, ...children) => {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith("on")) made.addEventListener(name.slice(2), value);
    else if (value === true) made.setAttribute(name, "");
    else if (value !== false && value != null) made.setAttribute(name, value);
  }
  made.append(...children);
  return made;
};

const HELP =
  "Drag: zoom. Shift and drag: move. Double click or 0: all of it. After a click: wheel, arrow keys, + and -. Touch: one finger moves, two zoom.";

// Digits after the point that tell multiples of a step apart: 2 for 0.25.
function decimalsOf(step) {
  let places = 0;
  for (let size = step; places < 9 && Math.abs(size - Math.round(size)) > 1e-6 * size; size *= 10) places++;
  return places;
}

function ticks(chart, scale, splits) {
  const { min, max } = chart.plot?.scales[scale] ?? { min: splits[0], max: splits.at(-1) };
  const axis = chart.spec[scale];
  if (axis.inverse) return splits.map((split) => (split == null ? "" : quantity(1 / split, axis.inverse, 2)));
  const { factor } = prefixed(Math.max(Math.abs(min), Math.abs(max)), axis.unit);
  if (axis.log) return splits.map((split) => (split == null ? "" : number(split * factor, 1)));
  const given = splits.filter((split) => split != null);
  const step = given.length > 1 ? Math.abs(given[1] - given[0]) * factor : 1;
  const places = decimalsOf(step);
  return splits.map((split) => {
    if (split == null) return "";
    const value = split * factor;
    return step < 1e-6 || Math.abs(value) >= 1e7 ? value.toExponential(1) : (Math.abs(value) < step * 1e-6 ? 0 : value).toFixed(places);
  });
}

// Label with the unit that the ticks have now.
function titleOf(chart, scale) {
  const { label, unit, inverse } = chart.spec[scale];
  if (inverse) return "period";
  const { min, max } = chart.plot.scales[scale];
  return labelled(label, prefixed(Math.max(Math.abs(min), Math.abs(max)), unit).unit);
}

function chart(host, spec) {
  const made = { spec, host, group: spec.group, log: Boolean(spec.x.log) };
  made.xTitle = () => titleOf(made, "x");
  made.yTitle = () => titleOf(made, "y");
  made.extent = extentOf(spec);
  const canvas = element("div", { class: "canvas" });
  const readout = element("span", { class: "at", "aria-live": "off" });
  made.readout = readout;
  const legend = element("div", { class: "curves", role: "group", "aria-label": "curves" });
  const bar = element("div", { class: "bar-of-plot" }, element("h3", {}, spec.title), ...(spec.beside ?? []), legend, tools(made));
  host.replaceChildren(bar, canvas, readout);
  host.setAttribute("role", "group");
  host.setAttribute("aria-label", `${spec.title}. ${spec.x.label} across, ${spec.y.label} up. ${HELP}`);
  host.classList.add("chart");
  made.plot = new uPlot(options(made, canvas), spec.data, canvas);
  made.buttons = spec.series.map((series, k) => (series.quiet ? null : legendButton(made, series, k + 1)));
  legend.append(...made.buttons.filter(Boolean));
  if (made.group) members(made.group).add(made);
  zoomable(made, made.plot.over, host);
  new ResizeObserver(() => {
    const width = canvas.clientWidth;
    if (width > 0 && width !== made.plot.width) made.plot.setSize({ width, height: heightOf(spec) });
  }).observe(canvas);
  made.redraw = () => made.plot.redraw(false, true);
  plots.add(made);
  return made;
}

// Plots whose place on the page is gone.
function forgetGone() {
  for (const made of plots) {
    if (made.host.isConnected) continue;
    made.plot?.destroy();
    if (made.group) leave(made);
    plots.delete(made);
  }
}

const heightOf = (spec) => spec.height ?? 240;

function extentOf(spec) {
  const [x] = spec.data;
  let [low, high] = [x[0], x[x.length - 1]];
  if (!(high > low)) [low, high] = [low - 1, low + 1];
  return [low, high];
}

function options(made, canvas) {
  const { spec } = made;
  const font = "11.5px system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif";
  const axis = (scale, more) => ({
    scale,
    font,
    stroke: () => colour("soft"),
    grid: { stroke: () => colour("line"), width: 1 },
    ticks: { stroke: () => colour("line"), width: 1, size: 4 },
    values: (plot, splits) => ticks(made, scale, splits),
    ...more,
  });
  const line = (series) => ({
    label: series.label,
    show: !series.hidden,
    stroke: () => (series.alpha ? through(colour(series.colour), series.alpha) : colour(series.colour)),
    width: series.width ?? 1.4,
    spanGaps: false,
    ...(series.dots
      ? { paths: () => null, points: { show: true, size: series.size ?? 4, width: 0, fill: () => through(colour(series.colour), 0.6) } }
      : { points: { show: false } }),
  });
  return {
    width: Math.max(canvas.clientWidth, 200),
    height: heightOf(spec),
    padding: [18, 10, 0, 0],
    legend: { show: false },
    focus: { alpha: 1 },
    cursor: {
      drag: { x: true, y: false, setScale: false },
      points: { size: 6 },
      ...(spec.group ? { sync: { key: spec.group, scales: ["x", null] } } : {}),
    },
    scales: {
      x: { time: false, distr: spec.x.log ? 3 : 1, range: (plot, min, max) => (spec.x.log ? [min, max] : max > min ? [min, max] : [min - 1, max + 1]) },
      y: spec.y.log ? { distr: 3 } : { range: (plot, min, max) => spread(made, min, max) },
    },
    series: [{}, ...spec.series.map(line)],
    bands: (spec.bands ?? []).map(({ of, colour: name }) => ({ series: of, fill: () => through(colour(name), 0.18) })),
    axes: [axis("x", { size: 40, space: 70 }), axis("y", { size: 56, space: 34 })],
    hooks: {
      drawClear: [(plot) => spec.behind?.(made, plot.ctx)],
      draw: [(plot) => titles(made, plot)],
      setSelect: [(plot) => chosen(made, plot)],
      setCursor: [(plot) => told(made, plot)],
    },
  };
}

// A little air, and limits that stay when the models change.
function spread(made, min, max) {
  if (min == null || !isFinite(min) || !isFinite(max)) return [-1, 1];
  const held = made.spec.held?.();
  const [low, high] = held ? [Math.min(min, held[0]), Math.max(max, held[1])] : [min, max];
  const air = 0.06 * (high - low) || Math.abs(high) * 0.1 || 1;
  return [low - air, high + air];
}

function titles(made, plot) {
  const pen = plot.ctx;
  const ratio = devicePixelRatio || 1;
  const { left, top, width, height } = plot.bbox;
  pen.save();
  pen.fillStyle = colour("ink");
  pen.font = `${12 * ratio}px system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif`;
  pen.textBaseline = "alphabetic";
  pen.textAlign = "left";
  pen.fillText(made.yTitle(), 2 * ratio, top - 6 * ratio);
  pen.textAlign = "right";
  pen.fillText(made.xTitle(), left + width, top + height + 34 * ratio);
  marks(made, plot, pen, ratio);
  pen.restore();
}

function marks(made, plot, pen, ratio) {
  const { left, top, width, height } = plot.bbox;
  let right = -Infinity;
  const inOrder = [...(made.spec.marks ?? [])].sort((a, b) => a.at - b.at);
  for (const { at, label } of inOrder) {
    const x = plot.valToPos(at, "x", true);
    if (!(x >= left && x <= left + width)) continue;
    pen.strokeStyle = colour("doubt");
    pen.lineWidth = ratio;
    pen.setLineDash([3 * ratio, 3 * ratio]);
    pen.beginPath();
    pen.moveTo(x, top);
    pen.lineTo(x, top + height);
    pen.stroke();
    pen.setLineDash([]);
    pen.fillStyle = colour("doubt");
    pen.textAlign = "center";
    const wide = pen.measureText(label).width / 2 + 4 * ratio;
    // A label that would lie on another one is left to the cursor.
    if (x - wide > right && x + wide < left + width + 8 * ratio) {
      pen.fillText(label, x, top - 6 * ratio);
      right = x + wide;
    }
  }
}

function chosen(made, plot) {
  const { left, width } = plot.select;
  if (width > 3) show(made, plot.posToVal(left, "x"), plot.posToVal(left + width, "x"));
  plot.setSelect({ left: 0, width: 0, top: 0, height: 0 }, false);
}

// The values under the cursor; of curves with points of their own the one before.
function told(made, plot) {
  const { idx, left } = plot.cursor;
  const { spec } = made;
  if (idx == null || left < 0) return void (made.readout.textContent = "");
  const x = plot.data[0][idx];
  const place = spec.x.inverse
    ? `period ${quantity(1 / x, spec.x.inverse)}`
    : spec.x.label === "time"
      ? `${number(x, 6)} s`
      : `${spec.x.label} ${quantity(x, spec.x.unit, 4)}`;
  const near = (spec.marks ?? []).find(({ at }) => Math.abs(plot.valToPos(at, "x") - left) < 6);
  const note = spec.note?.(idx);
  const values = spec.series.map((series, k) => {
    const column = plot.data[k + 1];
    let at = idx;
    while (at > 0 && column[at] === undefined) at--;
    if (series.quiet || !plot.series[k + 1].show || column[at] == null) return null;
    return `${series.label} ${quantity(column[at], series.unit ?? spec.y.unit)}`;
  });
  made.readout.textContent = [place, near?.label, ...values, note].filter(Boolean).join(" · ");
}

function legendButton(made, series, index) {
  const sample = element("i", { class: series.colour });
  const button = element(
    "button",
    { type: "button", "aria-pressed": String(!series.hidden), title: "curve on or off" },
    sample,
    element("span", { class: "of-curve" }, series.label),
  );
  button.addEventListener("click", () => {
    const on = !made.plot.series[index].show;
    made.plot.setSeries(index, { show: on });
    button.setAttribute("aria-pressed", String(on));
    series.asked = on;
  });
  return button;
}

// Buttons of a plot: all of it, and files.
function tools(made) {
  const { spec } = made;
  const button = (label, title, act) => element("button", { type: "button", title, onclick: act }, label);
  const names = () =>
    spec.series.filter((series, k) => !series.quiet && made.plot.series[k + 1].show).map((series) => [series.label, colour(series.colour)]);
  return element(
    "span",
    { class: "tools" },
    button("All", `Show all of it (0). ${HELP}`, () => whole(made)),
    button("CSV", "Download what is shown as CSV", () => save(fileName(spec.title, "csv"), new Blob([csvOf(made)], { type: "text/csv" }))),
    button("SVG", "Download the plot as SVG", () => save(fileName(spec.title, "svg"), new Blob([svgOf(made)], { type: "image/svg+xml" }))),
    button("PNG", "Download the plot as PNG", () => pngOf(made.plot.ctx.canvas, spec.title, names(), (blob) => save(fileName(spec.title, "png"), blob))),
  );
}

// New data behind the same axes; what is shown stays, or all of it.
function redata(made, data) {
  const { min, max } = made.plot.scales.x;
  const [low, high] = made.extent;
  // Before it was drawn once a plot has no limits.
  const isWhole = min == null || (min <= low && max >= high);
  made.spec.data = data;
  made.extent = extentOf(made.spec);
  made.plot.setData(data, false);
  const [from, to] = isWhole ? made.extent : [min, max];
  made.plot.setScale("x", { min: from, max: to });
}
