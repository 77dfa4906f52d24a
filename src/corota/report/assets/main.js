// The page: theme, keys, and bringing player, curves and tables together.

import { Charts } from "./charts.js";
import { byId, el, forgetInks, format } from "./dom.js";
import { History, nearestFrame } from "./history.js";
import { LiveSource, follow } from "./live.js";
import { Model } from "./model.js";
import { Player } from "./player.js";
import { Scene } from "./scene.js";
import { EmbeddedSource } from "./source.js";
import { Tables, showLeftOut } from "./tables.js";

const KEYS = [
  ["space", "play, pause"],
  ["← →", "frame before, next"],
  ["Home End", "first, last frame"],
  ["+ −", "zoom"],
  ["shift + arrows", "move the view"],
  ["F", "fit"],
  ["M", "mesh"],
  ["U", "undeformed outline"],
  ["R", "reactions"],
  ["C", "contact pressure"],
  ["X", "largest and smallest"],
  ["1 2", "results, model"],
  ["N", "probe a node by its number"],
  ["Esc", "close the probe"],
  ["?", "this list"],
];

class Page {
  constructor() {
    this.#theme();
    byId("keys").append(
      el("h2", {}, "Keys"),
      el("table", {}, ...KEYS.map(([key, text]) => el("tr", {}, el("th", { scope: "row" }, key), el("td", {}, text)))),
      el("p", { class: "soft" }, "Drag moves the view, the wheel zooms, a click probes, a double click fits. In curves a click moves the player, a drag zooms, a double click shows all."),
      el("button", { onclick: () => byId("keys").close() }, "Close"),
    );
    byId("help").addEventListener("click", () => byId("keys").showModal());
    document.addEventListener("keydown", (event) => this.#key(event));
  }

  // Theme: as the system says, or as chosen; kept for the next page where the browser allows it.
  #theme() {
    const system = matchMedia("(prefers-color-scheme: dark)");
    const names = ["auto", "light", "dark"];
    let chosen = "auto";
    try {
      chosen = localStorage.getItem("corota-theme") ?? "auto";
    } catch {
      // files opened from disk may have no storage
    }
    const apply = () => {
      document.documentElement.dataset.shade = chosen === "auto" ? (system.matches ? "dark" : "light") : chosen;
      byId("theme").textContent = `Theme: ${chosen}`;
      forgetInks();
      this.charts?.rebuild();
      this.tables?.rebuild();
      this.player?.draw();
    };
    byId("theme").addEventListener("click", () => {
      chosen = names[(names.indexOf(chosen) + 1) % names.length];
      try {
        localStorage.setItem("corota-theme", chosen);
      } catch {
        // as above
      }
      apply();
    });
    system.addEventListener("change", apply);
    // Paper is white.
    let screen = chosen;
    addEventListener("beforeprint", () => {
      screen = chosen;
      chosen = "light";
      apply();
    });
    addEventListener("afterprint", () => {
      chosen = screen;
      apply();
    });
    apply();
  }

  #key(event) {
    const { player, scene } = this;
    const typing = event.target.closest("input:not([type=checkbox]):not([type=radio]):not([type=range]), select, dialog");
    if (typing || event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === "?") return byId("keys").showModal();
    if (!player) return undefined;
    if (event.key === " " && event.target.closest("button, summary, label")) return undefined;
    const pan = { ArrowLeft: [60, 0], ArrowRight: [-60, 0], ArrowUp: [0, 60], ArrowDown: [0, -60] }[event.key];
    const tick = (id) => () => byId(id).click();
    const actions = {
      " ": () => player.toggle(),
      ArrowRight: () => player.step(1),
      ArrowLeft: () => player.step(-1),
      Home: () => player.step(-1e9),
      End: () => player.step(1e9),
      "+": () => player.zoom("in"),
      "=": () => player.zoom("in"),
      "-": () => player.zoom("out"),
      f: () => player.fit(),
      m: tick("mesh"),
      u: tick("undeformed"),
      r: tick("reactions"),
      c: tick("contact"),
      x: tick("extremes"),
      1: () => player.showView("results"),
      2: () => player.showView("model"),
      n: () => byId("probe-node").focus(),
      Escape: () => player.probe(null),
    };
    const action = event.shiftKey && pan ? () => player.pan(...pan) : actions[event.key.length === 1 ? event.key.toLowerCase() : event.key];
    if (!action || (event.target.type === "range" && event.key.startsWith("Arrow"))) return undefined;
    event.preventDefault();
    action();
    return scene;
  }

  status() {
    const { history, model } = this;
    const { end } = history;
    const word = end.status === "done" ? "finished" : end.status === "failed" ? "stopped" : history.start.event ? "at work" : "";
    const status = byId("status");
    status.textContent = word;
    status.dataset.state = word.replace(" ", "-");
    byId("message").hidden = !end.message;
    byId("message").textContent = end.message ?? "";
    const parts = [];
    if (model) parts.push(`${model.nNodes.toLocaleString("en")} nodes, ${model.nCells.toLocaleString("en")} elements`);
    if (history.count) parts.push(`${history.incrementCount.toLocaleString("en")} increments`);
    if (history.iterationCount) parts.push(`${(history.iterationNumbers.at(-1) + 1).toLocaleString("en")} iterations`);
    if (history.cutBackCount) parts.push(`${history.cutBackCount} cut-backs`);
    if (end.elapsed) parts.push(`${format(end.elapsed, 3)} s`);
    byId("subtitle").textContent = parts.join(" · ");
    byId("footer").textContent = `Corota ${history.facts.file?.version ?? history.start.version ?? ""}`;
    showLeftOut(history.leftOut ?? []);
  }

  /** Make player, curves and tables for what is there. */
  build(modelChunk, historyChunk) {
    this.history = new History(historyChunk);
    if (modelChunk) {
      this.model = new Model(modelChunk);
      this.scene = new Scene(this.model);
      this.player = new Player(this.scene);
    } else {
      byId("player").hidden = true;
      this.scene = Object.assign(new EventTarget(), { shown: [], kind: "increment", model: null });
    }
    this.status();
  }

  assemble() {
    this.scene.settle?.();
    if (this.model) this.scene.tell("frames");
    this.scene.index = 0;
    byId("curves").replaceChildren();
    this.charts = new Charts(byId("curves"), this.scene, this.history, this.player, this.other);
    this.tables = new Tables(byId("tables"), this.model, this.history, this.scene, this.charts.pick, this.other);
    if (this.model && this.scene.shown.length) {
      this.player.refresh("look");
      const last = this.scene.shown.findLastIndex((frame) => frame.kind !== "iterate");
      this.scene.show(live ? last : this.#telling(last));
    }
  }

  /** The frame of the largest main force or load, else that of the largest value of the field. */
  #telling(last) {
    const { scene } = this;
    const { telling } = this.charts;
    if (telling) return Math.max(nearestFrame(scene.shown, telling.step, telling.increment), 0);
    if (!scene.field || scene.kind !== "increment") return last;
    const sizes = scene.shown.map((frame) => (frame.kind === "iterate" ? -1 : Math.max(...scene.rangeOf(scene.field, frame).map(Math.abs))));
    return sizes.lastIndexOf(Math.max(...sizes));
  }

  async openEmbedded() {
    const source = new EmbeddedSource();
    this.build(await source.chunk("model"), await source.chunk("history"));
    const other = await source.chunk("other");
    if (other) this.other = new History(other);
    if (this.model) for await (const frame of source.frames()) this.scene.all.push(frame);
    this.assemble();
  }

  async openLive(path) {
    const source = new LiveSource(path);
    let model = null;
    let history = null;
    while (!model || !history) {
      byId("status").textContent = "waiting for the first increment";
      [model, history] = [await source.chunk("model"), await source.chunk("history")];
      if (!model || !history) await new Promise((resolve) => setTimeout(resolve, 500));
    }
    this.build(model, history);
    this.assemble();
    await follow(source, this.scene, (news) => this.#news(news));
  }

  #news({ history, frames, over, gone }) {
    if (history) {
      const shape = this.history.names.join();
      this.history.take(history);
      if (this.history.names.join() !== shape) this.assemble();
      else this.charts.update();
      this.status();
      this.tables.updateIncrements?.();
    }
    if (frames) {
      const atEnd = this.scene.index >= this.scene.shown.length - 1;
      const { frame } = this.scene;
      this.scene.settle();
      this.scene.index = Math.max(this.scene.shown.indexOf(frame), 0);
      this.scene.tell("frames");
      if (atEnd && !this.player.playing) this.scene.show(this.scene.shown.length - 1);
    }
    if (over) this.assemble();
    if (gone) {
      byId("status").textContent = "the server has ended";
      byId("status").dataset.state = "stopped";
    }
  }
}

const page = new Page();
const live = document.documentElement.dataset.live;
document.documentElement.dataset.ready = "";
(live ? page.openLive(live) : page.openEmbedded())
  .then(() => (document.documentElement.dataset.ready = "yes"))
  .catch((error) => {
    byId("message").hidden = false;
    byId("message").textContent = `The page cannot show its data: ${error.message}`;
    throw error;
  });
window.corotaReport = page; // for those who want the numbers in the console
