// Numbers with units, as people read them.

const PREFIXED = new Set(["m", "s", "N", "Nm", "N/m", "rad", "m/s", "rad/s", "m/s²", "rad/s²", "m/s/s", "V", "A", "Hz"]);

// A prefix for values up to `size`: {factor, unit}.
function prefixed(size, unit) {
  if (!PREFIXED.has(unit) || !(size > 0) || !isFinite(size)) return { factor: 1, unit };
  const big = unit.startsWith("N") ? [[1e6, 1e-6, "M"], [1e4, 1e-3, "k"]] : [];
  for (const [from, factor, prefix] of big) if (size >= from) return { factor, unit: prefix + unit };
  if (size < 0.9995e-6) return { factor: 1e9, unit: "n" + unit };
  if (size < 0.9995e-3) return { factor: 1e6, unit: "µ" + unit };
  if (size < 0.1 || (size < 0.9995 && unit.startsWith("m"))) return { factor: 1e3, unit: "m" + unit };
  return { factor: 1, unit };
}

function number(value, digits = 3) {
  if (!isFinite(value)) return "–";
  if (value === 0) return "0";
  const size = Math.abs(value);
  if (size < 1e-4 || size >= 1e6) return value.toExponential(digits - 1);
  const text = value.toPrecision(digits);
  return text.includes("e") ? String(Math.round(value)) : text;
}

function quantity(value, unit, digits = 3) {
  if (!isFinite(value)) return "–";
  const { factor, unit: shown } = prefixed(Math.abs(value), unit);
  return `${number(value * factor, digits)} ${shown}`.trim();
}

// A label of an axis, with the unit in brackets as far as there is one.
const labelled = (label, unit) => (unit && unit !== "1" ? `${label} / ${unit}` : label);

// "name / unit" as Rust writes labels; units may hold a stroke themselves.
function splitLabel(label) {
  const at = label.indexOf(" / ");
  return at < 0 ? [label, ""] : [label.slice(0, at), label.slice(at + 3)];
}

const sizeOf = (values) => {
  let most = 0;
  for (const value of values) if (Math.abs(value) > most) most = Math.abs(value);
  return most;
};
