// Checks the page of `nfr diff` in headless Chromium: node page.mjs FOLDER TEXT. FOLDER has the pages ascii/index.html and all/index.html, in
// rendered.json what `nfr render --json` draws of TEXT, and playwright-core in modules. Screenshots go into FOLDER/pictures.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const [folder, text] = process.argv.slice(2);
const { chromium } = createRequire(`${folder}/modules/`)("playwright-core");
const browser = await chromium.launch({ executablePath: process.env.CHROMIUM ?? "/usr/bin/chromium", args: ["--no-sandbox"] });
const rendered = readFileSync(`${folder}/rendered.json`, "utf8").trim().split("\n").map(JSON.parse);
const UNITS = 2048;

/** A page that has no network, with what it complains of. */
async function open({ colorScheme = "light", name = "ascii", width = 1100, javaScriptEnabled = true } = {}) {
  const context = await browser.newContext({ colorScheme, javaScriptEnabled, offline: true, viewport: { width, height: 900 } });
  const page = await context.newPage();
  const complaints = [];
  // The tests read canvases themselves.
  const isOurs = (said) => ["error", "warning"].includes(said.type()) && !said.text().includes("willReadFrequently");
  page.on("console", (said) => isOurs(said) && complaints.push(said.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on("request", (request) => /^(file|data):/.test(request.url()) || complaints.push(`asks for ${request.url()}`));
  await page.goto(pathToFileURL(`${folder}/${name}/index.html`).href);
  if (javaScriptEnabled) await drawn(page);
  return { page, close: () => (assert.deepEqual(complaints, []), context.close()) };
}

/** Until the canvases show the text at the size of the slider. */
const drawn = (page) =>
  page.waitForFunction(() => {
    const ppem = document.querySelector("#ppem").textContent.split(" ")[0];
    const label = document.querySelector("canvas[data-kind=unhinted]").getAttribute("aria-label");
    return label === `${document.querySelector("#text").value}, unhinted, ${ppem} pixels per em`;
  });

async function setSize(page, ppem) {
  const sizes = await page.evaluate(() => JSON.parse(document.querySelector("#data").textContent).sizes);
  await page.locator("#size").fill(String(sizes.indexOf(ppem)));
  await drawn(page);
}

const canvas = (page, kind) =>
  page.evaluate((kind) => {
    const canvas = document.querySelector(`canvas[data-kind=${kind}]`);
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    const alpha = Array.from({ length: data.length / 4 }, (_, at) => data[4 * at + 3]);
    return { width: canvas.width, height: canvas.height, css: canvas.getBoundingClientRect().width, alpha };
  }, kind);

/** The columns with ink of a canvas, from the first to the last, row by row. */
function trimmed({ width, height, alpha }) {
  const rows = Array.from({ length: height }, (_, y) => alpha.slice(y * width, (y + 1) * width));
  const inked = rows.filter((row) => row.some((level) => level > 0));
  const columns = [...Array(width).keys()].filter((x) => rows.some((row) => row[x] > 0));
  return inked.map((row) => row.slice(columns[0], columns.at(-1) + 1).join(" ")).join("\n");
}

/** The text as `nfr render` draws its glyphs. */
async function expected(page, ppem) {
  const { characters, glyphs } = await page.evaluate(() => JSON.parse(document.querySelector("#data").textContent));
  let x = 0;
  const placed = [...text].map((c) => {
    const glyph = glyphs[characters.find(([code]) => code === c.codePointAt(0))[1]];
    const at = Math.round(x);
    x += (glyph.advance * ppem) / UNITS;
    const found = rendered.find((line) => line.gid === glyph.gid && line.ppem === ppem);
    return { at, ...found, levels: Buffer.from(found.pixels, "base64") };
  });
  const width = 2 * ppem * text.length, height = 4 * ppem, alpha = new Array(width * height).fill(0);
  for (const { at, left, top, width: columns, levels } of placed) {
    levels.forEach((level, i) => {
      const to = (2 * ppem - top + Math.floor(i / columns)) * width + ppem + at + left + (i % columns);
      alpha[to] = Math.min(255, alpha[to] + level);
    });
  }
  return trimmed({ width, height, alpha });
}

const search = async (page, query) => {
  await page.fill("#search", query);
  await page.waitForTimeout(100);
  return page.evaluate(() => [...document.querySelectorAll("#results tbody th div:first-child")].map((cell) => cell.textContent.trim()));
};

const tests = {
  async "a text is drawn as `nfr render` draws its glyphs, at the size of the slider"() {
    const { page, close } = await open();
    await page.fill("#text", text);
    for (const ppem of [9, 12, 31, 64]) {
      await setSize(page, ppem);
      assert.equal(await page.textContent("#ppem"), `${ppem} ppem`);
      assert.equal(trimmed(await canvas(page, "neural")), await expected(page, ppem), `${ppem} ppem`);
    }
    await close();
  },
  async "the unhinted row differs from the others, and all have the same frame"() {
    const { page, close } = await open();
    await setSize(page, 11);
    const [hinted, neural, unhinted] = await Promise.all(["hinted", "neural", "unhinted"].map((kind) => canvas(page, kind)));
    assert.notDeepEqual(unhinted.alpha, hinted.alpha);
    const off = hinted.alpha.map((level, at) => Math.abs(level - neural.alpha[at]));
    assert.ok(Math.max(...off) < 32, `the neural text is off by ${Math.max(...off)}`);
    assert.deepEqual([hinted.width, hinted.height], [unhinted.width, unhinted.height]);
    await page.selectOption("#zoom", "4");
    await page.waitForFunction((width) => document.querySelector("canvas[data-kind=hinted]").getBoundingClientRect().width === 4 * width, hinted.width);
    await close();
  },
  async "characters that were not compared are named and drawn as boxes"() {
    const { page, close } = await open();
    await page.fill("#text", "aß漢😀ß b");
    await drawn(page);
    assert.equal(await page.textContent("#missing"), "Not in this comparison, drawn as a box: “ß” (U+00DF), “漢” (U+6F22), “😀” (U+1F600)");
    assert.ok((await canvas(page, "hinted")).alpha.includes(160));
    await page.fill("#text", "ab");
    await drawn(page);
    assert.equal(await page.textContent("#missing"), "");
    await page.fill("#text", "");
    await drawn(page);
    await close();
  },
  async "a glyph is found by character, code point, number and name"() {
    const { page, close } = await open();
    for (const query of ["g", "U+0067", "u+67", "74"]) assert.deepEqual(await search(page, query), ["74 g"], query);
    assert.deepEqual(await search(page, "ampersand"), ["9 ampersand"]);
    assert.deepEqual(await search(page, "7"), ["26 seven", "7 dollar"]);
    assert.deepEqual(await search(page, "paren"), ["11 parenleft", "12 parenright"]);
    assert.deepEqual(await search(page, "no such glyph"), []);
    assert.match(await page.textContent("#found"), /^No glyph/);
    assert.ok(await page.locator("#results").isHidden());
    await search(page, "g");
    assert.match(await page.textContent("#found"), /^1 glyph at 12 ppem/);
    await setSize(page, 30);
    await page.waitForFunction(() => document.querySelector("#found").textContent === "1 glyph at 30 ppem");
    assert.equal(await page.locator("#results canvas").count(), 4);
    await close();
  },
  async "the keyboard reaches every control, and arrows move the size"() {
    const { page, close } = await open();
    const reached = [];
    for (let i = 0; i < 4; i++) {
      await page.keyboard.press("Tab");
      reached.push(await page.evaluate(() => document.activeElement.id));
    }
    assert.deepEqual(reached, ["text", "size", "zoom", "search"]);
    await page.focus("#size");
    await page.keyboard.press("ArrowRight");
    await drawn(page);
    assert.equal(await page.textContent("#ppem"), "13 ppem");
    assert.equal(await page.getAttribute("#size", "aria-valuetext"), "13 ppem");
    const unnamed = await page.evaluate(() => [...document.querySelectorAll("input, select")].filter((control) => !control.labels.length).length);
    assert.equal(unnamed, 0);
    await close();
  },
  async "text is light on dark where the system asks for it, and changes with it"() {
    const { page, close } = await open({ colorScheme: "dark" });
    const colour = () => page.evaluate(() => [...document.querySelector("canvas[data-kind=hinted]").getContext("2d").getImageData(0, 0, 40, 12).data].reduce((most, level, at) => (at % 4 === 3 ? most : Math.max(most, level)), 0));
    assert.ok((await colour()) > 200);
    await page.emulateMedia({ colorScheme: "light" });
    await page.waitForFunction(() => getComputedStyle(document.body).color === "rgb(34, 34, 34)");
    await drawn(page);
    await page.waitForTimeout(200);
    assert.ok((await colour()) < 60);
    await close();
  },
  async "all glyphs of a font are in one page"() {
    const { page, close } = await open({ name: "all" });
    await page.fill("#text", "Größe, мир, ελληνικά, שלום");
    await drawn(page);
    assert.equal(await page.textContent("#missing"), "");
    assert.equal((await search(page, "a")).length, 1);
    assert.equal((await search(page, "uni")).length, 30);
    assert.match(await page.textContent("#found"), /; the first 30 are shown$/);
    await close();
  },
  async "without JavaScript the rest of the page is there"() {
    const { page, close } = await open({ javaScriptEnabled: false });
    assert.match(await page.content(), /This part needs JavaScript/);
    assert.ok((await page.locator("img").count()) > 40);
    await close();
  },
  async "screenshots"() {
    for (const colorScheme of ["light", "dark"]) {
      const { page, close } = await open({ colorScheme });
      await page.screenshot({ path: `${folder}/pictures/${colorScheme}.png` });
      await page.locator("#explorer").screenshot({ path: `${folder}/pictures/${colorScheme}-first.png` });
      await page.fill("#text", "My own text: 0123456789 & ß漢");
      for (const ppem of [9, 14, 36]) {
        await setSize(page, ppem);
        await search(page, "ampersand");
        await page.locator("#explorer").screenshot({ path: `${folder}/pictures/${colorScheme}-${ppem}.png` });
      }
      await page.screenshot({ path: `${folder}/pictures/${colorScheme}-whole.png`, fullPage: true });
      await close();
    }
    const { page, close } = await open({ width: 390 });
    assert.ok((await page.evaluate(() => document.documentElement.scrollWidth)) <= 390, "the page is wider than a phone");
    await page.screenshot({ path: `${folder}/pictures/phone.png` });
    await close();
  },
};

let failed = 0;
for (const [name, test] of Object.entries(tests)) {
  try {
    await test();
    console.log(`ok      ${name}`);
  } catch (error) {
    failed++;
    console.log(`FAILED  ${name}\n${error.stack}`);
  }
}
await browser.close();
process.exit(failed ? 1 : 0);
