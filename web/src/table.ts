/** Bodies and laws as the core describes them: crates/web/src/catalogue.rs. */

export interface Parameter {
  name: string;
  text: string;
  /** "1" for a ratio, null for a name. */
  unit: string | null;
  type: "number" | "pair" | "numbers" | "name";
  /** The interval of a number; null for an end that is infinite. Its upper end belongs to it. */
  low?: number;
  high?: number | null;
  closed?: boolean;
  names?: string[];
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

/** Every parameter of a body or a law by its name, which several may share. */
export const PARAMETERS = new Map<string, Parameter>(
  [...BODIES, ...LAWS].flatMap(({ parameters }) => parameters.map((one) => [one.name, one] as const)).reverse(),
);

export const kindOf = (table: readonly Kind[], key: string): Kind => table.find((kind) => kind.key === key)!;

/** The length that sets the size of a body, in which its other lengths are given on sliders. */
export const sizeOf = ({ parameters }: Kind): string => parameters.find(({ unit }) => unit === "m")!.name;

/** The length beside which this one is given, if it is not the size of its body. */
export function beside(name: string): string | undefined {
  const body = BODIES.find(({ parameters }) => parameters.some((one) => one.name === name));
  return body && PARAMETERS.get(name)!.unit === "m" && sizeOf(body) !== name ? sizeOf(body) : undefined;
}
