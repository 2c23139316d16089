/** The outline of a body, as the core has it: crates/web/src/lib.rs. Lengths in m, from the centre of mass. */

import type { Vector3 } from "three";
import { numbers } from "./engine/layout";
import type { Engine } from "./engine/module";
import { bodyOf, type Setup } from "./setup";
import { sizeOf } from "./table";

/** An arc about a point of the axis: the places centre + along cos t on the axis and across sin t beside it, t from `from` to `to`. */
export interface Arc {
  centre: number;
  along: number;
  across: number;
  from: number;
  to: number;
}

export interface Outline {
  /** At the end to which the axis points, and at the other; a straight line joins them. */
  arcs: [Arc, Arc];
  /** The largest distance of its surface from the axis. */
  size: number;
  /** Along the axis. */
  length: number;
  /** The largest distance of its surface from the centre of mass. */
  reach: number;
}

/** Points of an arc. */
const POINTS = 32;

let engine: Engine;
export function drawWith(core: Engine): void {
  engine = core;
}

const known = new Map<string, Outline>();
/** How many of them are kept: more than are on the page at once, less than a slider passes. */
const KEPT = 16;

export function outlineOf(setup: Setup): Outline {
  const row = numbers(setup);
  const key = row.slice(0, 5).join();
  const found = known.get(key) ?? made(drawn(setup, row));
  known.delete(key);
  known.set(key, found); // behind all others, so that the first is that which was not asked for the longest
  if (known.size > KEPT) known.delete(known.keys().next().value!);
  return found;
}

/** A sphere where the engine refuses the body, which the run says. */
function drawn(setup: Setup, row: Float64Array): Float64Array {
  try {
    return engine.outline(row);
  } catch {
    const radius = Number(setup[sizeOf(bodyOf(setup))]);
    return Float64Array.of(0, radius, radius, 0, Math.PI / 2, 0, radius, radius, Math.PI / 2, Math.PI);
  }
}

/** Normal speed of the first impact, about, in m/s. */
export const fallSpeed = (s: Setup): number =>
  Math.sqrt(2 * s.gravity * Math.cos(s.incline) * Math.max(s.release_height - outlineOf(s).size, 0) + s.velocity_z ** 2);

function made(row: Float64Array): Outline {
  const arc = (k: number): Arc => ({ centre: row[k], along: row[k + 1], across: row[k + 2], from: row[k + 3], to: row[k + 4] });
  const arcs: [Arc, Arc] = [arc(0), arc(5)];
  const points = arcs.flatMap(pointsOf);
  const places = points.map(([z]) => z);
  return {
    arcs,
    size: Math.max(...points.map(([, r]) => r)),
    length: Math.max(...places) - Math.min(...places),
    reach: Math.max(...points.map(([z, r]) => Math.hypot(z, r))),
  };
}

/** Places on the axis and beside it. */
export function pointsOf({ centre, along, across, from, to }: Arc): [number, number][] {
  return Array.from({ length: POINTS + 1 }, (_, k) => {
    const t = from + ((to - from) * k) / POINTS;
    return [centre + along * Math.cos(t), across * Math.sin(t)];
  });
}

/** From the centre of mass to the point that touches, in m, where the axis points along `axis` and this end touches: (6). */
export function contactArm(setup: Setup, axis: Vector3, end: number): Vector3 {
  const { centre, along, across } = outlineOf(setup).arcs[end === 1 ? 0 : 1];
  // The lowest point of an ellipsoid with the matrix Q = a²I + (c² − a²)ee: −Qn/√(n·Qn).
  const q = axis.clone().multiplyScalar((along * along - across * across) * axis.z);
  q.z += across * across;
  return q.multiplyScalar(-1 / Math.sqrt(q.z)).addScaledVector(axis, centre);
}
