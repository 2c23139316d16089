/** A set-up as the file of the desktop program, as Python, and its impacts as CSV. */

import { COLUMNS } from "../engine/layout";
import { DIGESTED, type Run } from "../engine/run";
import { bodyOf, lawOf, particlesOf, type Setup } from "../setup";
import type { Kind } from "../table";

/** As Python and TOML write a float. */
function float(x: number): string {
  const text = String(x);
  return Number.isInteger(x) && !text.includes("e") ? `${text}.0` : text;
}

const quoted = (text: string) => JSON.stringify(text);

function given({ parameters }: Kind, s: Setup): [string, string][] {
  return parameters.map(({ name, names }) => [name, names ? quoted(String(s[name])) : float(Number(s[name]))]);
}

function run(s: Setup): [string, string][] {
  return [
    ["particles", String(particlesOf(s))],
    ["impacts", String(s.impacts)],
    ["release_height", float(s.release_height)],
    ["gravity", float(s.gravity)],
    ["orientation", s.orientation === "given" ? `[${float(s.angle)}]` : quoted(s.orientation)],
    ["spin", `[0.0, ${float(s.spin_y)}, ${float(s.spin_z)}]`],
    ["release_velocity", `[${float(s.velocity_x)}, 0.0, ${float(s.velocity_z)}]`],
    ["incline", float(s.incline)],
    ["minimum_speed", float(s.minimum_speed)],
    ["seed", String(s.seed)],
  ];
}

/** RUN.toml for `restitution simulate`. */
export function toml(s: Setup): string {
  const table = (name: string, rows: [string, string][]) =>
    `[${name}]\n${rows.map(([key, value]) => `${key} = ${value}\n`).join("")}`;
  return [
    "# restitution simulate run.toml --out run.nc\n",
    table("body", [["shape", quoted(s.shape)], ...given(bodyOf(s), s)]),
    table("law", [["type", quoted(s.law)], ...given(lawOf(s), s)]),
    table("run", run(s)),
  ].join("\n");
}

/** The lines of Python that make the same data, to the last bit. */
export function python(s: Setup): string {
  const list = (rows: [string, string][], separator: string) =>
    rows.map(([key, value]) => `${key}=${value}`).join(separator);
  const names = DIGESTED.map(quoted).join(", ");
  return `import hashlib

import restitution as rs

body = rs.${bodyOf(s).name}(${list(given(bodyOf(s), s), ", ")})
law = rs.${lawOf(s).name}(${list(given(lawOf(s), s), ", ")})
data = rs.simulate(
    body,
    law,
    ${list(run(s), ",\n    ")},
)
columns = (${names})
print(hashlib.sha256(b"".join(data[name].values.tobytes() for name in columns)).hexdigest())
`;
}

/** One line an impact. */
export function csv({ columns, counts, particles, setup }: Run): string {
  const lines = [`particle,impact,${COLUMNS.join(",")}`];
  for (let particle = 0; particle < particles; particle++) {
    for (let i = 0; i < counts[particle]; i++) {
      const place = particle * setup.impacts + i;
      lines.push(`${particle},${i},${COLUMNS.map((name) => columns[name][place]).join(",")}`);
    }
  }
  return lines.join("\n") + "\n";
}
