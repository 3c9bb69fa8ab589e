// The page: what its controls do.

import { load } from "../nfr/nfr.js";
import { specimen, wasm } from "./assets.js";
import { bytes, onDrop, openFile } from "./files.js";
import { Magnifier, ROWS } from "./magnifier.js";
import { breakLines, characterAt, lacking, render } from "./specimen.js";

const WATERFALL = [8, 9, 10, 11, 12, 13, 14, 16, 18, 20, 24, 28, 32];
const KINDS = ["neural", "browser", "unhinted"];

const element = (id) => document.getElementById(id);
const [text, size, file, theme, stage] = ["text", "size", "file", "theme", "stage"].map(element);
const dark = matchMedia("(prefers-color-scheme: dark)");
const magnifier = new Magnifier(stage, showPlace);
/** What is shown: the font, its file's name and length, and the browser's name for it. */
let shown;
let layout;
let faces = 0;

const family = (data) => {
  const face = new FontFace(`Nfr Specimen ${++faces}`, data);
  return face.load().then(() => (document.fonts.add(face), face.family));
};

function draw() {
  if (!shown) return;
  const look = drawNeural();
  const errors = KINDS.slice(1).map((kind) => drawPanel(kind, look));
  magnifier.show(layout);
  showPlace();
  showFacts(look.error ?? errors.find((error) => error));
  drawWaterfall(look);
}

/** Breaks the text into lines and draws the first panel. Returns how the others are to look. */
function drawNeural() {
  const ppem = Number(size.value) * devicePixelRatio;
  const width = inDevice(stage.querySelector(".sheet").clientWidth);
  const look = { ...shown, ink: ink() };
  layout = breakLines(shown.font, text.value, ppem, width);
  layout.height = Math.max(layout.height, ROWS);
  look.error = drawPanel(KINDS[0], look);
  const device = devicePixelRatio === 1 ? "" : ` = ${round(ppem)} device pixels`;
  element("size-value").textContent = `${size.value} px${device}`;
  size.setAttribute("aria-valuetext", `${size.value} pixels`);
  return look;
}

function drawPanel(kind, look) {
  const canvas = stage.querySelector(`[data-kind=${kind}] .text`);
  canvas.setAttribute("aria-label", `“${text.value}” at ${size.value} pixels, ${kind}`);
  return render(canvas, layout, kind, look);
}

function drawWaterfall(look) {
  const kind = document.querySelector("[name=kind]:checked").value;
  for (const item of element("waterfall").children) {
    const canvas = item.querySelector("canvas");
    const ppem = Number(item.value) * devicePixelRatio;
    const width = inDevice(item.clientWidth - item.firstElementChild.offsetWidth);
    // One line, cut off at the edge.
    const line = breakLines(look.font, text.value, ppem, 1e6);
    render(canvas, { ...line, width }, kind, look);
    // The label stands on the line of the letters.
    canvas.style.marginBottom = `${(line.baseline(0) - line.height) / devicePixelRatio}px`;
    canvas.setAttribute("aria-label", `At ${item.value} pixels, ${kind}`);
  }
}

function makeWaterfall() {
  for (const pixels of WATERFALL) {
    const item = document.createElement("li");
    item.value = pixels;
    const label = document.createElement("span");
    label.textContent = pixels;
    const canvas = document.createElement("canvas");
    canvas.setAttribute("role", "img");
    // In a box of its own, so that its lower edge is a baseline.
    const box = document.createElement("div");
    box.append(canvas);
    item.append(label, box);
    element("waterfall").append(item);
  }
}

/** What there is to know of the font, and of characters that no model draws. */
function showFacts(error) {
  const { font, name, length } = shown;
  const [first, last] = font.ppemRange;
  const models = `models of ${font.modelCount} of ${font.glyphCount} glyphs in ${bytes(font.tableLength)}`;
  element("facts").textContent = `${name}, ${bytes(length)}: ${models}, ${first}–${last} pixels per em, ${font.target}`;
  const lack = lacking(font, text.value);
  const notes = [];
  if (lack.model.size > 0) notes.push(`${count(lack.model)} without a model, drawn as the plain outline: ${[...lack.model].join(" ")}.`);
  if (lack.glyph.size > 0) notes.push(`${count(lack.glyph)} not in the font: ${[...lack.glyph].join(" ")}.`);
  if (font.outlinesDropped) notes.push("The font's outlines were dropped: the browser has nothing to draw.");
  else if (!shown.family) notes.push("The browser refuses this font.");
  if (error) notes.push(`Some glyphs are damaged: ${error.message}.`);
  say(notes.join(" "));
}

const count = ({ size }) => `${size} character${size === 1 ? "" : "s"}`;
/** A length in device pixels. A page that is not shown has no lengths, a canvas needs one. */
const inDevice = (pixels) => Math.max(1, Math.floor(pixels * devicePixelRatio));
const round = (value) => Math.round(value * 100) / 100;

function say(line) {
  if (element("message").textContent !== line) element("message").textContent = line;
}

function showPlace() {
  const [x, y] = magnifier.place;
  const character = characterAt(shown.font, layout, x, y);
  element("place").textContent = `Pixel ${x}, ${y}${character ? `: “${character}”` : ""}`;
}

function ink() {
  const [red, green, blue] = getComputedStyle(document.body).color.match(/\d+/g).map(Number);
  return [red, green, blue];
}

function setTheme(isDark) {
  document.documentElement.dataset.theme = isDark ? "dark" : "light";
  theme.setAttribute("aria-pressed", String(isDark));
  draw();
}

/** Shows another font, if the file is one. */
async function take(chosen) {
  try {
    const { font, name, data } = await openFile(await library, chosen);
    const length = data.byteLength;
    const next = { font, name, length, family: await family(data).catch(() => undefined) };
    shown?.font.free();
    shown = next;
    draw();
  } catch (error) {
    if (error.cause?.code === "NFR_INTERNAL") await restart();
    say(error.message);
  }
}

/** After a defect of the module: another instance, with the page's own font. */
async function restart() {
  library = load(wasm());
  await begin();
}

async function begin() {
  const data = await specimen();
  shown = { font: (await library).open(data), name: "specimen.ttf", length: data.byteLength };
  drawNeural();
  performance.mark("first text");
  document.fonts.add(await new FontFace("Nfr Page", data).load());
  shown.family = await family(data);
  draw();
}

let library = load(wasm());
makeWaterfall();
setTheme(dark.matches);
begin().catch((error) => say(`The page cannot draw: ${error.message}.`));

text.addEventListener("input", draw);
size.addEventListener("input", draw);
file.addEventListener("change", () => file.files[0] && take(file.files[0]));
theme.addEventListener("click", () => setTheme(document.documentElement.dataset.theme !== "dark"));
dark.addEventListener("change", (event) => setTheme(event.matches));
document.querySelector("fieldset").addEventListener("change", draw);
document.querySelector("form").addEventListener("submit", (event) => event.preventDefault());
onDrop(document.body, take);
let before = 0;
new ResizeObserver(([{ contentRect }]) => {
  if (contentRect.width !== before) draw();
  before = contentRect.width;
}).observe(stage);
watchDevice();

/** The ratio of pixels changes with the page's zoom and with the screen. */
function watchDevice() {
  matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener("change", () => (draw(), watchDevice()), { once: true });
}
