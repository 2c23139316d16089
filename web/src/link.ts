/** The state of the page as the part of its address after #, so that a link is a set-up. */

import {
  DEFAULT,
  HYPOTHESES,
  LAWS,
  ORIENTATIONS,
  SHAPES,
  MOST_IMPACTS,
  type ChoiceKey,
  type Key,
  type Setup,
} from "./setup";
import { TOUR, at } from "./tour";

export const RANGES = ["fig2", "near", "fig7", "all"] as const;
export const DENSITIES = ["restitution", "fraction"] as const;
/** The pictures that can stand beside the scene, below the map of set-up A. */
export const CHARTS = ["scatter-b", "density", "sigma", "reservoir", "drawing"] as const;

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
  stop: 0,
});

const CHOICES: Record<ChoiceKey, readonly string[]> = {
  shape: SHAPES,
  law: LAWS,
  hypothesis: HYPOTHESES,
  orientation: ORIENTATIONS,
};

/** What is allowed of each number: least, most, and whether it is whole. */
export const LIMITS: Record<Exclude<Key, ChoiceKey>, readonly [number, number, boolean?]> = {
  radius: [1e-6, 1],
  elongation: [0, 20],
  normal: [0, 1],
  tangential: [-1, 1],
  friction: [0, 10],
  release_height: [1e-6, 10],
  gravity: [0.01, 100],
  angle: [-10, 10],
  spin_y: [-1e5, 1e5],
  spin_z: [-1e5, 1e5],
  velocity_x: [-100, 100],
  velocity_z: [-100, 100],
  incline: [0, 1.4],
  minimum_speed: [0, 10],
  particles: [1, MOST_IMPACTS, true],
  impacts: [1, 20_000, true],
  seed: [0, Number.MAX_SAFE_INTEGER, true],
};

/** Why a value cannot be, or "". */
export function problem(key: Key, value: string | number): string {
  if (key in CHOICES) {
    const allowed = CHOICES[key as ChoiceKey];
    return allowed.includes(String(value)) ? "" : `${key} = ${value}: must be ${allowed.join(" or ")}`;
  }
  const [low, high, whole] = LIMITS[key as Exclude<Key, ChoiceKey>];
  const x = Number(value);
  const fits = value !== "" && x >= low && x <= high && (!whole || Number.isInteger(x));
  return fits ? "" : `${key} = ${value}: must be ${whole ? "a whole number " : ""}in [${low}, ${high}]`;
}

function write(prefix: string, setup: Setup, out: URLSearchParams): void {
  for (const key of Object.keys(DEFAULT) as Key[]) {
    if (setup[key] !== DEFAULT[key]) out.set(prefix + key, String(setup[key]));
  }
}

function read(prefix: string, from: URLSearchParams, problems: string[]): Setup {
  const setup = { ...DEFAULT };
  for (const key of Object.keys(DEFAULT) as Key[]) {
    const text = from.get(prefix + key);
    if (text === null) continue;
    const wrong = problem(key, text);
    if (wrong) problems.push(wrong);
    else (setup as Record<Key, string | number>)[key] = key in CHOICES ? text : Number(text);
  }
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
  for (const key of ["speed", "range", "density", "chart", "particle", "impact", "stop"] as const) {
    if (state[key] !== start[key]) out.set(key, String(state[key]));
  }
  return out.toString();
}

/** The state of a link, and what of it cannot be. */
export function fromHash(hash: string): { state: State; problems: string[] } {
  const from = new URLSearchParams(hash.replace(/^#/, ""));
  const problems: string[] = [];
  let state = initial();
  state.a = read("", from, problems);
  if (from.has("b")) state.b = read("b.", from, problems);
  const number = (key: "speed" | "particle" | "impact" | "stop", least: number, most: number) => {
    const x = Number(from.get(key) ?? NaN);
    if (from.has(key)) {
      if (x >= least && x <= most) state[key] = key === "speed" ? x : Math.floor(x);
      else problems.push(`${key} = ${from.get(key)}: must be in [${least}, ${most}]`);
    }
  };
  number("speed", -100, 100);
  number("particle", 0, MOST_IMPACTS);
  number("impact", 0, MOST_IMPACTS);
  number("stop", 0, TOUR.length);
  if (state.stop && [...from.keys()].every((key) => key === "stop" || key === PRESENT)) state = at(state.stop, state);
  const one = <K extends "range" | "density" | "chart">(key: K, of: readonly State[K][]) => {
    const name = of.find((x) => x === from.get(key));
    if (name !== undefined) state[key] = name;
  };
  one("range", RANGES);
  one("density", DENSITIES);
  one("chart", ["map", ...CHARTS]);
  return { state, problems };
}
