/** Rigid bodies: the numbers that the core takes, crates/web/src/rigid.rs, and the arguments of the package. */

import { refusal } from "./outline";
import { bodyOf, DEFAULT, type Setup } from "./setup";
import { LISTS, SHAPES, type Described } from "./table";

export interface Surface {
  points: number[][];
  triangles: number[][];
}

/** Most rows of a table, and triangles of a mesh, on this page. */
const MOST = { rows: 1000, triangles: 20_000 };

const rows = (numbers: number[], width: number): number[][] =>
  Array.from({ length: Math.ceil(numbers.length / width) }, (_, k) => numbers.slice(width * k, width * (k + 1)));
const read = (text: string, width: number) => rows(text === "" ? [] : text.split("_").map((x) => (x === "" ? NaN : Number(x))), width);

/** A table, or the two of a mesh. They are asked for at every picture, and seldom change. */
const kept = new Map<string, Surface>();
function tableOf(name: string, text: string): Surface {
  const key = `${name} ${text}`;
  let found = kept.get(key);
  if (!found) {
    const [points, triangles = ""] = text.split("*");
    found = { points: read(points, LISTS[name]?.columns.length ?? 3), triangles: read(triangles, 3) };
    if (kept.size > 7) kept.delete(kept.keys().next().value!);
    kept.set(key, found);
  }
  return found;
}
/** The rows of the table with this name. */
export const rowsOf = (s: Setup, name: string): number[][] => tableOf(name, String(s[name])).points;
export const meshOf = (s: Setup): Surface => tableOf("mesh", String(s.mesh));

/** The rows of a parameter that is a table. */
function tableIn(s: Setup, { name, link }: Described): number[][] {
  if (name === "triangles") return meshOf(s).triangles;
  return name === "vertices" ? meshOf(s).points : rowsOf(s, link);
}

/** The body as numbers. */
export function dataOf(s: Setup): number[] {
  const body = bodyOf(s);
  const argument = (one: Described): number[] => {
    if (one.parts) return one.parts.map(([name]) => Number(s[name]));
    if (one.names) return [one.names.indexOf(String(s[one.link]))];
    if (!one.columns) return [Number(s[one.link])];
    const all = tableIn(s, one).flat();
    return [all.length, ...all];
  };
  return [SHAPES.indexOf(body), ...body.described.flatMap(argument)];
}

/** As Python and TOML write a float. */
export function float(x: number): string {
  const text = String(x);
  return Number.isInteger(x) && !text.includes("e") ? `${text}.0` : text;
}

/** The arguments of the body in the package; lists are those of Python and of TOML. */
export function argumentsOf(s: Setup): [string, string][] {
  const list = (row: number[], write = float) => `[${row.map(write).join(", ")}]`;
  const argument = (one: Described): string => {
    if (one.parts) return list(one.parts.map(([name]) => Number(s[name])));
    if (one.columns) return `[${tableIn(s, one).map((row) => list(row, one.unit ? float : String)).join(", ")}]`;
    return one.type === "whole" || one.type === "choice" ? String(s[one.link]) : float(Number(s[one.link]));
  };
  return bodyOf(s).described.map((one) => [one.name, argument(one)]);
}

/** Why a table of this name cannot be, or "". */
export function wrongTable(name: string, text: string): string {
  const { points, triangles } = tableOf(name, text);
  const whole = (all: number[][], width: number) => all.every((row) => row.length === width && row.every(Number.isFinite));
  const list = LISTS[name];
  if (list) {
    const { columns, least, rule } = list;
    const fits = points.length >= least && points.length <= MOST.rows && whole(points, columns.length) && points.every((row) => list.fits(row.at(-1)!));
    if (!fits) return `${name}: must be ${least} to ${MOST.rows} rows ${columns.join(", ")} of finite numbers${rule}`;
  } else {
    if (!whole(points, 3) || !whole(triangles, 3) || triangles.length > MOST.triangles) return `mesh: must be vertices x, y, z and at most ${MOST.triangles} triangles of finite numbers`;
    if (!triangles.flat().every((k) => Number.isInteger(k) && k >= 0 && k < points.length)) return "mesh: must have triangles of its vertices";
  }
  return refusal({ ...DEFAULT, shape: list?.shape ?? "mesh", [name]: text });
}
