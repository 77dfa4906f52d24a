// Tables below: the model, materials with their curves, notes, extremes, increments, versions.

import { Chart } from "./axes.js";
import { byId, el, format } from "./dom.js";
import { extremes } from "./fields.js";

const DIRECTIONS = ["x", "y", "rotation"];
/** Rows that are shown at once. */
const PAGE = 100;

function table(head, rows, caption) {
  return el("div", { class: "scroll" },
    el("table", {},
      caption ? el("caption", {}, caption) : null,
      el("thead", {}, el("tr", {}, ...head.map((text) => el("th", { scope: "col" }, text)))),
      el("tbody", {}, ...rows.map((row) => el("tr", {}, ...row.map((cell) => (cell instanceof Node ? cell : el("td", {}, show(cell)))))))));
}

const show = (value) => (typeof value === "number" ? format(value) : String(value ?? ""));

function panel(title, open, ...content) {
  const body = content.filter(Boolean);
  return body.length ? el("details", { open }, el("summary", {}, title), ...body) : null;
}

/** A number with its unit, where that is known. */
const withUnit = (value, unit) => (unit ? `${show(value)} ${unit}` : show(value));

/** Dimensions of constants of materials and of the values of loads. */
const CONSTANTS = { rho: "mass/length^3" };
for (const name of ["E", "E1", "E2", "E3", "G12", "G", "yield_stress", "isotropic"]) CONSTANTS[name] = "force/length^2";
const LOADS = {
  force: "force", moment: "force*length", pressure: "force/length^2", "penetrating pressure": "force/length^2", traction: "force/length^2",
  shear: "force/length^2", gravity: "length/time^2", body: "force/length^3",
};

const list = (items) => (items.length ? el("ul", {}, ...items.map((text) => el("li", {}, text))) : null);

export class Tables {
  /** `other` is the history of another run, to compare with. */
  constructor(place, model, history, scene, pick, other) {
    Object.assign(this, { place, model, history, scene, pick, other });
    this.charts = [];
    const panels = [panel("Comparison", true, other && this.#comparison()), panel("Stages", true, ...this.#stages()), panel("Notes and warnings", true, this.#notes())];
    if (model) {
      panels.push(
        panel("Model", true, this.#sections(), this.#materials()),
        panel("Supports and loads", false, this.#supports(), this.#loads(), this.#amplitudes(), list(model.description.joints ?? [])),
        panel("Steps", false, this.#steps()),
        this.#extremes(),
      );
    }
    panels.push(
      panel("Increments", false, this.#increments()),
      panel("Cut-backs", false, this.#cutBacks()),
      panel("Run", false, this.#profile()),
      panel("Versions and provenance", false, this.#versions()),
    );
    place.replaceChildren(...panels.filter(Boolean));
  }

  rebuild() {
    for (const chart of this.charts) if (chart.plot) chart.build();
  }

  #curve(title, { x, y, lines }) {
    const box = el("div", { class: "small" });
    // A chart needs the width of its place, which it has once it is in the page.
    requestAnimationFrame(() => {
      const chart = new Chart(box, { title, x, y, height: 170 });
      chart.show(Object.entries(lines).map(([label, points]) => ({
        label,
        x: points.map(([a]) => a),
        y: points.map(([, b]) => b),
      })), { x, y });
      this.charts.push(chart);
    });
    return box;
  }

  #sections() {
    const sections = this.model.description.sections ?? [];
    if (!sections.length) return el("pre", {}, this.model.lines.join("\n"));
    const materials = this.model.description.materials;
    const rows = sections.map((s) => [
      s.where, s.element, s.line ? "" : s.plane, materials[s.material].name || materials[s.material].type, withUnit(s.thickness, this.model.units.length), s["local strain"],
      [s.orientation ? `orientation ${format(s.orientation)}` : "", s.profile ? `profile ${s.profile.map((v) => format(v)).join(", ")}` : "",
        s["mean dilatation"] ? "mean dilatation" : ""].filter(Boolean).join("; "),
    ]);
    return el("div", {},
      el("pre", {}, this.model.lines.slice(0, 12).filter((line, i) => i === 0 || /^ {2}/.test(line)).slice(0, 6).join("\n")),
      table(["elements", "type", "plane", "material", "thickness", "local strain", ""], rows, "Sections"),
      ...sections.filter((s) => s.curve).map((s) => this.#curve(`Spring ${s.where}`, s.curve)));
  }

  #materials() {
    const materials = this.model.description.materials ?? [];
    if (!materials.length) return null;
    const rows = materials.map((m) => [m.name || "unnamed", m.type, Object.entries(m.constants).map(([k, v]) => `${k} ${withUnit(v, this.model.units[CONSTANTS[k]])}`).join(", ")]);
    const curves = materials.filter((m) => m.curve).map((m) => this.#curve(`Hardening of ${m.name || m.type}`, {
      ...m.curve, y: this.model.units["force/length^2"] ? `stress [${this.model.units["force/length^2"]}]` : m.curve.y }));
    return el("div", {}, table(["name", "law", "constants"], rows, "Materials"), el("div", { class: "row" }, ...curves));
  }

  #supports() {
    const rows = (this.model.description.supports ?? []).map((s) => [
      s.step || "every", s.where, s.nodes.length, DIRECTIONS[s.dof],
      s.free ? "free" : withUnit(s.value, s.value && s.dof < 2 ? this.model.units.length : ""), s.amplitude]);
    return rows.length ? table(["step", "where", "nodes", "direction", "value", "amplitude"], rows, "Supports") : null;
  }

  #loads() {
    const rows = (this.model.description.loads ?? []).map((l) => {
      const distinct = [...new Set(l.value)];
      const value = distinct.length > 3 ? `${format(Math.min(...l.value))} … ${format(Math.max(...l.value))}` : (l.edges || l.kind === "gravity" || l.kind === "centrifugal" ? l.value : distinct).map((v) => format(v)).join(", ");
      return [l.step || "every", l.kind + (l.total ? " (total)" : ""), l.where, l.dof === undefined ? "" : DIRECTIONS[l.dof],
        withUnit(value, this.model.units[l.total && l.kind === "traction" ? "force" : LOADS[l.kind]]), l.amplitude];
    });
    return rows.length ? table(["step", "kind", "where", "direction", "value", "amplitude"], rows, "Loads") : null;
  }

  #amplitudes() {
    const found = this.model.description.amplitudes ?? [];
    if (!found.length) return null;
    return el("div", { class: "row" }, ...found.slice(0, 8).map(({ name, time, value }) =>
      this.#curve(`Amplitude ${name}`, { x: "time", y: "factor", lines: { [name]: time.map((t, i) => [t, value[i]]) } })));
  }

  #steps() {
    const steps = this.model.description.steps ?? [];
    if (!steps.length) return null;
    return table(["", "name", "procedure", "settings"], steps.map(({ name, procedure, ...rest }, i) => [
      i + 1, name, procedure, Object.entries(rest).map(([k, v]) => `${k.replaceAll("_", " ")} ${show(v)}`).join(", ")]));
  }

  /** Largest sizes of the columns that both runs have, with their last values. */
  #comparison() {
    const { history, other } = this;
    const most = (values) => values.reduce((found, v) => (Math.abs(v) > found ? Math.abs(v) : found), 0);
    const rows = history.names
      .filter((name) => other.column(name) && !["step", "increment", "attempts", "run"].includes(name))
      .map((name) => {
        const [a, b] = [history.column(name), other.column(name)];
        const [first, second] = [most(a), most(b)];
        return [history.label(name), first, second, first ? `${(100 * (second / first - 1)).toFixed(1)} %` : "", a.at(-1), b.at(-1)];
      })
      .filter(([, first, second]) => first || second);
    const [a, b] = [history.facts.job, other.facts.job];
    return table(["", `largest size, ${a}`, b, "difference", `last, ${a}`, b], rows);
  }

  /** What was measured of each stage: the last value, the smallest and the largest. */
  #stages() {
    const { history } = this;
    return history.stages.map((stage) => {
      const rows = history.names.filter((name) => name.startsWith(`${stage}: `)).map((name) => {
        const values = history.column(name).filter(Number.isFinite);
        return [history.label(name).slice(stage.length + 2), values.at(-1), Math.min(...values), Math.max(...values)];
      }).filter(([, , low, high]) => low || high);
      return table(["", "last", "smallest", "largest"], rows, stage);
    });
  }

  #notes() {
    return list(this.history.notes) ?? el("p", {}, "None.");
  }

  /** Smallest and largest values of the frame that is shown. */
  #extremes() {
    const body = el("div", {});
    const found = el("details", {}, el("summary", {}, "Smallest and largest values of the frame"), body);
    const update = () => {
      const { scene, model } = this;
      if (!found.open || !scene.frame) return;
      const rows = [...scene.fields.values()].map((field) => {
        const values = scene.values(field);
        const { low, high } = extremes(values, model.used);
        if (low < 0) return null;
        return [field.name, field.meaning ?? "", values[low], model.nodeLabels[low], values[high], model.nodeLabels[high]];
      }).filter((row) => row && (row[2] !== 0 || row[4] !== 0));
      body.replaceChildren(table(["field", "", "smallest", "at node", "largest", "at node"], rows), el("p", { class: "soft" }, model.averaging ?? ""));
    };
    found.addEventListener("toggle", update);
    for (const event of ["frame", "frames"]) this.scene.addEventListener(event, update);
    return found;
  }

  #increments() {
    const { history } = this;
    if (!history.count) return null;
    const names = ["step", "increment", "attempts", "iterations", "time", "dt", "load factor", "residual", "largest U", "largest MISES", "energy balance error"]
      .filter((name) => history.column(name));
    const body = el("div", {});
    let shown = PAGE;
    const update = () => {
      const rows = Array.from({ length: Math.min(shown, history.count) }, (_, i) => [
        el("td", {}, el("button", { class: "link", title: "Show this increment", onclick: () => this.pick?.(i) }, "show")),
        ...names.map((name) => history.column(name)[i])]);
      const more = history.count > shown
        ? el("button", { onclick: () => { shown += 10 * PAGE; update(); } }, `More of ${history.count} rows`) : null;
      body.replaceChildren(table(["", ...names.map((name) => history.label(name))], rows), ...(more ? [more] : []));
    };
    this.updateIncrements = update;
    update();
    return body;
  }

  #cutBacks() {
    const { cutBacks } = this.history;
    if (!cutBacks.length) return null;
    return table(["step", "increment", "attempt", "reason", "next increment"],
      cutBacks.slice(0, 500).map((c) => [c.step, c.increment, c.attempt, c.reason, c.dt]));
  }

  #profile() {
    const { end, facts } = this.history;
    const profile = Object.entries(end.profile ?? facts.info?.profile ?? {});
    const total = profile.reduce((sum, [, seconds]) => sum + seconds, 0);
    const about = [["status", end.status ?? "still at work"], ["error", end.message], ["seconds", end.elapsed],
      ["degrees of freedom", facts.info?.n_dofs], ["threads", facts.info?.threads],
      ["cut-backs", this.history.cutBackCount], ...(facts["critical points"] ?? []).map(({ text }) => ["critical point", text])]
      .filter(([, value]) => value !== undefined && value !== null);
    return el("div", { class: "row" }, table(["", ""], about),
      profile.length ? table(["phase", "seconds", "share"], profile.map(([phase, seconds]) => [phase, seconds, `${((100 * seconds) / total).toFixed(1)} %`])) : null);
  }

  #versions() {
    const { start, facts } = this.history;
    const rows = [["Corota", facts.file?.version ?? start.version], ["job", facts.job], ["run", facts.file?.run ?? start.run]];
    const walk = (value, path) => {
      if (value && typeof value === "object") for (const [key, inner] of Object.entries(value)) walk(inner, path ? `${path}: ${key}` : key);
      else rows.push([path, value]);
    };
    walk(facts.provenance ?? {}, "");
    return table(["", ""], rows.filter(([, value]) => value !== undefined && value !== ""));
  }
}

export function showLeftOut(notes) {
  const place = byId("left-out");
  place.hidden = !notes.length;
  place.replaceChildren(...notes.map((text) => el("li", {}, text)));
}
