/** The sliders and choices of a set-up. */

import { problem } from "./link";
import { outlineOf } from "./outline";
import { part } from "./page";
import { meshOf, rowsOf } from "./rigid";
import { applies, bodyOf, MEETINGS, MOST_IMPACTS, ORIENTATIONS, rounded, type Setup, type Show } from "./setup";
import { nice } from "./statistics";
import { beside, LAWS, LISTS, PARAMETERS, SHAPES, sizeOf, written, type Parameter } from "./table";

interface Slider {
  key: string;
  name: string;
  title?: string;
  unit: string;
  /** What the page shows is the value times this, over the parameter `beside`. */
  factor: number;
  beside?: string | undefined;
  low: number;
  high: number;
  step: number;
  more?: boolean;
}

interface Choice {
  key: string;
  name: string;
  options: readonly string[];
  labels: readonly string[];
}

const DEGREES = 180 / Math.PI;

/** Of SI units that the page shows in others: their name and what one of them is in it. */
const UNITS: Record<string, [string, number]> = { m: ["mm", 1e3], kg: ["mg", 1e6], "kg m-3": ["kg/m³", 1], "1": ["", 1] };
const capital = (text: string) => text[0].toUpperCase() + text.slice(1);

/** Of a number in the table: over its interval, or from its lower end to some times a usual value. */
function sliderOf({ name, text, unit, low, high, example, ...about }: Parameter): Slider {
  const usual = Number(example);
  const body = SHAPES.some(({ parameters }) => parameters.some((one) => one.name === name));
  const size = beside(name);
  const label = capital(unit === "1" ? text : name.replaceAll("_", " "));
  if (size) return { key: name, name: `${label} / ${size.replaceAll("_", " ")}`, title: text, unit: "", factor: 1, beside: size, low: about.closed ? 0 : 0.05, high: about.beside ?? 3, step: 0.01 };
  const [shown, factor] = UNITS[unit!] ?? [unit!, 1];
  const most = (high != null && high < 1e6 && !(about.whole && high > 1e4) && high <= 20 * (usual || 1) ? high : (unit === "m" ? 6 : 5) * usual) * factor;
  const step = about.whole ? 1 : nice((most - low! * factor) / 200);
  return { key: name, name: label, title: text, unit: shown, factor, low: about.closed ? low! * factor : step, high: most, step, more: body && about.default !== undefined };
}

const NUMBERS = [...PARAMETERS.values()].filter(({ names, type }) => !names && type !== "table");
/** Fields that are neither a slider nor a choice. */
const TABLES = [
  ...Object.keys(LISTS).map((key) => ({ key, name: capital(key) })),
  { key: "mesh", name: "Mesh" },
  { key: "file", name: "From a file" },
];
/** What a unit of a file may be, in m. */
const FILE_UNITS = { m: 1, cm: 1e-2, mm: 1e-3, "µm": 1e-6 };
const SLIDERS: readonly Slider[] = [
  ...NUMBERS.map(sliderOf),
  { key: "release_height", name: "Release height of the centre", unit: "mm", factor: 1e3, low: 5, high: 300, step: 1 },
  { key: "angle", name: "Tilt θ of the axis at release", unit: "°", factor: DEGREES, low: 0, high: 180, step: 0.5 },
  { key: "spin_y", name: "Spin at release", unit: "rad/s", factor: 1, low: -300, high: 300, step: 1 },
  { key: "particles", name: "Particles", unit: "", factor: 1, low: 10, high: 5000, step: 10 },
  { key: "impacts", name: "Impacts of each, at most", unit: "", factor: 1, low: 1, high: 1000, step: 1 },
  { key: "seed", name: "Seed", unit: "", factor: 1, low: 0, high: 100, step: 1 },
  { key: "spin_z", name: "Spin about the vertical", unit: "rad/s", factor: 1, low: -300, high: 300, step: 1, more: true },
  { key: "incline", name: "Tilt of the plane", unit: "°", factor: DEGREES, low: 0, high: 45, step: 0.5, more: true },
  { key: "velocity_x", name: "Thrown sideways", unit: "m/s", factor: 1, low: -2, high: 2, step: 0.01, more: true },
  { key: "velocity_z", name: "Thrown upwards", unit: "m/s", factor: 1, low: -2, high: 2, step: 0.01, more: true },
  { key: "thermal_speed", name: "Thermal speed √(T/m)", title: "of translation, of which the velocities are drawn", unit: "m/s", factor: 1, low: 0.01, high: 2, step: 0.01 },
  { key: "temperature_ratio", name: "T of rotation / T of translation", title: "of which the spins are drawn", unit: "", factor: 1, low: 0, high: 5, step: 0.05 },
  { key: "grains", name: "Particles of the gas", unit: "", factor: 1, low: 50, high: 600, step: 10 },
  { key: "relative_speed", name: "Relative speed", unit: "m/s", factor: 1, low: 0.01, high: 2, step: 0.01 },
  { key: "impact_parameter", name: "Impact parameter / largest", title: "distance between the lines of the centres over the largest at which the bodies can touch", unit: "", factor: 1, low: 0.01, high: 1, step: 0.01 },
  { key: "spin_1", name: "Spin of the first", title: "about the normal of the plane of the paths", unit: "rad/s", factor: 1, low: -300, high: 300, step: 1 },
  { key: "spin_2", name: "Spin of the second", title: "about the normal of the plane of the paths", unit: "rad/s", factor: 1, low: -300, high: 300, step: 1 },
  { key: "gravity", name: "Gravity", unit: "m/s²", factor: 1, low: 0.5, high: 30, step: 0.01, more: true },
  { key: "minimum_speed", name: "Stop below", unit: "m/s", factor: 1, low: 0, high: 0.5, step: 0.01, more: true },
];

/** The words of a name as in Python. */
const words = (name: string) => name.replace(/(?<!^)(?=[A-Z])/g, " ");
const kinds = (key: string, name: string, table: readonly { key: string; name: string }[]): Choice => ({
  key,
  name,
  options: table.map((kind) => kind.key),
  labels: table.map((kind) => words(kind.name)),
});

const CHOICES: readonly Choice[] = [
  kinds("shape", "Shape", SHAPES),
  kinds("law", "Collision law", LAWS),
  ...[...PARAMETERS.values()].flatMap(({ name, names }) => (names ? [{ key: name, name: capital(name), options: names, labels: names.map(capital) }] : [])),
  { key: "meeting", name: "Two bodies meet", options: MEETINGS, labels: ["as in a gas", "as given here"] },
  { key: "orientation", name: "Axis at release", options: ORIENTATIONS, labels: ["θ uniform", "every direction alike", "one particle, θ given"] },
];
const later = (key: string) => SLIDERS.find((slider) => slider.key === key)?.more === true;
const named = (table: readonly { parameters: Parameter[] }[]) =>
  [...new Set(table.flatMap(({ parameters }) => parameters.map(({ name }) => name)))].filter((name) => !later(name));
/** The choices and sliders in the order of the page; what follows the last is under "More". */
const ORDER: readonly string[] = [
  "shape", ...named(SHAPES), "file", "law", ...named(LAWS), "meeting", "thermal_speed", "temperature_ratio", "grains", "relative_speed", "impact_parameter", "spin_1", "spin_2", "release_height", "orientation", "angle", "spin_y", "particles", "impacts", "seed",
];

const nameOf = (key: string) => [...SLIDERS, ...CHOICES, ...TABLES].find((x) => x.key === key)!.name;

/** The slider that is shown where there is room for one only, until another is chosen: a length beside the size of the body; of a table
 * the choice of the shape. */
function first(s: Setup): string {
  const { parameters } = bodyOf(s);
  const one = parameters.find(({ name }) => beside(name)) ?? parameters[0];
  return one.type === "table" ? "shape" : one.name;
}

/** Where a file goes, with what a unit of it is in m, and which table it is, if that is known. */
type Load = (file: File, unit: number, key?: string) => void;

export class Controls {
  private setup!: Setup;
  private looks!: Show;
  private readonly fields = new Map<string, { row: HTMLElement; show: () => void }>();

  constructor(host: HTMLFormElement, private readonly changed: (key: string, value: string | number) => void, private readonly load: Load) {
    host.addEventListener("submit", (event) => event.preventDefault());
    const more = document.createElement("details");
    more.innerHTML = "<summary>More</summary>";
    for (const key of ORDER) host.append(this.field(key));
    for (const { key, more: hidden } of SLIDERS) if (hidden) more.append(this.field(key));
    host.append(more);
    this.quick.addEventListener("change", () => this.show(this.setup, this.looks));
  }

  /** Which field is shown where there is room for one only. */
  private readonly quick = part<HTMLSelectElement>("quick");

  /** Shows the values of a set-up. */
  show(setup: Setup, looks: Show): void {
    [this.setup, this.looks] = [setup, looks];
    const there = ORDER.filter((key) => applies(key, setup, looks));
    const wanted = there.find((key) => key === this.quick.value) ?? first(setup);
    // An open list stays as it is.
    if ([...this.quick.options].map(({ value }) => value).join() !== there.join()) this.quick.replaceChildren(...there.map((key) => new Option(nameOf(key), key)));
    this.quick.value = wanted;
    for (const [key, { row, show }] of this.fields) {
      row.hidden = !applies(key, setup, looks);
      row.classList.toggle("quick", key === wanted);
      show();
    }
  }

  private field(key: string): HTMLElement {
    if (TABLES.some((x) => x.key === key)) return this.table(key);
    const slider = SLIDERS.find((x) => x.key === key);
    const row = slider ? this.slider(slider) : this.choice(CHOICES.find((x) => x.key === key)!);
    return row;
  }

  private choice({ key, name, options, labels }: Choice): HTMLElement {
    const row = document.createElement("div");
    row.className = "field";
    row.innerHTML = `<label class="name" for="${key}">${name}</label><select id="${key}">${options
      .map((option, k) => `<option value="${option}">${labels[k]}</option>`)
      .join("")}</select>`;
    const select = row.querySelector("select")!;
    select.addEventListener("change", () => this.changed(key, select.value));
    this.fields.set(key, { row, show: () => (select.value = String(this.setup[key])) });
    return row;
  }

  /** What a unit of the next file is, in m. */
  get unit(): number {
    return FILE_UNITS[part<HTMLSelectElement>("unit").value as keyof typeof FILE_UNITS];
  }

  private table(key: string): HTMLElement {
    const row = document.createElement("div");
    row.className = "field wide";
    const options = (names: string[]) => names.map((name) => `<option>${name}</option>`).join("");
    const list = LISTS[key];
    const html: Record<string, string> = {
      [key]: list && `<label class="name" for="${key}">${nameOf(key)}</label><select id="${key}-preset" aria-label="${nameOf(key)} to begin with"><option value="">your own</option>${options(Object.keys(list.presets))}</select>
        <textarea id="${key}" rows="5" spellcheck="false" aria-describedby="${key}-hint"></textarea><p id="${key}-hint" class="soft small">${list.columns.join(" ")} in mm, ${list.line}</p>`,
      mesh: `<p id="mesh" class="small"></p>`,
      file: `<label class="name" for="unit">From a file in</label><select id="unit">${options(Object.keys(FILE_UNITS))}</select>
        <input type="file" id="file" accept=".txt,.csv,.dat,.obj,.stl" aria-label="File of a body"><p class="soft small">or drop it on the page: rows x y z r (spheres), x y z (points) or z r (profile), CSV, OBJ, STL in text</p>`,
    };
    row.innerHTML = html[key];
    const on = (selector: string, act: (value: string) => void) => {
      const field = row.querySelector<HTMLInputElement>(selector)!;
      field.addEventListener("change", () => act(field.value));
      return field;
    };
    let show = () => {};
    if (list) {
      const preset = on("select", (name) => name && this.changed(key, written(list.presets[name], 1e-3)));
      const text = on("textarea", (value) => this.load(new File([value], nameOf(key)), 1e-3, key));
      show = () => {
        preset.value = Object.entries(list.presets).find(([, rows]) => written(rows, 1e-3) === this.setup[key])?.[0] ?? "";
        const lines = rowsOf(this.setup, key).map((row) => row.map((x) => rounded(x * 1e3)).join(" "));
        if (document.activeElement !== text) text.value = lines.join("\n");
      };
    } else if (key === "mesh") {
      show = () => {
        const surface = meshOf(this.setup);
        if (this.setup.shape === "mesh") row.querySelector("p")!.textContent = `${surface.triangles.length} triangles, ${surface.points.length} vertices. Only the convex hull touches.`;
      };
    } else {
      const again = () => file.files?.[0] && this.load(file.files[0], this.unit);
      const file = on("#file", again);
      on("#unit", again);
    }
    this.fields.set(key, { row, show });
    return row;
  }

  private slider({ key, name, title, unit, factor, beside, low, high, step }: Slider): HTMLElement {
    const row = document.createElement("div");
    row.className = "field";
    row.innerHTML = `<label class="name" for="${key}"${title ? ` title="${capital(title)}"` : ""}>${name}</label>
      <span class="value"><input type="number" id="${key}-number" aria-label="${name}${unit && `, ${unit}`}" step="any"><span>${unit}</span></span>
      <input type="range" id="${key}" min="${low}" max="${high}" step="${step}">`;
    const range = row.querySelector<HTMLInputElement>("input[type=range]")!;
    const number = row.querySelector<HTMLInputElement>("input[type=number]")!;
    const scale = () => factor / (beside ? Number(this.setup[beside]) : 1);
    const tell = (text: string) => {
      const value = rounded(Number(text) / scale());
      const wrong = text === "" ? `${name}: a number is missing` : problem(key, value);
      number.setCustomValidity(wrong);
      number.setAttribute("aria-invalid", String(wrong !== ""));
      if (wrong) number.reportValidity();
      else this.changed(key, value);
    };
    range.addEventListener("input", () => tell(range.value));
    number.addEventListener("change", () => tell(number.value));
    const show = () => {
      const value = Number((Number(this.setup[key]) * scale()).toPrecision(10));
      range.value = String(value);
      range.setAttribute("aria-valuetext", `${value} ${unit}`);
      if (document.activeElement !== number) number.value = String(value);
      number.setCustomValidity("");
      number.setAttribute("aria-invalid", "false");
    };
    this.fields.set(key, { row, show });
    return row;
  }
}

/** The set-up with one value changed, and all that must change with it. */
export function changed(setup: Setup, key: string, value: string | number): Setup {
  const next: Setup = { ...setup, [key]: value };
  // Another size is the same shape.
  const { parameters } = bodyOf(next);
  if (key === sizeOf(bodyOf(next))) {
    for (const { name } of parameters) if (beside(name)) next[name] = rounded((Number(setup[name]) / Number(setup[key])) * Number(value));
  }
  // The body must fit under its centre; a larger one pushes it up.
  const least = outlineOf(next).reach;
  if (next.release_height < least) next.release_height = Number((least * 1.02).toPrecision(3));
  if (next.particles * next.impacts > MOST_IMPACTS) {
    if (key === "impacts") next.particles = Math.max(1, Math.floor(MOST_IMPACTS / next.impacts));
    else next.impacts = Math.max(1, Math.floor(MOST_IMPACTS / next.particles));
  }
  return next;
}
