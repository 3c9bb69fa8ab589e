// Makes the page one file, which works from a disk without a server: node inline.mjs FOLDER > PAGE.html, FOLDER being what web/build
// makes. Browsers load neither modules nor data from a disk, so styles, scripts, module and font are put into the page.
import { readFileSync } from "node:fs";

const folder = process.argv[2];
const read = (name) => readFileSync(`${folder}/${name}`, "utf8");
const base64 = (name) => readFileSync(`${folder}/${name}`).toString("base64");

const assets = `
const bytes = (text) => Uint8Array.from(atob(text), (character) => character.charCodeAt(0)).buffer;
const wasm = () => bytes("${base64("nfr/nfr.wasm")}");
const specimen = async () => bytes("${base64("demo/specimen.ttf")}");
`;

/** A script as part of a larger one: its imports come before it, each in a block of its own, which returns what it exports. */
function part(name, needs) {
  const source = read(name);
  const exported = [...source.matchAll(/^export (?:async )?(?:class|function|const) (\w+)/gm)].map(([, name]) => name);
  for (const [, names] of source.matchAll(/^export \{ (.*?) \}/gm)) exported.push(...names.split(", "));
  const code = source.replace(/^import .*$/gm, "").replace(/^export \{.*$/gm, "").replace(/^export /gm, "");
  const imports = needs.length > 0 ? needs.join("\n") : "";
  return `${imports}\n${code.replace(/import\.meta\.url/g, "location.href")}\nreturn { ${exported.join(", ")} };`;
}

const block = (name, body) => `parts.${name} = (() => {\n${body}\n})();`;
const script = [
  "const parts = {};",
  block("font", part("nfr/font.js", [])),
  block("text", part("nfr/text.js", [])),
  block("nfr", part("nfr/nfr.js", ["const { Font, NfrError } = parts.font;", "const { drawText, layoutText, paint } = parts.text;"])),
  block("assets", `${assets}\nreturn { specimen, wasm };`),
  block("files", part("demo/files.js", [])),
  block("magnifier", part("demo/magnifier.js", [])),
  block("specimen", part("demo/specimen.js", ["const { drawText, layoutText, paint } = parts.nfr;"])),
  block("page", part("demo/page.js", [
    "const { load } = parts.nfr, { specimen, wasm } = parts.assets;",
    "const { bytes, onDrop, openFile } = parts.files, { Magnifier, ROWS } = parts.magnifier;",
    "const { breakLines, characterAt, lacking, render } = parts.specimen;",
  ])),
].join("\n");

const html = read("demo/index.html")
  .replace(/^.*rel="(?:preload|modulepreload)".*\n/gm, "")
  .replace(/<link rel="stylesheet".*>/, () => `<style>\n${read("demo/style.css")}</style>`)
  .replace(/<script type="module".*<\/script>/, () => `<script type="module">\n${script}\n</script>`);
process.stdout.write(html);
