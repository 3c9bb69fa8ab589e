// Font files that somebody chooses or drops: what is wrong with one is said in a line.

/** More than any font has. */
const MAX_BYTES = 256 << 20;

/**
 * Opens a file. Throws an Error with a line for people.
 */
export async function openFile(nfr, file) {
  const name = file.name || "the file";
  if (file.size > MAX_BYTES) throw new Error(`${name} has ${bytes(file.size)}: more than a font has.`);
  let data;
  try {
    data = await file.arrayBuffer();
  } catch {
    throw new Error(`${name} cannot be read.`);
  }
  try {
    return { name, data, font: nfr.open(data) };
  } catch (error) {
    throw new Error(reason(name, data, error), { cause: error });
  }
}

function reason(name, data, error) {
  const start = new TextDecoder("latin1").decode(data.slice(0, 4));
  switch (error.code) {
    case "NFR_NOT_A_FONT":
      if (start === "wOFF" || start === "wOF2") return `${name} is a compressed web font (WOFF): choose the font as .ttf.`;
      if (data.byteLength === 0) return `${name} is empty.`;
      return `${name} is no font: it does not begin as an OpenType font does.`;
    case "NFR_NO_MODELS":
      return `${name} is a font without models: it has no table “Nfrt”. Convert it with nfr-convert.`;
    case "NFR_LIMIT":
      return `${name} has ${bytes(data.byteLength)}, and there is no memory for it.`;
    case "NFR_UNKNOWN_VERSION":
      return `${name} was converted for another release of nfr: ${error.message}.`;
    default:
      return `${name} is damaged: ${error.message}.`;
  }
}

/** A number of bytes, for people. */
export function bytes(count) {
  if (count < 1000) return `${count} bytes`;
  return count < 1e6 ? `${(count / 1e3).toFixed(1)} kB` : `${(count / 1e6).toFixed(1)} MB`;
}

/** Calls `take` with each file that is dropped on the page. */
export function onDrop(page, take) {
  let inside = 0;
  const mark = (change) => {
    inside = Math.max(0, inside + change);
    page.classList.toggle("dropping", inside > 0);
  };
  page.addEventListener("dragenter", () => mark(1));
  page.addEventListener("dragleave", () => mark(-1));
  page.addEventListener("dragover", (event) => event.preventDefault());
  page.addEventListener("drop", (event) => {
    event.preventDefault();
    mark(-inside);
    const file = event.dataTransfer?.files[0];
    if (file) take(file);
  });
}
