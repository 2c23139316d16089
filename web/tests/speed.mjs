// How fast the page is, in the browser of the tests: node tests/speed.mjs. `make bench-web` builds the page first.
// Without a graphics card the scene is drawn by the processor, so that the frame rate is a lower bound.
import { cpus, loadavg } from "node:os";
import { launch } from "./browser.mjs";
import { PAGE } from "./library.mjs";

const REPEATS = 5;
const median = (values) => [...values].sort((a, b) => a - b)[Math.floor(values.length / 2)];
const browser = await launch();

async function open(hash, motion) {
  const context = await browser.newContext({ viewport: { width: 1400, height: 1000 }, reducedMotion: motion });
  const page = await context.newPage();
  await page.addInitScript(() => {
    window.seen = { frames: [], work: [] };
    const watch = new MutationObserver(() => {
      window.seen.first ??= performance.now();
      if (document.documentElement.dataset.state === "done") window.seen.done ??= performance.now();
    });
    watch.observe(document, { subtree: true, attributes: true, attributeFilter: ["data-redraw", "data-state"] });
    const ask = window.requestAnimationFrame.bind(window);
    window.requestAnimationFrame = (draw) =>
      ask((now) => {
        const started = performance.now();
        draw(now);
        window.seen.frames.push(now);
        window.seen.work.push(performance.now() - started);
      });
  });
  await page.goto(`file://${PAGE}#${hash}`);
  await page.waitForFunction(() => document.documentElement.dataset.state === "done", undefined, { timeout: 120_000 });
  return { page, close: () => context.close() };
}

const first = [];
const done = [];
for (let i = 0; i < REPEATS; i++) {
  const { page, close } = await open("", "reduce");
  const seen = await page.evaluate(() => window.seen);
  first.push(seen.first);
  done.push(seen.done);
  await close();
}

const { page, close } = await open("particles=100&impacts=100", "no-preference");
await page.evaluate(() => ((window.seen.frames = []), (window.seen.work = [])));
await page.waitForTimeout(4000);
const { frames, work } = await page.evaluate(() => window.seen);
const redraws = [];
for (const speed of [0.1, 0.15, 0.2, 0.3, 0.4, 0.5, 0.6]) {
  await page.locator("#speed").evaluate((input, x) => {
    input.value = x;
    input.dispatchEvent(new Event("input", { bubbles: true }));
  }, String(speed));
  await page.waitForTimeout(200);
  redraws.push(Number(await page.evaluate(() => document.documentElement.dataset.redraw)));
}
const runs = [];
for (const elongation of [0.11, 0.12, 0.13, 0.14, 0.15]) {
  runs.push(
    await page.locator("#separation").evaluate(async (input, x) => {
      const started = performance.now();
      input.value = x;
      input.dispatchEvent(new Event("input", { bubbles: true }));
      input.dispatchEvent(new Event("change", { bubbles: true }));
      const root = document.documentElement;
      while (root.dataset.state === "done") await new Promise((resolve) => setTimeout(resolve, 1));
      while (root.dataset.state !== "done") await new Promise((resolve) => setTimeout(resolve, 1));
      return performance.now() - started;
    }, String(elongation)),
  );
}
await close();

const ms = (value) => `${value.toFixed(0).padStart(6)} ms`;
console.log(`${cpus()[0].model}, ${cpus().length} cores, load ${loadavg()[0].toFixed(1)}; ${browser.version()}, drawn without a graphics card`);
console.log(`first picture after                 ${ms(median(first))}`);
console.log(`10^5 impacts drawn after            ${ms(median(done))}`);
console.log(`redraw of 10^4 impacts              ${ms(median(redraws))}`);
console.log(`10^4 new impacts, run and drawn     ${ms(median(runs))}`);
const rate = frames.length > 1 ? (1000 * (frames.length - 1)) / (frames.at(-1) - frames[0]) : 0;
console.log(`frames of the scene                 ${rate.toFixed(0).padStart(6)} a second`);
console.log(`the page's own work for a frame     ${median(work).toFixed(1).padStart(6)} ms`);
await browser.close();
