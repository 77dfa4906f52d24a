// Fields at the nodes: what the frames hold, and what follows from it.

const PARTS = ["11", "22", "33", "12"];
const VECTORS = {
  U: ["U1", "U2", "U"],
  RF: ["RF1", "RF2", "RF", "RM3"],
  F: ["F1", "F2", "F", "M3"],
  VEL: ["V1", "V2", "V", "VR3"],
  ACC: ["A1", "A2", "A", "AR3"],
};
const TENSORS = { S: "S", E: "E", PE: "PE", ALPHA: "ALPHA" };
/** Order of the list: others follow. */
const FIRST = ["MISESA", "MISES", "PEEQ", "S11", "S22", "S33", "S12", "SP1", "SP2", "SP3", "U", "U1", "U2", "UR3", "CPRESS"];

/** Principal values of xx, yy, zz, xy, largest first. */
function principal(xx, yy, zz, xy) {
  const middle = 0.5 * (xx + yy);
  const radius = Math.hypot(0.5 * (xx - yy), xy);
  return [middle + radius, middle - radius, zz].sort((a, b) => b - a);
}

function mises(xx, yy, zz, xy) {
  return Math.sqrt(0.5 * ((xx - yy) ** 2 + (yy - zz) ** 2 + (zz - xx) ** 2) + 3 * xy * xy);
}

class Field {
  constructor(name, source, compute, meaning = "") {
    Object.assign(this, { name, source, compute, meaning });
    this.cache = new WeakMap();
  }

  /** Values at the nodes in a frame; zeros where the frame has none. */
  values(frame, nNodes) {
    let found = this.cache.get(frame);
    if (!found) {
      const array = frame.arrays[this.source];
      found = array ? this.compute(array.data, nNodes) : new Float32Array(nNodes);
      this.cache.set(frame, found);
    }
    return found;
  }
}

const column = (width, index) => (data, n) => {
  const out = new Float32Array(n);
  for (let i = 0; i < n; i++) out[i] = data[width * i + index];
  return out;
};

const ofRows = (width, rule) => (data, n) => {
  const out = new Float32Array(n);
  for (let i = 0; i < n; i++) out[i] = rule(data.subarray(width * i, width * i + width));
  return out;
};

function fromSource(name, width) {
  if (VECTORS[name]) {
    const [first, second, size, turn] = VECTORS[name];
    const found = [
      [first, column(width, 0)],
      [second, column(width, 1)],
      [size, ofRows(width, ([x, y]) => Math.hypot(x, y))],
    ];
    if (width > 2) found.push([turn, column(width, 2)]);
    return found;
  }
  if (TENSORS[name]) {
    const found = PARTS.map((part, i) => [name + part, column(width, i)]);
    if (name === "S") found.push(["MISES", ofRows(4, ([a, b, c, d]) => mises(a, b, c, d))]);
    if (name === "S" || name === "E") {
      const shear = name === "S" ? 1 : 0.5; // the shear strain of results is the angle
      for (const i of [0, 1, 2]) {
        found.push([`${name}P${i + 1}`, ofRows(4, ([a, b, c, d]) => principal(a, b, c, shear * d)[i])]);
      }
    }
    return found;
  }
  return [[name === "UR" ? "UR3" : name, column(1, 0)]];
}

/** All fields that some frame has a value of, by name. */
export function fieldsOf(model, frames) {
  const sources = new Map();
  for (const frame of frames) {
    for (const [name, { shape }] of Object.entries(frame.arrays)) sources.set(name, shape[1] || 1);
  }
  const found = new Map();
  for (const [source, width] of sources) {
    for (const [name, compute] of fromSource(source, width)) {
      const known = VECTORS[source] && found.has(name); // a shear force is named as a speed
      if (!known) found.set(name, new Field(name, source, compute, model.meaning[name]));
    }
  }
  const rank = (name) => (FIRST.includes(name) ? FIRST.indexOf(name) : FIRST.length);
  return new Map([...found].sort(([a], [b]) => rank(a) - rank(b) || a.localeCompare(b)));
}

/** Smallest and largest of values where a mask is set. */
export function extremes(values, mask) {
  let low = -1;
  let high = -1;
  for (let i = 0; i < values.length; i++) {
    if (!mask[i]) continue;
    if (low < 0 || values[i] < values[low]) low = i;
    if (high < 0 || values[i] > values[high]) high = i;
  }
  return { low, high };
}
