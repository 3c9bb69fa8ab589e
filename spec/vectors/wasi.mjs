// Checks the vectors of a folder with the program built for wasm32-wasip1: node wasi.mjs vectors.wasm FOLDER
import { readFileSync } from "node:fs";
import { WASI } from "node:wasi";

const [program, folder] = process.argv.slice(2);
const wasi = new WASI({ version: "preview1", args: ["vectors", "check", "/vectors"], preopens: { "/vectors": folder } });
const module = await WebAssembly.compile(readFileSync(program));
const instance = await WebAssembly.instantiate(module, { wasi_snapshot_preview1: wasi.wasiImport });
process.exitCode = wasi.start(instance);
