// What lies above the colors: outlines, lines, rigid curves, vectors, supports, loads, the scale.

import { color, share } from "./colors.js";
import { format, ink } from "./dom.js";
import { rigidLines } from "./geometry.js";

/** Longest arrow [pixels], and the side of a square that gets one arrow. */
const ARROW = 80;
const APART = 9;

export class Overlay {
  constructor(canvas) {
    this.canvas = canvas;
    this.context = canvas.getContext("2d");
  }

  begin(camera) {
    this.camera = camera;
    const ratio = this.canvas.width / camera.width;
    this.context.setTransform(ratio, 0, 0, ratio, 0, 0);
    this.context.clearRect(0, 0, camera.width, camera.height);
    this.context.lineJoin = "round";
    this.context.setLineDash([]);
    this.context.globalAlpha = 1;
  }

  #style(stroke, width = 1, dash = []) {
    this.context.strokeStyle = stroke;
    this.context.fillStyle = stroke;
    this.context.lineWidth = width;
    this.context.setLineDash(dash);
  }

  /** Lines through places given as indices into positions. */
  chains(chains, positions, stroke, width, dash) {
    const { context, camera } = this;
    this.#style(stroke, width, dash);
    context.beginPath();
    for (const chain of chains) {
      for (let i = 0; i < chain.length; i++) {
        const [x, y] = [camera.toX(positions[2 * chain[i]]), camera.toY(positions[2 * chain[i] + 1])];
        if (i) context.lineTo(x, y);
        else context.moveTo(x, y);
      }
    }
    context.stroke();
    context.setLineDash([]);
  }

  #polyline(points) {
    const { context, camera } = this;
    points.forEach(([x, y], i) => (i ? context.lineTo(camera.toX(x), camera.toY(y)) : context.moveTo(camera.toX(x), camera.toY(y))));
  }

  /** Rigid curves where their nodes have carried them, shaded on the rigid side. */
  rigid(model, frame, scale) {
    const { context } = this;
    const width = 0.016 * model.size;
    for (const { segments, reference } of model.rigid) {
      const carry = carrier(model, reference, frame, scale);
      for (const line of rigidLines(segments)) {
        const points = line.map(carry);
        const band = points.map(([x, y], i) => {
          const [a, b] = [points[Math.max(i - 1, 0)], points[Math.min(i + 1, points.length - 1)]];
          const length = Math.hypot(b[0] - a[0], b[1] - a[1]) || 1;
          return [x + (width * (b[1] - a[1])) / length, y - (width * (b[0] - a[0])) / length];
        });
        context.fillStyle = ink("rigid-band");
        context.beginPath();
        this.#polyline([...points, ...band.reverse()]);
        context.fill();
        this.#style(ink("rigid"), 1.6);
        context.beginPath();
        this.#polyline(points);
        context.stroke();
      }
    }
  }

  /** Rigid bodies and couplings: lines from their reference nodes. */
  couplings(model, positions) {
    const { context, camera } = this;
    const place = (node) => [camera.toX(positions[2 * node]), camera.toY(positions[2 * node + 1])];
    for (const { reference, nodes } of model.description.couplings ?? []) {
      this.#style(ink("link"), 0.8);
      const [x, y] = place(reference);
      context.beginPath();
      for (const node of nodes) {
        context.moveTo(x, y);
        context.lineTo(...place(node));
      }
      context.stroke();
      context.fillRect(x - 2.5, y - 2.5, 5, 5);
    }
  }

  /** Line elements, colored by the mean of their ends where values are given. */
  lines(cells, positions, values, range, bands, table) {
    const { context, camera } = this;
    for (const { first, last } of cells) {
      const stroke = values ? color(table, share(0.5 * (values[first] + values[last]), range, bands)) : ink("beam");
      this.#style(stroke, 3);
      context.beginPath();
      context.moveTo(camera.toX(positions[2 * first]), camera.toY(positions[2 * first + 1]));
      context.lineTo(camera.toX(positions[2 * last]), camera.toY(positions[2 * last + 1]));
      context.stroke();
    }
  }

  /** An arrow from a place along (dx, dy) pixels, y upwards; `towards` puts its head at the place. */
  arrow(x, y, dx, dy, stroke, { towards = false, width = 1.6 } = {}) {
    const { context } = this;
    const [fromX, fromY] = towards ? [x - dx, y + dy] : [x, y];
    const [toX, toY] = towards ? [x, y] : [x + dx, y - dy];
    const length = Math.hypot(dx, dy);
    if (length < 1) return;
    const head = Math.min(8, 0.5 * length);
    const [ux, uy] = [(toX - fromX) / length, (toY - fromY) / length];
    this.#style(stroke, width);
    context.beginPath();
    context.moveTo(fromX, fromY);
    context.lineTo(toX - head * ux, toY - head * uy);
    context.stroke();
    context.beginPath();
    context.moveTo(toX, toY);
    context.lineTo(toX - head * ux - 0.45 * head * uy, toY - head * uy + 0.45 * head * ux);
    context.lineTo(toX - head * ux + 0.45 * head * uy, toY - head * uy - 0.45 * head * ux);
    context.closePath();
    context.fill();
  }

  /** A turning arrow about a place, counter-clockwise for positive moments. */
  turn(x, y, sign, stroke) {
    const { context } = this;
    const radius = 9;
    // Angles of the screen grow clockwise; the arc leaves a gap at its right-hand side.
    const [start, end] = sign > 0 ? [-0.5, 0.9 - 2 * Math.PI] : [0.5, 2 * Math.PI - 0.9];
    this.#style(stroke, 1.6);
    context.beginPath();
    context.arc(x, y, radius, start, end, sign > 0);
    context.stroke();
    const way = sign > 0 ? -1 : 1;
    const [tipX, tipY] = [x + radius * Math.cos(end), y + radius * Math.sin(end)];
    const [alongX, alongY] = [-way * Math.sin(end), way * Math.cos(end)];
    context.beginPath();
    context.moveTo(tipX + 6 * alongX, tipY + 6 * alongY);
    context.lineTo(tipX - 4 * alongY, tipY + 4 * alongX);
    context.lineTo(tipX + 4 * alongY, tipY - 4 * alongX);
    context.closePath();
    context.fill();
  }

  /** Forces (n, 3) at nodes, lengths in shares of the largest of all frames; one a square. */
  forces(data, positions, largest, stroke) {
    const { camera } = this;
    const squares = new Map();
    for (let node = 0; node < data.length / 3; node++) {
      const size = Math.hypot(data[3 * node], data[3 * node + 1]);
      if (size < 0.01 * largest) continue;
      const [x, y] = [camera.toX(positions[2 * node]), camera.toY(positions[2 * node + 1])];
      const key = `${Math.round(x / APART)},${Math.round(y / APART)}`;
      const known = squares.get(key);
      if (!known || known.size < size) squares.set(key, { node, size, x, y });
    }
    for (const { node, x, y } of squares.values()) {
      const length = ARROW / largest;
      this.arrow(x, y, length * data[3 * node], length * data[3 * node + 1], stroke, { towards: true });
    }
  }

  /** Contact pressure as a diagram along slave surfaces, with arrows on the body. */
  pressures(model, values, positions, largest, stroke) {
    const { context, camera } = this;
    for (const { slave } of model.pairs) {
      if (!slave) continue;
      const normals = slaveNormals(slave, positions);
      const tips = new Map();
      for (const [node, [nx, ny]] of normals) {
        if (!(values[node] > 0)) continue;
        const length = (0.8 * ARROW * values[node]) / largest;
        tips.set(node, [length * nx, length * ny]);
        const [x, y] = [camera.toX(positions[2 * node]), camera.toY(positions[2 * node + 1])];
        this.arrow(x, y, -length * nx, -length * ny, stroke, { towards: true, width: 1.1 });
      }
      this.#style(stroke, 1.2);
      context.beginPath();
      for (let i = 0; i < slave.length; i += 3) {
        const chain = slave[i + 2] >= 0 ? [slave[i], slave[i + 2], slave[i + 1]] : [slave[i], slave[i + 1]];
        if (!chain.some((node) => tips.has(node))) continue;
        chain.forEach((node, place) => {
          const [dx, dy] = tips.get(node) ?? [0, 0];
          const [x, y] = [camera.toX(positions[2 * node]) + dx, camera.toY(positions[2 * node + 1]) - dy];
          if (place) context.lineTo(x, y);
          else context.moveTo(x, y);
        });
      }
      context.stroke();
    }
  }

  /** Supports: triangles along constrained directions, squares for rotations, arrows for travel. */
  supports(model, step) {
    const { camera } = this;
    const middle = [0, 1].map((i) => 0.5 * (model.low[i] + model.high[i]));
    const ended = (model.description.supports ?? []).filter((s) => s.free && (step < 0 || s.step <= step));
    for (const support of chosen(model.description.supports, step)) {
      if (support.free || (step >= 0 && ended.some((e) => same(e, support)))) continue;
      for (const [x, y, node] of this.#apart(model, support.nodes)) {
        const at = [model.points[2 * node], model.points[2 * node + 1]];
        const beyond = at[support.dof] > middle[support.dof] ? 1 : -1;
        if (support.value !== 0 && support.dof < 2) {
          const way = 34 * Math.sign(support.value);
          this.arrow(x, y, support.dof === 0 ? way : 0, support.dof === 1 ? way : 0, ink("travel"), { width: 2 });
        } else if (support.dof === 2) {
          this.#style(ink("support"), 1.4);
          this.context.strokeRect(x - 4, y - 4, 8, 8);
        } else {
          this.#triangle(x, y, support.dof === 0 ? beyond : 0, support.dof === 1 ? -beyond : 0);
        }
      }
    }
    this.couplings(model, model.points);
    for (const mass of model.description.masses ?? []) {
      this.#style(ink("ink"));
      for (const node of mass.nodes) this.#dot(...this.#place(model, node), 5);
    }
    for (const [first, second] of model.description.dashpots ?? []) {
      const [x, y] = [model.points[2 * first], model.points[2 * first + 1]];
      this.#style(ink("link"), 2, [4, 3]);
      this.context.beginPath();
      this.context.moveTo(camera.toX(x), camera.toY(y));
      this.context.lineTo(...(second < 0 ? [camera.toX(x) - 24, camera.toY(y)] : this.#place(model, second)));
      this.context.stroke();
    }
  }

  #place(model, node) {
    return [this.camera.toX(model.points[2 * node]), this.camera.toY(model.points[2 * node + 1])];
  }

  #dot(x, y, radius) {
    this.context.setLineDash([]);
    this.context.beginPath();
    this.context.arc(x, y, radius, 0, 2 * Math.PI);
    this.context.fill();
  }

  /** A triangle whose tip is at a place and that opens along (dx, dy) of the screen. */
  #triangle(x, y, dx, dy) {
    const { context } = this;
    this.#style(ink("support"), 1.2);
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + 10 * dx - 5 * dy, y + 10 * dy + 5 * dx);
    context.lineTo(x + 10 * dx + 5 * dy, y + 10 * dy - 5 * dx);
    context.closePath();
    context.fill();
  }

  /** Places of nodes that stand apart on the screen, with the node. */
  #apart(model, nodes, apart = 13) {
    const found = new Map();
    for (const node of nodes) {
      const [x, y] = this.#place(model, node);
      const key = `${Math.round(x / apart)},${Math.round(y / apart)}`;
      if (!found.has(key)) found.set(key, [x, y, node]);
    }
    return [...found.values()];
  }

  /** Loads: arrows at nodes and on edges, one in the middle for gravity. */
  loads(model, step) {
    const { camera } = this;
    const loads = chosen(model.description.loads, step);
    const sizes = loads.filter((l) => l.kind === "force").flatMap((l) => l.value.map(Math.abs));
    const largest = Math.max(...sizes, 0) || 1;
    const stroke = ink("load");
    for (const load of loads) {
      if (load.kind === "force" || load.kind === "moment") {
        for (const [x, y, node] of this.#apart(model, load.nodes)) {
          const value = load.value[load.value.length > 1 ? load.nodes.indexOf(node) : 0];
          if (value === 0) continue;
          const length = Math.sign(value) * (18 + 26 * Math.abs(value / largest));
          if (load.kind === "moment") this.turn(x, y, Math.sign(value), stroke);
          else this.arrow(x, y, load.dof === 0 ? length : 0, load.dof === 1 ? length : 0, stroke, { width: 2 });
        }
      } else if (load.edges) {
        this.#edgeLoad(model, load, stroke);
      } else if (load.kind === "gravity") {
        const size = Math.hypot(...load.value) || 1;
        const [x, y] = [0, 1].map((i) => 0.5 * (model.low[i] + model.high[i]));
        this.arrow(camera.toX(x), camera.toY(y), (48 * load.value[0]) / size, (48 * load.value[1]) / size, stroke, { width: 3 });
      }
    }
  }

  #edgeLoad(model, load, stroke) {
    const squares = new Set();
    for (const [first, last] of load.edges) {
      const [[ax, ay], [bx, by]] = [this.#place(model, first), this.#place(model, last)];
      const [x, y] = [0.5 * (ax + bx), 0.5 * (ay + by)];
      const key = `${Math.round(x / 14)},${Math.round(y / 14)}`;
      if (squares.has(key)) continue;
      squares.add(key);
      const length = Math.hypot(bx - ax, by - ay) || 1;
      if (load.kind.endsWith("pressure")) {
        const sign = Math.sign(load.value[0]);
        // The body is on the left of the edge; on the screen y points down.
        const inward = [(by - ay) / length, (bx - ax) / length];
        this.arrow(x, y, 24 * sign * inward[0], 24 * sign * inward[1], stroke, { towards: sign > 0 });
      } else {
        const size = Math.hypot(...load.value) || 1;
        this.arrow(x, y, (24 * load.value[0]) / size, (24 * load.value[1]) / size, stroke);
      }
    }
  }

  /** Members of a set. */
  highlight(model, kind, members) {
    const { context } = this;
    this.#style(ink("accent"), 3);
    if (kind === "node") for (const node of members) this.#dot(...this.#place(model, node), 3);
    context.beginPath();
    if (kind === "edge") {
      for (let i = 0; i < members.length; i += 3) {
        context.moveTo(...this.#place(model, members[i]));
        if (members[i + 2] >= 0) context.lineTo(...this.#place(model, members[i + 2]));
        context.lineTo(...this.#place(model, members[i + 1]));
      }
      context.stroke();
    }
    if (kind === "cell") {
      for (const index of members) {
        const { kind: shape, nodes } = model.cell(index);
        const corners = nodes.slice(0, shape.startsWith("tri") ? 3 : shape.startsWith("quad") ? 4 : 2);
        corners.forEach((node, i) => (i ? context.lineTo(...this.#place(model, node)) : context.moveTo(...this.#place(model, node))));
        if (corners.length > 2) context.closePath();
      }
      context.globalAlpha = 0.45;
      context.fill();
      context.globalAlpha = 1;
      context.lineWidth = 1;
      context.stroke();
    }
  }

  /** The scale of colors on the left, with the field's name and numbers. */
  legend({ name, meaning, range, bands, table, remark }) {
    const { context, camera } = this;
    const height = Math.min(220, 0.5 * camera.height);
    const [x, y] = [14, 44];
    this.#text(name, x, 20, { bold: true });
    if (meaning) this.#text(meaning, x + 10 + context.measureText(name).width, 20, { soft: true });
    for (let i = 0; i < height; i++) {
      context.fillStyle = color(table, share(1 - (i + 0.5) / height, [0, 1], bands));
      context.fillRect(x, y + i, 16, 1.5);
    }
    this.#style(ink("ink"), 0.7);
    context.strokeRect(x, y, 16, height);
    for (let i = 0; i <= 4; i++) {
      const value = range[0] + (i / 4) * (range[1] - range[0]);
      this.#text(format(Math.abs(value) < 1e-9 * Math.max(...range.map(Math.abs)) ? 0 : value, 4), x + 22, y + height * (1 - i / 4) + 4);
    }
    if (remark) this.#text(remark, x, y + height + 22, { soft: true });
  }

  /** A ring about a place, with a text beside it. */
  mark(x, y, text, stroke = ink("accent")) {
    const { context } = this;
    this.#style(stroke, 2);
    context.beginPath();
    context.arc(x, y, 6, 0, 2 * Math.PI);
    context.stroke();
    if (text) this.#text(text, x + 10, y - 8, { bold: true });
  }

  #text(text, x, y, { bold = false, soft = false } = {}) {
    const { context } = this;
    context.font = `${bold ? 600 : 400} 12px system-ui, sans-serif`;
    context.lineWidth = 3;
    context.setLineDash([]);
    context.strokeStyle = ink("stage");
    context.strokeText(text, x, y);
    context.fillStyle = ink(soft ? "soft" : "ink");
    context.fillText(text, x, y);
  }
}

const chosen = (items, step) => (items ?? []).filter((item) => step < 0 || item.step === 0 || item.step === step);

/** Whether two supports are at one place in one direction. */
const same = (a, b) => a.dof === b.dof && a.where === b.where && a.nodes.length === b.nodes.length && a.nodes[0] === b.nodes[0];

/** Places of a rigid curve in a frame. */
export function rigidPoints(model, { segments, reference }, frame, scale) {
  return rigidLines(segments).flat().map(carrier(model, reference, frame, scale));
}

/** Where the node that carries a rigid curve takes a point. */
function carrier(model, reference, frame, scale) {
  if (reference < 0 || !frame) return (point) => point;
  const at = [model.points[2 * reference], model.points[2 * reference + 1]];
  const move = frame.arrays.U ? [0, 1].map((i) => scale * frame.arrays.U.data[2 * reference + i]) : [0, 0];
  const angle = scale * (frame.arrays.UR?.data[reference] ?? 0);
  const [c, s] = [Math.cos(angle), Math.sin(angle)];
  return ([x, y]) => [
    at[0] + move[0] + c * (x - at[0]) - s * (y - at[1]),
    at[1] + move[1] + s * (x - at[0]) + c * (y - at[1]),
  ];
}

/** Outward unit normals at the nodes of a slave surface, means over its edges. */
function slaveNormals(slave, positions) {
  const found = new Map();
  for (let i = 0; i < slave.length; i += 3) {
    const [first, last, middle] = slave.subarray(i, i + 3);
    const along = [positions[2 * last] - positions[2 * first], positions[2 * last + 1] - positions[2 * first + 1]];
    for (const node of [first, last, middle]) {
      if (node < 0) continue;
      const sum = found.get(node) ?? [0, 0];
      found.set(node, [sum[0] + along[1], sum[1] - along[0]]);
    }
  }
  for (const [node, [x, y]] of found) {
    const length = Math.hypot(x, y) || 1;
    found.set(node, [x / length, y / length]);
  }
  return found;
}
