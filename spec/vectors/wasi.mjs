// Checks the vectors of a folder with the program built for wasm32-wasip1: node wasi.mjs vectors.wasm FOLDER
import { readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const [program, folder] = process.argv.slice(2);
const wasi = new WASI({ version: "preview1", args: ["vectors", "check", "/vectors"], preopens: { "/vectors": folder } });
// Node 20 may corrupt its heap when WebAssembly calls its WASI functions directly (V8's fast API calls), and then ends with
// a segmentation fault. Through a function in between the calls are ordinary ones.
const imports = Object.entries(wasi.wasiImport).map(([name, call]) => [name, (...args) => call(...args)]);
const module = await WebAssembly.compile(readFileSync(program));
const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: Object.fromEntries(imports) });
process.exitCode = wasi.start(instance);
