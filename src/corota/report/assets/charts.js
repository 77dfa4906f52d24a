// The curves beside the player; a click moves the player, and the player moves their marks.

import { Chart } from "./axes.js";
import { el, fill, format } from "./dom.js";
import { nearestFrame } from "./history.js";

const ENERGY = /^(ALL[A-Z]+|ETOTAL)$/;
const OLD_ENERGY = /(energy|dissipation|work)$/;
const CONTACT = /: (force|friction) [xy]$/;

/** Of the largest value: smaller reactions are rounding. */
const NOISE = 1e-6;
/** Of the range: smaller turns of the abscissa are no branch. */
const TURN = 0.05;

const size = (values) => values.reduce((most, v) => (Math.abs(v) > most ? Math.abs(v) : most), 0);
const constant = (values) => values.every((v) => v === values[0] || Number.isNaN(v));
const power = (v) => (Number.isInteger(v) ? `1e${v}`.replace("-", "−") : "");

/** One line, or two where the abscissa goes forth and back; small turns do not count. */
export function branches(label, xs, ys) {
  const finite = xs.filter(Number.isFinite);
  const least = TURN * (Math.max(...finite) - Math.min(...finite));
  const turns = [];
  let [way, extreme] = [0, 0];
  xs.forEach((x, i) => {
    const step = x - xs[extreme];
    if (way * step >= 0 && (way || Math.abs(step) > least)) {
      way ||= Math.sign(step);
      extreme = i;
    } else if (way && Math.abs(step) > least) {
      turns.push(extreme);
      [way, extreme] = [-way, i];
    }
  });
  const parity = (i) => turns.filter((row) => row < i).length % 2;
  const rows = xs.map((_, i) => i);
  // The row of a turn belongs to both branches.
  const branch = (p) => ys.map((v, i) => (parity(i) === p || parity(i + 1) === p ? v : null));
  const whole = { label, rows, x: xs, y: turns.length ? branch(0) : ys };
  return turns.length ? [whole, { ...whole, label: `${label}, back`, branch: true, y: branch(1) }] : [whole];
}

export class Charts {
  /** `other` is the history of another run, whose curves are drawn beside. */
  constructor(place, scene, history, player, other) {
    Object.assign(this, { place, scene, history, player, other });
    this.charts = [];
    this.pick = (row) => this.#show(history.column("step")[row], history.column("increment")[row]);
    this.#path();
    this.#course("Energies", this.#energies(), { y: history.label("energy"), y2: "balance error [% of largest]" });
    this.#course("Contact forces", this.#contact(), { y: history.label("force") });
    this.#convergence();
    this.#course("Increments", this.#increments(), { y: "iterations", y2: history.label("time increment") });
    this.#probe();
    scene.addEventListener("frame", () => this.mark());
    scene.addEventListener("frames", () => this.mark());
    this.mark();
  }

  #show(step, increment) {
    const { scene, player } = this;
    if (scene.kind !== "increment") scene.showKind("increment");
    if (player && player.view !== "results") player.showView("results");
    player?.pause();
    const index = nearestFrame(scene.shown, step, increment);
    if (index >= 0) scene.show(index);
  }

  #chart(options) {
    const chart = new Chart(this.place, { step: (way) => this.player?.step(way), ...options });
    this.charts.push(chart);
    return chart;
  }

  /** Rows and marks of the current frame in all charts. */
  mark() {
    const { frame } = this.scene;
    const row = frame?.kind === "increment" ? this.history.rowOf(frame.step, frame.increment) : null;
    for (const chart of this.charts) chart.mark(chart.iterationRows ? chart.iterationRows(frame) : row);
    if (this.probeChart) this.probeChart.mark(this.scene.index);
  }

  rebuild() {
    for (const chart of this.charts) if (chart.plot) chart.build();
    if (this.probeChart?.plot) this.probeChart.build();
  }

  /** New rows of a run at work. */
  update() {
    for (const again of this.again ?? []) again();
    this.mark();
  }

  #live(action) {
    (this.again ??= []).push(action);
    action();
  }

  get #rows() {
    return Array.from({ length: this.history.count }, (_, i) => i);
  }

  // Load against displacement, or any two columns.
  #path() {
    const { history } = this;
    if (!history.count) return;
    const names = history.names.filter((name) => !constant(history.column(name)));
    const displacements = names.filter((name) => /^U[12] /.test(name));
    const moves = size(history.column("ALLKE") ?? []) > 0;
    const harmonic = names.includes("largest amplitude");
    const stage = harmonic ? null : history.stages.findLast((s) => names.includes(`${s}: travel`) && names.includes(`${s}: load`));
    const x = stage ? `${stage}: travel` : harmonic ? "frequency" : moves ? "time" : displacements.at(-1) ?? (names.includes("largest U") ? "largest U" : "time");
    const y = stage ? `${stage}: load` : harmonic ? "largest amplitude" : this.#driver(names, moves);
    this.main = y;
    const chart = this.#chart({ title: harmonic ? "Harmonic response" : moves ? "Force over time" : "Load–displacement", pick: this.pick, height: 260 });
    const selects = [["vertical", y], ["horizontal", x]].map(([label, value]) => {
      const select = el("select", { "aria-label": `Quantity on the ${label} axis` });
      fill(select, names.map((name) => [name, name]), value);
      return select;
    });
    chart.head.append(el("span", { class: "choose" }, selects[0], " over ", selects[1]));
    this.#live(() => {
      const [vertical, horizontal] = selects.map((select) => select.value);
      // Frames of other steps have no frequency.
      const outside = (i) => harmonic && !(history.column("frequency")[i] > 0);
      const xs = history.column(horizontal);
      const ys = Array.from(history.column(vertical), (v, i) => (outside(i) ? null : v));
      chart.show([...branches(vertical, xs, ys), ...this.#beside(vertical, horizontal)], {
        x: history.label(horizontal),
        y: history.label(vertical),
        points: this.#notable(ys).map(({ row, text }) => ({ x: xs[row], y: ys[row], row, text })),
      });
    });
    for (const select of selects) select.addEventListener("change", () => this.again[0]());
  }

  /** The same columns of the other run, dashed; none where it does not have them. */
  #beside(vertical, horizontal) {
    const [x, y] = [horizontal, vertical].map((name) => this.other?.column(name));
    return x && y ? [{ label: `${vertical}, ${this.other.facts.job}`, as: vertical, x, y, dash: [6, 4] }] : [];
  }

  /** What drives: the load factor where loads act, else the largest reaction of a support that moves. */
  #driver(names, moves) {
    const { history } = this;
    const { description } = this.scene.model ?? {};
    const acting = names.filter((name) => /^RF[12] (?!all)/.test(name) || CONTACT.test(name));
    const largest = Math.max(0, ...acting.map((name) => size(history.column(name))));
    const real = acting.filter((name) => size(history.column(name)) > NOISE * largest);
    const forces = real.filter((name) => name.startsWith("RF"));
    const contact = real.filter((name) => CONTACT.test(name)).sort((a, b) => size(history.column(b)) - size(history.column(a)));
    if (moves && contact.length) return contact[0];
    const loaded = description?.loads?.some((load) => load.kind !== "temperature");
    if ((loaded || !forces.length) && names.includes("load factor")) return "load factor";
    const moving = description?.supports?.filter((s) => s.value !== 0).map((s) => `RF${s.dof + 1} ${s.where}`) ?? [];
    const most = (name) => size(history.column(name));
    const candidates = forces.filter((name) => moving.includes(name));
    const sorted = (candidates.length ? candidates : forces).sort((a, b) => most(b) - most(a));
    return sorted[0] ?? (names.includes("load factor") ? "load factor" : "time");
  }

  /** Rows worth a mark: the extremes of a column within the run, limit and bifurcation points. */
  #notable(values) {
    const { history } = this;
    const found = (history.facts["critical points"] ?? []).map(({ kind, step, increment }) => ({
      row: history.rowOf(step, increment),
      text: kind,
    }));
    const finite = values.filter(Number.isFinite);
    for (const extreme of [Math.max(...finite), Math.min(...finite)]) {
      const row = values.indexOf(extreme);
      if (row > 0 && row < values.length - 1 && extreme !== 0 && !found.some((f) => Math.abs(f.row - row) < 2)) {
        found.push({ row, text: format(extreme, 4) });
      }
    }
    return found;
  }

  /** Step and increment of the largest value of the main quantity; null where there is none. */
  get telling() {
    const { history } = this;
    const values = history.count ? history.column(this.main) : null;
    if (!values || this.main === "time") return null;
    const most = size(values);
    const row = values.findLastIndex((v) => Math.abs(v) === most);
    return row < 0 || !most ? null : { step: history.column("step")[row], increment: history.column("increment")[row] };
  }

  /** A chart of columns over time. */
  #course(title, names, labels) {
    const { history } = this;
    if (!names.length || history.count < 2) return;
    const chart = this.#chart({ title, pick: this.pick });
    this.#live(() => {
      const time = history.column("time");
      const beside = names.filter(({ values, second }) => !values && !second).flatMap(({ name }) => this.#beside(name, "time"));
      chart.show(
        [...names.map(({ name, label, second, quiet, values, dash }) => ({
          label: label ?? name,
          x: time,
          y: values ? values() : history.column(name),
          second,
          quiet,
          dash,
          rows: this.#rows,
        })), ...beside],
        { x: history.label("time"), ...labels },
      );
    });
  }

  #energies() {
    const { history } = this;
    const has = (name) => !history.column(name).every((v) => v === 0 || Number.isNaN(v));
    let names = history.names.filter((name) => ENERGY.test(name) && has(name));
    if (!names.length) names = history.names.filter((name) => OLD_ENERGY.test(name) && has(name));
    const found = names.map((name) => ({ name }));
    if (found.length && history.column("energy balance error") && has("energy balance error")) {
      const values = () => this.#balance(found.slice(0, -1).map(({ name }) => name));
      found.push({ name: "energy balance error", label: "balance error [%]", second: true, quiet: true, values, dash: [5, 4] });
    }
    return found;
  }

  /** The error is stored relative to the largest energy so far: at the start that is next to nothing. */
  #balance(names) {
    const { history } = this;
    const columns = names.map((name) => history.column(name));
    let largest = 0;
    const peaks = columns[0].map((_, i) => (largest = Math.max(largest, ...columns.map((c) => Math.abs(c[i]) || 0))));
    return history.column("energy balance error").map((v, i) => (largest > 0 ? (100 * v * peaks[i]) / largest : v));
  }

  #contact() {
    const { history } = this;
    return history.names
      .filter((name) => CONTACT.test(name) && !history.stages.some((s) => name.startsWith(`${s}: `)) && !history.column(name).every((v) => v === 0 || Number.isNaN(v)))
      .slice(0, 8)
      .map((name) => ({ name }));
  }

  #increments() {
    const { history } = this;
    const found = [];
    if (history.column("iterations")?.every((v) => !v)) return found; // linear steps
    for (const [name, second] of [["iterations", false], ["attempts", false], ["dt", true]]) {
      const values = history.column(name);
      if (values && !(name === "attempts" && values.every((v) => v <= 1))) found.push({ name, second });
    }
    return found;
  }

  // Residuals of all iterations, each attempt a line of its own; cut-backs as marks.
  #convergence() {
    const { history } = this;
    if (!history.iterationCount && !history.cutBacks.length) return;
    const chart = this.#chart({
      title: "Convergence",
      ticks: power,
      tell: (v) => (10 ** v).toExponential(1),
      pick: (row) => this.#show(history.iteration("step")[row], history.iteration("increment")[row]),
    });
    this.#live(() => {
      const [step, increment, attempt] = ["step", "increment", "attempt"].map((name) => history.iteration(name));
      const [force, moment] = [history.iteration("residual"), history.iteration("moment residual")];
      const xs = [];
      const ys = [];
      const rows = [];
      for (let i = 0; i < step.length; i++) {
        const fresh = i > 0 && (step[i] !== step[i - 1] || increment[i] !== increment[i - 1] || attempt[i] !== attempt[i - 1]);
        if (fresh) {
          xs.push(xs.at(-1));
          ys.push(null);
          rows.push(-1);
        }
        const value = Math.max(force[i] || 0, moment[i] || 0);
        xs.push(history.iterationNumbers[i] + 1);
        ys.push(value > 0 ? Math.log10(value) : null);
        rows.push(i);
      }
      const marks = history.cutBacks.map(({ after }) => ({ x: after + 0.5, text: history.cutBacks.length <= 12 ? "cut back" : "" }));
      chart.iterationRows = (frame) => {
        if (frame?.kind !== "increment") return null;
        for (let i = step.length - 1; i >= 0; i--) if (step[i] === frame.step && increment[i] === frame.increment) return i;
        return null;
      };
      chart.show([{ label: "residual", x: xs, y: ys, rows, dots: xs.length < 1500 }], {
        x: "iterations so far",
        y: "relative residual",
        marks,
      });
    });
  }

  // The field at the probed node over the frames of the player.
  #probe() {
    const { scene } = this;
    const update = () => {
      const node = this.player?.probed?.node ?? -1;
      if (node < 0 || !scene.field || scene.shown.length < 2) {
        if (this.probeChart) this.probeChart.root.hidden = true;
        return;
      }
      if (!this.probeChart) {
        this.probeChart = new Chart(this.place, {
          title: "Probe",
          step: (way) => this.player.step(way),
          pick: (index) => {
            this.player.pause();
            scene.show(index);
          },
        });
        this.place.prepend(this.probeChart.root);
      }
      this.probeChart.root.hidden = false;
      const label = `${scene.field.name} at node ${scene.model.nodeLabels[node]}`;
      const unit = /\[.*\]/.exec(scene.field.meaning ?? "")?.[0] ?? "";
      const frames = scene.shown.filter((frame) => frame.kind !== "iterate");
      this.probeChart.head.firstChild.textContent = label;
      this.probeChart.show(
        [{
          label,
          x: frames.map((frame) => (scene.kind === "mode" ? frame.index + 1 : frame.time)),
          y: frames.map((frame) => scene.values(scene.field, frame)[node]),
          rows: frames.map((_, i) => i),
          dots: frames.length < 80,
        }],
        { x: scene.kind === "mode" ? "mode" : this.history.label("time"), y: `${scene.field.name} ${unit}`.trim() },
      );
      this.probeChart.mark(scene.index);
    };
    for (const event of ["probe", "frames", "look"]) scene.addEventListener(event, update);
  }
}

