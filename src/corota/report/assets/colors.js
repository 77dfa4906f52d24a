// Color maps and colors of lines: those of the pictures, from Python.

const PALETTE = /* of corota.plots.palette */ {};
const STOPS = PALETTE.maps;

export const MAPS = Object.keys(STOPS);
/** For values on both sides of zero; its middle is white. */
export const DIVERGING = PALETTE.diverging;
/** The map for values between two limits, of a variable that may be negative or not. */
export const mapOf = (low, high, signed) => {
  if (!signed) return PALETTE.sequential;
  const least = PALETTE.oneSign * Math.max(Math.abs(low), Math.abs(high));
  if (low < -least && high > least) return DIVERGING;
  return low + high < 0 ? PALETTE.negative : PALETTE.positive;
};
/** Of lines in charts, in this order. */
const LINES = PALETTE.lines;
/** Of sections, pale enough for symbols above them. */
const SHADES = { light: ["c9dcf0", "fadcc0", "cbe6d6", "ecd3e3", "f2e6ac", "d8d8e2"], dark: ["2f4a66", "6b4a2a", "2c5744", "603f56", "5f5522", "454552"] };

export const isDark = () => document.documentElement.dataset.shade === "dark";

export function lineColor(index) {
  const found = LINES[isDark() ? "dark" : "light"];
  return found[index % found.length];
}

/** Dashes of a line: a color that comes again is dotted. */
export const lineDash = (index) => (index < LINES.light.length ? undefined : [2, 3]);

const hex = (text, at) => [0, 2, 4].map((i) => parseInt(text.slice(at + i, at + i + 2), 16));

/** 256 colors of a map, four bytes each. */
export function table(name) {
  const stops = STOPS[name];
  const count = stops.length / 6 - 1;
  const out = new Uint8Array(1024);
  for (let i = 0; i < 256; i++) {
    const at = (i / 255) * count;
    const first = Math.min(Math.floor(at), count - 1);
    const [a, b] = [hex(stops, 6 * first), hex(stops, 6 * first + 6)];
    for (let c = 0; c < 3; c++) out[4 * i + c] = a[c] + (at - first) * (b[c] - a[c]);
    out[4 * i + 3] = 255;
  }
  return out;
}

/** Colors of sections, repeated over 256 places. */
export function shades() {
  const found = SHADES[isDark() ? "dark" : "light"];
  const out = new Uint8Array(1024);
  for (let i = 0; i < 256; i++) out.set([...hex(found[i % found.length], 0), 255], 4 * i);
  return out;
}

/** Place of a value in a range, 0 to 1, in the middle of its band if there are bands. */
export function share(value, [low, high], bands = 0) {
  const t = Math.min(Math.max((value - low) / (high - low || 1), 0), 1);
  return bands ? (Math.min(Math.floor(t * bands), bands - 1) + 0.5) / bands : t;
}

/** Color of a share of a table, for the drawing canvas. */
export function color(colors, t) {
  const at = 4 * Math.round(255 * t);
  return `rgb(${colors[at]},${colors[at + 1]},${colors[at + 2]})`;
}
