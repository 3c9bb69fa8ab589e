// Text in three renderings: broken into lines once, and drawn by the models, by the browser, and without hinting.

import { drawText, layoutText, paint } from "../nfr/nfr.js";

/** Free pixels on all sides: letters reach over their origins and lines. */
const MARGIN = 3;

/**
 * Breaks a text into lines of words. Sizes and positions are in device pixels.
 *
 * Words begin where the hinted advance widths put them, in each of the renderings, so that the same letters can be compared.
 */
export function breakLines(font, text, ppem, width) {
  const { ascent, descent, lineGap } = font.lineMetrics(ppem);
  const lineHeight = Math.max(1, Math.round(ascent - descent + lineGap));
  const room = width - 2 * MARGIN;
  const space = layOut(font, " ", ppem).advance;
  const words = [];
  let x = 0, line = 0;
  for (const word of text.split(/\s+/).filter((word) => word)) {
    for (const part of fit(font, word, ppem, room)) {
      if (x > 0 && x + part.advance > room) [x, line] = [0, line + 1];
      words.push({ text: part.text, line, x: MARGIN + Math.round(x), advance: part.advance });
      x += part.advance + space;
    }
  }
  const lines = line + 1;
  const baseline = (line) => MARGIN + Math.ceil(ascent) + line * lineHeight;
  return { words, lines, lineHeight, baseline, ppem, width, height: 2 * MARGIN + lines * lineHeight + 1 };
}

/** A text's layout; with linear widths if a model that is damaged does not tell the hinted ones. */
function layOut(font, text, ppem) {
  try {
    return layoutText(font, text, { ppem });
  } catch {
    return layoutText(font, text, { ppem, hinting: false });
  }
}

/** A word, in parts if it is longer than a line. */
function fit(font, word, ppem, room) {
  const parts = [];
  let text = "", advance = 0;
  for (const glyph of layOut(font, word, ppem).glyphs) {
    if (text && advance + glyph.advance > room) {
      parts.push({ text, advance });
      [text, advance] = ["", 0];
    }
    text += glyph.character;
    advance += glyph.advance;
  }
  parts.push({ text, advance });
  return parts;
}

/** Which characters of a text have no model, and which no glyph. */
export function lacking(font, text) {
  const lack = { model: new Set(), glyph: new Set() };
  for (const character of text) {
    const glyph = font.glyphForChar(character);
    if (/\s/.test(character)) continue;
    if (glyph === 0) lack.glyph.add(character);
    else if (!font.hasModel(glyph)) lack.model.add(character);
  }
  return lack;
}

/**
 * Draws a broken text into a canvas, whose pixels become device pixels. Returns the first error of the models, if there was one: what
 * it belongs to is left out.
 */
export function render(canvas, layout, kind, { font, family, ink }) {
  const { width, height } = layout;
  Object.assign(canvas, { width, height });
  canvas.style.width = `${width / devicePixelRatio}px`;
  canvas.style.height = `${height / devicePixelRatio}px`;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  return kind === "browser" ? byBrowser(context, layout, family, ink) : byModels(context, layout, font, ink, kind === "neural");
}

function byModels(context, { words, baseline, ppem, width, height }, font, ink, hinting) {
  const image = context.createImageData(width, height);
  let error;
  for (const { text, line, x } of words) {
    try {
      paint(image, drawText(font, text, { ppem, hinting }), x, baseline(line), ink);
    } catch (thrown) {
      error ??= thrown;
    }
  }
  context.putImageData(image, 0, 0);
  return error;
}

function byBrowser(context, { words, baseline, ppem }, family, ink) {
  if (!family) return;
  context.font = `${ppem}px "${family}"`;
  context.fontKerning = "none";
  context.fillStyle = `rgb(${ink.join(" ")})`;
  for (const { text, line, x } of words) context.fillText(text, x, baseline(line));
}

/** The character at a place, if there is one. */
export function characterAt(font, layout, x, y) {
  const line = Math.min(layout.lines - 1, Math.max(0, Math.floor((y - MARGIN) / layout.lineHeight)));
  const word = layout.words.find((word) => word.line === line && x >= word.x && x < word.x + word.advance);
  if (!word) return undefined;
  const { glyphs } = layOut(font, word.text, layout.ppem);
  return glyphs.findLast((glyph) => word.x + glyph.x <= x)?.character;
}
