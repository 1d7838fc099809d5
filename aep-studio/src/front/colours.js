// Colours are those of the style sheet, so that plots follow light and dark.

const style = () => getComputedStyle(document.documentElement);
let known = {};
const colour = (name) => (known[name] ??= style().getPropertyValue(`--${name}`).trim());

// Everything that is drawn with them, by what draws it anew.
const plots = new Set();
function forgetColours() {
  known = {};
  for (const plot of plots) plot.redraw();
}
matchMedia("(prefers-color-scheme: dark)").addEventListener("change", forgetColours);

// A colour with some of it seen through; colours of the style sheet are #rrggbb.
const through = (hex, alpha) => hex + Math.round(255 * alpha).toString(16).padStart(2, "0");

// From one end of a residual over nothing to the other.
function diverging(share) {
  const mix = (a, b, t) => a.map((value, k) => Math.round(value + (b[k] - value) * t));
  const parse = (hex) => [1, 3, 5].map((k) => parseInt(hex.slice(k, k + 2), 16));
  const end = parse(colour(share < 0 ? "c1" : "c2"));
  const t = Math.min(1, Math.abs(share)) ** 0.75;
  return `rgb(${mix(parse(colour("nothing")), end, t).join(" ")})`;
}
