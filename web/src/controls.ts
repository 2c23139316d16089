/** The sliders and choices of a set-up. */

import { problem } from "./link";
import { part } from "./page";
import {
  applies,
  HYPOTHESES,
  LAWS,
  ORIENTATIONS,
  SHAPES,
  MOST_IMPACTS,
  type ChoiceKey,
  type Key,
  type NumberKey,
  type Setup,
} from "./setup";

interface Slider {
  key: NumberKey;
  name: string;
  unit: string;
  /** What the page shows is the value times this. */
  factor: number;
  low: number;
  high: number;
  step: number;
  more?: boolean;
}

const DEGREES = 180 / Math.PI;

const SLIDERS: readonly Slider[] = [
  { key: "elongation", name: "Elongation L/R", unit: "", factor: 1, low: 0, high: 3, step: 0.01 },
  { key: "normal", name: "Normal restitution εₙ", unit: "", factor: 1, low: 0, high: 1, step: 0.01 },
  { key: "tangential", name: "Tangential restitution εₜ", unit: "", factor: 1, low: -1, high: 1, step: 0.01 },
  { key: "friction", name: "Friction μ", unit: "", factor: 1, low: 0, high: 1.5, step: 0.01 },
  { key: "release_height", name: "Release height of the centre", unit: "mm", factor: 1e3, low: 5, high: 300, step: 1 },
  { key: "radius", name: "Radius R", unit: "mm", factor: 1e3, low: 0.5, high: 20, step: 0.1 },
  { key: "angle", name: "Tilt θ of the axis at release", unit: "°", factor: DEGREES, low: 0, high: 180, step: 0.5 },
  { key: "spin_y", name: "Spin at release", unit: "rad/s", factor: 1, low: -300, high: 300, step: 1 },
  { key: "particles", name: "Particles", unit: "", factor: 1, low: 10, high: 5000, step: 10 },
  { key: "impacts", name: "Impacts of each, at most", unit: "", factor: 1, low: 1, high: 1000, step: 1 },
  { key: "seed", name: "Seed", unit: "", factor: 1, low: 0, high: 100, step: 1 },
  { key: "spin_z", name: "Spin about the vertical", unit: "rad/s", factor: 1, low: -300, high: 300, step: 1, more: true },
  { key: "incline", name: "Tilt of the plane", unit: "°", factor: DEGREES, low: 0, high: 45, step: 0.5, more: true },
  { key: "velocity_x", name: "Thrown sideways", unit: "m/s", factor: 1, low: -2, high: 2, step: 0.01, more: true },
  { key: "velocity_z", name: "Thrown upwards", unit: "m/s", factor: 1, low: -2, high: 2, step: 0.01, more: true },
  { key: "gravity", name: "Gravity", unit: "m/s²", factor: 1, low: 0.5, high: 30, step: 0.01, more: true },
  { key: "minimum_speed", name: "Stop below", unit: "m/s", factor: 1, low: 0, high: 0.5, step: 0.01, more: true },
];

const CHOICES: readonly { key: ChoiceKey; name: string; options: readonly string[]; labels: string[] }[] = [
  { key: "shape", name: "Shape", options: SHAPES, labels: ["Dumbbell", "Spherocylinder", "Spheroid"] },
  {
    key: "law",
    name: "Collision law",
    options: LAWS,
    labels: ["The paper's: εₙ and εₜ", "No friction", "Coulomb friction", "Chatterjee and Ruina"],
  },
  { key: "hypothesis", name: "Hypothesis", options: HYPOTHESES, labels: ["Stronge (energy)", "Poisson (impulse)", "Newton (velocity)"] },
  { key: "orientation", name: "Axis at release", options: ORIENTATIONS, labels: ["θ uniform", "every direction alike", "one particle, θ given"] },
];
/** The slider that is shown where there is room for one only, until another is chosen. */
const FIRST = "elongation";
/** The choices and sliders in the order of the page; what follows the last is under "More". */
const ORDER: readonly Key[] = [
  "shape", "elongation", "law", "normal", "tangential", "friction", "hypothesis", "release_height", "radius",
  "orientation", "angle", "spin_y", "particles", "impacts", "seed",
];

const nameOf = (key: Key) => [...SLIDERS, ...CHOICES].find((x) => x.key === key)!.name;

export class Controls {
  private setup!: Setup;
  private readonly fields = new Map<Key, { row: HTMLElement; show: () => void }>();

  constructor(host: HTMLFormElement, private readonly changed: (key: Key, value: string | number) => void) {
    host.addEventListener("submit", (event) => event.preventDefault());
    const more = document.createElement("details");
    more.innerHTML = "<summary>More</summary>";
    for (const key of ORDER) host.append(this.field(key));
    for (const { key, more: hidden } of SLIDERS) if (hidden) more.append(this.field(key));
    host.append(more);
    this.quick.addEventListener("change", () => this.show(this.setup));
  }

  /** Which field is shown where there is room for one only. */
  private readonly quick = part<HTMLSelectElement>("quick");

  /** Shows the values of a set-up. */
  show(setup: Setup): void {
    this.setup = setup;
    const there = ORDER.filter((key) => applies(key, setup));
    const wanted = there.find((key) => key === this.quick.value) ?? FIRST;
    // An open list stays as it is.
    if (this.quick.options.length !== there.length) this.quick.replaceChildren(...there.map((key) => new Option(nameOf(key), key)));
    this.quick.value = wanted;
    for (const [key, { row, show }] of this.fields) {
      row.hidden = !applies(key, setup);
      row.classList.toggle("quick", key === wanted);
      show();
    }
  }

  private field(key: Key): HTMLElement {
    const slider = SLIDERS.find((x) => x.key === key);
    const row = slider ? this.slider(slider) : this.choice(CHOICES.find((x) => x.key === key)!);
    return row;
  }

  private choice({ key, name, options, labels }: (typeof CHOICES)[number]): HTMLElement {
    const row = document.createElement("div");
    row.className = "field";
    row.innerHTML = `<label class="name" for="${key}">${name}</label><select id="${key}">${options
      .map((option, k) => `<option value="${option}">${labels[k]}</option>`)
      .join("")}</select>`;
    const select = row.querySelector("select")!;
    select.addEventListener("change", () => this.changed(key, select.value));
    this.fields.set(key, { row, show: () => (select.value = this.setup[key]) });
    return row;
  }

  private slider({ key, name, unit, factor, low, high, step }: Slider): HTMLElement {
    const row = document.createElement("div");
    row.className = "field";
    row.innerHTML = `<label class="name" for="${key}">${name}</label>
      <span class="value"><input type="number" id="${key}-number" aria-label="${name}${unit && `, ${unit}`}" step="any"><span>${unit}</span></span>
      <input type="range" id="${key}" min="${low}" max="${high}" step="${step}">`;
    const range = row.querySelector<HTMLInputElement>("input[type=range]")!;
    const number = row.querySelector<HTMLInputElement>("input[type=number]")!;
    const tell = (text: string) => {
      const value = Number((Number(text) / factor).toPrecision(12));
      const wrong = text === "" ? `${name}: a number is missing` : problem(key, value);
      number.setCustomValidity(wrong);
      number.setAttribute("aria-invalid", String(wrong !== ""));
      if (wrong) number.reportValidity();
      else this.changed(key, value);
    };
    range.addEventListener("input", () => tell(range.value));
    number.addEventListener("change", () => tell(number.value));
    const show = () => {
      const value = Number((this.setup[key] * factor).toPrecision(10));
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
export function changed(setup: Setup, key: Key, value: string | number): Setup {
  const next = { ...setup, [key]: value } as Setup;
  // The body must fit under its centre; radius and elongation push it up.
  const least = next.radius * (1 + next.elongation / 2);
  if (next.release_height < least) next.release_height = Number((least * 1.02).toPrecision(3));
  if (next.particles * next.impacts > MOST_IMPACTS) {
    if (key === "impacts") next.particles = Math.max(1, Math.floor(MOST_IMPACTS / next.impacts));
    else next.impacts = Math.max(1, Math.floor(MOST_IMPACTS / next.particles));
  }
  return next;
}

