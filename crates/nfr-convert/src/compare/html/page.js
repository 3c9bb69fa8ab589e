// Sets a text and finds glyphs from the bitmaps in the page. The data is described in bitmaps.rs and explorer.rs.
"use strict";
(() => {
  const KINDS = ["hinted", "neural", "unhinted"];
  const GAIN = 4; // as in the page's other pictures of differences
  const MOST_FOUND = 30;
  const byId = (id) => document.getElementById(id);
  const data = JSON.parse(byId("data").textContent);
  const glyphOf = new Map(data.characters);
  const charactersOf = new Map();
  for (const [code, glyph] of data.characters) charactersOf.set(glyph, [...(charactersOf.get(glyph) ?? []), code]);

  // ---- Bitmaps of a size, unpacked when they are first needed.

  const unpacked = new Map();

  function bitmapsAt(size) {
    if (!unpacked.has(size)) unpacked.set(size, unpack(data.images[size]));
    return unpacked.get(size);
  }

  async function unpack(images) {
    const parts = await Promise.all(images.map(levels));
    const bytes = new Uint8Array(parts.reduce((sum, part) => sum + part.length, 0));
    parts.reduce((at, part) => (bytes.set(part, at), at + part.length), 0);
    return glyphsIn(bytes);
  }

  async function levels(base64) {
    const image = new Image();
    image.src = `data:image/png;base64,${base64}`;
    await image.decode();
    const canvas = Object.assign(document.createElement("canvas"), { width: image.width, height: image.height });
    const context = canvas.getContext("2d", { willReadFrequently: true });
    context.drawImage(image, 0, 0);
    const { data: rgba } = context.getImageData(0, 0, image.width, image.height);
    return Uint8Array.from({ length: rgba.length / 4 }, (_, at) => rgba[4 * at]);
  }

  function glyphsIn(bytes) {
    const view = new DataView(bytes.buffer);
    let at = 0;
    const record = () => {
      const [left, top, width, height] = [0, 2, 4, 6].map((offset) => view.getInt16(at + offset, true));
      at += 8 + width * height;
      return { left, top, width, height, pixels: bytes.subarray(at - width * height, at) };
    };
    return data.glyphs.map(() => {
      const hinted = record();
      const same = view.getInt16(at, true) === -0x8000;
      if (same) at += 2;
      const neural = same ? hinted : record();
      return { hinted, neural, unhinted: record() };
    });
  }

  // ---- Drawing. A line is bitmaps with the position of their origin; a frame is a box around bitmaps, rows counted downwards.

  function frameOf(placed) {
    const sides = placed.filter(({ bitmap }) => bitmap.width * bitmap.height > 0);
    const min = (of) => Math.min(...sides.map(of)), max = (of) => Math.max(...sides.map(of));
    if (sides.length === 0) return { left: 0, top: 0, width: 1, height: 1 };
    const left = min(({ x, bitmap }) => x + bitmap.left), top = max(({ bitmap }) => bitmap.top);
    const right = max(({ x, bitmap }) => x + bitmap.left + bitmap.width), bottom = min(({ bitmap }) => bitmap.top - bitmap.height);
    return { left, top, width: right - left, height: top - bottom };
  }

  /** Coverage of bitmaps in a frame; where they overlap, it adds up. */
  function coverage(placed, frame) {
    const sum = new Uint8ClampedArray(frame.width * frame.height);
    for (const { x, bitmap } of placed) {
      for (let row = 0; row < bitmap.height; row++) {
        const to = (frame.top - bitmap.top + row) * frame.width + x + bitmap.left - frame.left;
        for (let column = 0; column < bitmap.width; column++) sum[to + column] += bitmap.pixels[row * bitmap.width + column];
      }
    }
    return sum;
  }

  function paint(canvas, frame, zoom, colourAt) {
    canvas.width = frame.width;
    canvas.height = frame.height;
    canvas.style.width = `${frame.width * zoom}px`;
    canvas.style.height = `${frame.height * zoom}px`;
    const context = canvas.getContext("2d");
    const image = context.createImageData(frame.width, frame.height);
    for (let at = 0; at < frame.width * frame.height; at++) image.data.set(colourAt(at), 4 * at);
    context.putImageData(image, 0, 0);
  }

  /** The colour of text as numbers. */
  function ink() {
    return getComputedStyle(document.body).color.match(/\d+/g).slice(0, 3).map(Number);
  }

  const painted = (levels) => {
    const colour = ink();
    return (at) => [...colour, levels[at]];
  };

  /** Red where a bitmap is too dark, blue where it is too light. */
  const difference = (truth, other) => (at) => {
    const by = other[at] - truth[at];
    return [...(by > 0 ? [224, 40, 40] : [50, 110, 255]), Math.min(255, GAIN * Math.abs(by))];
  };

  // ---- The text.

  /** A box in the place of a character that was not compared. */
  function placeholder(ppem) {
    const width = Math.max(3, Math.round(0.5 * ppem)), height = Math.max(4, Math.round(0.7 * ppem));
    const isEdge = (x, y) => x === 0 || y === 0 || x === width - 1 || y === height - 1;
    const pixels = Uint8Array.from({ length: width * height }, (_, at) => (isEdge(at % width, Math.floor(at / width)) ? 160 : 0));
    return { left: 1, top: height, width, height, pixels };
  }

  const named = (c) => `“${c}” (U+${c.codePointAt(0).toString(16).toUpperCase().padStart(4, "0")})`;

  function line(text, kind, bitmaps, ppem) {
    let x = 0;
    const placed = [];
    for (const c of text) {
      const glyph = glyphOf.get(c.codePointAt(0));
      if (glyph !== undefined) {
        placed.push({ x: Math.round(x), bitmap: bitmaps[glyph][kind] });
        x += (data.glyphs[glyph].advance * ppem) / data.units;
      } else if (/\s/u.test(c)) {
        x += ppem / 4;
      } else {
        const box = placeholder(ppem);
        placed.push({ x: Math.round(x), bitmap: box });
        x += box.width + 2;
      }
    }
    return placed;
  }

  async function setText(size) {
    const ppem = data.sizes[size], text = byId("text").value;
    const bitmaps = await bitmapsAt(size);
    if (size !== chosenSize()) return; // the slider was moved meanwhile
    const lines = KINDS.map((kind) => line(text, kind, bitmaps, ppem));
    const frame = frameOf(lines.flat());
    KINDS.forEach((kind, at) => {
      const canvas = document.querySelector(`canvas[data-kind=${kind}]`);
      paint(canvas, frame, Number(byId("zoom").value), painted(coverage(lines[at], frame)));
      canvas.setAttribute("aria-label", `${text}, ${kind}, ${ppem} pixels per em`);
    });
    const missing = [...new Set([...text].filter((c) => !glyphOf.has(c.codePointAt(0)) && !/\s/u.test(c)))];
    byId("missing").textContent = missing.length ? `Not in this comparison, drawn as a box: ${missing.map(named).join(", ")}` : "";
  }

  // ---- The search.

  /** The indices of the glyphs that a query means: a character, a code point, a number, a name, or a part of names. */
  function search(query) {
    const found = new Set();
    const add = (glyph) => glyph !== undefined && glyph >= 0 && found.add(glyph);
    const code = /^(?:u\+|0x)([0-9a-f]{1,6})$/i.exec(query);
    if (code) add(glyphOf.get(parseInt(code[1], 16)));
    if ([...query].length === 1) add(glyphOf.get(query.codePointAt(0)));
    if (/^\d+$/.test(query)) add(data.glyphs.findIndex(({ gid }) => gid === Number(query)));
    data.glyphs.forEach(({ name }, glyph) => name === query && add(glyph));
    if (!code && [...query].length > 1) {
      const part = query.toLowerCase();
      data.glyphs.forEach(({ name }, glyph) => name?.toLowerCase().includes(part) && add(glyph));
    }
    return [...found];
  }

  function heading(glyph) {
    const { gid, name, mae } = data.glyphs[glyph];
    const cell = Object.assign(document.createElement("th"), { scope: "row" });
    const codes = (charactersOf.get(glyph) ?? []).slice(0, 4).map((code) => named(String.fromCodePoint(code)));
    for (const text of [`${gid} ${name ?? ""}`, codes.join(", "), `mae ${mae.toFixed(5)} over all sizes`]) {
      if (text) cell.append(Object.assign(document.createElement("div"), { textContent: text }));
    }
    return cell;
  }

  function row(glyph, bitmaps) {
    const row = document.createElement("tr");
    const all = KINDS.map((kind) => [{ x: 0, bitmap: bitmaps[glyph][kind] }]);
    const frame = frameOf(all.flat());
    const drawn = all.map((placed) => coverage(placed, frame));
    const zoom = Math.max(1, Math.min(12, Math.floor(140 / Math.max(frame.width, frame.height))));
    row.append(heading(glyph));
    [...drawn.map(painted), difference(drawn[0], drawn[1])].forEach((colourAt, at) => {
      const canvas = document.createElement("canvas");
      canvas.setAttribute("role", "img");
      canvas.setAttribute("aria-label", `glyph ${data.glyphs[glyph].gid}, ${[...KINDS, "difference"][at]}`);
      paint(canvas, frame, zoom, colourAt);
      const cell = document.createElement("td");
      cell.append(canvas);
      row.append(cell);
    });
    return row;
  }

  async function showFound(size) {
    const query = byId("search").value.trim();
    const bitmaps = await bitmapsAt(size);
    if (size !== chosenSize() || query !== byId("search").value.trim()) return;
    const glyphs = query ? search(query) : [];
    const shown = glyphs.slice(0, MOST_FOUND);
    byId("results").hidden = shown.length === 0;
    byId("results").tBodies[0].replaceChildren(...shown.map((glyph) => row(glyph, bitmaps)));
    const count = `${glyphs.length} glyph${glyphs.length === 1 ? "" : "s"} at ${data.sizes[size]} ppem`;
    const more = glyphs.length > shown.length ? `; the first ${shown.length} are shown` : "";
    byId("found").textContent = !query ? "" : glyphs.length ? count + more : "No glyph of this comparison has that character, name or number.";
  }

  // ---- The controls.

  const chosenSize = () => Number(byId("size").value);

  function show() {
    const size = chosenSize();
    const text = `${data.sizes[size]} ppem`;
    byId("ppem").textContent = text;
    byId("size").setAttribute("aria-valuetext", text);
    setText(size);
    showFound(size);
  }

  byId("text").addEventListener("input", () => setText(chosenSize()));
  byId("zoom").addEventListener("change", () => setText(chosenSize()));
  byId("search").addEventListener("input", () => showFound(chosenSize()));
  byId("size").addEventListener("input", show);
  // Canvases have the colour of the text in them.
  matchMedia("(prefers-color-scheme: dark)").addEventListener("change", show);
  show();
})();
