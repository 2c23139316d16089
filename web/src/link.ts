/** The state of the page as the part of its address after #, so that a link is a set-up. */

import { DEFAULT, MEETINGS, MOST_IMPACTS, ORIENTATIONS, rounded, SHOWS, type Setup, type Show } from "./setup";
import { wrongTable } from "./rigid";
import { LAWS, PARAMETERS, SHAPES } from "./table";
import { TOUR, at } from "./tour";

export const RANGES = ["fig2", "near", "slow", "fig7", "all"] as const;
export const DENSITIES = ["restitution", "fraction"] as const;
/** The pictures that can stand beside the scene, below the map of set-up A. */
export const CHARTS = ["scatter-b", "density", "sigma", "reservoir", "drawing", "orbit"] as const;

/** In a link: of what the density is shown. */
const DENSITY_OF = "density-of";

/** In a link: a table of more characters than this, which the link does not hold, for not every program takes such a one. */
export const MOST_TEXT = 20_000;
const LEFT_OUT = "*";
/** Whether a link lacks a body. */
export const lacks = (hash: string): boolean => [...new URLSearchParams(hash).values()].includes(LEFT_OUT);

/** In a link: the page is to open as it is projected. */
export const PRESENT = "present";

/** Everything that a link holds of what is shown. */
export interface State {
  a: Setup;
  /** The second set-up, if there is one. */
  b: Setup | undefined;
  /** The speed at which p(ε | v) is shown, in m/s. */
  speed: number;
  range: (typeof RANGES)[number];
  density: (typeof DENSITIES)[number];
  /** What to look at: the map, or the picture that is to stand beside the scene. */
  chart: "map" | (typeof CHARTS)[number];
  /** The particle and the impact in the scene. */
  particle: number;
  impact: number;
  /** What is looked at, and which encounter. */
  show: Show;
  encounter: number;
  /** Stop of the tour; 0: none. */
  stop: number;
}

export const initial = (): State => ({
  a: { ...DEFAULT },
  b: undefined,
  speed: 0.4,
  range: "fig2",
  density: "restitution",
  chart: "map",
  particle: 0,
  impact: 0,
  show: "plane",
  encounter: 0,
  stop: 0,
});

const keys = (table: readonly { key: string }[]) => table.map(({ key }) => key);
const CHOICES: Record<string, readonly string[]> = {
  shape: keys(SHAPES),
  law: keys(LAWS),
  orientation: ORIENTATIONS,
  meeting: MEETINGS,
  ...Object.fromEntries([...PARAMETERS.values()].flatMap(({ name, names }) => (names ? [[name, names]] : []))),
};

/** What is allowed of each number: least, most, and whether it is whole. */
export const LIMITS: Record<string, [number, number, boolean?]> = {
  release_height: [1e-6, 10],
  gravity: [0.01, 100],
  angle: [-10, 10],
  spin_y: [-1e5, 1e5],
  spin_z: [-1e5, 1e5],
  velocity_x: [-100, 100],
  velocity_z: [-100, 100],
  incline: [0, 1.4],
  minimum_speed: [0, 10],
  thermal_speed: [1e-6, 100],
  temperature_ratio: [0, 1000],
  relative_speed: [1e-6, 100],
  impact_parameter: [1e-6, 1],
  spin_1: [-1e5, 1e5],
  spin_2: [-1e5, 1e5],
  grains: [10, 2000, true],
  particles: [1, MOST_IMPACTS, true],
  impacts: [1, 20_000, true],
  seed: [0, Number.MAX_SAFE_INTEGER, true],
};

/** Why a value cannot be, or "". */
export function problem(key: string, value: string | number): string {
  if (key in CHOICES) {
    const allowed = CHOICES[key];
    return allowed.includes(String(value)) ? "" : `${key} = ${value}: must be ${allowed.join(" or ")}`;
  }
  const about = PARAMETERS.get(key);
  if (about?.type === "table") return value === LEFT_OUT ? `${key}: of a file too large for a link; drop the file on the page` : wrongTable(key, String(value));
  const [low, high, whole] = about ? [about.low!, about.high ?? Infinity, about.whole] : LIMITS[key];
  const [x, open] = [Number(value), about?.closed === false];
  const fits = value !== "" && Number.isFinite(x) && (open ? x > low : x >= low) && x <= high && (!whole || Number.isInteger(x));
  const interval = high < Infinity ? `in ${open ? "(" : "["}${low}, ${high}]` : `${open ? ">" : ">="} ${low}`;
  return fits ? "" : `${key} = ${value}: must be ${whole ? "a whole number " : ""}${interval}`;
}

function write(prefix: string, setup: Setup, out: URLSearchParams): void {
  for (const key of Object.keys(DEFAULT)) {
    const text = String(setup[key]);
    if (setup[key] !== DEFAULT[key]) out.set(prefix + key, text.length > MOST_TEXT ? LEFT_OUT : text);
  }
}

/** Takes what links of the page once had: L/R and R for all bodies. A spheroid was as long for its width as the dumbbell of that L/R. */
function longAs(elongation: string | null, sized: boolean, setup: Setup): void {
  if (elongation === null && !(sized && setup.shape === "spheroid")) return;
  const [x, radius] = [Number(elongation ?? 0.1), Number(setup.radius)];
  if (!(x >= 0 && x <= 20)) return;
  setup.separation = rounded(radius * x);
  if (setup.shape === "spheroid") [setup.equatorial, setup.polar] = [radius, rounded(radius * (1 + x / 2))];
}

function read(prefix: string, from: URLSearchParams, problems: string[]): Setup {
  const setup = { ...DEFAULT };
  for (const key of Object.keys(DEFAULT)) {
    const text = from.get(prefix + key);
    if (text === null) continue;
    const wrong = problem(key, text);
    if (wrong) problems.push(wrong);
    else setup[key] = key in CHOICES || PARAMETERS.get(key)?.type === "table" ? text : Number(text);
  }
  longAs(from.get(`${prefix}elongation`), from.has(`${prefix}radius`), setup);
  if (setup.particles * setup.impacts > MOST_IMPACTS) {
    problems.push(`particles × impacts = ${setup.particles * setup.impacts}: must be at most ${MOST_IMPACTS} on this page`);
    setup.particles = Math.max(1, Math.floor(MOST_IMPACTS / setup.impacts));
  }
  return setup;
}

/** A link; of a stop as it is in the tour no more than its number. */
export function toHash(state: State): string {
  const short = `stop=${state.stop}`;
  const written = all(state);
  if (state.stop && written === all(at(state.stop, initial()))) return short;
  return written === short ? `particle=0&${short}` : written;
}

function all(state: State): string {
  const out = new URLSearchParams();
  const start = initial();
  write("", state.a, out);
  if (state.b) {
    out.set("b", "1");
    write("b.", state.b, out);
  }
  for (const key of ["speed", "range", "density", "chart", "particle", "impact", "show", "encounter", "stop"] as const) {
    if (state[key] !== start[key]) out.set(key === "density" ? DENSITY_OF : key, String(state[key]));
  }
  return out.toString();
}

/** The state of a link, and what of it cannot be. */
export function fromHash(hash: string): { state: State; problems: string[] } {
  const from = new URLSearchParams(hash.replace(/^#/, ""));
  // Links of the page once had this in the place of the density of the body.
  const of = from.get("density");
  if (of && !(Number(of) > 0)) {
    from.set(DENSITY_OF, of);
    from.delete("density");
  }
  const problems: string[] = [];
  let state = initial();
  state.a = read("", from, problems);
  if (from.has("b")) state.b = read("b.", from, problems);
  const number = (key: "speed" | "particle" | "impact" | "encounter" | "stop", least: number, most: number) => {
    const x = Number(from.get(key) ?? NaN);
    if (from.has(key)) {
      if (x >= least && x <= most) state[key] = key === "speed" ? x : Math.floor(x);
      else problems.push(`${key} = ${from.get(key)}: must be in [${least}, ${most}]`);
    }
  };
  number("speed", -100, 100);
  number("particle", 0, MOST_IMPACTS);
  number("impact", 0, MOST_IMPACTS);
  number("encounter", 0, 2 ** 32 - 1);
  number("stop", 0, TOUR.length);
  if (state.stop && [...from.keys()].every((key) => key === "stop" || key === PRESENT)) state = at(state.stop, state);
  const one = <K extends "range" | "density" | "chart" | "show">(key: K, of: readonly State[K][], name: string = key) => {
    const found = of.find((x) => x === from.get(name));
    if (found !== undefined) state[key] = found;
  };
  one("range", RANGES);
  one("density", DENSITIES, DENSITY_OF);
  one("chart", ["map", ...CHARTS]);
  one("show", SHOWS);
  return { state, problems };
}
