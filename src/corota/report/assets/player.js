// The player: stage, camera, controls of frames and looks, probe.

import { MAPS, isDark, shades, table } from "./colors.js";
import { byId, el, fill, format, ink, onceAFrame } from "./dom.js";
import { extremes } from "./fields.js";
import { Overlay, rigidPoints } from "./overlay.js";
import { makePainter } from "./painter.js";
import { paintRevolved } from "./revolved.js";

/** Rigid curves that make the view larger than this times the body are not framed. */
const LARGE = 2.5;

/** Seconds that all frames take at speed 1, and frames a second at most. */
const DURATION = 6;
const MOST_A_SECOND = 24;
/** Seconds of a swing of a mode. */
const SWING = 2;
/** Elements up to which edges are drawn at first. */
const EDGES_UP_TO = 6000;

class Camera {
  constructor() {
    Object.assign(this, { width: 1, height: 1, scale: 1, x: 0, y: 0 });
  }

  toX(x) {
    return 0.5 * this.width + (x - this.x) * this.scale;
  }

  toY(y) {
    return 0.5 * this.height - (y - this.y) * this.scale;
  }

  fromX(x) {
    return this.x + (x - 0.5 * this.width) / this.scale;
  }

  fromY(y) {
    return this.y - (y - 0.5 * this.height) / this.scale;
  }

  fit(low, high) {
    const [w, h] = [high[0] - low[0], high[1] - low[1]];
    // Room on the left for the scale of colors.
    const left = Math.min(96, 0.2 * this.width);
    this.scale = Math.min((this.width - left - 40) / (w || h || 1), (this.height - 80) / (h || w || 1));
    this.x = 0.5 * (low[0] + high[0]) - (0.5 * left) / this.scale;
    this.y = 0.5 * (low[1] + high[1]) + 6 / this.scale;
  }

  zoom(factor, x = 0.5 * this.width, y = 0.5 * this.height) {
    const [atX, atY] = [this.fromX(x), this.fromY(y)];
    this.scale *= factor;
    this.x = atX - (x - 0.5 * this.width) / this.scale;
    this.y = atY + (y - 0.5 * this.height) / this.scale;
  }
}

export class Player {
  constructor(scene) {
    this.scene = scene;
    this.model = scene.model;
    this.camera = new Camera();
    this.surfaceCanvas = byId("surface");
    this.overlayCanvas = byId("overlay");
    this.painter = makePainter(this.surfaceCanvas);
    this.painter.topology(this.model.surface);
    // The system may take the graphics memory away, and give it back.
    this.surfaceCanvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    this.surfaceCanvas.addEventListener("webglcontextrestored", () => {
      this.painter = makePainter(this.surfaceCanvas);
      this.painter.topology(this.model.surface);
      this.draw();
    });
    this.overlay = new Overlay(this.overlayCanvas);
    this.view = "results";
    this.playing = false;
    this.probed = null;
    this.fitted = false;
    this.draw = onceAFrame(() => this.#draw());
    byId("mesh").checked = this.model.nCells <= EDGES_UP_TO;
    byId("undeformed").checked = true;
    byId("contact").checked = true;
    const ring = (this.model.description.sections ?? []).some(({ plane }) => plane === "axisymmetric");
    byId("revolved").parentElement.hidden = !ring;
    this.#controls();
    this.#gestures();
    this.#modelControls();
    new ResizeObserver(() => this.#resize()).observe(byId("stage"));
    for (const event of ["frame", "look", "frames"]) scene.addEventListener(event, () => this.refresh(event));
    this.#resize();
  }

  // What the controls say.
  checked(id) {
    return byId(id).checked;
  }

  #controls() {
    const { scene } = this;
    fill(byId("map"), [["", "automatic"], ...MAPS.map((name) => [name, name])], "");
    const on = (id, event, action) => byId(id).addEventListener(event, action);
    on("field", "change", (e) => scene.set({ field: scene.fields.get(e.target.value) }));
    on("range", "change", (e) => {
      if (e.target.value === "given") scene.given = [...scene.range];
      scene.set({ rangeMode: e.target.value });
    });
    for (const [id, place] of [["low", 0], ["high", 1]]) {
      on(id, "change", (e) => {
        const given = [...scene.given];
        given[place] = Number(e.target.value);
        scene.set({ given });
      });
    }
    on("map", "change", (e) => scene.set({ map: e.target.value }));
    on("bands", "change", (e) => scene.set({ bands: Number(e.target.value) }));
    on("scale", "change", (e) => {
      if (e.target.value === "given") scene.givenScale = scene.scale || 1;
      scene.set({ scaleMode: e.target.value });
    });
    on("factor", "change", (e) => scene.set({ givenScale: Number(e.target.value) || 0 }));
    on("kinds", "change", (e) => scene.showKind(e.target.value));
    on("frame", "input", (e) => {
      this.pause();
      scene.show(Number(e.target.value));
    });
    on("play", "click", () => this.toggle());
    for (const id of ["mesh", "undeformed", "reactions", "contact", "extremes", "revolved", "supports", "loads"]) on(id, "change", () => this.draw());
    for (const button of document.querySelectorAll("[data-zoom]")) button.addEventListener("click", () => this.zoom(button.dataset.zoom));
    for (const input of document.querySelectorAll("input[name=view]")) input.addEventListener("change", () => this.showView(input.value));
    on("probe-node", "change", (e) => this.probeLabel("node", e.target));
    on("probe-element", "change", (e) => this.probeLabel("element", e.target));
    on("picture", "click", () => this.savePicture());
  }

  #modelControls() {
    const steps = this.model.description.steps ?? [];
    fill(byId("model-step"), [["-1", "all"], ...steps.map((step, i) => [String(i + 1), `${i + 1} ${step.name || step.procedure}`])], "-1");
    const sets = [["", "none"]];
    for (const [kind, label] of [["node", "nodes"], ["edge", "edges"], ["cell", "elements"]]) {
      this.model.sets[kind].forEach((name, i) => sets.push([`${kind} ${i}`, `${name} (${label})`]));
    }
    fill(byId("model-set"), sets, "");
    for (const id of ["model-step", "model-set"]) byId(id).addEventListener("change", () => this.draw());
  }

  showView(view) {
    this.view = view;
    document.querySelector(`input[name=view][value=${view}]`).checked = true;
    for (const found of document.querySelectorAll(".of-results")) found.hidden = view !== "results";
    for (const found of document.querySelectorAll(".of-model")) found.hidden = view !== "model";
    if (view === "model") this.pause();
    this.refresh("look");
  }

  /** Bring controls and picture up to date with the scene. */
  refresh(what) {
    const { scene } = this;
    const { frame } = scene;
    if (what === "frames") this.#choices();
    const slider = byId("frame");
    slider.max = Math.max(scene.shown.length - 1, 0);
    slider.value = scene.index;
    const text = frame ? describeFrame(frame) : "no frames";
    byId("where").textContent = text;
    slider.setAttribute("aria-valuetext", text);
    byId("limits").hidden = scene.rangeMode !== "given";
    if (what !== "frame") {
      [byId("low").value, byId("high").value] = scene.given.map((v) => Number(v.toPrecision(6)));
      byId("factor").hidden = scene.scaleMode !== "given";
      byId("factor").value = scene.givenScale;
      byId("scale").value = scene.scaleMode ?? "1";
      if (scene.field) byId("field").value = scene.field.name;
    }
    this.#tellProbe();
    this.draw();
  }

  #choices() {
    const { scene } = this;
    fill(byId("field"), [...scene.fields.values()].map(({ name, meaning }) => [name, name, meaning]), scene.field?.name);
    const kinds = [...new Set(scene.all.map((frame) => (frame.kind === "iterate" ? "increment" : frame.kind)))];
    fill(byId("kinds"), kinds.map((kind) => [kind, `${kind}s`]), scene.kind);
    byId("kinds").parentElement.hidden = kinds.length < 2;
    const sources = new Set(scene.shown.flatMap((frame) => Object.keys(frame.arrays)));
    for (const label of document.querySelectorAll("[data-needs]")) label.hidden = !sources.has(label.dataset.needs);
    this.sizes = {
      RF: largestForce(scene.shown),
      CPRESS: scene.shown.reduce((most, frame) => Math.max(most, ...(frame.arrays.CPRESS?.data ?? [0])), 0),
    };
    if (!this.fitted && scene.shown.length) this.fit();
  }

  // The stage.
  #resize() {
    const stage = byId("stage").getBoundingClientRect();
    if (!stage.width) return;
    const ratio = Math.min(window.devicePixelRatio || 1, 2);
    for (const canvas of [this.surfaceCanvas, this.overlayCanvas]) {
      canvas.width = Math.round(stage.width * ratio);
      canvas.height = Math.round(stage.height * ratio);
    }
    Object.assign(this.camera, { width: stage.width, height: stage.height });
    if (!this.moved) this.fit();
    this.draw();
  }

  /** Show all of the model, undeformed and in the first, middle and last frame. */
  fit() {
    const low = [...this.model.low];
    const high = [...this.model.high];
    const { scene } = this;
    const index = scene.index;
    if (scene.shown.length && this.view === "results") {
      for (const place of [0, 0.25, 0.5, 0.75, 1]) {
        scene.index = Math.round(place * (scene.shown.length - 1));
        if (scene.frame.kind === "iterate") continue; // wherever that went
        const positions = scene.positions();
        for (let i = 0; i < positions.length; i++) {
          if (!this.model.used[i >> 1]) continue;
          low[i % 2] = Math.min(low[i % 2], positions[i]);
          high[i % 2] = Math.max(high[i % 2], positions[i]);
        }
      }
      scene.index = index;
      this.fitted = true;
    }
    this.#include(low, high);
    this.camera.fit(low, high);
    this.moved = false;
    this.draw();
  }

  /** Extend a box by the rigid curves that are not far larger than the body, in the first and this frame. */
  #include(low, high) {
    const { scene, model } = this;
    const body = Math.hypot(high[0] - low[0], high[1] - low[1]);
    for (const curve of model.rigid) {
      const [least, most] = [[...low], [...high]];
      for (const frame of [null, scene.frame]) {
        for (const [x, y] of rigidPoints(model, curve, frame, scene.scale)) {
          [x, y].forEach((v, i) => {
            least[i] = Math.min(least[i], v);
            most[i] = Math.max(most[i], v);
          });
        }
      }
      if (Math.hypot(most[0] - least[0], most[1] - least[1]) > LARGE * body) continue;
      [0, 1].forEach((i) => ([low[i], high[i]] = [least[i], most[i]]));
    }
  }

  zoom(way, x, y) {
    if (way === "fit") return this.fit();
    this.camera.zoom(way === "in" ? 1.4 : 1 / 1.4, x, y);
    this.moved = true;
    this.draw();
  }

  pan(dx, dy) {
    this.camera.x -= dx / this.camera.scale;
    this.camera.y += dy / this.camera.scale;
    this.moved = true;
    this.draw();
  }

  #draw() {
    this.overlay.begin(this.camera);
    if (this.view === "model") this.#drawModel();
    else this.#drawResults();
  }

  get #meshInk() {
    const size = Math.sqrt((this.camera.scale ** 2 * this.model.size ** 2) / Math.max(this.model.nCells, 1));
    const level = isDark() ? 0.85 : 0.1;
    return [level, level, level, Math.min(0.45, 0.05 + size / 60)];
  }

  #drawResults() {
    const { scene, model, overlay, camera } = this;
    byId("empty").hidden = Boolean(scene.frame);
    if (!scene.frame) {
      byId("empty").textContent = "No frames yet";
      return;
    }
    const nodes = scene.positions();
    const positions = model.surface.spread(nodes, 2);
    const values = scene.field ? scene.values() : new Float32Array(model.nNodes);
    // The last attempt of a run that stopped has displacements only.
    const blank = scene.frame.kind === "iterate" && scene.field?.source !== "U";
    const { bands } = scene;
    const range = blank ? [0, 255] : scene.range;
    const colors = blank ? shades() : table(scene.mapName);
    this.nodes = nodes;
    this.positions = positions;
    this.drawnValues = model.surface.spread(values, 1);
    const legend = () => {
      if (!scene.field || blank) return;
      const scale = scene.scale === 1 ? "" : `displacements × ${format(scene.scale, 3)}`;
      overlay.legend({ name: scene.field.name, meaning: scene.field.meaning, range, bands, table: colors, remark: scale });
    };
    this.surfaceCanvas.hidden = this.checked("revolved");
    if (this.surfaceCanvas.hidden) {
      paintRevolved(overlay.context, camera, model.surface, positions, this.drawnValues, range, bands, colors);
      legend();
      return;
    }
    this.painter.data(positions, this.drawnValues);
    this.painter.colors(colors);
    this.painter.paint({ camera, range, bands, mesh: this.checked("mesh"), meshInk: this.#meshInk });
    if (this.checked("undeformed")) {
      if (!this.still) this.still = model.surface.spread(model.points, 2);
      overlay.chains(model.surface.outline, this.still, ink("ghost"), 1, [4, 3]);
      overlay.chains(model.lineCells.map(({ first, last }) => [first, last]), model.points, ink("ghost"), 1, [4, 3]);
    }
    overlay.chains(model.surface.outline, positions, ink("outline"), 1.1);
    overlay.couplings(model, nodes);
    overlay.rigid(model, scene.frame, scene.scale * scene.phase);
    overlay.lines(model.lineCells, nodes, values, range, bands, colors);
    const { RF, CPRESS } = scene.frame.arrays;
    if (RF && this.checked("reactions") && this.sizes.RF > 0) overlay.forces(RF.data, nodes, this.sizes.RF, ink("reaction"));
    if (CPRESS && this.checked("contact") && this.sizes.CPRESS > 0) {
      overlay.pressures(model, CPRESS.data, nodes, this.sizes.CPRESS, ink("contact"));
    }
    if (this.checked("extremes") && scene.field) this.#markExtremes(values, nodes);
    if (this.probed) this.#markProbe(nodes);
    legend();
  }

  #drawModel() {
    const { model, overlay, camera } = this;
    byId("empty").hidden = true;
    this.surfaceCanvas.hidden = false;
    if (!this.still) this.still = model.surface.spread(model.points, 2);
    this.nodes = model.points;
    this.positions = this.still;
    const sections = Float32Array.from(model.sections, (s) => Math.max(s, 0));
    this.drawnValues = model.surface.spreadCells(sections);
    this.painter.data(this.still, this.drawnValues);
    this.painter.colors(shades());
    this.painter.paint({ camera, range: [0, 255], bands: 0, mesh: this.checked("mesh"), meshInk: this.#meshInk });
    overlay.chains(model.surface.outline, this.still, ink("outline"), 1.1);
    overlay.rigid(model, null, 0);
    overlay.lines(model.lineCells, model.points, null);
    const step = Number(byId("model-step").value);
    if (this.checked("supports")) overlay.supports(model, step);
    if (this.checked("loads")) overlay.loads(model, step);
    const [kind, number] = byId("model-set").value.split(" ");
    if (kind) overlay.highlight(model, kind, model.set(kind, Number(number)));
    if (this.probed) this.#markProbe(model.points);
  }

  #markExtremes(values, nodes) {
    const { low, high } = extremes(values, this.model.used);
    for (const [node, word] of [[low, "min"], [high, "max"]]) {
      if (node < 0) continue;
      this.overlay.mark(
        this.camera.toX(nodes[2 * node]),
        this.camera.toY(nodes[2 * node + 1]),
        `${word} ${format(values[node], 4)} at node ${this.model.nodeLabels[node]}`,
        ink("ink"),
      );
    }
  }

  // Play.
  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  play() {
    const { scene } = this;
    if (this.playing || !scene.shown.length || this.view !== "results") return;
    if (scene.index === scene.shown.length - 1 && scene.kind !== "mode") scene.show(0);
    this.playing = true;
    this.#playButton();
    let before = performance.now();
    let due = 0;
    const tick = (now) => {
      if (!this.playing) return;
      const passed = ((now - before) / 1000) * Number(byId("speed").value);
      before = now;
      if (scene.kind === "mode") {
        due += passed;
        scene.phase = Math.cos((2 * Math.PI * due) / SWING);
        this.draw();
      } else {
        due += passed * Math.min(scene.shown.length / DURATION, MOST_A_SECOND);
        if (due >= 1) {
          scene.show(scene.index + Math.floor(due));
          due %= 1;
        }
        if (scene.index >= scene.shown.length - 1) this.pause();
      }
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  pause() {
    this.playing = false;
    this.scene.phase = 1;
    this.#playButton();
    this.draw();
  }

  #playButton() {
    const button = byId("play");
    button.textContent = this.playing ? "❚❚" : "▶";
    button.setAttribute("aria-label", this.playing ? "Pause" : "Play");
  }

  step(count) {
    this.pause();
    this.scene.show(this.scene.index + count);
  }

  // Pointer and keys.
  #gestures() {
    const canvas = this.overlayCanvas;
    const pointers = new Map();
    let traveled = 0;
    const place = (event) => {
      const box = canvas.getBoundingClientRect();
      return [event.clientX - box.left, event.clientY - box.top];
    };
    canvas.addEventListener("pointerdown", (event) => {
      canvas.setPointerCapture(event.pointerId);
      pointers.set(event.pointerId, place(event));
      traveled = 0;
    });
    canvas.addEventListener("pointermove", (event) => {
      const known = pointers.get(event.pointerId);
      const [x, y] = place(event);
      if (!known) return this.#hover(x, y);
      const others = [...pointers].filter(([id]) => id !== event.pointerId).map(([, at]) => at);
      traveled += Math.hypot(x - known[0], y - known[1]);
      if (others.length) {
        const [ox, oy] = others[0];
        this.camera.zoom(Math.hypot(x - ox, y - oy) / (Math.hypot(known[0] - ox, known[1] - oy) || 1), ox, oy);
        this.moved = true;
        this.draw();
      } else if (traveled > 3) {
        this.pan(x - known[0], y - known[1]);
      }
      pointers.set(event.pointerId, [x, y]);
    });
    const end = (event) => {
      if (pointers.delete(event.pointerId) && traveled <= 3 && event.type === "pointerup") this.probeAt(...place(event));
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("pointerleave", () => (byId("hover").textContent = ""));
    canvas.addEventListener("dblclick", () => this.fit());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.camera.zoom(Math.exp(-0.0015 * event.deltaY), ...place(event));
      this.moved = true;
      this.draw();
    }, { passive: false });
  }

  #hover(x, y) {
    if (this.view !== "results" || this.surfaceCanvas.hidden || !this.positions || this.playing || this.model.surface.owner.length > 200000) return;
    const found = this.model.surface.find(this.positions, this.camera.fromX(x), this.camera.fromY(y));
    const value = found?.corners.reduce((sum, corner, i) => sum + found.shares[i] * this.drawnValues[corner], 0);
    byId("hover").textContent = found ? `${this.scene.field?.name ?? ""} ${format(value, 4)}` : "";
  }

  // Probe.
  probeAt(x, y) {
    if (!this.nodes || this.surfaceCanvas.hidden) return;
    const { camera, model } = this;
    let node = -1;
    let nearest = 24;
    for (let i = 0; i < model.nNodes; i++) {
      const away = Math.hypot(camera.toX(this.nodes[2 * i]) - x, camera.toY(this.nodes[2 * i + 1]) - y);
      if (away < nearest) [node, nearest] = [i, away];
    }
    const found = model.surface.find(this.positions, camera.fromX(x), camera.fromY(y));
    let cell = found ? found.cell : -1;
    if (cell < 0 && node >= 0) cell = model.lineCells.find(({ first, last }) => first === node || last === node)?.cell ?? -1;
    this.probe(node < 0 && cell < 0 ? null : { node, cell });
  }

  probe(probed) {
    this.probed = probed;
    this.#tellProbe();
    this.draw();
    this.scene.tell("probe");
  }

  probeLabel(kind, input) {
    const label = Number.parseInt(input.value, 10);
    const { model } = this;
    if (Number.isNaN(label)) return this.probe(null);
    const index = kind === "node" ? model.nodeOfLabel(label) : model.cellOfLabel(label);
    input.setCustomValidity(index < 0 ? `There is no ${kind} ${label}` : "");
    input.reportValidity();
    if (index < 0) return null;
    return this.probe(kind === "node" ? { node: index, cell: -1 } : { node: -1, cell: index });
  }

  #markProbe(nodes) {
    const { node, cell } = this.probed;
    if (cell >= 0) {
      const { kind, nodes: own } = this.model.cell(cell);
      const corners = own.slice(0, kind.startsWith("tri") ? 3 : kind.startsWith("quad") ? 4 : 2);
      this.overlay.chains([[...corners, corners[0]]], nodes, ink("accent"), 2);
    }
    if (node >= 0) this.overlay.mark(this.camera.toX(nodes[2 * node]), this.camera.toY(nodes[2 * node + 1]), "");
  }

  #tellProbe() {
    const panel = byId("probe");
    panel.hidden = !this.probed;
    if (!this.probed) return;
    const { node, cell } = this.probed;
    const { scene, model } = this;
    const parts = [];
    if (node >= 0) {
      const at = [model.points[2 * node], model.points[2 * node + 1]];
      parts.push(el("h3", {}, `Node ${model.nodeLabels[node]}`), el("p", {}, `at (${format(at[0])}, ${format(at[1])})`));
    }
    if (cell >= 0) parts.push(...this.#tellCell(cell));
    if (scene.frame) {
      const rows = [];
      const own = cell >= 0 ? model.cell(cell).nodes : [];
      for (const field of scene.fields.values()) {
        const values = scene.values(field);
        const mean = own.length ? own.reduce((sum, n) => sum + values[n], 0) / own.length : null;
        if ((node < 0 || values[node] === 0) && !mean) continue;
        rows.push(
          el("tr", {}, el("th", { scope: "row", title: field.meaning || false }, field.name),
            node >= 0 ? el("td", {}, format(values[node])) : null,
            own.length ? el("td", {}, format(mean)) : null),
        );
      }
      const head = el("tr", {}, el("th", { scope: "col" }, "field"),
        node >= 0 ? el("th", { scope: "col" }, "node") : null,
        own.length ? el("th", { scope: "col", title: "mean of the values at its nodes" }, "element") : null);
      parts.push(el("div", { class: "scroll" }, el("table", {}, el("thead", {}, head), el("tbody", {}, ...rows))));
    }
    panel.replaceChildren(
      el("button", { class: "close", "aria-label": "Close the probe", onclick: () => this.probe(null) }, "×"),
      ...parts,
    );
  }

  #tellCell(cell) {
    const { model } = this;
    const { kind, label, nodes, section } = model.cell(cell);
    const known = sectionOf(model, section);
    return [
      el("h3", {}, `Element ${label}`),
      el("p", {}, `${known ? `${known.element}, ` : ""}${kind}, nodes ${nodes.map((n) => model.nodeLabels[n]).join(" ")}`),
    ];
  }

  /** The stage as PNG. */
  savePicture() {
    this.#draw();
    const canvas = el("canvas", { width: this.overlayCanvas.width, height: this.overlayCanvas.height });
    const context = canvas.getContext("2d");
    context.fillStyle = ink("stage");
    context.fillRect(0, 0, canvas.width, canvas.height);
    if (!this.surfaceCanvas.hidden) context.drawImage(this.surfaceCanvas, 0, 0);
    context.drawImage(this.overlayCanvas, 0, 0);
    canvas.toBlob((blob) => {
      const link = el("a", { href: URL.createObjectURL(blob), download: `${this.model.name}.png` });
      link.click();
      URL.revokeObjectURL(link.href);
    });
  }
}

export function describeFrame(frame) {
  if (frame.label) return frame.label;
  const factor = frame["load factor"];
  return (
    `step ${frame.step}, increment ${frame.increment}, time ${format(frame.time, 4)}` +
    (factor && factor !== frame.time ? `, load factor ${format(factor, 4)}` : "")
  );
}

/** The first section of a group of cells, as the groups are numbered: by what they share. */
function sectionOf(model, group) {
  const seen = [];
  for (const section of model.description.sections ?? []) {
    const key = [section.material, section.thickness, section.plane, section.orientation ?? 0].join();
    if (!seen.includes(key)) seen.push(key);
    if (seen.indexOf(key) === group) return section;
  }
  return null;
}

function largestForce(frames) {
  let most = 0;
  for (const frame of frames) {
    if (frame.kind === "iterate") continue; // what is out of balance there is no reaction
    const data = frame.arrays.RF?.data ?? [];
    for (let i = 0; i < data.length; i += 3) most = Math.max(most, Math.hypot(data[i], data[i + 1]));
  }
  return most;
}
