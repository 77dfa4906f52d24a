// A run at work: the page asks its own server for what is new, and may end the run.

import { openChunk } from "./chunk.js";
import { byId } from "./dom.js";

/** Milliseconds between two questions, frames that are fetched at once and that are kept. */
const BEAT = 1000;
const AT_ONCE = 4;
const MOST_FRAMES = 200;

export class LiveSource {
  constructor(path) {
    this.path = path;
    this.known = new Set();
  }

  async #get(name, options) {
    const answer = await fetch(`${this.path}/${name}`, { cache: "no-store", ...options });
    return answer.status === 200 ? answer : null;
  }

  async chunk(name) {
    const answer = await this.#get(name);
    return answer ? openChunk(new Uint8Array(await answer.arrayBuffer())) : null;
  }

  async state() {
    return (await this.#get("state"))?.json() ?? null;
  }

  stop() {
    return this.#get("stop", { method: "POST" });
  }
}

/** Ask until the run is over; `take` gets what is new. */
export async function follow(source, scene, take) {
  const button = byId("stop");
  button.hidden = false;
  button.addEventListener("click", async () => {
    button.disabled = true;
    button.textContent = "Ends after this increment";
    await source.stop();
  });
  let seen = -1;
  for (;;) {
    let state = null;
    const begin = performance.now();
    try {
      state = await source.state();
    } catch {
      take({ gone: true });
      break;
    }
    if (state) {
      if (state.version !== seen) {
        seen = state.version;
        take({ history: await source.chunk("history") });
      }
      const fresh = await newFrames(source, scene, state.frames);
      if (fresh) take({ frames: fresh });
      if (state.over && !fresh) {
        take({ over: true });
        break;
      }
    }
    // Slow requests are made less often: the run needs the processor.
    const pause = Math.max(BEAT, 2 * (performance.now() - begin));
    await new Promise((resolve) => setTimeout(resolve, Math.min(pause, 10 * BEAT)));
  }
  button.hidden = true;
}

/** The newest frame and some of those that are missing, spread over the run; how many came. */
async function newFrames(source, scene, count) {
  const missing = [];
  for (let index = 0; index < count; index++) if (!source.known.has(index)) missing.push(index);
  if (!missing.length || (scene.all.length >= MOST_FRAMES && missing.at(-1) !== count - 1)) return 0;
  const stride = Math.max(1, Math.ceil(missing.length / AT_ONCE));
  const wanted = missing.filter((_, i) => (missing.length - 1 - i) % stride === 0);
  let found = 0;
  for (const index of wanted) {
    const frame = await source.chunk(`frame/${index}`);
    if (!frame) break; // not written yet
    source.known.add(index);
    scene.all.push(frame);
    found += 1;
  }
  scene.all.sort((a, b) => a.index - b.index);
  if (scene.all.length > MOST_FRAMES) {
    scene.all = scene.all.filter((_, i) => i % 2 === 0 || i === scene.all.length - 1);
  }
  return found;
}
