/** Bodies from files: the spheres of a clump as rows or as a table with a header, the points of a convex polyhedron or of a profile as
 * rows, a mesh as OBJ or as STL in text. Whatever is wrong is said with its line. The formats are those of the package: python/restitution/bodies/_clump_files.py. */

import { wrongTable } from "./rigid";
import { LISTS } from "./table";

/** A body, and the table of it under its key. */
export interface Read {
  shape: string;
  key: string;
  text: string;
}

/** A line without its comment, and its number. */
interface Line {
  number: number;
  words: string[];
}

/** The body in a file of this name, of which a unit is so many metres. Which table its rows are, their number of columns says, if `key` does
 * not. Throws what is wrong with it. */
export function readBody(name: string, text: string, unit: number, key?: string): Read {
  if (/[\0\uFFFD]/.test(text)) throw new Error(`${name}: not a text file; must be rows of numbers, or a mesh as OBJ or as STL in text`);
  const lines = linesOf(text.replace(/^\uFEFF/, ""));
  const wrong = (line: Line, allowed: string): never => {
    throw new Error(`${name}, line ${line.number}: ${line.words.join(" ").slice(0, 60)}: must be ${allowed}`);
  };
  const mesh = /\.(obj|stl)$/i.exec(name)?.[1].toLowerCase();
  const list = key ?? Object.keys(LISTS).find((one) => LISTS[one].columns.length === lines[0]?.words.length && !lines[0].words.includes("z")) ?? "spheres";
  const corners = mesh ? triangles(mesh, lines, wrong) : [];
  if (mesh && !corners.length) throw new Error(`${name}: has no triangle; must be a mesh as ${mesh === "obj" ? "OBJ, with lines v x y z and f 1 2 3" : "STL in text, with lines vertex x y z"}`);
  const read: Read = mesh
    ? { shape: "mesh", key: "mesh", text: meshText(corners, unit) }
    : { shape: LISTS[list].shape, key: list, text: table(list, lines, wrong).flatMap((row) => row.map((x) => unit * x)).join("_") };
  const problem = wrongTable(read.key, read.text);
  if (problem) throw new Error(`${name}: ${problem}`);
  return read;
}

function linesOf(text: string): Line[] {
  const lines = text.split(/\r\n|\r|\n/).map((line, k) => ({ number: k + 1, words: line.split("#")[0].split(/[,;\s]+/).filter(Boolean) }));
  return lines.filter(({ words }) => words.length);
}

type Wrong = (line: Line, allowed: string) => never;

function numbers(line: Line, words: string[], allowed: string, wrong: Wrong): number[] {
  const found = words.map(Number);
  return found.every(Number.isFinite) ? found : wrong(line, `${allowed}; finite`);
}

function table(key: string, lines: Line[], wrong: Wrong): number[][] {
  const { columns, fits, rule } = LISTS[key];
  const row = (line: Line, words: string[], allowed: string) => {
    const found = numbers(line, words, allowed, wrong);
    return fits(found.at(-1)!) ? found : wrong(line, allowed);
  };
  const names = lines[0]?.words.map((word) => word.replace(/["']/g, "").toLowerCase()) ?? [];
  if (!["x", "y", "z"].every((column) => names.includes(column))) {
    const [lengths, more] = key === "spheres" ? [[4, 5], " and perhaps a type after them"] : [[columns.length], ""];
    const allowed = `${columns.join(" ")}, with spaces or commas between them${more}${rule}`;
    return lines.map((line) => (lengths.includes(line.words.length) ? row(line, line.words.slice(0, columns.length), allowed) : wrong(line, allowed)));
  }
  const once = columns.every((column) => names.filter((name) => name === column).length === 1);
  if (!once) wrong(lines[0], `a header with the columns ${columns.slice(0, -1).join(", ")} and ${columns.at(-1)}, each once`);
  return lines.slice(1).map((line) => {
    const allowed = `${names.length} values, as many as the header has names; finite${rule}`;
    if (line.words.length !== names.length) wrong(line, allowed);
    return row(line, columns.map((column) => line.words[names.indexOf(column)]), allowed);
  });
}

/** The corners of triangles. */
function triangles(kind: string, lines: Line[], wrong: Wrong): number[][][] {
  const place = (line: Line) => {
    const allowed = `${line.words[0]} x y z`;
    return line.words.length < 4 ? wrong(line, allowed) : numbers(line, line.words.slice(1, 4), allowed, wrong);
  };
  const found: number[][][] = [];
  if (kind === "stl") {
    const corners = lines.filter(({ words }) => words[0] === "vertex").map(place);
    for (let k = 0; k + 2 < corners.length; k += 3) found.push(corners.slice(k, k + 3));
    return found;
  }
  const points: number[][] = [];
  for (const line of lines) {
    if (line.words[0] === "v") points.push(place(line));
    if (line.words[0] !== "f") continue;
    const corners = line.words.slice(1).map((word) => {
      const number = Number(word.split("/")[0]);
      return points.at(number < 0 ? number : number > 0 ? number - 1 : points.length) ?? wrong(line, "f with the numbers of vertices above it");
    });
    if (corners.length < 3) wrong(line, "f with three or more vertices");
    for (let k = 1; k + 1 < corners.length; k++) found.push([corners[0], corners[k], corners[k + 1]]);
  }
  return found;
}

/** Each vertex once, in order, and the triangles of their numbers: as the package has them. */
function meshText(found: number[][][], unit: number): string {
  const inOrder = (a: number[], b: number[]) => a[0] - b[0] || a[1] - b[1] || a[2] - b[2];
  const key = (point: number[]) => point.map((x) => x + 0).join();
  const once = new Map(found.flat().map((point) => [key(point), point]));
  const points = [...once.values()].sort(inOrder);
  const numberOf = new Map(points.map((point, k) => [key(point), k]));
  const vertices = points.flatMap((point) => point.map((x) => unit * (x + 0))).join("_");
  return `${vertices}*${found.flatMap((corners) => corners.map((point) => numberOf.get(key(point)))).join("_")}`;
}
