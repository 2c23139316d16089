/** A set-up: what falls, under which law, and how it is let go. Names and SI units are those of the package. */

export const SHAPES = ["dumbbell", "spherocylinder", "spheroid"] as const;
export const LAWS = ["tangential-restitution", "frictionless", "coulomb", "chatterjee-ruina"] as const;
export const HYPOTHESES = ["stronge", "poisson", "newton"] as const;
export const ORIENTATIONS = ["uniform-angle", "isotropic", "given"] as const;

export interface Setup {
  shape: (typeof SHAPES)[number];
  /** R in m: of a sphere, of the hemispheres; the equatorial semi-axis of a spheroid. */
  radius: number;
  /** L/R; a spheroid is as long for its width as the dumbbell of the same L/R. */
  elongation: number;
  law: (typeof LAWS)[number];
  normal: number;
  tangential: number;
  friction: number;
  hypothesis: (typeof HYPOTHESES)[number];
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
  shape: "dumbbell",
  radius: 3e-3,
  elongation: 0.1,
  law: "tangential-restitution",
  normal: 0.98,
  tangential: 1,
  friction: 0.3,
  hypothesis: "stronge",
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

export type Key = keyof Setup;
export type NumberKey = { [K in Key]: Setup[K] extends number ? K : never }[Key];
export type ChoiceKey = Exclude<Key, NumberKey>;

/** Most impacts that a page keeps: 64 bytes each. */
export const MOST_IMPACTS = 2_000_000;
/** Of the bodies' material; the motion does not depend on it. */
export const DENSITY = 2500;

export const particlesOf = (s: Setup): number => (s.orientation === "given" ? 1 : s.particles);

/** The length of the body beside its radius, in m: L, or the polar semi-axis of a spheroid. To twelve digits, so that 0.1 times
 * 3 mm is 0.3 mm, as somebody would write it, and not a bit more. */
export const lengthOf = (s: Setup): number =>
  Number((s.radius * (s.shape === "spheroid" ? 1 + s.elongation / 2 : s.elongation)).toPrecision(12));

/** Largest height of the centre of mass with the body on the plane, in m. */
export const reachOf = (s: Setup): number => s.radius * (1 + s.elongation / 2);

/** Normal speed of the first impact, about, in m/s. */
export const fallSpeed = (s: Setup): number =>
  Math.sqrt(2 * s.gravity * Math.cos(s.incline) * Math.max(s.release_height - s.radius, 0) + s.velocity_z ** 2);

/** Which parameters a law has. */
export const LAW_PARAMETERS: Record<Setup["law"], readonly Key[]> = {
  "tangential-restitution": ["normal", "tangential"],
  frictionless: ["normal"],
  coulomb: ["normal", "friction", "hypothesis"],
  "chatterjee-ruina": ["normal", "tangential", "friction"],
};

/** Whether a parameter has a meaning in this set-up. */
export function applies(key: Key, s: Setup): boolean {
  if (["normal", "tangential", "friction", "hypothesis"].includes(key)) return LAW_PARAMETERS[s.law].includes(key);
  if (key === "angle") return s.orientation === "given";
  if (key === "particles") return s.orientation !== "given";
  return true;
}
