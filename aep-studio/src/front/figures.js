// Drawings that came with the page, drawn anew as plots when they come into view. The drawing stays for printing.

// Curves with abscissas of their own on one: undefined where a curve has no point, null where it has a gap.
function joined(curves) {
  const sorted = curves.map(({ x, y }) => {
    const order = Array.from(x, (_, k) => k)
      .filter((k) => isFinite(x[k]))
      .sort((a, b) => x[a] - x[b]);
    const ys = order.map((k) => (isFinite(y[k]) ? y[k] : null));
    return [order.map((k) => x[k]), ys];
  });
  return uPlot.join(sorted, sorted.map((table) => table.map(() => 2)));
}

// Whether a curve runs forward, so that its points belong together.
const runsForward = (x) => x.every((value, k) => k === 0 || !(value < x[k - 1]));

function plotted(raw) {
  const curves = raw.curves.map((curve) => ({ ...curve, x: floatsOf(curve.x), y: floatsOf(curve.y) }));
  const spectrum = raw.period != null;
  const series = [];
  const all = [];
  const bands = [];
  for (const curve of curves) {
    const cloud = !runsForward(curve.x.filter(isFinite));
    if (spectrum) curve.y = curve.y.map((value, k) => (value > 0 && curve.x[k] > 0 ? value : NaN));
    const isDots = cloud || /\(points\)$/.test(curve.label);
    const line = { label: curve.label.replace(/ \(points\)$/, ""), colour: curve.class, dots: isDots, size: curve.class === "c0" ? 4 : 3, width: curve.class === "c0" ? 2.5 : 1.4 };
    all.push(spectrum ? kept(curve, (x) => x > 0) : curve);
    series.push(line);
    if (curve.band) {
      const [x, low, high] = [curve.band.x, curve.band.low, curve.band.high].map(floatsOf);
      all.push({ x, y: high }, { x, y: low });
      const edge = { label: "", colour: curve.class, width: 0, quiet: true };
      series.push(edge, { ...edge });
      bands.push({ of: [series.length - 1, series.length], colour: curve.class });
    }
  }
  const [xLabel, xUnit] = splitLabel(raw.x);
  const [yLabel, yUnit] = splitLabel(raw.y);
  const data = joined(all);
  return {
    title: raw.title,
    x: { label: xLabel, unit: xUnit, log: spectrum, inverse: spectrum && raw.period !== "s" ? raw.period : null },
    y: { label: yLabel, unit: yUnit, log: spectrum },
    data,
    series,
    bands,
    marks: (raw.lines ?? []).map(([at, label]) => ({ at, label })),
    height: 290,
    note: spectrum && raw.period === "s" ? (k) => `period ${quantity(1 / data[0][k], "s")}` : null,
  };
}

const kept = ({ x, y, ...rest }, holds) => {
  const places = Array.from(x, (_, k) => k).filter((k) => holds(x[k]));
  return { ...rest, x: Float64Array.from(places, (k) => x[k]), y: Float64Array.from(places, (k) => y[k]) };
};

function enliven(figure) {
  if (figure.dataset.live) return;
  figure.dataset.live = "yes";
  const spec = plotted(JSON.parse(figure.dataset.plot));
  const still = element("div", { class: "still" });
  still.append(...figure.childNodes);
  const host = element("div", { class: "live" });
  figure.append(still, host);
  chart(host, spec);
}

// Does something with each element once it comes near to what is seen.
function whenSeen(elements, act) {
  const watcher = new IntersectionObserver(
    (entries) => {
      for (const { isIntersecting, target } of entries) {
        if (!isIntersecting || target.clientWidth === 0) continue;
        watcher.unobserve(target);
        act(target);
      }
    },
    { rootMargin: "300px" },
  );
  elements.forEach((one) => watcher.observe(one));
}

const watchFigures = (root) => whenSeen(root.querySelectorAll("figure[data-plot]"), enliven);
