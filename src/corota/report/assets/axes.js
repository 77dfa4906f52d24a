// A chart: curves over any abscissa, of which a click finds the nearest point. Axes by uPlot.

import { lineColor, lineDash } from "./colors.js";
import { el, format, ink } from "./dom.js";

/** Curves that go back and forth: every point in its order, gaps where a number is missing. */
function polyline(u, index) {
  const path = new Path2D();
  uPlot.orient(u, index, (series, xs, ys, scaleX, scaleY, toX, toY, left, top, width, height) => {
    let pen = false;
    for (let i = 0; i < xs.length; i++) {
      if (xs[i] === null || ys[i] === null || Number.isNaN(ys[i]) || Number.isNaN(xs[i])) {
        pen = false;
        continue;
      }
      const [x, y] = [toX(xs[i], scaleX, width, left), toY(ys[i], scaleY, height, top)];
      if (pen) path.lineTo(x, y);
      else path.moveTo(x, y);
      pen = true;
    }
  });
  return { stroke: path, fill: null, clip: null, band: null, gaps: null, flags: 0 };
}

const padded = (u, low, high) => {
  if (low === null || !Number.isFinite(low)) return [0, 1];
  const pad = high > low ? 0.04 * (high - low) : Math.abs(low) * 0.1 || 1;
  return [low - pad, high + pad];
};

/** Distance within which a click means a mark [pixels]. */
const NEAR = 12;

export class Chart {
  /**
   * @param place   element that takes the chart
   * @param options title, hint, x (label), y (label), y2 (label of a second axis),
   *                ticks (function from number to text), pick(index of a point)
   */
  constructor(place, options) {
    this.options = options;
    this.readout = el("output", { class: "readout" });
    this.legend = el("div", { class: "legend" });
    this.body = el("div", { class: "plot", tabindex: "0", role: "img", "aria-label": `${options.title}. Arrow keys step through the frames.` });
    this.head = el("div", { class: "head" }, el("h3", {}, options.title));
    this.root = el("figure", { class: "chart" }, this.head, this.body, this.legend, this.readout);
    place.append(this.root);
    this.lines = [];
    this.hidden = new Set();
    this.marked = null;
    this.resize = new ResizeObserver(() => this.#fit());
    this.resize.observe(this.body);
    this.body.addEventListener("keydown", (event) => {
      const way = { ArrowRight: 1, ArrowLeft: -1 }[event.key];
      if (way && options.step) {
        options.step(way);
        event.preventDefault();
        event.stopPropagation();
      }
    });
  }

  /**
   * Show lines: { label, x, y, second, rows, dots, stroke }; `rows` tells which row a point is of.
   * `marks` are places on the abscissa with a text; `points` are { x, y, text } on the first line.
   */
  show(lines, { x, y, y2, marks = [], points = [] } = {}) {
    Object.assign(this.options, { x: x ?? this.options.x, y: y ?? this.options.y, y2: y2 ?? this.options.y2 });
    this.lines = lines;
    this.marks = marks;
    this.points = points;
    this.build();
  }

  get #size() {
    return { width: Math.max(this.body.clientWidth, 120), height: this.options.height ?? 220 };
  }

  build() {
    this.plot?.destroy();
    let next = 0;
    this.lines.forEach((line, i) => {
      if (line.branch) line.stroke = `${this.lines[i - 1].stroke}99`; // the line before it, paler
      else if (line.quiet) line.stroke = ink("soft");
      else if (line.as) line.stroke = this.lines.find(({ label }) => label === line.as).stroke;
      else {
        line.stroke = lineColor(next);
        line.dash ??= lineDash(next);
        next += 1;
      }
    });
    const second = this.lines.some((line) => line.second);
    const axis = (scale, label, side) => ({
      scale,
      side,
      label,
      labelSize: 18,
      size: side === 2 ? 34 : 62,
      stroke: ink("soft"),
      font: "11px system-ui, sans-serif",
      labelFont: "11px system-ui, sans-serif",
      grid: { show: scale !== "y2", stroke: ink("grid"), width: 1 },
      ticks: { stroke: ink("grid"), width: 1, size: 4 },
      values: (u, splits) => splits.map((v) => (scale === "y" && this.options.ticks ? this.options.ticks(v) : format(v, 4))),
    });
    const axes = [axis("x", this.options.x, 2), axis("y", this.options.y, 3)];
    if (second) axes.push(axis("y2", this.options.y2, 1));
    this.plot = new uPlot(
      {
        ...this.#size,
        mode: 2,
        padding: [8, 10, 0, 0],
        legend: { show: false },
        cursor: { points: { show: false }, drag: { x: true, y: true, uni: 12 }, focus: { prox: -1 } },
        scales: {
          x: { time: false, range: padded },
          y: { range: padded },
          ...(second ? { y2: { range: padded } } : {}),
        },
        axes,
        series: [
          {},
          ...this.lines.map((line, i) => ({
            label: line.label,
            stroke: line.stroke,
            width: line.dash ? 1.2 : 1.7,
            dash: line.dash,
            show: !this.hidden.has(line.label),
            paths: polyline,
            points: { show: false },
            facets: [{ scale: "x", auto: true }, { scale: line.second ? "y2" : "y", auto: true }],
          })),
        ],
        hooks: {
          draw: [(u) => this.#drawMarks(u)],
          setCursor: [(u) => this.#hover(u)],
        },
      },
      [null, ...this.lines.map(({ x, y }) => [x, y])],
      this.body,
    );
    this.plot.over.addEventListener("click", (event) => this.#click(event));
    this.#legend();
  }

  #fit() {
    const size = this.#size;
    if (this.plot && size.width !== this.plot.width) this.plot.setSize(size);
  }

  #legend() {
    this.legend.replaceChildren(
      ...(this.lines.length < 2 && !this.options.legend ? [] : this.lines).map((line, i) => {
        const shown = !this.hidden.has(line.label);
        return el(
          "button",
          {
            "aria-pressed": String(shown),
            class: line.dash ? "dashed" : false,
            style: `--line: ${line.stroke}`,
            onclick: () => {
              if (shown) this.hidden.add(line.label);
              else this.hidden.delete(line.label);
              this.plot.setSeries(i + 1, { show: !shown });
              this.#legend();
            },
          },
          line.label,
        );
      }),
    );
  }

  /** Nearest point of a line to a place of the plot [pixels]. */
  #nearest(left, top, reach) {
    let found = null;
    let best = reach;
    this.lines.forEach((line, number) => {
      if (this.hidden.has(line.label)) return;
      for (let i = 0; i < line.x.length; i++) {
        if (line.y[i] === null || Number.isNaN(line.y[i])) continue;
        const x = this.plot.valToPos(line.x[i], "x");
        const y = this.plot.valToPos(line.y[i], line.second ? "y2" : "y");
        const away = Math.hypot(x - left, y - top);
        if (away < best) [best, found] = [away, { line, number, i }];
      }
    });
    return found;
  }

  #hover(u) {
    const { left, top } = u.cursor;
    const found = left >= 0 ? this.#nearest(left, top, 40) : null;
    const ticks = this.options.tell ?? this.options.ticks ?? ((v) => format(v));
    this.readout.textContent = found
      ? `${found.line.label}: ${found.line.second ? format(found.line.y[found.i]) : ticks(found.line.y[found.i])} at ${this.options.x} ${format(found.line.x[found.i])}`
      : "";
  }

  #click(event) {
    const box = this.plot.over.getBoundingClientRect();
    const [left, top] = [event.clientX - box.left, event.clientY - box.top];
    const marked = (this.points ?? []).find(({ x, y }) => Math.hypot(this.plot.valToPos(x, "x") - left, this.plot.valToPos(y, "y") - top) < NEAR);
    if (marked) return this.options.pick?.(marked.row);
    const found = this.#nearest(left, top, 1e9);
    if (found?.line.rows) this.options.pick?.(found.line.rows[found.i]);
  }

  /** Mark the points that belong to a row. */
  mark(row) {
    this.marked = row;
    this.plot?.redraw(false);
  }

  #drawMarks(u) {
    const { ctx } = u;
    ctx.save();
    ctx.beginPath();
    ctx.rect(u.bbox.left, u.bbox.top, u.bbox.width, u.bbox.height);
    ctx.clip();
    const ratio = devicePixelRatio;
    let free = -Infinity; // where the last label ends
    for (const { x, text } of this.marks ?? []) {
      const at = u.valToPos(x, "x", true);
      ctx.strokeStyle = ink("danger");
      ctx.lineWidth = ratio;
      ctx.setLineDash([3 * ratio, 3 * ratio]);
      ctx.beginPath();
      ctx.moveTo(at, u.bbox.top);
      ctx.lineTo(at, u.bbox.top + u.bbox.height);
      ctx.stroke();
      ctx.font = `${10 * ratio}px system-ui, sans-serif`;
      const end = at + 3 * ratio + ctx.measureText(text).width;
      if (text && at > free && end < u.bbox.left + u.bbox.width) {
        free = end + 6 * ratio;
        ctx.fillStyle = ink("danger");
        ctx.fillText(text, at + 3 * ratio, u.bbox.top + 10 * ratio);
      }
    }
    ctx.setLineDash([]);
    this.lines.forEach((line) => {
      if (this.hidden.has(line.label)) return;
      const scale = line.second ? "y2" : "y";
      if (line.dots) {
        ctx.fillStyle = line.stroke;
        for (let i = 0; i < line.x.length; i++) {
          if (line.y[i] === null || Number.isNaN(line.y[i])) continue;
          ctx.beginPath();
          ctx.arc(u.valToPos(line.x[i], "x", true), u.valToPos(line.y[i], scale, true), 2.2 * ratio, 0, 2 * Math.PI);
          ctx.fill();
        }
      }
      if (this.marked === null || !line.rows) return;
      const i = line.rows.lastIndexOf(this.marked);
      if (i < 0 || line.y[i] === null) return;
      ctx.beginPath();
      ctx.arc(u.valToPos(line.x[i], "x", true), u.valToPos(line.y[i], scale, true), 5 * ratio, 0, 2 * Math.PI);
      ctx.fillStyle = ink("stage");
      ctx.strokeStyle = ink("accent");
      ctx.lineWidth = 2.2 * ratio;
      ctx.fill();
      ctx.stroke();
    });
    this.#drawPoints(u);
    ctx.restore();
  }

  /** Peaks and critical points: a diamond with a word, on the side where there is room. */
  #drawPoints(u) {
    const { ctx } = u;
    const ratio = devicePixelRatio;
    ctx.font = `${11 * ratio}px system-ui, sans-serif`;
    for (const { x, y, text } of this.points) {
      const [left, top] = [u.valToPos(x, "x", true), u.valToPos(y, "y", true)];
      const size = 4.5 * ratio;
      ctx.beginPath();
      ctx.moveTo(left, top - size);
      for (const [dx, dy] of [[size, 0], [0, size], [-size, 0]]) ctx.lineTo(left + dx, top + dy);
      ctx.closePath();
      ctx.fillStyle = ink("stage");
      ctx.strokeStyle = ink("ink");
      ctx.lineWidth = 1.3 * ratio;
      ctx.fill();
      ctx.stroke();
      ctx.fillStyle = ink("ink");
      const right = left + 2 * size + ctx.measureText(text).width < u.bbox.left + u.bbox.width;
      ctx.textAlign = right ? "left" : "right";
      const high = top < u.bbox.top + 14 * ratio;
      ctx.fillText(text, left + (right ? 1.6 : -1.6) * size, top + (high ? 12 : 0) * ratio);
    }
    ctx.textAlign = "left";
  }
}
