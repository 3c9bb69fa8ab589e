// nfr: draws the glyphs of fonts that nfr-convert has converted. nfr.d.ts describes everything that is exported.

import { Font, NfrError } from "./font.js";

export { Font, NfrError };
export { drawText, layoutText, paint } from "./text.js";

/**
 * Loads the WebAssembly module: without an argument the file nfr.wasm beside this one.
 */
export async function load(source = new URL("./nfr.wasm", import.meta.url)) {
  return new Nfr(await instantiate(await source));
}

async function instantiate(source) {
  if (source instanceof WebAssembly.Module) return WebAssembly.instantiate(source);
  if (typeof source === "string" || source instanceof URL) source = await read(source);
  if (typeof Response !== "undefined" && source instanceof Response) {
    if (!source.ok) throw new Error(`${source.url}: ${source.status} ${source.statusText}`);
    // Compiling while it is loaded needs the right type; some servers do not know it.
    const type = source.headers.get("content-type") ?? "";
    if (type.startsWith("application/wasm")) return (await WebAssembly.instantiateStreaming(source)).instance;
    source = await source.arrayBuffer();
  }
  return (await WebAssembly.instantiate(source)).instance;
}

async function read(url) {
  url = new URL(url, globalThis.location?.href ?? import.meta.url);
  // Node's fetch knows no files.
  if (url.protocol === "file:" && globalThis.process?.versions?.node) return (await import("node:fs/promises")).readFile(url);
  return fetch(url);
}

class Nfr {
  #state;
  #registry = new FinalizationRegistry((handle) => {
    if (!this.#state.broken) this.#state.exports.nfr_free(handle);
  });

  constructor(instance) {
    this.#state = { exports: instance.exports, memory: instance.exports.memory, broken: false };
  }

  get memoryBytes() {
    return this.#state.memory.buffer.byteLength;
  }

  open(data, options) {
    return new Font(this.#state, this.#registry, data, options);
  }
}
