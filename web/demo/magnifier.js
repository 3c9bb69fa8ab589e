// The magnifier: one place, shown enlarged in all renderings. It follows the pointer and the arrow keys.

/** CSS pixels for a device pixel of the specimen. */
const SCALE = 8;
/** Rows of the specimen that are shown. */
export const ROWS = 24;

export class Magnifier {
  #stage;
  #panels;
  #moved;
  #layout;
  /** The middle of what is shown, in pixels of the specimen. */
  #x = 40;
  #y = 10;

  /** `moved` is called when it was moved. */
  constructor(stage, moved) {
    this.#stage = stage;
    this.#moved = moved;
    this.#panels = [...stage.querySelectorAll("figure")].map((figure) => ({
      text: figure.querySelector(".text"),
      frame: figure.querySelector(".frame"),
      glass: figure.querySelector(".glass"),
      sheet: figure.querySelector(".sheet"),
    }));
    for (const { sheet, text } of this.#panels) {
      sheet.addEventListener("pointermove", (event) => {
        const box = text.getBoundingClientRect();
        this.#go((event.clientX - box.left) * devicePixelRatio, (event.clientY - box.top) * devicePixelRatio);
      });
    }
    stage.addEventListener("keydown", (event) => this.#key(event));
  }

  get place() {
    return [this.#x, this.#y];
  }

  /** Shows another specimen, whose text stands as `layout` says. */
  show(layout) {
    this.#layout = layout;
    this.#draw();
  }

  #key(event) {
    const step = event.shiftKey ? 8 : 1;
    const { width } = this.#layout;
    const target = {
      ArrowLeft: [this.#x - step, this.#y],
      ArrowRight: [this.#x + step, this.#y],
      ArrowUp: [this.#x, this.#y - step],
      ArrowDown: [this.#x, this.#y + step],
      Home: [0, this.#y],
      End: [width, this.#y],
    }[event.key];
    if (!target || event.ctrlKey || event.altKey || event.metaKey) return;
    event.preventDefault();
    this.#go(...target);
  }

  #go(x, y) {
    [this.#x, this.#y] = [Math.round(x), Math.round(y)];
    this.#draw();
    this.#moved();
  }

  #draw() {
    const { width, height } = this.#layout;
    const columns = Math.floor(this.#panels[0].sheet.clientWidth / SCALE);
    const clamp = (middle, shown, all) => Math.min(Math.max(middle, Math.ceil(shown / 2)), Math.max(all - Math.floor(shown / 2), Math.ceil(shown / 2)));
    this.#x = clamp(this.#x, columns, width);
    this.#y = clamp(this.#y, ROWS, height);
    const left = this.#x - Math.ceil(columns / 2), top = this.#y - Math.ceil(ROWS / 2);
    const style = getComputedStyle(this.#stage);
    for (const { text, frame, glass } of this.#panels) {
      Object.assign(frame.style, {
        width: `${columns / devicePixelRatio}px`,
        height: `${ROWS / devicePixelRatio}px`,
        transform: `translate(${left / devicePixelRatio}px, ${top / devicePixelRatio}px)`,
      });
      this.#enlarge(text, glass, { left, top, columns, style });
    }
  }

  #enlarge(text, glass, { left, top, columns, style }) {
    const size = SCALE * Math.max(1, Math.round(devicePixelRatio));
    Object.assign(glass, { width: columns * size, height: ROWS * size });
    glass.style.width = `${columns * SCALE}px`;
    glass.style.height = `${ROWS * SCALE}px`;
    const context = glass.getContext("2d");
    context.imageSmoothingEnabled = false;
    context.drawImage(text, left, top, columns, ROWS, 0, 0, columns * size, ROWS * size);
    context.fillStyle = style.getPropertyValue("--grid");
    for (let column = 1; column < columns; column++) context.fillRect(column * size, 0, 1, ROWS * size);
    for (let row = 1; row < ROWS; row++) context.fillRect(0, row * size, columns * size, 1);
    context.fillStyle = style.getPropertyValue("--accent");
    const { lines, baseline } = this.#layout;
    for (let line = 0; line < lines; line++) context.fillRect(0, (baseline(line) - top) * size, columns * size, 1);
  }
}
