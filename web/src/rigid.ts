/** Bodies without an axis: the numbers that the core takes, crates/web/src/rigid.rs, and the arguments of the package. */

import { Vector3 } from "three";
import { ConvexHull } from "three/addons/math/ConvexHull.js";
import type { Setup } from "./setup";

export type Triple = [number, number, number];
export interface Surface {
  points: number[][];
  triangles: number[][];
}

/** Most spheres of a clump, and triangles of a mesh, on this page. */
export const MOST = { spheres: 1000, triangles: 20_000 };

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

/** The rows of a table, or of the two of a mesh. They are asked for at every picture, and seldom change. */
const kept = new Map<string, { spheres: number[][]; mesh: Surface; hull: number[] | undefined }>();
function tableOf(text: string) {
  let found = kept.get(text);
  if (!found) {
    const [points, triangles = ""] = text.split("*");
    found = { spheres: read(points, 4), mesh: { points: read(points, 3), triangles: read(triangles, 3) }, hull: undefined };
    if (kept.size > 7) kept.delete(kept.keys().next().value!);
    kept.set(text, found);
  }
  return found;
}
export const spheresOf = (s: Setup): number[][] => tableOf(String(s.spheres)).spheres;

/** Numbers of the vertices of the convex hull, in order. */
function hullOf(text: string): number[] {
  const found = tableOf(text);
  if (!found.hull) {
    const places = found.mesh.points.map(([x, y, z]) => new Vector3(x, y, z));
    const numbers = new Map(places.map((place, k) => [place, k]));
    const touched = new Set<number>();
    for (const { edge } of new ConvexHull().setFromPoints(places).faces) {
      for (let at = edge, k = 0; k < 3; k++, at = at.next) touched.add(numbers.get(at.head().point)!);
    }
    found.hull = [...touched].sort((a, b) => a - b);
  }
  return found.hull;
}

/** The surface of a polyhedron or a mesh, in m. */
export function surfaceOf(s: Setup): Surface | undefined {
  if (s.shape === "mesh") return tableOf(String(s.mesh)).mesh;
  if (s.shape === "box") {
    const half = three(s, "edge_").map((edge) => 0.5 * edge);
    return { points: CUBE.map((corner) => corner.map((sign, k) => sign * half[k])), triangles: BOX };
  }
  if (s.shape !== "die") return undefined;
  const [edge, points, triangles] = DICE[s.faces];
  const scale = Number(s.edge) / edge;
  return { points: points.map((point) => point.map((x) => scale * x)), triangles };
}

export const semiAxesOf = (s: Setup): number[] => three(s, "axis_");

/** The body as numbers. */
export function dataOf(s: Setup): number[] {
  const surface = surfaceOf(s);
  if (surface) {
    const hull = s.shape === "mesh" ? hullOf(String(s.mesh)) : [];
    const { points, triangles } = surface;
    return [0, s.density as number, points.length, triangles.length, hull.length, ...points.flat(), ...triangles.flat(), ...hull];
  }
  const of: Record<string, () => number[]> = {
    clump: () => [1, ...spheresOf(s).flat()],
    ellipsoid: () => [2, ...semiAxesOf(s)],
    "rough-sphere": () => [3, ...[s.radius, s.asperities, s.asperity_radius, s.asperity_seed].map(Number)],
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
    clump: () => [["spheres", table(spheresOf(s))]],
    "rough-sphere": () => [number("radius"), whole("asperities"), number("asperity_radius"), whole("seed", "asperity_seed")],
    mesh: () => [["vertices", table(surfaceOf(s)!.points)], ["triangles", table(surfaceOf(s)!.triangles, String)]],
  };
  return [...of[s.shape](), number("density")];
}

/** Why a table of this name cannot be, or "". */
export function wrongTable(name: string, text: string): string {
  const { spheres, mesh } = tableOf(text);
  const whole = (all: number[][], width: number) => all.every((row) => row.length === width && row.every(Number.isFinite));
  if (name === "spheres") {
    const fits = spheres.length > 0 && spheres.length <= MOST.spheres && whole(spheres, 4) && spheres.every(([, , , r]) => r > 0);
    return fits ? "" : `spheres: must be 1 to ${MOST.spheres} rows x, y, z, r of finite numbers, r > 0`;
  }
  const { points, triangles } = mesh;
  if (!whole(points, 3) || !whole(triangles, 3) || triangles.length > MOST.triangles) return `mesh: must be vertices x, y, z and at most ${MOST.triangles} triangles of finite numbers`;
  if (!triangles.flat().every((k) => Number.isInteger(k) && k >= 0 && k < points.length)) return "mesh: must have triangles of its vertices";
  return openEdge(mesh) || (volumeOf(mesh) > 0 ? "" : "mesh: encloses no volume; its triangles must be counter-clockwise as seen from outside");
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
