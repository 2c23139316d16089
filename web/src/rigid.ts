/** Bodies without an axis: the numbers that the core takes, crates/web/src/rigid.rs, and the arguments of the package. */

import { Vector3 } from "three";
import { ConvexHull } from "three/addons/math/ConvexHull.js";
import type { Setup } from "./setup";
import { LISTS } from "./table";

export type Triple = [number, number, number];
export interface Surface {
  points: number[][];
  triangles: number[][];
}

/** Most rows of a table, and triangles of a mesh, on this page. */
const MOST = { rows: 1000, triangles: 20_000 };
/** As those of the package: python/restitution/bodies/_polyhedra.py. */
const [COPLANAR, COLLINEAR] = [1e-12, 1e-14];

const SIGNS = [-1, 1];
const CUBE = SIGNS.flatMap((x) => SIGNS.flatMap((y) => SIGNS.map((z) => [x, y, z])));
const GOLDEN = 0.5 * (1 + Math.sqrt(5));
/** (0, ±x, ±y) and what follows by shifting the axes round. */
const cyclic = (x: number, y: number) =>
  [0, 1, 2].flatMap((shift) => SIGNS.flatMap((a) => SIGNS.map((b) => [0, 1, 2].map((k) => [0, a * x, b * y][(k - shift + 3) % 3]))));
const triplets = (text: string) => text.split(" ").map((corners) => [...corners].map((letter) => parseInt(letter, 36)));

const BOX = triplets("013 032 457 476 015 054 237 276 026 064 137 175");
/** Length of an edge, vertices about the centre and triangles, as the package has them: the order of the triangles is that of its sums. */
const DICE: Record<string, [number, number[][], number[][]]> = {
  4: [Math.sqrt(8), CUBE.filter(([x, y, z]) => x * y * z > 0), triplets("120 320 310 312")],
  6: [2, CUBE, triplets("620 640 540 510 564 567 320 310 362 367 351 357")],
  8: [Math.sqrt(2), [[-1, 0, 0], [0, -1, 0], [0, 0, -1], [0, 0, 1], [0, 1, 0], [1, 0, 0]], triplets("210 215 310 315 425 420 435 430")],
  12: [2 / GOLDEN, [...CUBE, ...cyclic(1 / GOLDEN, GOLDEN)], triplets("i59 i1g i19 20c 208 2a8 e1g e0c e0g e3h e2c e2h 408 40g 4ig 4a8 46d 46a f4i fi5 f4d b19 be1 be3 b59 bf7 bf5 j2a j6a j2h j6d jfd jf7 j3h jb7 jb3")],
  20: [2, cyclic(1, GOLDEN), triplets("084 694 684 b75 a05 a75 a08 204 294 205 2b9 2b5 3b9 369 3b7 1a8 168 1a7 136 137")],
};

const three = (s: Setup, name: string): number[] => ["x", "y", "z"].map((of) => Number(s[name + of]));
const rows = (numbers: number[], width: number): number[][] =>
  Array.from({ length: Math.ceil(numbers.length / width) }, (_, k) => numbers.slice(width * k, width * (k + 1)));
const read = (text: string, width: number) => rows(text === "" ? [] : text.split("_").map((x) => (x === "" ? NaN : Number(x))), width);

/** A table, or the two of a mesh. They are asked for at every picture, and seldom change. */
interface Table {
  rows: number[][];
  triangles: number[][];
  /** What was found of its convex hull. */
  hull?: number[];
  faces?: number[][];
}
const kept = new Map<string, Table>();
function tableOf(name: string, text: string): Table {
  const key = `${name} ${text}`;
  let found = kept.get(key);
  if (!found) {
    const [points, triangles = ""] = text.split("*");
    found = { rows: read(points, LISTS[name]?.columns.length ?? 3), triangles: read(triangles, 3) };
    if (kept.size > 7) kept.delete(kept.keys().next().value!);
    kept.set(key, found);
  }
  return found;
}
/** The rows of the table with this name. */
export const rowsOf = (s: Setup, name: string): number[][] => tableOf(name, String(s[name])).rows;

/** Points and the triangles of their convex hull, of which those on a line have none. */
function hullFaces(points: number[][]) {
  const places = points.map(([x, y, z]) => new Vector3(x, y, z));
  try {
    return { places, faces: new ConvexHull().setFromPoints(places).faces };
  } catch {
    return { places, faces: [] };
  }
}

/** Numbers of the vertices of the convex hull, in order. */
function hullOf(mesh: Table): number[] {
  if (!mesh.hull) {
    const { places, faces } = hullFaces(mesh.rows);
    const numbers = new Map(places.map((place, k) => [place, k]));
    const touched = new Set<number>();
    for (const { edge } of faces) {
      for (let at = edge, k = 0; k < 3; k++, at = at.next) touched.add(numbers.get(at.head().point)!);
    }
    mesh.hull = [...touched].sort((a, b) => a - b);
  }
  return mesh.hull;
}

/** The faces of a convex hull in triangles, which do not depend on how it was found: fans from the first corner of each, in order. */
function trianglesOf(polyhedron: Table): number[][] {
  if (!polyhedron.faces) {
    const { rows } = polyhedron;
    const size = Math.max(...[0, 1, 2].map((k) => Math.max(...rows.map((row) => row[k])) - Math.min(...rows.map((row) => row[k])))) || 1;
    const { places, faces } = hullFaces(rows.map((row) => row.map((x, k) => (x - rows[0][k]) / size)));
    // Of points at the same place the first counts.
    const first = new Map(places.map((place, k) => [place.toArray().join(), k] as const).reverse());
    const free = new Map(faces.map((of) => {
      const edges = [of.edge, of.edge.next, of.edge.prev];
      const corners = edges.map((edge) => edge.head().point);
      const normal = corners[1].clone().sub(corners[0]).cross(corners[2].clone().sub(corners[0]));
      return [of, { corners, normal, near: edges.map((edge) => edge.twin.face) }];
    }));
    const found: number[][] = [];
    for (const [seed, { corners, normal }] of [...free].sort(([, a], [, b]) => b.normal.length() - a.normal.length())) {
      if (!free.has(seed) || normal.length() === 0) continue;
      const up = normal.clone().normalize();
      const isFlat = (one: { corners: Vector3[]; normal: Vector3 }) =>
        one.corners.every((corner) => Math.abs(corner.clone().sub(corners[0]).dot(up)) < COPLANAR) && one.normal.dot(up) > -COPLANAR;
      const face = [free.get(seed)!];
      free.delete(seed);
      for (const { near } of face) {
        for (const next of near) {
          const one = free.get(next);
          if (one && isFlat(one) && free.delete(next)) face.push(one);
        }
      }
      found.push(...fan(places, up, face.map((one) => one.corners.map((corner) => first.get(corner.toArray().join())!))));
    }
    polyhedron.faces = found.sort((a, b) => a[0] - b[0] || a[1] - b[1] || a[2] - b[2]);
  }
  return polyhedron.faces;
}

/** A face, given as any triangles of it, cut anew. */
function fan(places: Vector3[], up: Vector3, face: number[][]): number[][] {
  const edges = face.flatMap(([x, y, z]) => [[x, y], [y, z], [z, x]]);
  const there = new Set(edges.map((edge) => edge.join()));
  const after = new Map(edges.filter(([a, b]) => !there.has([b, a].join())).map(([a, b]) => [a, b]));
  // Or a needle so thin that all of it is one face.
  if (face.length === 1 || !after.size) return face.map((corners) => [...corners].sort((a, b) => a - b));
  const around = [Math.min(...after.keys())];
  while (around.length < after.size) around.push(after.get(around.at(-1)!)!);
  const side = (from: number, to: number) => places[to].clone().sub(places[from]);
  const kept = around.filter((corner, k) => side(around.at(k - 1)!, corner).cross(side(corner, around[(k + 1) % around.length])).dot(up) > COLLINEAR);
  const least = kept.indexOf(Math.min(...kept));
  const [corner, ...others] = [...kept.slice(least), ...kept.slice(0, least)];
  return others.slice(1).map((last, k) => [corner, others[k], last].sort((a, b) => a - b));
}

/** The surface of a polyhedron or a mesh, in m. */
export function surfaceOf(s: Setup): Surface | undefined {
  const table = (name: string) => tableOf(name, String(s[name]));
  if (s.shape === "mesh") return { points: table("mesh").rows, triangles: table("mesh").triangles };
  if (s.shape === "convex-polyhedron") return { points: table("points").rows, triangles: trianglesOf(table("points")) };
  if (s.shape === "box") {
    const half = three(s, "edge_").map((edge) => 0.5 * edge);
    return { points: CUBE.map((corner) => corner.map((sign, k) => sign * half[k])), triangles: BOX };
  }
  if (s.shape !== "die") return undefined;
  const [edge, points, triangles] = DICE[s.faces];
  const scale = Number(s.edge) / edge;
  return { points: points.map((point) => point.map((x) => scale * x)), triangles };
}

/** The profile (z, r) of a solid of revolution, in m. */
export function profileOf(s: Setup): number[][] | undefined {
  if (s.shape === "revolution") return rowsOf(s, "profile");
  if (s.shape === "cylinder") return [-0.5, 0.5].map((half) => [half * Number(s.height), Number(s.radius)]);
  if (s.shape !== "ring") return undefined;
  const [outer, inner, half] = [Number(s.outer), Number(s.inner), 0.5 * Number(s.ring_height)];
  return [[-half, inner], [-half, outer], [half, outer], [half, inner], [-half, inner]];
}

const semiAxesOf = (s: Setup): number[] => three(s, "axis_");
const several = (s: Setup, ...names: string[]) => names.map((name) => Number(s[name]));

/** The body as numbers. */
export function dataOf(s: Setup): number[] {
  const surface = surfaceOf(s);
  if (surface) {
    const hull = s.shape === "mesh" ? hullOf(tableOf("mesh", String(s.mesh))) : [];
    const { points, triangles } = surface;
    return [0, s.density as number, points.length, triangles.length, hull.length, ...points.flat(), ...triangles.flat(), ...hull];
  }
  const of: Record<string, () => number[]> = {
    clump: () => [1, ...rowsOf(s, "spheres").flat()],
    ellipsoid: () => [2, ...semiAxesOf(s)],
    "rough-sphere": () => [3, ...several(s, "radius", "asperities", "asperity_radius", "asperity_seed")],
    superellipsoid: () => [4, ...semiAxesOf(s), ...several(s, "exponent_1", "exponent_2")],
    ring: () => [5, ...several(s, "outer", "inner", "ring_height")],
    egg: () => [6, ...several(s, "length", "width", "blunt_end", "tip")],
    cylinder: () => [7, ...profileOf(s)!.flat()],
    revolution: () => [7, ...profileOf(s)!.flat()],
  };
  const [kind, ...rest] = of[s.shape]();
  return [kind, s.density as number, ...rest];
}

/** As Python and TOML write a float. */
export function float(x: number): string {
  const text = String(x);
  return Number.isInteger(x) && !text.includes("e") ? `${text}.0` : text;
}

/** The arguments of the body in the package; lists are those of Python and of TOML. */
export function argumentsOf(s: Setup): [string, string][] {
  const list = (row: number[], write = float) => `[${row.map(write).join(", ")}]`;
  const table = (all: number[][], write = float) => `[${all.map((row) => list(row, write)).join(", ")}]`;
  const number = (name: string, from = name): [string, string] => [name, float(Number(s[from]))];
  const whole = (name: string, from = name): [string, string] => [name, String(s[from])];
  const of: Record<string, () => [string, string][]> = {
    ellipsoid: () => [["semi_axes", list(semiAxesOf(s))]],
    box: () => [number("a", "edge_x"), number("b", "edge_y"), number("c", "edge_z")],
    die: () => [whole("faces"), number("edge")],
    superellipsoid: () => [["semi_axes", list(semiAxesOf(s))], ["exponents", list(several(s, "exponent_1", "exponent_2"))]],
    "convex-polyhedron": () => [["points", table(rowsOf(s, "points"))]],
    cylinder: () => [number("radius"), number("height")],
    ring: () => [number("outer"), number("inner"), number("height", "ring_height")],
    egg: () => [number("length"), number("width"), number("blunt_end"), number("tip")],
    revolution: () => [["profile", table(rowsOf(s, "profile"))]],
    clump: () => [["spheres", table(rowsOf(s, "spheres"))]],
    "rough-sphere": () => [number("radius"), whole("asperities"), number("asperity_radius"), whole("seed", "asperity_seed")],
    mesh: () => [["vertices", table(surfaceOf(s)!.points)], ["triangles", table(surfaceOf(s)!.triangles, String)]],
  };
  return [...of[s.shape](), number("density")];
}

/** Why a table of this name cannot be, or "". */
export function wrongTable(name: string, text: string): string {
  const { rows, triangles } = tableOf(name, text);
  const whole = (all: number[][], width: number) => all.every((row) => row.length === width && row.every(Number.isFinite));
  const list = LISTS[name];
  if (list) {
    const { columns, least, rule } = list;
    const fits = rows.length >= least && rows.length <= MOST.rows && whole(rows, columns.length) && rows.every((row) => list.fits(row.at(-1)!));
    if (!fits) return `${name}: must be ${least} to ${MOST.rows} rows ${columns.join(", ")} of finite numbers${rule}`;
    return name === "profile" ? crossing(rows) : "";
  }
  const mesh = { points: rows, triangles };
  if (!whole(rows, 3) || !whole(triangles, 3) || triangles.length > MOST.triangles) return `mesh: must be vertices x, y, z and at most ${MOST.triangles} triangles of finite numbers`;
  if (!triangles.flat().every((k) => Number.isInteger(k) && k >= 0 && k < rows.length)) return "mesh: must have triangles of its vertices";
  return openEdge(mesh) || (volumeOf(mesh) > 0 ? "" : "mesh: encloses no volume; its triangles must be counter-clockwise as seen from outside");
}

/** Where lines of a profile cross, or "". */
function crossing(profile: number[][]): string {
  const side = ([x, y]: number[], [p, q]: number[], [u, v]: number[]) => Math.sign((p - x) * (v - y) - (q - y) * (u - x));
  for (let i = 1; i < profile.length; i++) {
    for (let j = 1; j < i; j++) {
      const [a, b, c, d] = [profile[i - 1], profile[i], profile[j - 1], profile[j]];
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return `profile: its lines from the points ${j} and ${i} cross`;
    }
  }
  return "";
}

/** Where a surface ends or turns its inside out, or "". */
function openEdge({ points, triangles }: Surface): string {
  const balance = new Map<string, number>();
  for (const corners of triangles) {
    corners.forEach((from, k) => {
      const to = corners[(k + 1) % 3];
      if (from === to) return;
      const key = `${Math.min(from, to)} ${Math.max(from, to)}`;
      balance.set(key, (balance.get(key) ?? 0) + (from < to ? 1 : -1));
    });
  }
  const open = [...balance].filter(([, sum]) => sum !== 0).map(([key]) => key.split(" ").map((k) => `(${points[Number(k)].join(", ")})`));
  return open.length ? `mesh: not closed, or not oriented, at ${open.length} edges, of which the first is from ${open[0].join(" to ")}` : "";
}

function volumeOf({ points, triangles }: Surface): number {
  const [x, y, z] = points[0] ?? [0, 0, 0];
  const from = new Vector3(x, y, z);
  const corner = (k: number) => new Vector3(...(points[k] as Triple)).sub(from);
  return triangles.reduce((sum, [a, b, c]) => sum + corner(a).dot(corner(b).cross(corner(c))) / 6, 0);
}
