/** A run as the row of numbers that crates/web/src/parameters.rs reads. */

import { DENSITY, HYPOTHESES, LAWS, SHAPES, lengthOf, particlesOf, type Setup } from "../setup";

export const PARAMETERS = 28;
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

export function numbers(s: Setup): Float64Array {
  const row = new Float64Array(PARAMETERS);
  row.set([SHAPES.indexOf(s.shape), s.radius, lengthOf(s), DENSITY], 0);
  row.set([LAWS.indexOf(s.law), s.normal, s.tangential, s.friction, HYPOTHESES.indexOf(s.hypothesis)], 4);
  row.set([particlesOf(s), s.impacts, s.release_height, s.gravity], 10);
  row.set([["uniform-angle", "isotropic", "given"].indexOf(s.orientation), s.angle], 14);
  row.set([0, s.spin_y, s.spin_z, s.velocity_x, 0, s.velocity_z, s.incline, s.minimum_speed], 16);
  row.set([Math.floor(s.seed / 2 ** 32), s.seed % 2 ** 32], 24);
  return row;
}
