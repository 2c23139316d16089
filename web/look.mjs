// Pictures of the page as people see it, into web/shots/: every stop of the tour on a laptop, some on a phone, in the dark, presented,
// printed.  node look.mjs [NAME...]   `make look` builds the page first.
import { mkdirSync } from "node:fs";
import { fileURLToPath } from "node:url";
import { launch } from "./tests/browser.mjs";
import { PAGE, page as library } from "./tests/library.mjs";

export const LAPTOP = { width: 1280, height: 800 };
export const PHONE = { width: 390, height: 844 };
const SHOTS = fileURLToPath(new URL("shots/", import.meta.url));
const stops = Array.from({ length: 10 }, (_, k) => k + 1);

/** A gas after a few collisions. */
async function cooled(page) {
  await page.locator("#gas-pace").selectOption("4");
  await page.locator("#gas-play").click();
  await page.waitForFunction(() => Number(/([\d.]+) collisions/.exec(document.getElementById("gas-text").textContent)?.[1]) > 10);
  await page.locator("#gas-play").click();
}

const LOOKS = {
  laptop: { hash: "" },
  whole: { hash: "", whole: true },
  compare: { hash: "particles=100&impacts=200&b=1&b.law=frictionless&b.particles=100&b.impacts=200&chart=scatter-b&impact=20" },
  ...Object.fromEntries(stops.map((stop) => [`stop-${stop}`, { hash: `stop=${stop}` }])),
  ...Object.fromEntries(stops.map((stop) => [`phone-${stop}`, { hash: `stop=${stop}`, ...PHONE }])),
  phone: { hash: "", ...PHONE },
  "phone-whole": { hash: "impact=3", ...PHONE, whole: true },
  "phone-sheet": { hash: "", ...PHONE, act: (page) => page.locator("#sheet").click() },
  dark: { hash: "stop=3", scheme: "dark" },
  "dark-5": { hash: "stop=5", scheme: "dark" },
  "dark-9": { hash: "stop=9", scheme: "dark" },
  tablet: { hash: "stop=4", width: 820, height: 1180 },
  present: { hash: "present=1" },
  "present-3": { hash: "stop=3&present=1", width: 1920, height: 1080 },
  "present-5": { hash: "stop=5&present=1" },
  spheroid: { hash: "shape=spheroid&elongation=1&particles=50&impacts=50&impact=9&chart=drawing" },
  capsule: { hash: "shape=spherocylinder&elongation=2&spin_y=80&particles=50&impacts=50&impact=4&chart=drawing&law=coulomb" },
  ...Object.fromEntries(library.RIGID.flatMap(({ key: shape }) => {
    const hash = `shape=${shape}&law=coulomb&faces=20&particles=50&impacts=50&impact=2`;
    return [[shape, { hash }], [`${shape}-dark`, { hash, scheme: "dark" }], [`${shape}-phone`, { hash, ...PHONE }]];
  })),
  pair: { hash: "show=pair&separation=0.006&encounter=3" },
  "pair-dark": { hash: "show=pair&shape=spheroid&polar=0.006&law=coulomb&encounter=5", scheme: "dark" },
  "pair-phone": { hash: "show=pair&separation=0.006&encounter=3", ...PHONE, whole: true },
  gas: { hash: "show=gas&separation=0.006&law=frictionless&normal=0.9", act: cooled },
  "gas-dark": { hash: "show=gas&shape=box&law=coulomb&normal=0.8&grains=200", scheme: "dark", act: cooled },
  "gas-phone": { hash: "show=gas&separation=0.006&law=frictionless&normal=0.9", ...PHONE, act: cooled, whole: true },
  "pair-boxes": { hash: "show=pair&shape=box&meeting=given&encounter=4" },
  "pair-present": { hash: "show=pair&separation=0.006&encounter=3&present=1", width: 1920, height: 1080 },
  print: { hash: "stop=3", print: true },
};

const asked = process.argv.slice(2);
mkdirSync(SHOTS, { recursive: true });
const browser = await launch();
for (const [name, { hash, scheme = "light", whole = false, print = false, act, width, height }] of Object.entries(LOOKS)) {
  if (asked.length && !asked.includes(name)) continue;
  const context = await browser.newContext({
    viewport: { width: width ?? LAPTOP.width, height: height ?? LAPTOP.height },
    colorScheme: scheme,
    reducedMotion: "reduce",
  });
  context.setDefaultTimeout(180_000);
  const page = await context.newPage();
  page.on("console", (message) => console.log(name, message.text()));
  page.on("pageerror", (error) => console.log(name, error.stack));
  await page.goto(`file://${PAGE}#${hash}`);
  await page.waitForFunction(() => document.documentElement.dataset.state === "done");
  // Charts are drawn where somebody looks.
  if (whole) {
    for (const chart of await page.locator(".chart:visible").all()) await chart.scrollIntoViewIfNeeded();
    await page.waitForTimeout(300);
    await page.evaluate(() => scrollTo(0, 0));
  }
  await act?.(page);
  if (print) await page.emulateMedia({ media: "print" });
  await page.waitForTimeout(700);
  await page.screenshot({ path: `${SHOTS}${name}.png`, fullPage: whole || print });
  await context.close();
}
await browser.close();
