// Zoom and pan of a plot along its abscissa: mouse, touch and keys. Plots of one group go together.

const groups = new Map();

function members(group) {
  if (!groups.has(group)) groups.set(group, new Set());
  return groups.get(group);
}

function leave(chart) {
  const others = members(chart.group);
  others.delete(chart);
  if (!others.size) groups.delete(chart.group);
}

// Shows [min, max] of the abscissa in a plot and in all of its group, never beyond the data.
function show(chart, min, max) {
  const [low, high] = chart.extent;
  const least = (high - low) * 1e-6;
  let width = Math.min(Math.max(max - min, least), high - low);
  let from = Math.min(Math.max(min, low), high - width);
  if (chart.log) {
    from = Math.max(min, low);
    width = Math.min(max, high) - from;
    if (!(width > 0)) return;
  }
  const all = chart.group ? members(chart.group) : [chart];
  for (const other of all) {
    other.plot.setScale("x", { min: from, max: from + width });
  }
}

const whole = (chart) => {
  chart.spec.onWhole?.();
  show(chart, ...chart.extent);
};

// Around `at` by `factor`; below 1 it comes nearer.
function zoomBy(chart, factor, at) {
  const { min, max } = chart.plot.scales.x;
  if (chart.log) {
    const place = Math.log(at);
    const to = (end) => Math.exp(place + (Math.log(end) - place) * factor);
    return show(chart, to(min), to(max));
  }
  show(chart, at + (min - at) * factor, at + (max - at) * factor);
}

function panBy(chart, share) {
  const { min, max } = chart.plot.scales.x;
  if (chart.log) {
    const factor = (max / min) ** share;
    const [low, high] = chart.extent;
    const kept = Math.min(Math.max(factor, low / min), high / max);
    return show(chart, min * kept, max * kept);
  }
  show(chart, min + (max - min) * share, max + (max - min) * share);
}

const KEYS = {
  ArrowLeft: (chart) => panBy(chart, -0.15),
  ArrowRight: (chart) => panBy(chart, 0.15),
  ArrowUp: (chart) => zoomBy(chart, 0.7, middle(chart)),
  ArrowDown: (chart) => zoomBy(chart, 1 / 0.7, middle(chart)),
  "+": (chart) => zoomBy(chart, 0.7, middle(chart)),
  "-": (chart) => zoomBy(chart, 1 / 0.7, middle(chart)),
  0: whole,
  Home: whole,
};

function middle(chart) {
  const { min, max } = chart.plot.scales.x;
  return chart.log ? Math.sqrt(min * max) : (min + max) / 2;
}

function zoomable(chart, over, host) {
  const left = (event) => event.clientX - over.getBoundingClientRect().left;
  const at = (x) => chart.plot.posToVal(x, "x");
  host.tabIndex = 0;
  host.addEventListener("keydown", (event) => {
    if (event.target !== host || event.ctrlKey || event.metaKey || event.altKey) return;
    const act = KEYS[event.key];
    if (!act) return;
    act(chart);
    event.preventDefault();
    event.stopPropagation();
  });
  let pressed = 0;
  over.addEventListener("pointerdown", (event) => {
    host.focus({ preventScroll: true });
    pressed = event.clientX;
  });
  // A drag ends with a click, too; so does what becomes a double click.
  over.addEventListener("click", (event) => {
    if (Math.abs(event.clientX - pressed) < 4 && event.detail < 2 && !event.shiftKey) chart.spec.onClick?.(at(left(event)));
  });
  // The wheel scrolls the page until the plot was clicked.
  over.addEventListener(
    "wheel",
    (event) => {
      if (!event.ctrlKey && document.activeElement !== host) return;
      event.preventDefault();
      zoomBy(chart, Math.exp(Math.sign(event.deltaY) * Math.min(Math.abs(event.deltaY), 120) * 0.002), at(left(event)));
    },
    { passive: false },
  );
  over.addEventListener("dblclick", () => whole(chart));
  // With Shift, or with the middle button, a drag moves the picture; without it chooses a stretch.
  over.addEventListener(
    "mousedown",
    (event) => {
      if (!(event.shiftKey || event.button === 1)) return;
      event.preventDefault();
      event.stopImmediatePropagation();
      let last = left(event);
      const move = (moved) => {
        panBy(chart, (last - left(moved)) / over.clientWidth);
        last = left(moved);
      };
      const end = () => {
        window.removeEventListener("mousemove", move);
        window.removeEventListener("mouseup", end);
      };
      window.addEventListener("mousemove", move);
      window.addEventListener("mouseup", end);
    },
    true,
  );
  touch(chart, over, at);
}

// One finger moves sideways, two come nearer; up and down stays with the page.
function touch(chart, over, at) {
  let before = null;
  const fingers = (event) => {
    const { left } = over.getBoundingClientRect();
    const x = [...event.touches].map((finger) => finger.clientX - left);
    return { middle: (x[0] + (x[1] ?? x[0])) / 2, apart: x.length > 1 ? Math.abs(x[1] - x[0]) : 0 };
  };
  const start = (event) => (before = event.touches.length ? fingers(event) : null);
  over.addEventListener("touchstart", start, { passive: true });
  over.addEventListener("touchend", start, { passive: true });
  over.addEventListener(
    "touchmove",
    (event) => {
      const now = fingers(event);
      if (before.apart > 0 && now.apart > 0) {
        event.preventDefault();
        zoomBy(chart, before.apart / now.apart, at(now.middle));
      }
      panBy(chart, (before.middle - now.middle) / over.clientWidth);
      before = now;
    },
    { passive: false },
  );
}
