// Lines of text: one glyph for each character, from left to right. There is no shaping: no kerning, ligatures or joined scripts.

/** Positions along x are rounded to quarters of a pixel. */
const STEPS = 4;

/** Where the glyphs of a text stand. */
export function layoutText(font, text, { ppem, hinting = true }) {
  const glyphs = [];
  const widths = new Map();
  let x = 0;
  for (const character of text) {
    const glyph = font.glyphForChar(character);
    let advance = widths.get(glyph);
    if (advance === undefined) {
      advance = hinting ? font.hintedAdvance(glyph, ppem) : font.advance(glyph, ppem);
      widths.set(glyph, advance);
    }
    glyphs.push({ character, glyph, x, advance });
    x += advance;
  }
  return { glyphs, advance: x };
}

/** Draws a text as one bitmap. */
export function drawText(font, text, options) {
  const { glyphs, advance } = layoutText(font, text, options);
  const { ppem, hinting = true } = options;
  const drawn = [];
  let left = Infinity, top = -Infinity, right = -Infinity, bottom = Infinity;
  for (const { glyph, x } of glyphs) {
    const position = Math.round(x * STEPS) / STEPS;
    const whole = Math.floor(position);
    const bitmap = font.draw(glyph, { ppem, hinting, offset: [position - whole, 0] });
    if (bitmap.pixels.length === 0) continue;
    bitmap.left += whole;
    left = Math.min(left, bitmap.left);
    top = Math.max(top, bitmap.top);
    right = Math.max(right, bitmap.left + bitmap.width);
    bottom = Math.min(bottom, bitmap.top - bitmap.height);
    drawn.push(bitmap);
  }
  if (drawn.length === 0) return { left: 0, top: 0, width: 0, height: 0, pixels: new Uint8Array(0), advance };
  const width = right - left, height = top - bottom;
  const pixels = new Uint8Array(width * height);
  for (const bitmap of drawn) add(bitmap, pixels, width, bitmap.left - left, top - bitmap.top);
  return { left, top, width, height, pixels, advance };
}

/** Where two glyphs touch a pixel, it has what they cover together, at most all of it. */
function add(bitmap, pixels, stride, left, top) {
  let from = 0;
  for (let y = 0; y < bitmap.height; y++) {
    let to = (top + y) * stride + left;
    for (let x = 0; x < bitmap.width; x++, from++, to++) {
      const level = pixels[to] + bitmap.pixels[from];
      pixels[to] = level > 255 ? 255 : level;
    }
  }
}

/**
 * Paints a bitmap into an ImageData that is clear where it is painted: the colour with the coverage as alpha, the bitmap's
 * origin at (x, y). What lies outside is cut off.
 */
export function paint(image, bitmap, x, y, [red, green, blue] = [0, 0, 0]) {
  const left = Math.round(x) + bitmap.left, top = Math.round(y) - bitmap.top;
  const { data, width, height } = image;
  for (let row = Math.max(0, -top); row < Math.min(bitmap.height, height - top); row++) {
    for (let column = Math.max(0, -left); column < Math.min(bitmap.width, width - left); column++) {
      const level = bitmap.pixels[row * bitmap.width + column];
      if (level === 0) continue;
      const at = ((top + row) * width + left + column) * 4;
      data[at] = red;
      data[at + 1] = green;
      data[at + 2] = blue;
      data[at + 3] = Math.min(255, data[at + 3] + level);
    }
  }
}
