// Checks nfr.js in node: node node.mjs FOLDER, a folder with nfr/ as web/build makes it. Run at the root of the repository.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { pathToFileURL } from "node:url";

const { load, drawText, layoutText, paint, NfrError } = await import(pathToFileURL(`${process.argv[2]}/nfr/nfr.js`));
const wasm = readFileSync(`${process.argv[2]}/nfr/nfr.wasm`);
const nfr = await load();
const vectors = "spec/vectors";
const font = (name, options) => nfr.open(readFileSync(`${vectors}/${name}.ttf`), options);
const lines = (file) => readFileSync(`${vectors}/${file}`, "ascii").split("\n").filter((line) => line && !line.startsWith("#"));

/** The 64-bit FNV-1a hash, in two halves: multiplying BigInts takes ten times as long. */
class Hash {
  high = 0xcbf29ce4;
  low = 0x84222325;
  add(pixels) {
    let { high, low } = this;
    for (const level of pixels) {
      low = (low ^ level) >>> 0;
      // Times 0x100_0000_01b3 modulo 2^64.
      const product = low * 0x1b3;
      high = (Math.imul(high, 0x1b3) + Math.floor(product / 2 ** 32) + (low << 8)) >>> 0;
      low = product >>> 0;
    }
    Object.assign(this, { high, low });
    return this;
  }
  toString() {
    return [this.high, this.low].map((half) => half.toString(16).padStart(8, "0")).join("");
  }
}

const tests = {
  "every vector is drawn as it is written down"() {
    let count = 0;
    for (const name of ["sans", "serif", "mono", "outline", "outline-mono", "postscript"]) {
      const opened = font(name);
      for (const line of lines(`${name}.txt`)) {
        const [glyph, ppem, x, y] = line.split(" ").map(Number);
        const { left, top, width, height, pixels } = opened.draw(glyph, { ppem, offset: [x, y], copy: false });
        const said = `${line.split(" ", 4).join(" ")} ${left} ${top} ${width} ${height} ${new Hash().add(pixels)}`;
        assert.equal(said, line, name);
        count++;
      }
      opened.free();
    }
    return `${count} bitmaps, 0 pixels differ`;
  },
  "glyphs that networks draw are refused: the module is built without them"() {
    const opened = font("network");
    for (const line of lines("network.txt")) {
      const [glyph, ppem] = line.split(" ").map(Number);
      assert.throws(() => opened.draw(glyph, { ppem }), { code: "NFR_UNSUPPORTED" });
    }
  },
  "every sweep is drawn as it is written down"() {
    const fonts = new Map();
    for (const line of lines("sweeps.txt")) {
      const [name, glyph] = line.split(" ");
      if (!fonts.has(name)) fonts.set(name, font(name));
      const opened = fonts.get(name);
      const hash = new Hash();
      const last = opened.ppemRange[1];
      for (let step = 64; step >= 0; step--) hash.add(opened.draw(Number(glyph), { ppem: last - step / 4, copy: false }).pixels);
      assert.equal(`${name} ${glyph} ${hash}`, line);
    }
    return `${lines("sweeps.txt").length * 65} bitmaps`;
  },
  "whole bitmaps are drawn as they are written down"() {
    const blocks = readFileSync(`${vectors}/bitmaps.txt`, "ascii").split("\n\n").slice(1).map((block) => block.trim().split("\n"));
    let differing = 0;
    for (const [head, ...rows] of blocks) {
      const [name, ...numbers] = head.split(" ");
      if (name === "network") continue;
      const [glyph, ppem, x, y] = numbers.map(Number);
      const { pixels } = font(name).draw(glyph, { ppem, offset: [x, y] });
      const wanted = rows.flatMap((row) => row.split(" ")).map((level) => parseInt(level, 16));
      assert.equal(pixels.length, wanted.length);
      differing += wanted.filter((level, at) => level !== pixels[at]).length;
    }
    assert.equal(differing, 0);
  },
  "properties are the font's"() {
    const sans = font("outline");
    assert.deepEqual(sans.ppemRange, [8, 64]);
    assert.deepEqual([sans.target, sans.unitsPerEm, sans.outlinesDropped], ["smooth", 2048, false]);
    assert.equal(font("outline-mono").target, "mono");
    assert.equal(font("sans").outlinesDropped, true);
    assert.equal(sans.modelCount, sans.glyphCount);
    assert.ok(sans.tableLength > 1000 && sans.tableLength < 20000);
    const a = sans.glyphForChar("a");
    assert.equal(a, sans.glyphForChar(0x61));
    assert.equal(sans.glyphForChar("漢"), 0);
    assert.equal(sans.glyphForChar(""), 0);
    assert.ok(sans.hasModel(a) && !sans.hasModel(60000));
    assert.equal(sans.hintedAdvance(a, 16), Math.round(sans.advance(a, 16)));
    assert.ok(sans.advance(a, 16) % 1 !== 0);
    const { ascent, descent } = sans.lineMetrics(16);
    assert.ok(ascent > 10 && descent < 0);
  },
  "a glyph without hinting is the plain outline"() {
    const sans = font("outline");
    const glyph = sans.glyphForChar("x");
    const [hinted, plain] = [true, false].map((hinting) => sans.draw(glyph, { ppem: 13, hinting }));
    assert.notDeepEqual(hinted.pixels, plain.pixels);
    // Beyond the sizes of the models both are the outline.
    const [large, outline] = [true, false].map((hinting) => sans.draw(glyph, { ppem: 100, hinting }));
    assert.deepEqual(large, outline);
  },
  "pixels are a copy unless a view is asked for"() {
    const sans = font("outline");
    const draw = (character, copy) => sans.draw(sans.glyphForChar(character), { ppem: 40, copy }).pixels;
    const [kept, before] = [draw("a"), draw("a").slice()];
    const view = draw("a", false);
    assert.deepEqual(view, before);
    draw("X");
    assert.deepEqual(kept, before);
    assert.notDeepEqual(view, before);
  },
  "text is its glyphs side by side"() {
    const sans = font("outline");
    const { glyphs, advance } = layoutText(sans, "ac", { ppem: 16 });
    assert.deepEqual(glyphs.map(({ x }) => x), [0, glyphs[0].advance]);
    const line = drawText(sans, "ac", { ppem: 16 });
    assert.equal(line.advance, advance);
    const sum = (pixels) => pixels.reduce((sum, level) => sum + level, 0);
    assert.equal(sum(line.pixels), glyphs.reduce((all, { glyph }) => all + sum(sans.draw(glyph, { ppem: 16 }).pixels), 0));
    const image = { width: 10, height: 10, data: new Uint8ClampedArray(400) };
    paint(image, line, 2, 9, [1, 2, 3]);
    const at = ((9 - line.top) * 10 + 2 + line.left) * 4;
    for (let x = 0; x < 8 - line.left; x++) assert.equal(image.data[at + 4 * x + 3], line.pixels[x]);
    assert.equal(drawText(sans, "", { ppem: 16 }).width, 0);
    assert.equal(drawText(sans, "  ", { ppem: 16 }).advance, 2 * sans.hintedAdvance(sans.glyphForChar(" "), 16));
  },
  "errors have the library's messages and a code"() {
    const bytes = readFileSync(`${vectors}/outline.ttf`);
    const fails = (code, message, work) => assert.throws(work, (e) => e instanceof NfrError && e.code === code && message.test(e.message));
    fails("NFR_NOT_A_FONT", /no OpenType font/, () => nfr.open(new Uint8Array([1, 2, 3])));
    fails("NFR_NOT_A_FONT", /no OpenType font/, () => nfr.open(new ArrayBuffer(0)));
    fails("NFR_NO_MODELS", /no table 'Nfrt'/, () => nfr.open(readFileSync("fonts/LiberationSans-Regular.ttf")));
    fails("NFR_DAMAGED_FONT", /truncated/, () => nfr.open(bytes.subarray(0, 4000)));
    fails("NFR_NO_SUCH_FONT", /font index 3/, () => nfr.open(bytes, { index: 3 }));
    const sans = nfr.open(bytes);
    fails("NFR_NO_SUCH_GLYPH", /no glyph 9999/, () => sans.draw(9999, { ppem: 16 }));
    fails("NFR_INVALID_SIZE", /0 ppem/, () => sans.draw(1, { ppem: 0 }));
    fails("NFR_INVALID_SIZE", /NaN ppem/, () => sans.hintedAdvance(1, NaN));
    fails("NFR_INVALID_SIZE", /4000 ppem/, () => sans.lineMetrics(4000));
    fails("NFR_INVALID_OFFSET", /offset/, () => sans.draw(1, { ppem: 16, offset: [1e9, 0] }));
    sans.free();
    sans.free();
    fails("NFR_INVALID_ARGUMENT", /was freed/, () => sans.draw(1, { ppem: 16 }));
    assert.throws(() => nfr.open("text"), TypeError);
    assert.throws(() => nfr.open(bytes, { missing: "what" }), TypeError);
    // A font goes on after an error.
    const other = nfr.open(bytes);
    fails("NFR_NO_SUCH_GLYPH", /9999/, () => other.draw(9999, { ppem: 16 }));
    assert.ok(other.draw(5, { ppem: 16 }));
  },
  "fonts that are freed give their memory back"() {
    const bytes = readFileSync("fonts/LiberationSans-Regular.ttf");
    const converted = readFileSync(`${vectors}/outline.ttf`);
    const use = () => {
      assert.throws(() => nfr.open(bytes));
      const opened = nfr.open(converted);
      for (let glyph = 0; glyph < opened.glyphCount; glyph++) opened.draw(glyph, { ppem: 20 });
      opened.free();
    };
    for (let i = 0; i < 5; i++) use();
    const size = nfr.memoryBytes;
    for (let i = 0; i < 100; i++) use();
    assert.equal(nfr.memoryBytes, size);
  },
  "damaged fonts are errors or other pixels, never a trap"() {
    const bytes = readFileSync(`${vectors}/outline.ttf`);
    let random = 1;
    const next = (below) => (random = (random * 48271) % 2147483647) % below;
    let refused = 0;
    for (let i = 0; i < 500; i++) {
      const damaged = Uint8Array.from(i % 5 === 0 ? bytes.subarray(0, next(bytes.length)) : bytes);
      for (let j = next(4); j >= 0 && damaged.length > 0; j--) damaged[next(damaged.length)] = next(256);
      try {
        const opened = nfr.open(damaged);
        for (let glyph = 0; glyph < Math.min(opened.glyphCount, 60); glyph += 3) opened.draw(glyph, { ppem: 16, copy: false });
        opened.free();
      } catch (error) {
        assert.ok(error instanceof NfrError && error.code !== "NFR_INTERNAL", String(error));
        refused++;
      }
    }
    assert.ok(refused > 50 && refused < 500);
    return `${refused} of 500 refused`;
  },
  async "after a trap nothing is called any more"() {
    const { Font } = await import(pathToFileURL(`${process.argv[2]}/nfr/font.js`));
    let calls = 0;
    const nfr_alloc = () => {
      calls++;
      throw new WebAssembly.RuntimeError("unreachable");
    };
    const state = { exports: { nfr_alloc }, broken: false };
    const registry = new FinalizationRegistry(() => {});
    for (let i = 0; i < 2; i++) assert.throws(() => new Font(state, registry, new Uint8Array(4)), { code: "NFR_INTERNAL" });
    assert.equal(calls, 1);
  },
  "a large file that is no font is refused"() {
    assert.throws(() => nfr.open(new Uint8Array(50 << 20)), { code: "NFR_NOT_A_FONT" });
  },
  async "the module is taken as bytes, compiled, or as an answer, with the right type or another"() {
    const answer = (type) => new Response(wasm, { headers: { "content-type": type } });
    const address = new URL("nfr.wasm", pathToFileURL(`${process.argv[2]}/nfr/`));
    const sources = [wasm, await WebAssembly.compile(wasm), answer("application/wasm"), answer("text/plain"), address, String(address)];
    for (const source of [...sources, Promise.resolve(wasm)]) assert.ok((await load(source)).open(readFileSync(`${vectors}/sans.ttf`)));
    await assert.rejects(load(new Response("", { status: 404 })), /404/);
    await assert.rejects(load(new Uint8Array(8)), WebAssembly.CompileError);
  },
  "codes are those of nfr.h"() {
    const header = readFileSync("crates/nfr-capi/include/nfr.h", "utf8");
    const wanted = [...header.matchAll(/^\s+(NFR_[A-Z_]+) = (\d+),$/gm)].map(([, name, number]) => [name, Number(number)]);
    const source = readFileSync("web/nfr/font.js", "utf8").match(/const CODES = \[([^\]]*)\]/)[1];
    const codes = [...source.matchAll(/"(\w+)"/g)].map(([, name]) => name);
    const statuses = wanted.slice(0, codes.length);
    assert.deepEqual(codes.map((name, number) => [name, number]), statuses);
  },
};

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  const since = performance.now();
  try {
    const said = await test();
    console.log(`ok  ${name}${said ? `: ${said}` : ""}  (${((performance.now() - since) / 1000).toFixed(1)} s)`);
  } catch (error) {
    failed++;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
process.exitCode = failed;
