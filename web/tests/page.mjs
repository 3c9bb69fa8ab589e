// Checks the page in headless Chromium: node page.mjs FOLDER MODULES PICTURES. FOLDER is what web/build makes, MODULES has playwright-core in
// node_modules, screenshots are written into PICTURES. Run at the root of the repository.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createServer } from "node:http";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const [folder, modules, pictures] = process.argv.slice(2);
const { chromium } = createRequire(`${modules}/`)("playwright-core");
const { load, drawText } = await import(pathToFileURL(`${folder}/nfr/nfr.js`));
const specimen = readFileSync("web/demo/specimen.ttf");
const font = (await load()).open(specimen);

const TYPES = { html: "text/html", css: "text/css", js: "text/javascript", wasm: "application/wasm", ttf: "font/ttf" };
const server = createServer((request, response) => {
  try {
    const path = new URL(request.url, "http://localhost").pathname;
    response.setHeader("content-type", TYPES[path.split(".").pop()]);
    // As hosts of static files have it: a second visit within the time asks for the page alone.
    response.setHeader("cache-control", path.endsWith(".html") ? "no-cache" : "max-age=600");
    response.end(readFileSync(folder + path));
  } catch {
    response.writeHead(404).end();
  }
});
await new Promise((ready) => server.listen(0, "127.0.0.1", ready));
const address = `http://127.0.0.1:${server.address().port}/demo/index.html`;
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });

/** A page with what it complains of. */
async function open({ colorScheme = "light", deviceScaleFactor = 1, width = 1280, url = address } = {}) {
  const context = await browser.newContext({ colorScheme, deviceScaleFactor, viewport: { width, height: 1000 } });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (said) => ["error", "warning"].includes(said.type()) && complaints.push(said.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("requestfailed", (request) => complaints.push(request.url()));
  await page.goto(url);
  // The browser's text comes last.
  await page.waitForFunction(() => document.fonts.size === 2);
  return { page, complaints, close: () => (assert.deepEqual(complaints, []), context.close()) };
}

/** A canvas of a panel: its size and the pixels' alpha. */
const canvasOf = (page, kind) =>
  page.evaluate((kind) => {
    const canvas = document.querySelector(`[data-kind=${kind}] .text`);
    const { width, height } = canvas;
    const { data } = canvas.getContext("2d").getImageData(0, 0, width, height);
    return { width, height, css: canvas.getBoundingClientRect().width, alpha: Array.from({ length: width * height }, (_, at) => data[4 * at + 3]) };
  }, kind);
const message = (page) => page.locator("#message").textContent();
const choose = async (page, name, buffer) => {
  await page.setInputFiles("#file", { name, mimeType: "font/ttf", buffer });
};
const says = (page, pattern) => page.waitForFunction((pattern) => new RegExp(pattern).test(document.querySelector("#message").textContent), pattern.source);

/** How many pixels of the first panel differ from what the library draws for one word at a size in device pixels. */
async function differing(page, word, ppem) {
  const { width, height, alpha } = await canvasOf(page, "neural");
  const wanted = new Array(width * height).fill(0);
  const line = drawText(font, word, { ppem });
  const baseline = 3 + Math.ceil(font.lineMetrics(ppem).ascent);
  line.pixels.forEach((level, at) => {
    const x = 3 + line.left + (at % line.width), y = baseline - line.top + Math.floor(at / line.width);
    wanted[y * width + x] = level;
  });
  assert.ok(line.pixels.some((level) => level > 100));
  return wanted.filter((level, at) => level !== alpha[at]).length;
}

const tests = {
  async "the pixels are the library's, at one and at two device pixels a pixel"() {
    let count = 0;
    for (const deviceScaleFactor of [1, 2]) {
      const { page, close } = await open({ deviceScaleFactor });
      await page.fill("#text", "Hamburg");
      for (const size of [8, 11, 16, 31, 40]) {
        await page.fill("#size", String(size));
        assert.equal(await differing(page, "Hamburg", size * deviceScaleFactor), 0, `${size} × ${deviceScaleFactor}`);
        count++;
      }
      const { width, css } = await canvasOf(page, "neural");
      assert.ok(Math.abs(width - css * deviceScaleFactor) < 0.01, "a canvas pixel is a device pixel");
      await close();
    }
    return `${count} pictures, 0 pixels differ`;
  },
  async "the three renderings differ, and each has ink"() {
    const { page, close } = await open();
    const drawn = [];
    for (const kind of ["neural", "browser", "unhinted"]) drawn.push((await canvasOf(page, kind)).alpha);
    drawn.forEach((alpha) => assert.ok(alpha.some((level) => level > 128)));
    assert.equal(new Set(drawn.map(String)).size, 3);
    await close();
  },
  async "the size and the text change the picture, and the waterfall its rendering"() {
    const { page, close } = await open();
    const pictures = new Set([String((await canvasOf(page, "neural")).alpha)]);
    await page.fill("#size", "24");
    pictures.add(String((await canvasOf(page, "neural")).alpha));
    await page.fill("#text", "Another text");
    pictures.add(String((await canvasOf(page, "neural")).alpha));
    assert.equal(pictures.size, 3);
    const row = () => page.evaluate(() => document.querySelector("#waterfall canvas").toDataURL());
    const before = await row();
    await page.check("[name=kind][value=unhinted]");
    assert.notEqual(await row(), before);
    await close();
  },
  async "a file that is no converted font is named in a line, and the page goes on"() {
    const { page, close } = await open();
    const vector = readFileSync("spec/vectors/outline.ttf");
    const cases = [
      ["notes.txt", Buffer.from("Dear reader,\nthis is a letter."), /^notes\.txt is no font/],
      ["empty.ttf", Buffer.alloc(0), /^empty\.ttf is empty/],
      ["plain.ttf", readFileSync("fonts/LiberationSans-Regular.ttf"), /^plain\.ttf is a font without models/],
      ["short.ttf", vector.subarray(0, 5000), /^short\.ttf is damaged: /],
      ["web.woff2", Buffer.from("wOF2 and more"), /^web\.woff2 is a compressed web font/],
      // playwright gives at most 50 MB.
      ["large.bin", Buffer.alloc(49 << 20, 7), /^large\.bin is no font/],
    ];
    const before = String((await canvasOf(page, "neural")).alpha);
    for (const [name, bytes, line] of cases) {
      await choose(page, name, bytes);
      await says(page, line);
      assert.equal(String((await canvasOf(page, "neural")).alpha), before, name);
    }
    await page.fill("#size", "20");
    assert.notEqual(String((await canvasOf(page, "neural")).alpha), before);
    await choose(page, "good.ttf", vector);
    await page.waitForFunction(() => document.querySelector("#facts").textContent.startsWith("good.ttf, 11.9 kB"));
    await close();
    return `${cases.length} kinds of files`;
  },
  async "damaged glyphs are left out and said"() {
    const { page, complaints, close } = await open();
    const damaged = Buffer.from(readFileSync("spec/vectors/outline.ttf"));
    const table = tableOf(damaged, "glyf");
    damaged.fill(0x5a, table.offset + 200, table.offset + table.length);
    await choose(page, "damaged.ttf", damaged);
    await says(page, /damaged/);
    await page.fill("#text", "still here");
    // The browser refuses the font's outlines, and says so.
    assert.match(complaints.splice(0).join(), /^OTS parsing error: glyf[^,]*$/);
    await close();
  },
  async "a file can be dropped"() {
    const { page, close } = await open();
    const drop = (name, bytes) =>
      page.evaluate(([name, text]) => {
        const data = Uint8Array.from(atob(text), (character) => character.charCodeAt(0));
        const transfer = new DataTransfer();
        transfer.items.add(new File([data], name));
        for (const type of ["dragenter", "dragover", "drop"]) {
          document.body.dispatchEvent(new DragEvent(type, { dataTransfer: transfer, bubbles: true, cancelable: true }));
        }
        return document.body.className;
      }, [name, bytes.toString("base64")]);
    assert.equal(await drop("dropped.txt", Buffer.from("text")), "");
    await says(page, /^dropped\.txt is no font/);
    await drop("serif.ttf", readFileSync("spec/vectors/outline.ttf"));
    await page.waitForFunction(() => document.querySelector("#facts").textContent.startsWith("serif.ttf"));
    await close();
  },
  async "characters without a model are counted and drawn plain"() {
    const { page, close } = await open();
    await page.fill("#text", "αβ漢");
    assert.match(await message(page), /2 characters without a model.*α β.*1 character not in the font: 漢/);
    assert.ok((await canvasOf(page, "neural")).alpha.some((level) => level > 128));
    await page.fill("#text", "ab");
    assert.equal(await message(page), "");
    await close();
  },
  async "the theme follows the system and the button"() {
    for (const [colorScheme, first] of [["light", 250], ["dark", 22]]) {
      const { page, close } = await open({ colorScheme });
      const paper = () => page.evaluate(() => Number(getComputedStyle(document.body).backgroundColor.match(/\d+/)[0]));
      const ink = () =>
        page.evaluate(() => {
          const { data } = document.querySelector(".text").getContext("2d").getImageData(0, 0, 300, 30);
          return data[data.findLastIndex((level, at) => at % 4 === 3 && level === 255) - 3];
        });
      assert.equal(await paper(), first);
      const before = await ink();
      await page.click("#theme");
      assert.equal(await paper(), 272 - first);
      assert.ok(Math.abs((await ink()) - before) > 150);
      await close();
    }
  },
  async "the keyboard alone reaches everything, and what has the focus shows it"() {
    const { page, close } = await open();
    const reached = [];
    for (let i = 0; i < 6; i++) {
      await page.keyboard.press("Tab");
      reached.push(
        await page.evaluate(() => {
          const { outlineStyle } = getComputedStyle(document.activeElement);
          return `${document.activeElement.id || document.activeElement.name} ${outlineStyle}`;
        }),
      );
    }
    assert.deepEqual(reached, ["theme", "text", "size", "file", "stage", "kind"].map((name) => `${name} solid`));
    await page.focus("#theme");
    await page.keyboard.press("Space");
    assert.equal(await page.getAttribute("html", "data-theme"), "dark");
    await page.focus("#size");
    await page.keyboard.press("ArrowRight");
    assert.match(await page.textContent("#size-value"), /^13 px/);
    await page.focus("#stage");
    const glass = () => page.evaluate(() => document.querySelector(".glass").toDataURL());
    const before = await glass();
    await page.keyboard.press("Shift+ArrowRight");
    assert.notEqual(await glass(), before);
    assert.match(await page.textContent("#place"), /^Pixel 48, \d+/);
    await page.focus("[name=kind]");
    await page.keyboard.press("ArrowRight");
    assert.equal(await page.inputValue("[name=kind]:checked"), "browser");
    await close();
  },
  async "the magnifier follows the pointer and shows the same place in all three"() {
    const { page, close } = await open();
    const box = await page.locator("[data-kind=browser] .text").boundingBox();
    await page.mouse.move(box.x + 200, box.y + 12);
    assert.match(await page.textContent("#place"), /^Pixel 200, \d+/);
    const frames = await page.evaluate(() => [...document.querySelectorAll(".frame")].map((frame) => frame.style.cssText));
    assert.equal(new Set(frames).size, 1);
    await close();
  },
  async "every control has a name and what is said is announced"() {
    const { page, close } = await open();
    const unnamed = await page.evaluate(() => {
      const name = (element) =>
        element.getAttribute("aria-label") || element.labels?.[0]?.textContent.trim() || element.textContent.trim() || "";
      const all = document.querySelectorAll("input, button, canvas:not([aria-hidden]), [tabindex], form, [role=img]");
      return [...all].filter((element) => !name(element)).map((element) => element.outerHTML);
    });
    assert.deepEqual(unnamed, []);
    const tree = await page.locator("body").ariaSnapshot();
    for (const part of ['button "Dark"', 'textbox "Text"', 'slider "Size', 'application "Specimen', 'heading "Waterfall"', 'radio "neural"', 'img "“Hamburge']) {
      assert.ok(tree.includes(part), `${part} is not in\n${tree}`);
    }
    assert.equal(await page.getAttribute("#message", "role"), "status");
    await close();
  },
  async "text and frames have contrast in both themes"() {
    for (const colorScheme of ["light", "dark"]) {
      const { page, close } = await open({ colorScheme });
      const ratios = await page.evaluate(() => {
        const style = getComputedStyle(document.documentElement);
        const light = (name) => {
          const digits = style.getPropertyValue(name).match(/[0-9a-f]{2}/gi).map((part) => parseInt(part, 16) / 255);
          const [r, g, b] = digits.map((v) => (v <= 0.04045 ? v / 12.92 : ((v + 0.055) / 1.055) ** 2.4));
          return 0.2126 * r + 0.7152 * g + 0.0722 * b;
        };
        const ratio = (a, b) => (Math.max(light(a), light(b)) + 0.05) / (Math.min(light(a), light(b)) + 0.05);
        return [ratio("--ink", "--paper"), ratio("--muted", "--paper"), ratio("--accent", "--paper")];
      });
      assert.ok(ratios.every((ratio) => ratio >= 4.5), `${colorScheme}: ${ratios}`);
      await close();
    }
  },
  async "narrow pages do not scroll sideways"() {
    const { page, close } = await open({ width: 380 });
    assert.equal(await page.evaluate(() => document.documentElement.scrollWidth), 380);
    await close();
  },
  async "the page as one file works from the disk"() {
    const { page, close } = await open({ url: String(pathToFileURL(`${folder}/specimen.html`)) });
    await page.fill("#text", "Hamburg");
    await page.fill("#size", "16");
    assert.equal(await differing(page, "Hamburg", 16), 0);
    await close();
  },
  async "screenshots"() {
    for (const colorScheme of ["light", "dark"]) {
      for (const deviceScaleFactor of [1, 2]) {
        const { page, close } = await open({ colorScheme, deviceScaleFactor });
        await page.screenshot({ path: `${pictures}/${colorScheme}-${deviceScaleFactor}x.png`, fullPage: true });
        await close();
      }
    }
    return pictures;
  },
  async "the time to the first text"() {
    // From the start of the navigation to the first text drawn by models, with the server in this process, after a first visit.
    const { page, close } = await open();
    const times = [];
    for (let i = 0; i < 15; i++) {
      await page.reload();
      await page.waitForFunction(() => document.fonts.size === 2);
      times.push(await page.evaluate(() => performance.getEntriesByName("first text")[0].startTime));
    }
    await close();
    times.sort((a, b) => a - b);
    return `median ${times[7].toFixed(0)} ms, fastest ${times[0].toFixed(0)}, slowest ${times[14].toFixed(0)} (limit 100)`;
  },
};

function tableOf(font, tag) {
  for (let at = 12; at < 12 + 16 * font.readUInt16BE(4); at += 16) {
    if (font.toString("latin1", at, at + 4) === tag) return { offset: font.readUInt32BE(at + 8), length: font.readUInt32BE(at + 12) };
  }
  throw new Error(`no table ${tag}`);
}

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    const said = await test();
    console.log(`ok  ${name}${said ? `: ${said}` : ""}`);
  } catch (error) {
    failed++;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
await browser.close();
server.close();
process.exitCode = failed;
