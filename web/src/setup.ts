/** A set-up: what falls, under which law, and how it is let go. Names and SI units are those of the package. */

import { BODIES, kindOf, LAWS, PARAMETERS, RIGID, SHAPES } from "./table";

export const ORIENTATIONS = ["uniform-angle", "isotropic", "given"] as const;

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

/** Whether a parameter has a meaning in this set-up. */
export function applies(key: string, s: Setup): boolean {
  if (PARAMETERS.has(key)) return [bodyOf(s), lawOf(s)].some(({ parameters }) => parameters.some(({ name }) => name === key));
  if (key === "orientation") return !isRigid(s);
  if (key === "angle") return orientationOf(s) === "given";
  if (key === "particles") return orientationOf(s) !== "given";
  if (key === "file") return bodyOf(s).parameters.some(({ type }) => type === "table");
  return true;
}
