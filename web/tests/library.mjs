// The page's parts that need no browser, and the native program beside them.
import { build } from "esbuild";
import { table } from "../table.mjs";
import { execFileSync } from "node:child_process";
import { createHash } from "node:crypto";
import { readFileSync } from "node:fs";
import { fileURLToPath } from "node:url";

const at = (path) => fileURLToPath(new URL(path, import.meta.url));
const bundled = await build({ entryPoints: [at("../src/library.ts")], bundle: true, write: false, format: "esm", target: "es2022", define: { TABLE: table() } });
const source = Buffer.from(bundled.outputFiles[0].text).toString("base64");
export const page = await import(`data:text/javascript;base64,${source}`);

export const PAGE = at("../../python/restitution/explorer/explorer.html");
const BIN = at("../../.venv/bin/");

const module = new WebAssembly.Module(readFileSync(at("../module/restitution_web.wasm")));
export const engine = new page.Engine(module);
page.drawWith(engine);

/** The columns of a run, by name, and the number of impacts of each particle. */
export function simulate(setup) {
  const particles = page.particlesOf(setup);
  const size = particles * setup.impacts;
  const table = engine.simulate(page.numbers(setup), 0, particles);
  const columns = Object.fromEntries(page.COLUMNS.map((name, k) => [name, table.subarray(k * size, (k + 1) * size)]));
  return { columns, counts: table.subarray(8 * size, 8 * size + particles) };
}

/** The digest of the page, from the module. */
export function digest(setup) {
  const { columns } = simulate(setup);
  const hash = createHash("sha256");
  for (const name of page.digested(setup)) {
    const { buffer, byteOffset, byteLength } = columns[name];
    hash.update(new Uint8Array(buffer, byteOffset, byteLength));
  }
  return hash.digest("hex");
}

/** What the native program prints for some lines of Python. */
export function native(lines) {
  return execFileSync(`${BIN}python`, ["-W", "ignore", "-c", lines], { encoding: "utf8" }).trim();
}

export function command(...args) {
  return execFileSync(`${BIN}restitution`, args, { encoding: "utf8" });
}
