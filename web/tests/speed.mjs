// Prints what the module weighs and how fast it draws in node: node speed.mjs FOLDER, a folder with nfr/ as web/build makes it. Fails
// if the module is larger than its limit. Run at the root of the repository.
//
// 2,000 glyphs, 100 different ones, of the page's font. Cold: from the font's bytes, in a module that has drawn another font, so that its
// code is compiled. Warm: again, with models that are decoded. The fastest of several rounds, and in brackets their median, which tells
// how busy the machine was. All pixels are drawn, none is copied out of the module's memory.
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";
import { gzipSync } from "node:zlib";

const { load } = await import(pathToFileURL(`${process.argv[2]}/nfr/nfr.js`));
const wasm = readFileSync(`${process.argv[2]}/nfr/nfr.wasm`);
const specimen = readFileSync("web/demo/specimen.ttf");
const DISTINCT = 100, GLYPHS = 2000, ROUNDS = 21;

const nfr = await load(wasm);
const font = nfr.open(specimen);
const glyphs = Array.from({ length: DISTINCT }, (_, at) => font.glyphForChar(String.fromCharCode(at < 94 ? 0x21 + at : 0xe0 + at)));
const text = Array.from({ length: GLYPHS }, (_, at) => glyphs[(at * 37) % DISTINCT]);

const draw = (font, ppem) => text.forEach((glyph) => font.draw(glyph, { ppem, copy: false }));
function time(work) {
  const rounds = Array.from({ length: ROUNDS }, () => {
    const since = performance.now();
    work();
    return performance.now() - since;
  }).sort((a, b) => a - b);
  return [rounds[0], rounds[ROUNDS >> 1]];
}

/** What node takes the first time, before it has compiled the module well. */
async function first(ppem) {
  const fresh = await load(wasm);
  const since = performance.now();
  draw(fresh.open(specimen), ppem);
  return performance.now() - since;
}

const MAX_GZIP = 120;

let failed = false;
function figure(name, values, unit, limit) {
  const [value, median] = [values].flat();
  const beyond = limit !== undefined && value > limit;
  failed ||= beyond;
  const digits = (value) => value.toFixed(value < 100 ? 1 : 0).padStart(6);
  const more = [median && `(${digits(median).trim()})`, limit && `limit ${limit}`, beyond && "BEYOND"].filter((part) => part);
  console.log(`${name.padEnd(48)} ${digits(value)} ${unit}  ${more.join("  ")}`);
}

figure("nfr.wasm", wasm.length / 1000, "kB");
figure("nfr.wasm, gzip -9", gzipSync(wasm, { level: 9 }).length / 1000, "kB", MAX_GZIP);
for (const ppem of [12, 16, 24, 40]) {
  figure(`${GLYPHS} glyphs at ${ppem} ppem, first in a fresh module`, await first(ppem), "ms");
  figure(`${GLYPHS} glyphs at ${ppem} ppem, cold`, time(() => {
    const opened = nfr.open(specimen);
    draw(opened, ppem);
    opened.free();
  }), "ms");
  figure(`${GLYPHS} glyphs at ${ppem} ppem, warm`, time(() => draw(font, ppem)), "ms");
}
process.exitCode = Number(failed);
