/** The outline of a body, as the core has it: crates/web/src/lib.rs. Lengths in m, from the centre of mass. */

import { Quaternion, Vector3 } from "three";
import { numbers } from "./engine/layout";
import type { Engine } from "./engine/module";
import type { Surface } from "./rigid";
import { bodyOf, isRigid, type Setup } from "./setup";
import type { Flight, Turn } from "./stage/path";
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

/** A rigid body: its outline is the least and the largest distance of a tangent plane from the centre of mass. */
interface Free extends Outline {
  /** Principal moments, and the rotation from the principal axes: what its rotation follows from. */
  rotor: number[];
  centre: Vector3;
  /** Balls or vertices that can touch, in the order of their numbers, from the centre of mass; none of a smooth body. */
  balls: { place: Vector3; radius: number }[];
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

const free = new WeakMap<Setup, Free>();
/** The outline of a rigid body. A set-up is never changed once it is on the page. */
export function freeOf(setup: Setup): Free {
  const found = free.get(setup) ?? ofRigid(setup);
  free.set(setup, found);
  return found;
}

/** Directions that look every way, about alike. */
const DIRECTIONS = Array.from({ length: 200 }, (_, k) => {
  const [z, azimuth] = [1 - (2 * k + 1) / 200, k * Math.PI * (3 - Math.sqrt(5))];
  const across = Math.sqrt(1 - z * z);
  return new Vector3(across * Math.cos(azimuth), across * Math.sin(azimuth), z);
});

function ofRigid(setup: Setup): Free {
  const row = drawn(setup, numbers(setup));
  const [centre, reach] = [new Vector3(row[7], row[8], row[9]), row[10]];
  const balls = Array.from({ length: (row.length - 11) / 4 }, (_, k) => {
    const at = 11 + 4 * k;
    return { place: new Vector3(row[at], row[at + 1], row[at + 2]).sub(centre), radius: row[at + 3] };
  });
  const supports = balls.length
    ? DIRECTIONS.map((direction) => balls.reduce((most, { place, radius }) => Math.max(most, place.dot(direction) + radius), 0))
    : farthestOf(setup, DIRECTIONS).map((place, k) => place.dot(DIRECTIONS[k]));
  const size = Math.min(...supports);
  const arc = (from: number): Arc => ({ centre: 0, along: size, across: size, from, to: from + Math.PI / 2 });
  return { arcs: [arc(0), arc(Math.PI / 2)], size, length: 2 * reach, reach, rotor: [...row.subarray(0, 7)], centre, balls };
}

/** The places of a rigid body that lie farthest in these directions, unit vectors, from its centre of mass. */
export function farthestOf(setup: Setup, directions: Vector3[]): Vector3[] {
  const found = engine.farthest(numbers(setup), Float64Array.from(directions.flatMap((direction) => direction.toArray())));
  return directions.map((_, k) => new Vector3().fromArray(found, 3 * k));
}

/** How a rigid body turns. */
export const freely = (setup: Setup): Turn | undefined => (isRigid(setup) ? turnOf(freeOf(setup).rotor) : undefined);

/** How a body turns with these principal moments and the rotation from its principal axes. */
export function turnOf(rotor: readonly number[]): Turn {
  return ({ w, x, y, z }, spin, time) => {
    const found = engine.turn(Float64Array.of(...rotor, w, x, y, z, spin.x, spin.y, spin.z, time));
    return { attitude: new Quaternion(found[1], found[2], found[3], found[0]), spin: new Vector3(found[4], found[5], found[6]) };
  };
}

/** Rows of so many numbers. */
const rows = (numbers: Float64Array, width: number): number[][] => Array.from({ length: numbers.length / width }, (_, k) => [...numbers.subarray(width * k, width * (k + 1))]);

/** What there is to draw of a rigid body, in m: a surface of triangles, or the profile (z, r) of a solid of revolution; else nothing. */
export function drawingOf(setup: Setup): { surface?: Surface; profile?: number[][] } {
  const [count = 0, ...found] = engine.drawing(numbers(setup));
  const all = Float64Array.from(found);
  if (count < 0) return { profile: rows(all, 2) };
  return count > 0 ? { surface: { points: rows(all.subarray(0, count), 3), triangles: rows(all.subarray(count), 3) } } : {};
}

/** Why the core refuses the body of a set-up, or "". */
export function refusal(setup: Setup): string {
  try {
    if (engine) engine.outline(numbers(setup));
    return "";
  } catch (error) {
    return (error as Error).message;
  }
}

export function outlineOf(setup: Setup): Outline {
  if (isRigid(setup)) return freeOf(setup);
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
    const radius = Number(setup[sizeOf(bodyOf(setup)) ?? "radius"]);
    if (isRigid(setup)) return Float64Array.of(1, 1, 1, 1, 0, 0, 0, 0, 0, 0, radius, 0, 0, 0, radius);
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

/** The same of any body, at the beginning of a flight, after its impact. */
export const armOf = (setup: Setup, { axis, arm, sphere }: Flight): Vector3 => (isRigid(setup) ? arm.clone() : contactArm(setup, axis, sphere));
