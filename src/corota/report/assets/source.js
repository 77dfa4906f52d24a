// Where the data come from: chunks inside the page.

import { fromBase64, openChunk } from "./chunk.js";

export class EmbeddedSource {
  constructor() {
    this.elements = new Map(
      [...document.querySelectorAll("script[data-chunk]")].map((found) => [found.dataset.chunk, found]),
    );
  }

  async chunk(name) {
    const found = this.elements.get(name);
    return found ? openChunk(fromBase64(found.textContent)) : null;
  }

  /** Frames one after the other. */
  async *frames() {
    for (let number = 0; this.elements.has(`frame-${number}`); number++) {
      yield await this.chunk(`frame-${number}`);
    }
  }
}
