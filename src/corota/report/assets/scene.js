// What is drawn: the model, its frames, the chosen frame, field, range and deformation.

import { DIVERGING, mapOf } from "./colors.js";
import { extremes, fieldsOf } from "./fields.js";

/** Displacements below this share of the model are enlarged unless a factor is given. */
const SMALL = 0.01;
/** Share of the model that enlarged displacements reach. */
const ENLARGED = 0.1;

export class Scene extends EventTarget {
  constructor(model) {
    super();
    this.model = model;
    this.all = [];
    this.shown = [];
    this.kind = "increment";
    this.index = 0;
    this.field = null;
    this.rangeMode = "all";
    this.given = [0, 1];
    this.map = "";
    this.bands = 0;
    this.scaleMode = null;
    this.givenScale = 1;
    this.phase = 1; // of a mode that swings
    this.ranges = new Map();
    this.fields = new Map();
  }

  tell(what) {
    this.dispatchEvent(new CustomEvent(what));
  }

  /** Frames of the kind that is shown. */
  get frames() {
    return this.all.filter((frame) => frame.kind === this.kind || (this.kind === "increment" && frame.kind === "iterate"));
  }

  get frame() {
    return this.shown[this.index];
  }

  /** Take up frames that came or went. */
  refresh() {
    this.shown = this.frames;
    this.ranges.clear();
    this.index = Math.min(this.index, Math.max(this.shown.length - 1, 0));
  }

  /** Once the frames are there: fields, and defaults that suit them. */
  settle() {
    if (!this.all.some((frame) => frame.kind === this.kind) && this.all.length) this.kind = this.all[0].kind;
    this.refresh();
    const before = this.field?.name;
    this.fields = fieldsOf(this.model, this.shown);
    this.field = this.fields.get(before) ?? this.#firstField();
    if (this.scaleMode === null && this.shown.length) {
      this.scaleMode = this.largest < SMALL * this.model.size || this.kind === "mode" ? "auto" : "1";
    }
  }

  #firstField() {
    for (const name of ["MISESA", "MISES", "U"]) {
      const field = this.fields.get(name);
      if (field && this.shown.some((frame) => field.values(frame, this.model.nNodes).some((v) => v !== 0))) return field;
    }
    return this.fields.values().next().value ?? null;
  }

  show(index) {
    const next = Math.min(Math.max(index, 0), this.shown.length - 1);
    if (next === this.index || next < 0) return;
    this.index = next;
    this.tell("frame");
  }

  showKind(kind) {
    this.kind = kind;
    this.index = 0;
    this.scaleMode = null;
    this.settle();
    this.tell("frames");
  }

  set(options) {
    Object.assign(this, options);
    this.tell("look");
  }

  values(field = this.field, frame = this.frame) {
    return field.values(frame, this.model.nNodes);
  }

  /** Range of a field in a frame over the nodes of elements. */
  rangeOf(field, frame) {
    const values = this.values(field, frame);
    const { low, high } = extremes(values, this.model.used);
    return low < 0 ? [0, 0] : [values[low], values[high]];
  }

  get range() {
    if (!this.field || !this.frame) return [0, 1];
    if (this.rangeMode === "given") return this.given;
    let found = this.rangeMode === "frame" ? this.rangeOf(this.field, this.frame) : this.ranges.get(this.field.name);
    if (!found) {
      found = [Infinity, -Infinity];
      for (const frame of this.shown) {
        if (frame.kind === "iterate") continue; // no equilibrium: its stress may be anything
        const [low, high] = this.rangeOf(this.field, frame);
        found = [Math.min(found[0], low), Math.max(found[1], high)];
      }
      if (found[0] > found[1]) found = this.rangeOf(this.field, this.frame);
      this.ranges.set(this.field.name, found);
    }
    if (this.mapName === DIVERGING && found[0] < 0 && found[1] > 0) {
      const size = Math.max(-found[0], found[1]); // white is zero
      return [-size, size];
    }
    return found;
  }

  /** The chosen map; by default blue for negative and orange for positive values of signed fields. */
  get mapName() {
    if (this.map) return this.map;
    const known = this.ranges.get(this.field?.name);
    const [low, high] = known ?? (this.field && this.frame ? this.rangeOf(this.field, this.frame) : [0, 1]);
    return mapOf(low, high, !this.model.positive.includes(this.field?.name));
  }

  /** Largest displacement of the frames. */
  get largest() {
    let most = 0;
    for (const frame of this.shown) {
      const data = frame.arrays.U?.data ?? [];
      for (let i = 0; i < data.length; i += 2) most = Math.max(most, Math.hypot(data[i], data[i + 1]));
    }
    return most;
  }

  get scale() {
    if (this.scaleMode === "auto") {
      const most = this.largest;
      if (!(most > 0)) return 1;
      const exact = (ENLARGED * this.model.size) / most;
      if (this.kind === "mode") return exact;
      const power = 10 ** Math.floor(Math.log10(exact));
      return power * [5, 2, 1].find((step) => step * power <= exact * (1 + 1e-9));
    }
    return this.scaleMode === "given" ? this.givenScale : Number(this.scaleMode ?? 1);
  }

  /** Places of the nodes in the frame, two numbers each. */
  positions() {
    const { points } = this.model;
    const moved = Float32Array.from(points);
    const data = this.frame?.arrays.U?.data;
    const scale = this.scale * this.phase;
    if (data && scale) for (let i = 0; i < moved.length; i++) moved[i] += scale * data[i];
    return moved;
  }
}
