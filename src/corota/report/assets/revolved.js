// Three quarters of a solid of revolution: its section turned about the axis, on the drawing canvas.

import { color, share } from "./colors.js";
import { ink } from "./dom.js";

/** Angles of the sections: three quarters of a turn. */
const STEPS = 54;
const TURN = 1.5 * Math.PI;
/** To the viewer, who looks into the quarter that is left out, from above; to the right; upwards. */
const unit = (v) => v.map((x) => x / Math.hypot(...v));
const cross = ([a, b, c], [d, e, f]) => [b * f - c * e, c * d - a * f, a * e - b * d];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const VIEW = unit([1, 0.7, -1]);
const RIGHT = unit(cross([0, 1, 0], VIEW));
const UP = cross(VIEW, RIGHT);
/** Where the light comes from, and the share of it that is everywhere. */
const LIGHT = unit([0.3, 1, -0.9]);
const AMBIENT = 0.55;

const turned = (x, y, t) => [x * Math.cos(t), y, x * Math.sin(t)];

/** Facets that face the viewer, the farthest first: corners, value and light of each. */
export function facets({ triangles, outline }, positions, values) {
  const found = [];
  const add = (corners, value, light) => {
    const depth = corners.reduce((sum, p) => sum + dot(p, VIEW), 0) / corners.length;
    found.push({ corners: corners.map((p) => [dot(p, RIGHT), dot(p, UP)]), value, light, depth });
  };
  const at = (i, t) => turned(positions[2 * i], positions[2 * i + 1], t);
  for (const chain of outline) {
    for (let i = 1; i < chain.length; i++) {
      const [a, b] = [chain[i - 1], chain[i]];
      // The body is on the left of its outline.
      const [dx, dy] = [positions[2 * b] - positions[2 * a], positions[2 * b + 1] - positions[2 * a + 1]];
      const length = Math.hypot(dx, dy);
      if (!length) continue;
      for (let k = 0; k < STEPS; k++) {
        const [t0, t1] = [(TURN * k) / STEPS, (TURN * (k + 1)) / STEPS];
        const normal = turned(dy / length, -dx / length, 0.5 * (t0 + t1));
        if (dot(normal, VIEW) <= 0) continue;
        const light = AMBIENT + (1 - AMBIENT) * Math.max(dot(normal, LIGHT), 0);
        add([at(a, t0), at(b, t0), at(b, t1), at(a, t1)], 0.5 * (values[a] + values[b]), light);
      }
    }
  }
  for (const t of [0, TURN]) {
    for (let i = 0; i < triangles.length; i += 3) {
      const own = [triangles[i], triangles[i + 1], triangles[i + 2]];
      add(own.map((p) => at(p, t)), own.reduce((sum, p) => sum + values[p], 0) / 3, 1);
    }
  }
  return found.sort((p, q) => p.depth - q.depth);
}

/** Draw the solid into the middle of a canvas of a size. */
export function paintRevolved(context, { width, height }, surface, positions, values, range, bands, table) {
  const solid = facets(surface, positions, values);
  const [low, high] = [[Infinity, Infinity], [-Infinity, -Infinity]];
  for (const { corners } of solid) {
    for (const p of corners) {
      for (const i of [0, 1]) [low[i], high[i]] = [Math.min(low[i], p[i]), Math.max(high[i], p[i])];
    }
  }
  const left = Math.min(96, 0.2 * width);
  const scale = Math.min((width - left - 40) / (high[0] - low[0] || 1), (height - 60) / (high[1] - low[1] || 1));
  const x = (p) => 0.5 * (width + left) + (p[0] - 0.5 * (low[0] + high[0])) * scale;
  const y = (p) => 0.5 * height - (p[1] - 0.5 * (low[1] + high[1])) * scale;
  context.lineWidth = 0.7;
  for (const { corners, value, light } of solid) {
    const own = color(table, share(value, range, bands)).replace(/\d+/g, (c) => Math.round(light * c));
    context.fillStyle = context.strokeStyle = own; // a line of the same color closes the seams
    context.beginPath();
    corners.forEach((p, i) => (i ? context.lineTo(x(p), y(p)) : context.moveTo(x(p), y(p))));
    context.closePath();
    context.fill();
    context.stroke();
  }
  context.strokeStyle = ink("outline");
  context.beginPath();
  for (const t of [0, TURN]) {
    for (const chain of surface.outline) {
      chain.forEach((i, n) => {
        const p = turned(positions[2 * i], positions[2 * i + 1], t);
        const place = [dot(p, RIGHT), dot(p, UP)];
        if (n) context.lineTo(x(place), y(place));
        else context.moveTo(x(place), y(place));
      });
    }
  }
  context.stroke();
}
