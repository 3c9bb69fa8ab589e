/** Loads the WebAssembly module: nfr.wasm beside this script, or what is given. */
export function load(source?: Source | Promise<Source>): Promise<Nfr>;

/** An address, an answer of fetch, the module's bytes, or the compiled module. */
export type Source = string | URL | Response | ArrayBuffer | Uint8Array | WebAssembly.Module;

/** A loaded module. All of its fonts share one memory. */
export interface Nfr {
  /** The bytes of the module's memory. It grows and does not shrink; what is freed is used again. */
  readonly memoryBytes: number;
  /**
   * Opens a converted font from a copy of a file's bytes.
   * @throws NfrError saying why it cannot be opened: NFR_NOT_A_FONT, NFR_NO_SUCH_FONT, NFR_DAMAGED_FONT, NFR_NO_MODELS (the font was not
   * converted), NFR_UNKNOWN_VERSION, NFR_STALE, NFR_LIMIT (no memory for it).
   */
  open(data: ArrayBuffer | ArrayBufferView, options?: OpenOptions): Font;
}

export interface OpenOptions {
  /** Counts the fonts of a collection. 0 by default. */
  index?: number;
  /**
   * What is drawn for a glyph that has no model: its plain outline (the default), an empty bitmap, or nothing, with the error
   * NFR_MISSING_MODEL.
   */
  missing?: "outline" | "blank" | "error";
}

/** A font with models, and the working memory to draw it. Sizes are in pixels per em, may be fractional, and are at most 2048. */
export class Font {
  private constructor();
  /** The glyphs, with a model or without. */
  readonly glyphCount: number;
  /** The glyphs that have models. */
  readonly modelCount: number;
  /** The bytes that all models take. */
  readonly tableLength: number;
  readonly unitsPerEm: number;
  /** What the models were made for. */
  readonly target: "smooth" | "mono" | "lcd" | "unknown";
  /** The models know all whole sizes from the first to the second; at others the plain outline is drawn. */
  readonly ppemRange: [first: number, last: number];
  /** Whether glyphs that have models have no outlines, so that no other renderer can draw them. */
  readonly outlinesDropped: boolean;
  hasModel(glyph: number): boolean;
  /** The glyph of a character or code point; 0, the glyph for what is missing, if the font has none. */
  glyphForChar(character: string | number): number;
  /** The advance width in pixels, linear in the size; 0 for a glyph that the font does not have. */
  advance(glyph: number, ppem: number): number;
  /**
   * The hinted advance width in pixels: whole at the sizes of ppemRange; the linear one at others and for glyphs whose models do not know it.
   * @throws NfrError NFR_NO_SUCH_GLYPH, NFR_INVALID_SIZE, NFR_STALE, NFR_DAMAGED_GLYPH.
   */
  hintedAdvance(glyph: number, ppem: number): number;
  /** Metrics of a line in pixels, y up. @throws NfrError NFR_INVALID_SIZE. */
  lineMetrics(ppem: number): LineMetrics;
  /**
   * Draws a glyph.
   * @throws NfrError NFR_NO_SUCH_GLYPH, NFR_MISSING_MODEL (only as asked for when it was opened), NFR_STALE, NFR_DAMAGED_GLYPH,
   * NFR_INVALID_SIZE, NFR_INVALID_OFFSET, NFR_LIMIT, NFR_UNSUPPORTED.
   */
  draw(glyph: number, options: DrawOptions): Bitmap;
  /** Frees the font's memory now; a font that is not used any more is freed some time after. It cannot be used afterwards. */
  free(): void;
}

export interface LineMetrics {
  /** From the baseline up to the top of a line. */
  ascent: number;
  /** From the baseline up to its bottom: negative in most fonts. */
  descent: number;
  /** What is left free between two lines: baselines are ascent - descent + lineGap apart. */
  lineGap: number;
  underlinePosition: number;
  underlineThickness: number;
}

export interface DrawOptions {
  /** The size in pixels per em. */
  ppem: number;
  /** How far the glyph is moved in pixels, x to the right and y up. [0, 0] by default. */
  offset?: readonly [x: number, y: number];
  /** false: the plain outline. true by default. */
  hinting?: boolean;
  /** false: the pixels are a view into the module's memory, valid until the next call of any function here. true by default. */
  copy?: boolean;
}

export interface Bitmap {
  /** From the glyph's origin to the left edge of the left column, in pixels. */
  left: number;
  /** From the baseline up to the top edge of the top row, in pixels. */
  top: number;
  width: number;
  height: number;
  /** Coverage, 0–255: width × height bytes, top row first. */
  pixels: Uint8Array;
}

export interface TextOptions {
  /** The size in pixels per em. */
  ppem: number;
  /** false: plain outlines and linear advance widths. true by default. */
  hinting?: boolean;
}

/**
 * Where the glyphs of a text stand: one for each character, from left to right, with hinted advance widths. There is no shaping: no
 * kerning, no ligatures, no joined scripts.
 */
export function layoutText(font: Font, text: string, options: TextOptions): {
  glyphs: { character: string; glyph: number; x: number; advance: number }[];
  /** The width of the text. */
  advance: number;
};

/** Draws a text, laid out by layoutText, as one bitmap. Positions are rounded to quarters of a pixel. */
export function drawText(font: Font, text: string, options: TextOptions): Bitmap & { advance: number };

/**
 * Paints a bitmap into an ImageData that is clear there: a colour (0–255 each, black by default) with the coverage as alpha, the bitmap's
 * origin at (x, y), rounded to whole pixels. What lies outside is cut off.
 */
export function paint(
  image: ImageData,
  bitmap: Bitmap,
  x: number,
  y: number,
  color?: readonly [red: number, green: number, blue: number],
): void;

/** What a font is refused for, or why a glyph cannot be drawn. The message is one sentence for people. */
export class NfrError extends Error {
  readonly code:
    | "NFR_INVALID_ARGUMENT"
    | "NFR_NOT_A_FONT"
    | "NFR_NO_SUCH_FONT"
    | "NFR_DAMAGED_FONT"
    | "NFR_NO_MODELS"
    | "NFR_UNKNOWN_VERSION"
    | "NFR_STALE"
    | "NFR_DAMAGED_GLYPH"
    | "NFR_NO_SUCH_GLYPH"
    | "NFR_MISSING_MODEL"
    | "NFR_INVALID_SIZE"
    | "NFR_INVALID_OFFSET"
    | "NFR_BUFFER_TOO_SMALL"
    | "NFR_LIMIT"
    | "NFR_UNSUPPORTED"
    /** A defect of this library: load the module again. */
    | "NFR_INTERNAL";
}
