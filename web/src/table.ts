/** Bodies and laws as the core describes them: crates/web/src/catalogue.rs. */

export interface Parameter {
  name: string;
  text: string;
  /** "1" for a ratio, null for a name. */
  unit: string | null;
  /** A table is written as in a link: numbers with _ between them. */
  type: "number" | "pair" | "numbers" | "name" | "choice" | "table";
  /** The interval of a number; null for an end that is infinite. Its upper end belongs to it. */
  low?: number;
  high?: number | null;
  closed?: boolean;
  names?: string[];
  whole?: boolean;
  /** The end of the slider of a length beside the size of the body; null if it has one of its own. */
  beside?: number | null;
  default?: number | string;
  example: number | string;
}

export interface Kind {
  /** In Python, and in files and links. */
  name: string;
  key: string;
  text: string;
  parameters: Parameter[];
  /** A rigid body: the parameters of the core, which may be several, or a table, of those of the page. */
  described: Described[];
}

/** A parameter as the core describes it. */
export interface Described extends Omit<Parameter, "type" | "example" | "default"> {
  /** Its name in links. */
  link: string;
  type: "number" | "pair" | "numbers" | "whole" | "several" | "rows" | "name" | "choice";
  /** The names in links, and descriptions, of several numbers. */
  parts?: [string, string][];
  columns?: string[];
  default?: number | string | number[];
  example: number | string | number[];
}

/** Put in by build.mjs. */
interface Entry {
  name: string;
  text: string;
  rigid?: boolean;
  parameters: Described[];
}
declare const TABLE: { bodies: Entry[]; laws: Entry[] };

const hyphened = (name: string) => name.replace(/(?<!^)(?=[A-Z])/g, "-").toLowerCase();
/** Most asperities that the page draws. */
const MOST_ASPERITIES = 10_000;

/** A parameter of the core as those of the page. Of a mesh both tables are one. */
function shown({ parts, columns, ...about }: Described): Parameter[] {
  const one = { ...about, name: about.link, example: about.example as number | string, default: about.default as number | string };
  if (about.default === undefined) delete (one as Partial<typeof one>).default;
  if (parts) return parts.map(([name, text], k) => ({ ...one, name, text, type: "number", example: (about.example as number[])[k] }));
  if (columns) return about.name === "triangles" ? [] : [table(columns.length === 3 && about.name === "vertices" ? "mesh" : about.link)];
  if (about.type === "choice") return [{ ...one, type: "choice", default: String(about.default ?? about.example), example: String(about.example) }];
  if (about.type !== "whole") return [{ ...one, type: about.type as Parameter["type"] }];
  return [{ ...one, type: "number", whole: true, high: about.high == null ? Number.MAX_SAFE_INTEGER : MOST_ASPERITIES }];
}
const kinds = (entries: Entry[]): Kind[] =>
  entries.map(({ parameters, ...kind }) => ({ ...kind, key: hyphened(kind.name), described: parameters, parameters: parameters.flatMap(shown) }));

interface List {
  /** The body that it makes. */
  shape: string;
  columns: string[];
  /** Fewest rows, and what holds for their last column. */
  least: number;
  fits: (last: number) => boolean;
  rule: string;
  /** What a line of the field is. */
  line: string;
  /** Some to begin with, in mm. */
  presets: Record<string, number[][]>;
}
/** So many corners about the axis z, the first at an angle. */
const polygon = (corners: number, radius: number, z: number, from = 0) =>
  Array.from({ length: corners }, (_, k) => {
    const angle = from + (2 * Math.PI * k) / corners;
    return [radius * Math.cos(angle), radius * Math.sin(angle), z].map((x) => Number(x.toFixed(3)) + 0);
  });

/** Tables of rows, by the parameter that they are. */
export const LISTS: Record<string, List> = {
  spheres: { shape: "clump", columns: ["x", "y", "z", "r"], least: 1, fits: (r) => r > 0, rule: "; r > 0", line: "one sphere a line", presets: {
    "three in a triangle": [[0, 2, 0, 2], [-1.7, -1, 0, 2], [1.7, -1, 0, 2]],
    "four in a tetrahedron": [[1.2, 1.2, 1.2, 2], [1.2, -1.2, -1.2, 2], [-1.2, 1.2, -1.2, 2], [-1.2, -1.2, 1.2, 2]],
    "a bent rod of five": [[-4, 0, 0, 1.5], [-2, 0, 0, 1.5], [0, 0, 0, 1.5], [1.6, 1.2, 0, 1.5], [3.2, 2.4, 0, 1.5]],
  } },
  points: { shape: "convex-polyhedron", columns: ["x", "y", "z"], least: 4, fits: () => true, rule: "", line: "one point a line; their convex hull is the body", presets: {
    "a stone": [[3.4, 0.2, 0.6], [1.2, 2.6, 1.1], [-2.1, 2.2, -0.4], [-3.2, -0.6, 0.8], [-0.9, -2.7, 0.3],
      [2.3, -2.1, -0.8], [0.4, 0.3, 2.1], [1.5, 1.3, -1.9], [-1.4, -0.8, -2.2], [-1.1, 1.2, 1.8]],
    "a pyramid": [...polygon(4, 4, -1.5), [0, 0, 4]],
    "a prism of six sides": [...polygon(6, 2.5, -3.5), ...polygon(6, 2.5, 3.5)],
    "an antiprism": [...polygon(5, 3, -1.8), ...polygon(5, 3, 1.8, Math.PI / 5)],
  } },
  profile: { shape: "revolution", columns: ["z", "r"], least: 2, fits: (r) => r >= 0, rule: "; r >= 0", line: "one point a line, from one end to the other; r is the distance from the axis", presets: {
    "a cone": [[0, 3], [6, 0]],
    "a spinning top": [[-4, 0], [-0.8, 2.8], [0.4, 3], [1, 2.2], [1.2, 0.5], [3.5, 0.4]],
    "a cup": [[0, 0], [0, 2], [5, 3], [5, 2.6], [0.5, 1.7], [0.5, 0]],
    "a bullet": [[-3, 2], [1, 2], [2.6, 1.7], [3.8, 1.2], [4.6, 0.6], [5, 0]],
  } },
};
/** As they are in a link, in m. */
export const written = (rows: readonly (readonly number[])[], unit: number): string => rows.flatMap((row) => row.map((x) => Number((x * unit).toPrecision(12)))).join("_");
/** Of a table that has none to begin with: a tetrahedron with unequal edges. */
const MESH = "0_0_0_0.008_0_0_0_0.006_0_0_0_0.005*0_2_1_0_1_3_0_3_2_1_2_3";
function table(name: string): Parameter {
  const example = name in LISTS ? written(Object.values(LISTS[name].presets)[0], 1e-3) : MESH;
  return { name, text: name, unit: null, type: "table", example };
}

export const BODIES = kinds(TABLE.bodies.filter(({ rigid }) => !rigid));
/** Those that are followed in any attitude. A mesh has its vertices, and behind * the numbers of three of them for each triangle. */
export const RIGID = kinds(TABLE.bodies.filter(({ rigid }) => rigid));
/** Their normal coefficient, which all have, first. */
export const LAWS = kinds(TABLE.laws).map((law) => ({
  ...law,
  parameters: [{ name: "normal", text: "normal restitution εₙ", unit: "1", type: "number", low: 0, high: 1, closed: true, default: 0.98, example: 0.98 } as Parameter, ...law.parameters],
}));
/** The bodies in the order of the core's table. */
export const SHAPES: readonly Kind[] = [...BODIES, ...RIGID];

/** Every parameter of a body or a law by its name, which several may share. */
export const PARAMETERS = new Map<string, Parameter>(
  [...SHAPES, ...LAWS].flatMap(({ parameters }) => parameters.map((one) => [one.name, one] as const)).reverse(),
);

export const kindOf = (table: readonly Kind[], key: string): Kind => table.find((kind) => kind.key === key)!;

/** The length that sets the size of a body, in which its other lengths are given on sliders; none of a table. */
export const sizeOf = ({ parameters }: Kind): string | undefined => parameters.find(({ unit }) => unit === "m")?.name;

/** The length beside which this one is given, if it is not the size of its body. */
export function beside(name: string): string | undefined {
  const body = SHAPES.find(({ parameters }) => parameters.some((one) => one.name === name));
  return body && PARAMETERS.get(name)!.unit === "m" && PARAMETERS.get(name)!.beside !== null && sizeOf(body) !== name ? sizeOf(body) : undefined;
}
