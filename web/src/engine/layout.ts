/** A run as the row of numbers that crates/web/src/parameters.rs reads; behind it the arguments of a rigid body: crates/web/src/rigid.rs. */

import { dataOf } from "../rigid";
import { bodyOf, isRigid, lawOf, MEETINGS, orientationOf, particlesOf, sideOf, type Setup } from "../setup";
import { BODIES, LAWS, SHAPES, type Kind } from "../table";

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

/** As many places for the parameters of a body, and of a law beside its normal coefficient, as one has. */
const most = (kinds: readonly Kind[]) => Math.max(...kinds.map(({ parameters }) => parameters.length));
const [OF_BODY, OF_LAW] = [most(BODIES), most(LAWS)];

export function numbers(s: Setup): Float64Array {
  const [body, law] = [bodyOf(s), lawOf(s)];
  const row = [
    ...[SHAPES.indexOf(body), ...(isRigid(s) ? Array<number>(OF_BODY).fill(0) : filled(body, s, OF_BODY))],
    ...[LAWS.indexOf(law as (typeof LAWS)[number]), ...filled(law, s, OF_LAW)],
    ...[particlesOf(s), s.impacts, s.release_height, s.gravity],
    ...[["uniform-angle", "isotropic", "given"].indexOf(orientationOf(s)), s.angle],
    ...[0, s.spin_y, s.spin_z, s.velocity_x, 0, s.velocity_z, s.incline, s.minimum_speed],
    ...[Math.floor(s.seed / 2 ** 32), s.seed % 2 ** 32],
  ];
  return Float64Array.from(isRigid(s) ? row.concat(dataOf(s)) : row);
}

/** The same, and behind it how two bodies meet: crates/web/src/pair.rs. */
export const pairNumbers = (s: Setup): Float64Array =>
  Float64Array.of(...numbers(s), MEETINGS.indexOf(s.meeting), s.thermal_speed, s.temperature_ratio, s.relative_speed, s.impact_parameter, s.spin_1, s.spin_2);

/** The same, and behind it a step of a gas: crates/web/src/gas.rs. */
export const gasNumbers = (s: Setup, collisions: number, step: number): Float64Array =>
  Float64Array.of(...numbers(s), s.grains, s.thermal_speed, s.temperature_ratio, sideOf(s), collisions, step);

/** A name is given as its number. */
function filled({ parameters }: Kind, s: Setup, length: number): number[] {
  const given = parameters.map(({ name, names }) => (names ? names.indexOf(String(s[name])) : Number(s[name])));
  return Object.assign(Array<number>(length).fill(0), given);
}
