// The course of the run: rows of increments, iterations, cut-backs, notes.

export class History {
  constructor(chunk) {
    this.take(chunk);
  }

  take(chunk) {
    const { arrays } = chunk;
    this.names = chunk.names;
    this.units = chunk.units ?? {};
    this.facts = chunk.facts;
    this.cutBacks = chunk["cut backs"];
    this.steps = chunk.steps;
    this.notes = chunk.notes;
    this.leftOut = chunk["left out"];
    this.start = chunk.start;
    this.end = chunk.end;
    this.count = arrays.rows.shape[0];
    this.rows = arrays.rows.data;
    this.iterationNames = chunk["iteration names"];
    this.iterations = arrays.iterations.data;
    this.iterationCount = arrays.iterations.shape[0];
    this.iterationNumbers = arrays["iteration numbers"].data;
    this.columns = new Map();
  }

  /** A name with its unit, where that is known. */
  label(name) {
    return this.units[name] ? `${name} [${this.units[name]}]` : name;
  }

  /** Names of stages: bodies whose travel is measured. */
  get stages() {
    return this.names.filter((name) => name.endsWith(": travel")).map((name) => name.slice(0, -": travel".length));
  }

  /** Values of a column over the rows; null where there is no such column. */
  column(name) {
    if (!this.columns.has(name)) {
      const place = this.names.indexOf(name);
      const width = this.names.length;
      this.columns.set(name, place < 0 ? null : Array.from({ length: this.count }, (_, i) => this.rows[i * width + place]));
    }
    return this.columns.get(name);
  }

  iteration(name) {
    const place = this.iterationNames.indexOf(name);
    const width = this.iterationNames.length;
    return Array.from({ length: this.iterationCount }, (_, i) => this.iterations[i * width + place]);
  }

  /** Row of a step and an increment, or the nearest before it; -1 without rows. */
  rowOf(step, increment) {
    const [steps, increments] = [this.column("step"), this.column("increment")];
    if (!steps || !this.count) return -1;
    let found = 0;
    for (let i = 0; i < this.count; i++) {
      if (steps[i] < step || (steps[i] === step && increments[i] <= increment)) found = i;
    }
    return found;
  }

  /** Increments; the row of the start of a step is none. */
  get incrementCount() {
    return (this.column("increment") ?? []).filter((number) => number > 0).length;
  }

  /** Cut-backs of the log; results in memory have no log, but the attempts of each increment. */
  get cutBackCount() {
    const attempts = this.column("attempts") ?? [];
    return this.cutBacks.length || attempts.reduce((sum, count) => sum + Math.max(count - 1, 0), 0);
  }
}

/** Place of the frame that is nearest to a step and an increment. */
export function nearestFrame(frames, step, increment) {
  let best = -1;
  let away = Infinity;
  frames.forEach((frame, i) => {
    if (frame.kind !== "increment") return;
    const distance = 1e6 * Math.abs(frame.step - step) + Math.abs(frame.increment - increment);
    if (distance < away) [best, away] = [i, distance];
  });
  return best;
}
