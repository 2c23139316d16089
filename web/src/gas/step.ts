/** A step of a gas, from the table of the core: crates/web/src/gas.rs. */

import { turnOf } from "../outline";
import type { Turn } from "../stage/path";

/** Columns before the two looks at a gas, of a look, and of a particle: crates/web/src/gas.rs. */
const [ROTOR, LOOK] = [8, 5];
export const STATE = 10;

/** A step of a gas; temperatures in J. */
export interface Step {
  /** At its beginning and its end. */
  looks: { time: number; collisions: number; contacts: number; translational: number; rotational: number }[];
  /** A row of velocity, ω and attitude (w, x, y, z) of each particle at the end. */
  states: Float64Array;
  count: number;
  /** The largest distance of the surface of a body from its centre of mass, and how it turns. */
  reach: number;
  turn: Turn;
}

export function stepOf(table: Float64Array): Step {
  const [reach, ...rotor] = table.subarray(0, ROTOR);
  const looks = [0, 1].map((k) => {
    const [time, collisions, contacts, translational, rotational] = table.subarray(ROTOR + LOOK * k, ROTOR + LOOK * (k + 1));
    return { time, collisions, contacts, translational, rotational };
  });
  const states = table.slice(ROTOR + 2 * LOOK);
  return { looks, states, reach, turn: turnOf(rotor), count: states.length / STATE };
}
