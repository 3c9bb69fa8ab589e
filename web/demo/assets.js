// What the page needs beside its code. In the page that is one file, web/demo/inline.mjs puts the bytes here.

/** The WebAssembly module, as `load` takes it; undefined for the one beside nfr.js. */
export const wasm = () => undefined;

/** The page's own font. */
export const specimen = async () => (await fetch("specimen.ttf")).arrayBuffer();
