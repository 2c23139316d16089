/** A run as the row of numbers that crates/web/src/parameters.rs reads. */

import { DENSITY, HYPOTHESES, LAWS, LAW_PARAMETERS, lengthOf, particlesOf, type Setup } from "../setup";

/** Columns of the table of impacts, as in crates/web/src/records.rs. */
export const COLUMNS = [
  "time",
  "impact_velocity",
  "rebound_velocity",
  "restitution",
  "rotational_fraction",
  "energy_ratio",
  "angle",
  "contact",
] as const;
export type Column = (typeof COLUMNS)[number];

/** Bodies and laws in the order of the core's tables, under the names of a set-up. */
export const BODIES = ["dumbbell", "loaded-sphere", "spherocylinder", "spheroid"] as const;
/** Places for the parameters of a body, and of a law beside its normal coefficient. */
const OF_BODY = 4;
const OF_LAW = 2;

export function numbers(s: Setup): Float64Array {
  const [normal, ...rest] = LAW_PARAMETERS[s.law];
  const body = [s.radius, lengthOf(s), DENSITY];
  const law = rest.map((key) => (key === "hypothesis" ? HYPOTHESES.indexOf(s.hypothesis) : (s[key] as number)));
  const row = [
    ...[BODIES.indexOf(s.shape), ...filled(body, OF_BODY)],
    ...[LAWS.indexOf(s.law), s[normal as "normal"], ...filled(law, OF_LAW)],
    ...[particlesOf(s), s.impacts, s.release_height, s.gravity],
    ...[["uniform-angle", "isotropic", "given"].indexOf(s.orientation), s.angle],
    ...[0, s.spin_y, s.spin_z, s.velocity_x, 0, s.velocity_z, s.incline, s.minimum_speed],
    ...[Math.floor(s.seed / 2 ** 32), s.seed % 2 ** 32],
  ];
  return Float64Array.from(row);
}

const filled = (numbers: number[], length: number): number[] => Object.assign(Array<number>(length).fill(0), numbers);
