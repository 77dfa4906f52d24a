// Color maps that are perceptually uniform and clear to color-blind readers, as 33 stops each.

const STOPS = {
  viridis:
    "440154470d6048186a482374472d7b4537814240863e49893b528b375b8d33638d2f6b8e2c728e297a8e26828e23898e21918c" +
    "1f988b1fa08822a78528ae8032b67a3fbc734ec36b5ec96270cf5784d44b98d83eaddc30c2df23d8e219ece51bfde725",
  cividis:
    "00224e00285b002e6a0533711a386f273e6e32436d3b496c434e6c4b546c535a6d5a5f6e61656f686a716f70737676767d7c78" +
    "8482798c8878938e789b9476a39a74aba072b4a76fbcae6cc4b468cdbb63d5c25edec958e7d150f0d846f9e03afee838",
  inferno:
    "0000040403120b0724150b37210c4a2f0a5b3d09654a0c6b57106e64156e71196e7d1e6d8a226a972766a32c61b0315bbc3754" +
    "c73e4cd24644db503be45a31eb6628f1731df68013f98e09fb9d07fcac11fbbc21f9cb35f5db4cf2ea69f3f68afcffa4",
  "blue–orange":
    "0f47861a5191255b9c3065a73c70b0487bba5585c26390ca719bd17fa6d88eb1dd9ebce2aec6e7bed1eacfdcede0e7f0f2f2f2" +
    "eee4deebd6cbe6c8b8e1bba6dcae94d6a183cf9473c78763bf7b54b66f45ad6337a35829994d1a8e4208833800772e00",
};

// Its halves, for values of one sign: pale near zero.
STOPS.blue = STOPS["blue–orange"].slice(0, 6 * 16);
STOPS.orange = STOPS["blue–orange"].slice(6 * 17);

export const MAPS = Object.keys(STOPS);
/** For values on both sides of zero; its middle is white. */
export const DIVERGING = "blue–orange";
/** Of lines in charts, in this order (Okabe and Ito, lighter on dark ground). */
const LINES = {
  light: ["#0072b2", "#d55e00", "#009e73", "#cc79a7", "#e69f00", "#56b4e9", "#8a7400", "#6f6f6f"],
  dark: ["#56b4e9", "#ff9a4d", "#3fc79a", "#f0a3cf", "#f0c14b", "#9db8ff", "#d3c95c", "#b5b5b5"],
};
/** Of sections, pale enough for symbols above them. */
const SHADES = { light: ["c9dcf0", "fadcc0", "cbe6d6", "ecd3e3", "f2e6ac", "d8d8e2"], dark: ["2f4a66", "6b4a2a", "2c5744", "603f56", "5f5522", "454552"] };

export const isDark = () => document.documentElement.dataset.shade === "dark";

export function lineColor(index) {
  const found = LINES[isDark() ? "dark" : "light"];
  return found[index % found.length];
}

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
