// The table of bodies, laws and materials of the kept module, as JSON: what the page is built with.
import { readFileSync } from "node:fs";

export function table() {
  const module = new WebAssembly.Module(readFileSync(new URL("module/restitution_web.wasm", import.meta.url)));
  const core = new WebAssembly.Instance(module).exports;
  core.describe();
  return Buffer.from(core.memory.buffer, core.message(), core.message_length()).toString();
}
