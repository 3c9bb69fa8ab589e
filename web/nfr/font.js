// Fonts: opening, metrics, drawing. A font is a handle in the module's memory; a call's results are at the handle's address,
// as crates/nfr-web/src/handle.rs lays them out.

/** The codes of errors, at the numbers of the statuses. They are those of nfr.h. */
const CODES = [
  "NFR_OK",
  "NFR_NULL_POINTER",
  "NFR_INVALID_ARGUMENT",
  "NFR_NOT_A_FONT",
  "NFR_NO_SUCH_FONT",
  "NFR_DAMAGED_FONT",
  "NFR_NO_MODELS",
  "NFR_UNKNOWN_VERSION",
  "NFR_STALE",
  "NFR_DAMAGED_GLYPH",
  "NFR_NO_SUCH_GLYPH",
  "NFR_MISSING_MODEL",
  "NFR_INVALID_SIZE",
  "NFR_INVALID_OFFSET",
  "NFR_BUFFER_TOO_SMALL",
  "NFR_LIMIT",
  "NFR_UNSUPPORTED",
  "NFR_INTERNAL",
];
const MISSING = { error: 0, blank: 1, outline: 2 };
const TARGETS = ["unknown", "smooth", "mono", "lcd"];
/** The 32-bit words of a handle. */
const MESSAGE = 1, MESSAGE_LEN = 2, LEFT = 3, TOP = 4, WIDTH = 5, HEIGHT = 6, PIXELS = 7, NUMBERS = 8, WORDS = 13;
const NO_OFFSET = [0, 0];

export class NfrError extends Error {
  constructor(code, message) {
    super(message);
    this.name = "NfrError";
    this.code = code;
  }
}

export class Font {
  #state;
  #registry;
  #handle = 0;
  /** The handle's words as integers and as numbers. They are made anew when the memory has grown. */
  #ints = new Int32Array(0);
  #floats = new Float32Array(0);

  /** Fonts are opened by Nfr.open. */
  constructor(state, registry, data, { index = 0, missing = "outline" } = {}) {
    if (!(missing in MISSING)) throw new TypeError(`missing is ${missing}, not "error", "blank" or "outline"`);
    const bytes = asBytes(data);
    this.#state = state;
    this.#registry = registry;
    this.#handle = this.#run(({ nfr_alloc, nfr_open, memory }) => {
      const at = nfr_alloc(bytes.length) >>> 0;
      if (at === 0) throw new NfrError("NFR_LIMIT", `there is no memory for a font of ${bytes.length} bytes`);
      new Uint8Array(memory.buffer, at, bytes.length).set(bytes);
      return nfr_open(at, bytes.length, index, MISSING[missing]) >>> 0;
    });
    registry.register(this, this.#handle, this);
    this.#look();
    if (this.#ints[0] !== 0) {
      const error = this.#error();
      this.free();
      throw error;
    }
  }

  get glyphCount() {
    return this.#get("nfr_glyph_count");
  }

  get modelCount() {
    return this.#get("nfr_model_count");
  }

  get tableLength() {
    return this.#get("nfr_table_len");
  }

  get unitsPerEm() {
    return this.#get("nfr_units_per_em");
  }

  get target() {
    return TARGETS[this.#get("nfr_target")];
  }

  get ppemRange() {
    const range = this.#get("nfr_ppem_range");
    return [range & 0xffff, range >>> 16];
  }

  get outlinesDropped() {
    return this.#get("nfr_outlines_dropped") !== 0;
  }

  hasModel(glyph) {
    return this.#get("nfr_has_model", glyph) !== 0;
  }

  glyphForChar(character) {
    return this.#get("nfr_glyph_for_char", typeof character === "number" ? character : (character.codePointAt(0) ?? 0));
  }

  advance(glyph, ppem) {
    return this.#get("nfr_advance", glyph, ppem);
  }

  hintedAdvance(glyph, ppem) {
    this.#call("nfr_hinted_advance", glyph, ppem);
    return this.#floats[NUMBERS];
  }

  lineMetrics(ppem) {
    this.#call("nfr_line_metrics", ppem);
    const [ascent, descent, lineGap, underlinePosition, underlineThickness] = this.#floats.subarray(NUMBERS);
    return { ascent, descent, lineGap, underlinePosition, underlineThickness };
  }

  draw(glyph, { ppem, offset = NO_OFFSET, hinting = true, copy = true }) {
    this.#call("nfr_draw", glyph, ppem, offset[0], offset[1], hinting ? 1 : 0);
    const ints = this.#ints;
    const width = ints[WIDTH], height = ints[HEIGHT];
    const lent = new Uint8Array(this.#state.memory.buffer, ints[PIXELS] >>> 0, width * height);
    return { left: ints[LEFT], top: ints[TOP], width, height, pixels: copy ? lent.slice() : lent };
  }

  free() {
    if (this.#handle === 0) return;
    this.#registry.unregister(this);
    const handle = this.#handle;
    this.#handle = 0;
    if (!this.#state.broken) this.#run(({ nfr_free }) => nfr_free(handle));
  }

  [Symbol.dispose ?? Symbol.for("Symbol.dispose")]() {
    this.free();
  }

  /** A property; nothing can go wrong with it but a font that was freed. */
  #get(name, a, b) {
    this.#check();
    return this.#state.exports[name](this.#handle, a, b);
  }

  /** A call that has a status. */
  #call(name, a, b, c, d, e) {
    this.#check();
    let status;
    try {
      status = this.#state.exports[name](this.#handle, a, b, c, d, e);
    } catch (error) {
      throw this.#broken(error);
    }
    if (this.#ints.buffer !== this.#state.memory.buffer) this.#look();
    if (status !== 0) throw this.#error();
  }

  #run(work) {
    if (this.#state.broken) throw broken();
    try {
      return work(this.#state.exports);
    } catch (error) {
      throw this.#broken(error);
    }
  }

  #check() {
    if (this.#state.broken) throw broken();
    if (this.#handle === 0) throw new NfrError("NFR_INVALID_ARGUMENT", "the font was freed");
  }

  /** A trap leaves memory in doubt: nothing is called any more in this instance. */
  #broken(error) {
    if (!(error instanceof WebAssembly.RuntimeError)) return error;
    this.#state.broken = true;
    return broken(error);
  }

  #look() {
    const { buffer } = this.#state.memory;
    this.#ints = new Int32Array(buffer, this.#handle, WORDS);
    this.#floats = new Float32Array(buffer, this.#handle, WORDS);
  }

  #error() {
    const ints = this.#ints;
    const text = new Uint8Array(this.#state.memory.buffer, ints[MESSAGE] >>> 0, ints[MESSAGE_LEN]);
    return new NfrError(CODES[ints[0]] ?? "NFR_INTERNAL", new TextDecoder().decode(text));
  }
}

function broken(cause) {
  const error = new NfrError("NFR_INTERNAL", "a defect of nfr stopped its WebAssembly module; load it again");
  if (cause) error.cause = cause;
  return error;
}

function asBytes(data) {
  if (data instanceof ArrayBuffer) return new Uint8Array(data);
  if (ArrayBuffer.isView(data)) return new Uint8Array(data.buffer, data.byteOffset, data.byteLength);
  throw new TypeError("a font is opened from an ArrayBuffer or a Uint8Array");
}
