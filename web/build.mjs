// Builds the page: one file that needs nothing else, on any static host, from a disk, offline.
//   node build.mjs [OUT.html]   write it
//   node build.mjs --check      leave with 1 if the one in the repository is of other sources
import { build } from "esbuild";
import { existsSync, mkdirSync, readFileSync, writeFileSync } from "node:fs";
import { dirname, join } from "node:path";
import { fileURLToPath } from "node:url";
import { gzipSync } from "node:zlib";
import { table } from "./table.mjs";

const here = dirname(fileURLToPath(import.meta.url));
const at = (...names) => join(here, ...names);
const KEPT = at("..", "python", "restitution", "explorer", "explorer.html");
const text = (...names) => readFileSync(at(...names), "utf8");

const bundled = new Set();

async function bundle(entry, define = {}) {
  const result = await build({
    entryPoints: [at(entry)],
    bundle: true,
    write: false,
    minify: true,
    format: "iife",
    target: "es2022",
    legalComments: "none",
    metafile: true,
    absWorkingDir: here,
    define,
  });
  for (const input of Object.keys(result.metafile.inputs)) {
    const name = /^node_modules\/((?:@[^/]+\/)?[^/]+)/.exec(input)?.[1];
    if (name) bundled.add(name);
  }
  return result.outputFiles[0].text;
}

const core = readFileSync(at("module", "restitution_web.wasm")).toString("base64");
const worker = await bundle("src/engine/worker.ts");
/** An address of the project, once it has one. */
const cited = (key) => text("..", "CITATION.cff").match(new RegExp(`^${key}: *"?([^"\n]+)`, "m"))?.[1];
const home = cited("url");
const script = await bundle("src/main.ts", { CORE: JSON.stringify(core), WORKER: JSON.stringify(worker), TABLE: table(), HOME: JSON.stringify(home ?? "") });
const links = [["Paper", "https://doi.org/10.1103/PhysRevE.90.052204"], ["Documentation", home], ["Repository", cited("repository-code")]]
  .filter(([, address]) => address)
  .map(([name, address]) => `<a href="${address}">${name}</a>`);
const version = text("..", "Cargo.toml").match(/^version = "(.*)"/m)[1];

function licence(name) {
  const { version, license } = JSON.parse(text("node_modules", name, "package.json"));
  return `${name} ${version}, ${license}\n\n${text("node_modules", name, "LICENSE")}`;
}
const licences = [
  `restitution\n\n${text("..", "LICENSE")}`,
  ...[...bundled].sort().map(licence),
  text("module", "LICENCES.txt"),
].join("\n\n----------------------------------------\n\n");

const escaped = licences.replace(/[&<>]/g, (c) => `&#${c.charCodeAt(0)};`);
// A function as the replacement: "$" in a bundle means nothing. "</script" would end the element that holds it.
const page = text("src/page.html")
  .replace("/*STYLE*/", () => text("src/style.css"))
  .replace("/*LINKS*/", () => links.join(""))
  .replace("/*VERSION*/", () => version)
  .replace("/*LICENCES*/", () => escaped)
  .replace("/*SCRIPT*/", () => script.replace(/<\/script/gi, "<\\/script"));
if (process.argv[2] === "--check") {
  const fresh = existsSync(KEPT) && readFileSync(KEPT, "utf8") === page;
  if (!fresh) console.error("python/restitution/explorer/explorer.html is not of these sources: run make web");
  process.exit(fresh ? 0 : 1);
}
const out = process.argv[2] ?? KEPT;
mkdirSync(dirname(out), { recursive: true });
writeFileSync(out, page);
const kilobytes = (length) => `${(length / 1000).toFixed(0)} kB`;
console.log(`${out}: ${kilobytes(Buffer.byteLength(page))}, compressed ${kilobytes(gzipSync(page, { level: 9 }).length)}`);
