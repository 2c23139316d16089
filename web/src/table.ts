/** Bodies and laws as the core describes them: crates/web/src/catalogue.rs. */

export interface Parameter {
  name: string;
  text: string;
  /** "1" for a ratio, null for a name. */
  unit: string | null;
  /** A table is written as in a link: numbers with _ between them. */
  type: "number" | "pair" | "numbers" | "name" | "table";
  /** The interval of a number; null for an end that is infinite. Its upper end belongs to it. */
  low?: number;
  high?: number | null;
  closed?: boolean;
  names?: string[];
  whole?: boolean;
  /** A length that has a slider of its own, and is not given beside the size of the body. */
  apart?: boolean;
  default?: number | string;
  example: number | string;
}

export interface Kind {
  /** In Python, and in files and links. */
  name: string;
  key: string;
  text: string;
  parameters: Parameter[];
}

/** Put in by build.mjs. */
declare const TABLE: { bodies: Omit<Kind, "key">[]; laws: Omit<Kind, "key">[] };

const hyphened = (name: string) => name.replace(/(?<!^)(?=[A-Z])/g, "-").toLowerCase();
const kinds = (table: Omit<Kind, "key">[]): Kind[] => table.map((kind) => ({ ...kind, key: hyphened(kind.name) }));

export const BODIES = kinds(TABLE.bodies);
/** Their normal coefficient, which all have, first. */
export const LAWS = kinds(TABLE.laws).map((law) => ({
  ...law,
  parameters: [{ name: "normal", text: "normal restitution εₙ", unit: "1", type: "number", low: 0, high: 1, closed: true, default: 0.98, example: 0.98 } as Parameter, ...law.parameters],
}));

const length = (name: string, text: string, example: number): Parameter => ({ name, text, unit: "m", type: "number", low: 0, high: null, closed: false, example });
const count = (name: string, text: string, low: number, high: number, example: number): Parameter => ({ name, text, unit: "1", type: "number", low, high, closed: true, whole: true, example });
const DENSITY: Parameter = { ...length("density", "density of the body", 2500), unit: "kg m-3", default: 2500 };
const edges = ["x", "y", "z"].map((of, k) => length(`edge_${of}`, `edge along ${of} of the body`, [8e-3, 6e-3, 4e-3][k]));
const semiAxes = ["x", "y", "z"].map((of, k) => length(`axis_${of}`, `semi-axis along ${of} of the body`, [4e-3, 3e-3, 2e-3][k]));
const table = (name: string, example: string): Parameter => ({ name, text: name, unit: null, type: "table", example });
const rigid = (name: string, text: string, ...parameters: Parameter[]): Kind => ({ name, key: hyphened(name), text, parameters: [...parameters, DENSITY] });

/** Clumps to begin with: rows x y z r in mm. */
export const CLUMPS = {
  "three in a triangle": [[0, 2, 0, 2], [-1.7, -1, 0, 2], [1.7, -1, 0, 2]],
  "four in a tetrahedron": [[1.2, 1.2, 1.2, 2], [1.2, -1.2, -1.2, 2], [-1.2, 1.2, -1.2, 2], [-1.2, -1.2, 1.2, 2]],
  "a bent rod of five": [[-4, 0, 0, 1.5], [-2, 0, 0, 1.5], [0, 0, 0, 1.5], [1.6, 1.2, 0, 1.5], [3.2, 2.4, 0, 1.5]],
};
/** As they are in a link, in m. */
export const written = (rows: readonly (readonly number[])[], unit: number): string => rows.flatMap((row) => row.map((x) => Number((x * unit).toPrecision(12)))).join("_");

/** Bodies without an axis. A clump has rows x y z r; a mesh its vertices, and behind * the numbers of three of them for each triangle. */
export const RIGID: readonly Kind[] = [
  rigid("Ellipsoid", "ellipsoid with three semi-axes", ...semiAxes),
  rigid("Box", "cuboid", ...edges),
  rigid("Die", "die with equal faces", { name: "faces", text: "number of faces", unit: null, type: "name", names: ["4", "6", "8", "12", "20"], default: "6", example: "6" }, length("edge", "length of an edge", 6e-3)),
  rigid("Clump", "spheres fixed to each other", table("spheres", written(CLUMPS["three in a triangle"], 1e-3))),
  rigid("RoughSphere", "sphere with small balls on its surface", length("radius", "radius of the sphere", 3e-3), count("asperities", "number of asperities", 1, 10_000, 1000),
    { ...length("asperity_radius", "radius of the asperities, and their height", 3e-5), apart: true }, count("asperity_seed", "seed of the asperities", 0, Number.MAX_SAFE_INTEGER, 1)),
  rigid("Mesh", "solid within triangles, whose hull touches", table("mesh", "0_0_0_0.008_0_0_0_0.006_0_0_0_0.005*0_2_1_0_1_3_0_3_2_1_2_3")),
];
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
  return body && PARAMETERS.get(name)!.unit === "m" && !PARAMETERS.get(name)!.apart && sizeOf(body) !== name ? sizeOf(body) : undefined;
}
