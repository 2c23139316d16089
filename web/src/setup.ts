/** A set-up: what falls, under which law, and how it is let go. Names and SI units are those of the package. */

import { BODIES, kindOf, LAWS, PARAMETERS, RIGID, SHAPES } from "./table";

export const ORIENTATIONS = ["uniform-angle", "isotropic", "given"] as const;

export const MEETINGS = ["drawn", "given"] as const;
/** What can be looked at: a body that bounces on a plane, two in free flight, or a gas of them. */
export const SHOWS = ["plane", "pair", "gas"] as const;
export type Show = (typeof SHOWS)[number];

export interface Setup {
  /** The parameters of bodies and laws by their names; of one, those that its entry in the table has. */
  [parameter: string]: number | string;
  shape: string;
  law: string;
  normal: number;
  release_height: number;
  gravity: number;
  orientation: (typeof ORIENTATIONS)[number];
  /** θ at release in rad, of the one particle there is where the angle is given. */
  angle: number;
  /** ω at release in rad/s: across, along the plane, and about its normal. */
  spin_y: number;
  spin_z: number;
  /** Velocity at release in m/s: along x, down the slope, and along the normal. */
  velocity_x: number;
  velocity_z: number;
  /** Of the plane, in rad. */
  incline: number;
  minimum_speed: number;
  /** How two bodies meet, and what is then given: √(T_tr/m) in m/s and T_rot/T_tr; or the relative speed, the impact parameter over the largest
   * at which they can touch, and ω of each about the normal of the plane of their paths. */
  meeting: (typeof MEETINGS)[number];
  thermal_speed: number;
  temperature_ratio: number;
  relative_speed: number;
  impact_parameter: number;
  spin_1: number;
  spin_2: number;
  /** Particles of a gas. */
  grains: number;
  particles: number;
  impacts: number;
  seed: number;
}

export const DEFAULT: Readonly<Setup> = {
  shape: BODIES[0].key,
  law: LAWS[0].key,
  normal: 0.98,
  ...Object.fromEntries([...PARAMETERS.values()].map((one) => [one.name, one.default ?? one.example])),
  release_height: 0.06,
  gravity: 9.81,
  orientation: "uniform-angle",
  angle: 0.5,
  spin_y: 0,
  spin_z: 0,
  velocity_x: 0,
  velocity_z: 0,
  incline: 0,
  minimum_speed: 0,
  meeting: "drawn",
  thermal_speed: 0.2,
  temperature_ratio: 1,
  relative_speed: 0.3,
  impact_parameter: 0.3,
  spin_1: 0,
  spin_2: 0,
  grains: 300,
  particles: 250,
  impacts: 400,
  seed: 1,
};

/** Most impacts that a page keeps: 64 bytes each. */
export const MOST_IMPACTS = 2_000_000;

export const bodyOf = (s: Setup) => kindOf(SHAPES, s.shape);
/** Whether it is followed in any attitude; it is then released in all alike. */
export const isRigid = (s: Setup): boolean => RIGID.some(({ key }) => key === s.shape);
export const orientationOf = (s: Setup): Setup["orientation"] => (isRigid(s) ? "isotropic" : s.orientation);
export const lawOf = (s: Setup) => kindOf(LAWS, s.law);

export const particlesOf = (s: Setup): number => (orientationOf(s) === "given" ? 1 : s.particles);

/** To twelve digits, so that 0.1 times 3 mm is 0.3 mm, as somebody would write it, and not a bit more. */
export const rounded = (x: number): number => Number(x.toPrecision(12));

/** The parameters of encounters, by how bodies meet. */
const OF_MEETINGS: Record<Setup["meeting"], string[]> = { drawn: ["thermal_speed", "temperature_ratio"], given: ["relative_speed", "impact_parameter", "spin_1", "spin_2"] };

/** The side of the box of a gas, in reaches of a body. */
export const sideOf = (s: Setup): number => 5 * Math.cbrt(s.grains);

/** Whether a parameter has a meaning in this set-up, of what is looked at. */
export function applies(key: string, s: Setup, show: Show): boolean {
  if (["shape", "law", "seed"].includes(key)) return true;
  if (PARAMETERS.has(key)) return [bodyOf(s), lawOf(s)].some(({ parameters }) => parameters.some(({ name }) => name === key));
  const flying = ["meeting", "grains", ...Object.values(OF_MEETINGS).flat()].includes(key);
  if (key !== "file" && flying !== (show !== "plane")) return false;
  if (flying) return show === "gas" ? ["grains", ...OF_MEETINGS.drawn].includes(key) : ["meeting", ...OF_MEETINGS[s.meeting]].includes(key);
  if (key === "orientation") return !isRigid(s);
  if (key === "angle") return orientationOf(s) === "given";
  if (key === "particles") return orientationOf(s) !== "given";
  if (key === "file") return bodyOf(s).parameters.some(({ type }) => type === "table");
  return true;
}
