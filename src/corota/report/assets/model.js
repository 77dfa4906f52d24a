// The model: mesh, labels, sets, description.

import { Surface } from "./geometry.js";

export class Model {
  constructor(chunk) {
    const { arrays } = chunk;
    this.name = chunk.name;
    this.lines = chunk.lines;
    this.description = chunk.description || {};
    this.meaning = chunk.meaning || {};
    this.positive = chunk.positive || [];
    this.units = chunk.units || {};
    this.averaging = chunk.averaging;
    this.sets = chunk.sets;
    this.arrays = arrays;
    this.points = arrays.points.data;
    this.nNodes = arrays.points.shape[0];
    this.nodeLabels = arrays["node labels"].data;
    this.sections = arrays["section of cells"].data;
    this.blocks = chunk.blocks.map((block, number) => ({
      ...block,
      nodes: arrays[`nodes ${number}`].data,
      width: arrays[`nodes ${number}`].shape[1],
      count: arrays[`nodes ${number}`].shape[0],
      labels: arrays[`labels ${number}`].data,
    }));
    this.offsets = [0];
    for (const block of this.blocks) this.offsets.push(this.offsets.at(-1) + block.count);
    this.nCells = this.offsets.at(-1);
    this.rigid = chunk.rigid || [];
    this.pairs = (chunk.pairs || []).map((pair, number) => ({
      ...pair,
      slave: arrays[`slave ${number}`]?.data,
      master: arrays[`master ${number}`]?.data,
    }));
    this.surface = new Surface(this.blocks, this.nCells);
    this.lineCells = this.#lines();
    this.#extent();
  }

  /** Line elements as pairs of nodes with their cell. */
  #lines() {
    const found = [];
    this.blocks.forEach((block, number) => {
      if (!block.kind.startsWith("line")) return;
      for (let row = 0; row < block.count; row++) {
        const [first, last] = block.nodes.subarray(row * block.width, row * block.width + 2);
        found.push({ first, last, cell: this.offsets[number] + row });
      }
    });
    return found;
  }

  #extent() {
    this.low = [Infinity, Infinity];
    this.high = [-Infinity, -Infinity];
    for (let i = 0; i < this.points.length; i++) {
      this.low[i % 2] = Math.min(this.low[i % 2], this.points[i]);
      this.high[i % 2] = Math.max(this.high[i % 2], this.points[i]);
    }
    this.size = Math.hypot(this.high[0] - this.low[0], this.high[1] - this.low[1]) || 1;
  }

  /** Mask of the nodes that a cell of the plane or a line has. */
  get used() {
    if (!this._used) {
      this._used = new Uint8Array(this.nNodes);
      for (const block of this.blocks) for (const node of block.nodes) this._used[node] = 1;
    }
    return this._used;
  }

  /** Block, row, nodes and label of a cell. */
  cell(index) {
    let number = 0;
    while (index >= this.offsets[number + 1]) number++;
    const block = this.blocks[number];
    const row = index - this.offsets[number];
    return {
      kind: block.kind,
      label: block.labels[row],
      nodes: [...block.nodes.subarray(row * block.width, (row + 1) * block.width)],
      section: this.sections[index],
    };
  }

  nodeOfLabel(label) {
    return this.nodeLabels.indexOf(label);
  }

  cellOfLabel(label) {
    for (let number = 0; number < this.blocks.length; number++) {
      const row = this.blocks[number].labels.indexOf(label);
      if (row >= 0) return this.offsets[number] + row;
    }
    return -1;
  }

  set(kind, number) {
    return this.arrays[`${kind} set ${number}`].data;
  }
}
