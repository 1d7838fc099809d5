// Plots as files: CSV of what is shown, SVG and PNG of how it looks.

function save(name, blob) {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  document.body.append(link);
  link.click();
  link.remove();
  setTimeout(() => URL.revokeObjectURL(link.href), 1000);
}

const fileName = (title, end) => `${title.toLowerCase().replace(/[^a-z0-9]+/g, "-").replace(/^-|-$/g, "") || "plot"}.${end}`;

// A spreadsheet takes a cell that begins so for a formula.
const cell = (text) => {
  const safe = /^[=+\-@\t\r]/.test(text) ? `'${text}` : text;
  return /[",\n]/.test(safe) ? `"${safe.replaceAll('"', '""')}"` : safe;
};

// Every point within what is shown, in SI units; an empty cell where nothing is known.
function csvOf(chart) {
  const { plot, spec } = chart;
  const { min, max } = plot.scales.x;
  const shown = spec.series.map((series, k) => [series, k + 1]).filter(([, k]) => plot.series[k].show);
  const head = [labelled(spec.x.label, spec.x.unit), ...shown.map(([series]) => labelled(series.label, series.unit ?? spec.y.unit))];
  const rows = [head.map(cell).join(",")];
  const [x] = plot.data;
  for (let k = 0; k < x.length; k++) {
    if (x[k] < min || x[k] > max) continue;
    const values = shown.map(([, s]) => plot.data[s][k]);
    rows.push([x[k], ...values.map((value) => (value == null || Number.isNaN(value) ? "" : value))].join(","));
  }
  return `${rows.join("\n")}\n`;
}

const xml = (text) =>
  String(text).replace(/[&<>"]/g, (sign) => ({ "&": "&amp;", "<": "&lt;", ">": "&gt;", '"': "&quot;" })[sign]);

// The plot drawn anew as lines and text; each column of pixels keeps its extremes.
function svgOf(chart) {
  const { plot, spec } = chart;
  const ratio = devicePixelRatio || 1;
  const box = { left: plot.bbox.left / ratio, top: plot.bbox.top / ratio, width: plot.bbox.width / ratio, height: plot.bbox.height / ratio };
  const [width, height] = [plot.width, plot.height + 34];
  const down = 34;
  const x = (value) => box.left + plot.valToPos(value, "x");
  const y = (value) => box.top + down + plot.valToPos(value, "y");
  const parts = [];
  const text = (at, content, more = "") => parts.push(`<text x="${at[0].toFixed(1)}" y="${at[1].toFixed(1)}" ${more}>${xml(content)}</text>`);
  const [right, bottom] = [box.left + box.width, box.top + down + box.height];
  for (const [k, scale] of [[0, "x"], [1, "y"]]) {
    const axis = plot.axes[k];
    (axis._splits ?? []).forEach((split, n) => {
      const label = axis._values?.[n];
      if (split == null || label == null || label === "") return;
      if (scale === "x") {
        parts.push(`<line x1="${x(split)}" x2="${x(split)}" y1="${box.top + down}" y2="${bottom}" stroke="${colour("line")}"/>`);
        text([x(split), bottom + 15], label, 'text-anchor="middle"');
      } else {
        parts.push(`<line x1="${box.left}" x2="${right}" y1="${y(split)}" y2="${y(split)}" stroke="${colour("line")}"/>`);
        text([box.left - 6, y(split) + 4], label, 'text-anchor="end"');
      }
    });
  }
  text([box.left + box.width / 2, bottom + 34], chart.xTitle(), 'text-anchor="middle"');
  parts.push(`<text transform="translate(13 ${box.top + down + box.height / 2}) rotate(-90)" text-anchor="middle">${xml(chart.yTitle())}</text>`);
  let across = box.left;
  spec.series.forEach((series, k) => {
    if (!plot.series[k + 1].show) return;
    const ink = colour(series.colour);
    parts.push(curveOf(plot, k + 1, [x, y], ink, series));
    if (series.label && !series.quiet) {
      parts.push(`<rect x="${across}" y="12" width="14" height="4" fill="${ink}"/>`);
      text([across + 19, 18], series.label);
      across += 34 + 6.6 * series.label.length;
    }
  });
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="system-ui, sans-serif" font-size="12" fill="${colour("ink")}"><title>${xml(spec.title)}</title><rect width="${width}" height="${height}" fill="${colour("card")}"/><clipPath id="box"><rect x="${box.left}" y="${box.top + down}" width="${box.width}" height="${box.height}"/></clipPath>${parts.join("")}</svg>\n`;
}

function curveOf(plot, s, [x, y], ink, series) {
  const [xs, ys] = [plot.data[0], plot.data[s]];
  const { min, max } = plot.scales.x;
  const runs = [];
  let run = null;
  let column = null;
  const flush = () => {
    if (!column || !run) return;
    const ends = [column.first, ...(column.low[0] <= column.high[0] ? [column.low, column.high] : [column.high, column.low]), column.last];
    for (const [px, value] of ends) run.push(`${px.toFixed(1)},${y(value).toFixed(1)}`);
    column = null;
  };
  const dots = [];
  for (let k = 0; k < xs.length; k++) {
    if (xs[k] < min || xs[k] > max) continue;
    const value = ys[k];
    if (value === undefined) continue;
    if (value === null || Number.isNaN(value)) {
      flush();
      run = null;
      continue;
    }
    const px = x(xs[k]);
    if (series.dots) {
      dots.push(`M${px.toFixed(1)} ${y(value).toFixed(1)}h0`);
      continue;
    }
    if (!run) runs.push((run = []));
    if (column && Math.round(column.first[0]) !== Math.round(px)) flush();
    column ??= { first: [px, value], low: [px, value], high: [px, value], last: [px, value] };
    if (value < column.low[1]) column.low = [px, value];
    if (value > column.high[1]) column.high = [px, value];
    column.last = [px, value];
  }
  flush();
  if (series.dots) return `<path d="${dots.join("")}" stroke="${ink}" stroke-width="3" stroke-linecap="round" clip-path="url(#box)"/>`;
  return runs.map((points) => `<polyline fill="none" stroke="${ink}" stroke-width="${series.width ?? 1.5}" points="${points.join(" ")}" clip-path="url(#box)"/>`).join("");
}

// The canvas as it is, on the colour of the page, with title and names above.
function pngOf(canvas, title, names, done) {
  const ratio = devicePixelRatio || 1;
  const image = document.createElement("canvas");
  const above = 44 * ratio;
  image.width = canvas.width;
  image.height = canvas.height + above;
  const pen = image.getContext("2d");
  pen.fillStyle = colour("card");
  pen.fillRect(0, 0, image.width, image.height);
  pen.drawImage(canvas, 0, above);
  pen.fillStyle = colour("ink");
  pen.font = `600 ${13 * ratio}px system-ui, sans-serif`;
  pen.fillText(title, 8 * ratio, 17 * ratio);
  pen.font = `${12 * ratio}px system-ui, sans-serif`;
  let across = 8 * ratio;
  for (const [name, ink] of names) {
    pen.fillStyle = ink;
    pen.fillRect(across, 30 * ratio, 14 * ratio, 4 * ratio);
    pen.fillStyle = colour("ink");
    pen.fillText(name, across + 19 * ratio, 36 * ratio);
    across += 34 * ratio + pen.measureText(name).width;
  }
  image.toBlob((blob) => done(blob), "image/png");
}
