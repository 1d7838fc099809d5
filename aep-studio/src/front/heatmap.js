// The mean residual over two quantities as a map: one colour each for a residual above and below nothing.

// Means of `values` over cells of x and y: {across, up, mean, count, x: [low, high], y: [low, high]}.
function cellsOf(xs, ys, values, across, up) {
  const range = (of) => {
    let [low, high] = [Infinity, -Infinity];
    for (const value of of) {
      if (value < low) low = value;
      if (value > high) high = value;
    }
    return [low, high];
  };
  const [x, y] = [range(xs), range(ys)];
  const [sum, count] = [new Float64Array(across * up), new Uint32Array(across * up)];
  for (let k = 0; k < values.length; k++) {
    if (!(isFinite(values[k]) && isFinite(xs[k]) && isFinite(ys[k]))) continue;
    const column = Math.min(across - 1, Math.floor(((xs[k] - x[0]) / (x[1] - x[0])) * across));
    const row = Math.min(up - 1, Math.floor(((ys[k] - y[0]) / (y[1] - y[0])) * up));
    sum[row * across + column] += values[k];
    count[row * across + column] += 1;
  }
  return { across, up, mean: sum.map((value, k) => (count[k] ? value / count[k] : NaN)), count, x, y };
}

// spec: {title, x: {label, unit}, y: {label, unit}, z: {label, unit}, height, onClick(area, name)}; `paint(cells, limit)` draws
// anew. `area(x, y)` holds near the cell that was clicked.
function heatmap(host, spec) {
  const canvas = element("canvas", { role: "img" });
  const readout = element("span", { class: "at" });
  const made = { host, cells: null, limit: 1 };
  const fileButton = (name, title, act) => element("button", { type: "button", title, onclick: act }, name);
  const tools = element(
    "span",
    { class: "tools" },
    fileButton("CSV", "Download the cells as CSV", () => save(fileName(spec.title, "csv"), new Blob([cellsCsv(made.cells, spec)], { type: "text/csv" }))),
    fileButton("PNG", "Download the map as PNG", () => pngOf(canvas, spec.title, [], (blob) => save(fileName(spec.title, "png"), blob))),
  );
  host.classList.add("chart", "heatmap");
  host.replaceChildren(element("div", { class: "bar-of-plot" }, element("h3", {}, spec.title), tools), canvas, readout);
  const box = { left: 56, top: 18, right: 64, bottom: 40 };
  const size = () => ({ width: host.clientWidth, height: spec.height });
  const draw = () => made.cells && drawMap(canvas, made, spec, box, size());
  made.redraw = draw;
  made.paint = (cells, limit, label) => {
    Object.assign(made, { cells, limit });
    canvas.setAttribute("aria-label", label);
    draw();
  };
  new ResizeObserver(draw).observe(host);
  plots.add(made);
  // The place of an event in shares of the map; nothing outside it.
  const placed = (event) => {
    const { left, top } = canvas.getBoundingClientRect();
    const { width, height } = size();
    const u = (event.clientX - left - box.left) / (width - box.left - box.right);
    const v = 1 - (event.clientY - top - box.top) / (height - box.top - box.bottom);
    return made.cells && u >= 0 && u < 1 && v >= 0 && v < 1 ? [u, v] : null;
  };
  const along = ([low, high], share) => low + share * (high - low);
  canvas.addEventListener("click", (event) => {
    const place = placed(event);
    if (!place) return;
    const { cells } = made;
    const around = (share, range, count) => [share - NEAR / count, share + NEAR / count].map((end) => along(range, Math.min(Math.max(end, 0), 1)));
    const [x, y] = [around(place[0], cells.x, cells.across), around(place[1], cells.y, cells.up)];
    const named = ({ label, unit }, [low, high]) => `${label} ${quantity(low, unit)} to ${quantity(high, unit)}`;
    spec.onClick?.((a, b) => a >= x[0] && a <= x[1] && b >= y[0] && b <= y[1], `${named(spec.x, x)}, ${named(spec.y, y)}`);
  });
  canvas.addEventListener("pointermove", (event) => {
    const { cells } = made;
    const inside = placed(event);
    if (!inside) return void (readout.textContent = "");
    const [u, v] = inside;
    const [column, row] = [Math.floor(u * cells.across), Math.floor(v * cells.up)];
    const at = row * cells.across + column;
    const place = `${spec.x.label} ${quantity(along(cells.x, u), spec.x.unit)}, ${spec.y.label} ${quantity(along(cells.y, v), spec.y.unit)}`;
    readout.textContent = cells.count[at] ? `${place}: mean ${quantity(cells.mean[at], spec.z.unit)} of ${cells.count[at]} samples` : `${place}: no samples`;
  });
  canvas.addEventListener("pointerleave", () => (readout.textContent = ""));
  return made;
}

// How many cells to either side of a click belong to it.
const NEAR = 2.5;

function drawMap(canvas, { cells, limit }, spec, box, { width, height }) {
  const ratio = devicePixelRatio || 1;
  canvas.width = Math.round(width * ratio);
  canvas.height = Math.round(height * ratio);
  canvas.style.height = `${height}px`;
  const pen = canvas.getContext("2d");
  pen.scale(ratio, ratio);
  const [inner, tall] = [width - box.left - box.right, height - box.top - box.bottom];
  pen.fillStyle = colour("page");
  pen.fillRect(box.left, box.top, inner, tall);
  const { across, up } = cells;
  for (let row = 0; row < up; row++) {
    for (let column = 0; column < across; column++) {
      const mean = cells.mean[row * across + column];
      if (Number.isNaN(mean)) continue;
      pen.fillStyle = diverging(mean / limit);
      const [x0, x1] = [column, column + 1].map((k) => Math.round(box.left + (k / across) * inner));
      const [y1, y0] = [row, row + 1].map((k) => Math.round(box.top + (1 - k / up) * tall));
      pen.fillRect(x0, y0, x1 - x0, y1 - y0);
    }
  }
  pen.font = "11.5px system-ui, -apple-system, 'Segoe UI', Roboto, sans-serif";
  const of = ([low, high], unit) => prefixed(Math.max(Math.abs(low), Math.abs(high)), unit);
  const [inX, inY] = [of(cells.x, spec.x.unit), of(cells.y, spec.y.unit)];
  const round = ([low, high], factor) => roundTicks(low * factor, high * factor, 5).map((tick) => [tick / factor, tick]);
  pen.fillStyle = colour("soft");
  pen.textAlign = "center";
  for (const [value, tick] of round(cells.x, inX.factor)) {
    pen.fillText(number(tick, 3).replace(/\.0+$/, ""), box.left + ((value - cells.x[0]) / (cells.x[1] - cells.x[0])) * inner, box.top + tall + 15);
  }
  pen.textAlign = "right";
  for (const [value, tick] of round(cells.y, inY.factor)) {
    pen.fillText(number(tick, 3).replace(/\.0+$/, ""), box.left - 6, box.top + (1 - (value - cells.y[0]) / (cells.y[1] - cells.y[0])) * tall + 4);
  }
  pen.fillStyle = colour("ink");
  pen.fillText(labelled(spec.x.label, inX.unit), box.left + inner, box.top + tall + 33);
  pen.textAlign = "left";
  pen.fillText(labelled(spec.y.label, inY.unit), 2, 11);
  const scale = [box.left + inner + 10, 12];
  for (let k = 0; k < tall; k++) {
    pen.fillStyle = diverging(1 - (2 * k) / (tall - 1));
    pen.fillRect(scale[0], box.top + k, scale[1], 1.5);
  }
  pen.fillStyle = colour("soft");
  const end = quantity(limit, spec.z.unit, 2);
  pen.fillText(`+${end.split(" ")[0]}`, scale[0] + 15, box.top + 9);
  pen.fillText("0", scale[0] + 15, box.top + tall / 2 + 4);
  pen.fillText(`−${end.split(" ")[0]}`, scale[0] + 15, box.top + tall);
  pen.textAlign = "right";
  pen.fillText(end.split(" ")[1] ?? "", width - 2, box.top - 6);
}

// Round values between low and high, about `wanted` of them.
function roundTicks(low, high, wanted) {
  const rough = (high - low) / wanted;
  const power = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * power).find((s) => s >= rough);
  const ticks = [];
  for (let k = Math.ceil(low / step); k * step <= high + 1e-9 * step; k++) ticks.push(+(k * step).toPrecision(12));
  return ticks;
}

function cellsCsv(cells, spec) {
  const rows = [[labelled(spec.x.label, spec.x.unit), labelled(spec.y.label, spec.y.unit), labelled(spec.z.label, spec.z.unit), "samples"].map(cell).join(",")];
  const centre = ([low, high], k, count) => low + ((k + 0.5) / count) * (high - low);
  for (let row = 0; row < cells.up; row++) {
    for (let column = 0; column < cells.across; column++) {
      const at = row * cells.across + column;
      if (cells.count[at]) rows.push([centre(cells.x, column, cells.across), centre(cells.y, row, cells.up), cells.mean[at], cells.count[at]].join(","));
    }
  }
  return `${rows.join("\n")}\n`;
}
