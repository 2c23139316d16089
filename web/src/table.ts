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
  /** The end of its slider, beside the size of the body. */
  most?: number;
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
const within = (name: string, text: string, example: number, most: number): Parameter => ({ ...length(name, text, example), most });
const exponent = (name: string, text: string, example: number): Parameter => ({ name, text, unit: "1", type: "number", low: 1.1, high: null, closed: true, example });
const rigid = (name: string, text: string, ...parameters: Parameter[]): Kind => ({ name, key: hyphened(name), text, parameters: [...parameters, DENSITY] });

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
const table = (name: string, example = written(Object.values(LISTS[name].presets)[0], 1e-3)): Parameter => ({ name, text: name, unit: null, type: "table", example });

/** Bodies without an axis, and those of revolution that run as such. A mesh has its vertices, and behind * the numbers of three of them for each triangle. */
export const RIGID: readonly Kind[] = [
  rigid("Ellipsoid", "ellipsoid with three semi-axes", ...semiAxes),
  rigid("Superellipsoid", "superellipsoid, the superquadric of DEM codes", ...semiAxes,
    exponent("exponent_1", "exponent along z", 4), exponent("exponent_2", "exponent across z", 3)),
  rigid("Box", "cuboid", ...edges),
  rigid("Die", "die with equal faces", { name: "faces", text: "number of faces", unit: null, type: "name", names: ["4", "6", "8", "12", "20"], default: "6", example: "6" }, length("edge", "length of an edge", 6e-3)),
  rigid("ConvexPolyhedron", "convex hull of points", table("points")),
  rigid("Cylinder", "cylinder: a coin, a tablet, a rod", length("radius", "radius", 3e-3), length("height", "height of the cylinder", 1.8e-3)),
  rigid("Ring", "ring, washer or tube", length("outer", "outer radius", 4e-3), within("inner", "inner radius", 2.4e-3, 0.99), length("ring_height", "height of the ring", 2e-3)),
  rigid("Egg", "egg of two caps, joined by an arc", length("length", "length", 6e-3), within("width", "width", 4.5e-3, 1),
    within("blunt_end", "radius of the blunt end", 2.1e-3, 0.5), within("tip", "radius of the tip", 1.5e-3, 0.5)),
  rigid("Revolution", "solid of revolution with any profile", table("profile")),
  rigid("Clump", "spheres fixed to each other", table("spheres")),
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
