// Cells as small triangles and their edges as short lines, so that curved shapes look curved.

const CORNERS = [[-1, -1], [1, -1], [1, 1], [-1, 1]];

/** Shape functions of a block's kind of cell at natural coordinates: sums of monomials. */
function shapeFunctions({ powers, coefficients }, x, y) {
  const terms = powers.map(([i, j]) => x ** i * y ** j);
  return coefficients[0].map((_, k) => terms.reduce((sum, term, i) => sum + term * coefficients[i][k], 0));
}

/** Points and triangles that divide a cell into `parts` along each side. */
function pattern(kind, parts) {
  const points = [];
  const triangles = [];
  if (kind.startsWith("tri")) {
    const start = [];
    for (let j = 0; j <= parts; j++) {
      start.push(points.length);
      for (let i = 0; i <= parts - j; i++) points.push([i / parts, j / parts]);
    }
    for (let j = 0; j < parts; j++) {
      for (let i = 0; i < parts - j; i++) {
        const low = start[j] + i;
        const high = start[j + 1] + i;
        triangles.push(low, low + 1, high);
        if (i < parts - j - 1) triangles.push(low + 1, high + 1, high);
      }
    }
    return { points, triangles };
  }
  for (let j = 0; j <= parts; j++) {
    for (let i = 0; i <= parts; i++) points.push([(2 * i) / parts - 1, (2 * j) / parts - 1]);
  }
  const half = (parts - 1) / 2;
  for (let j = 0; j < parts; j++) {
    for (let i = 0; i < parts; i++) {
      const a = j * (parts + 1) + i;
      const [b, c, d] = [a + 1, a + parts + 2, a + parts + 1];
      // Diagonals towards the middle keep the picture symmetric.
      if ((i - half) * (j - half) >= 0) triangles.push(a, b, c, a, c, d);
      else triangles.push(a, b, d, b, c, d);
    }
  }
  return { points, triangles };
}

/** Places in a pattern of the points along the side between two corners. */
function along(points, from, to) {
  const dx = to[0] - from[0];
  const dy = to[1] - from[1];
  return points
    .map(([x, y], place) => ({
      place,
      t: ((x - from[0]) * dx + (y - from[1]) * dy) / (dx * dx + dy * dy),
      off: Math.abs((x - from[0]) * dy - (y - from[1]) * dx),
    }))
    .filter(({ off }) => off < 1e-9)
    .sort((a, b) => a.t - b.t)
    .map(({ place }) => place);
}

/** Into how many parts a side is divided: fewer in large meshes. */
function partsOf(kind, nCells) {
  if (kind === "tri3" || nCells > 40000) return 1;
  if (kind === "quad4" || nCells > 4000) return 2;
  return 4;
}

/** Sides of an outline, each from a node to another, as long chains: dashes run through. */
function joined(sides) {
  const from = new Map();
  for (const side of sides) from.set(side.ends[0], [...(from.get(side.ends[0]) ?? []), side]);
  const chains = [];
  for (const first of sides) {
    const chain = [];
    for (let side = first; side && !side.taken; side = from.get(side.ends[1])?.find((next) => !next.taken)) {
      side.taken = true;
      chain.push(...side.points);
    }
    if (chain.length) chains.push(Uint32Array.from(chain));
  }
  return chains;
}

export class Surface {
  /** Triangles, edges and outline of all cells of the plane. */
  constructor(blocks, nCells) {
    this.pieces = [];
    this.count = 0;
    const triangles = [];
    const owner = [];
    const sides = new Map();
    let offset = 0;
    for (const block of blocks) {
      if (block.edges.length) this.#add(block, offset, nCells, triangles, owner, sides);
      offset += block.count;
    }
    this.triangles = Uint32Array.from(triangles);
    this.owner = Int32Array.from(owner);
    const edges = [];
    const outline = [];
    for (const side of sides.values()) {
      for (let i = 1; i < side.points.length; i++) edges.push(side.points[i - 1], side.points[i]);
      if (side.cells === 1) outline.push(side);
    }
    this.edges = Uint32Array.from(edges);
    this.outline = joined(outline);
  }

  #add(block, offset, nCells, triangles, owner, sides) {
    const { points, triangles: small } = pattern(block.kind, partsOf(block.kind, nCells));
    const corners = block.kind.startsWith("tri") ? [[0, 0], [1, 0], [0, 1]] : CORNERS;
    const chains = block.edges.map(([a, b]) => along(points, corners[a], corners[b]));
    const shape = points.map(([x, y]) => shapeFunctions(block, x, y));
    this.pieces.push({ block, shape, start: this.count, size: points.length });
    for (let row = 0; row < block.count; row++) {
      const first = this.count + row * points.length;
      for (const place of small) triangles.push(first + place);
      for (let i = 0; i < small.length; i += 3) owner.push(offset + row);
      block.edges.forEach(([a, b], side) => {
        const ends = [block.nodes[row * block.width + a], block.nodes[row * block.width + b]];
        const key = Math.min(...ends) * 67108864 + Math.max(...ends);
        const known = sides.get(key);
        if (known) known.cells += 1;
        else sides.set(key, { cells: 1, ends, points: chains[side].map((place) => first + place) });
      });
    }
    this.count += block.count * points.length;
  }

  /** Values at the drawn points from those at the nodes, `width` numbers each. */
  spread(nodal, width, out = new Float32Array(this.count * width)) {
    for (const { block, shape, start, size } of this.pieces) {
      const { nodes, width: k, count } = block;
      for (let row = 0; row < count; row++) {
        for (let p = 0; p < size; p++) {
          const weights = shape[p];
          const at = (start + row * size + p) * width;
          for (let c = 0; c < width; c++) {
            let sum = 0;
            for (let n = 0; n < k; n++) sum += weights[n] * nodal[nodes[row * k + n] * width + c];
            out[at + c] = sum;
          }
        }
      }
    }
    return out;
  }

  /** A value for each cell at its drawn points. */
  spreadCells(ofCells) {
    const out = new Float32Array(this.count);
    for (let t = 0; t < this.owner.length; t++) {
      for (let c = 0; c < 3; c++) out[this.triangles[3 * t + c]] = ofCells[this.owner[t]];
    }
    return out;
  }

  /** Triangle under a point, with the shares of its corners; null outside. */
  find(positions, x, y) {
    const t = this.triangles;
    for (let i = 0; i < t.length; i += 3) {
      const [ax, ay] = [positions[2 * t[i]], positions[2 * t[i] + 1]];
      const [bx, by] = [positions[2 * t[i + 1]] - ax, positions[2 * t[i + 1] + 1] - ay];
      const [cx, cy] = [positions[2 * t[i + 2]] - ax, positions[2 * t[i + 2] + 1] - ay];
      const area = bx * cy - by * cx;
      if (area === 0) continue;
      const b = ((x - ax) * cy - (y - ay) * cx) / area;
      const c = (bx * (y - ay) - by * (x - ax)) / area;
      if (b >= -1e-6 && c >= -1e-6 && b + c <= 1 + 1e-6) {
        return { cell: this.owner[i / 3], corners: [t[i], t[i + 1], t[i + 2]], shares: [1 - b - c, b, c] };
      }
    }
    return null;
  }
}

/** Points of the segments of a rigid curve, arcs by pieces of four degrees. */
export function rigidLines(segments) {
  return segments.map(([x0, y0, x1, y1, cx, cy, sweep]) => {
    if (sweep === 0) return [[x0, y0], [x1, y1]];
    const pieces = 1 + Math.ceil((Math.abs(sweep) * 45) / Math.PI);
    return Array.from({ length: pieces + 1 }, (_, i) => {
      const [c, s] = [Math.cos((sweep * i) / pieces), Math.sin((sweep * i) / pieces)];
      const [x, y] = [x0 - cx, y0 - cy];
      return [cx + c * x - s * y, cy + s * x + c * y];
    });
  });
}
