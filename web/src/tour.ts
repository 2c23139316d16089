/** The guided tour: the paper in ten stops, for a lecture. Each is a set-up and what to look at. */

import type { State } from "./link";
import type { Kind } from "./pick";
import { DEFAULT, rounded, type Setup } from "./setup";

export interface Stop {
  title: string;
  text: string;
  a?: Partial<Setup>;
  b?: Partial<Setup>;
  view?: Partial<Pick<State, "speed" | "range" | "density" | "chart">>;
  /** The impact to replay. */
  kind?: Kind;
}

/** L in m of a body with this L/R. */
const long = (elongation: number) => rounded(elongation * Number(DEFAULT.radius));

export const TOUR: readonly Stop[] = [
  {
    title: "A sphere has one coefficient of restitution",
    text: "A sphere (L = 0) loses the same share of its speed at every impact: ε = εₙ = 0.98, a line. Now move L, the distance between the centres, from 0. The body of Fig. 1 of the paper is two overlapping spheres whose centres are L apart.",
    a: { separation: long(0), impacts: 100, particles: 100 },
  },
  {
    title: "Fig. 2: ε of a slightly elongated body scatters",
    text: "The dumbbell of the paper, L/R = 0.1: hardly distinguishable from a sphere by eye. ε depends on how it lies and spins when it touches. Slow impacts scatter most. Colour: how many impacts, on a logarithmic scale.",
  },
  {
    title: "ε > 1: who pays?",
    text: "At many impacts the body leaves faster than it came. Watch the bars: energy that earlier impacts gave to sideways motion and to rotation returns to the fall. Sideways motion pays 71 %, rotation 29 %: a nearly round body that was released at rest bounces as if it rolled. The impact with the largest ε, of those faster than a tenth of the fall, is replayed, and drawn.",
    view: { chart: "drawing" },
    kind: "superelastic",
  },
  {
    title: "Figs. 3 and 5: the reservoir fills",
    text: "Released from rest, a body has no rotation. The slower it has become, the larger the share of its kinetic energy that rotates (colour and mean). Drag the line to another speed: the density of the rotational share, below it, follows.",
    view: { density: "fraction", speed: 0.2, chart: "reservoir" },
  },
  {
    title: "Fig. 4: p(ε | v) has a cusp",
    text: "At a given speed ε has a density with a cusp near εₙ and flanks that are straight on a logarithmic scale: nearly a Laplace density, which is fitted to it. Drag the line to lower speeds: it widens, and below 0.3 m/s lines grow out of it (last stop).",
    a: { particles: 1000 },
    view: { speed: 0.4, chart: "density" },
  },
  {
    title: "Fig. 6: even good glass beads scatter",
    text: "Two set-ups with the same random numbers: L/R = 0.01 (A) and 0.02 (B), glass beads of average make. The standard deviation σ(ε) grows as they slow down. Twice the elongation gives four to five times the scatter: the rotation that a body picks up grows with L, and so does what it does at the next impact.",
    a: { separation: long(0.01) },
    b: { separation: long(0.02) },
    view: { speed: 0.5, range: "near", chart: "sigma" },
  },
  {
    title: "Fig. 7: ε < 0, in two ways",
    text: "Slow impacts, and ε from −3 to 4. Right of v = 0 a falling body turns so fast that its centre goes on downwards after the impact, which the pale arrow v↓ shows, the vertical part of v, drawn larger. Left of it the body is hit while its centre rises. One of the first kind is replayed; choose the other kind below the scene.",
    a: { particles: 1000 },
    view: { range: "fig7", speed: 0.05 },
    kind: "downward",
  },
  {
    title: "Fig. 9: the first impact, exactly",
    text: "Two touching spheres (L = 2R) of soft material, εₙ = 0.4, at their first impact from rest. The line is the density in closed form, Eqs. 17 to 21. Already without any spin, 3 % of the bodies go on downwards: one of them is replayed.",
    a: { separation: long(2), normal: 0.4, impacts: 1, particles: 20000 },
    view: { range: "near", chart: "density" },
    kind: "downward",
  },
  {
    title: "A surprise: the law creates energy",
    text: "A: the paper's law, which keeps the tangential velocity of the contact (εₜ = 1). B: no friction. They are not the same: A's plane must push sideways, and kinetic energy can grow. The impact that creates most is replayed. Nothing of the kind happens in B, whose scatter is larger by far.",
    a: { separation: long(0.5) },
    b: { separation: long(0.5), law: "frictionless" },
    view: { chart: "scatter-b" },
    kind: "gain",
  },
  {
    title: "A surprise: slow bodies fall into step",
    text: "One in thirty slow bodies turns by half a turn in each bounce, or each two, for hundreds of impacts, and climbs while it loses energy: vω = πg/2. Each bright line is such an orbit. One is played, with ghosts of the body where it touched; click another line to play it.",
    a: { particles: 1000, impacts: 1000 },
    view: { speed: 0.1, range: "slow", chart: "orbit" },
    kind: "locked",
  },
];

/** The state of a stop. */
export function at(stop: number, state: State): State {
  const { a, b, view } = TOUR[stop - 1];
  return {
    ...state,
    a: { ...DEFAULT, ...a } as Setup,
    b: b && ({ ...DEFAULT, ...b } as Setup),
    speed: 0.4,
    range: "fig2",
    density: "restitution",
    chart: "map",
    particle: 0,
    impact: 0,
    show: "plane",
    ...view,
    stop,
  };
}
