/** A set-up as the file of the desktop program, as Python, and its impacts as CSV. */

import { COLUMNS } from "../engine/layout";
import { digested, type Run } from "../engine/run";
import type { Body, Encounter } from "../pair/encounter";
import { argumentsOf, float } from "../rigid";
import { bodyOf, isRigid, lawOf, orientationOf, particlesOf, type Setup } from "../setup";
import type { Kind } from "../table";

const quoted = (text: string) => JSON.stringify(text);

function ofKind({ parameters }: Kind, s: Setup): [string, string][] {
  return parameters.map(({ name, names }) => [name, names ? quoted(String(s[name])) : float(Number(s[name]))]);
}

const body = (s: Setup) => (isRigid(s) ? argumentsOf(s) : ofKind(bodyOf(s), s));

function run(s: Setup): [string, string][] {
  return [
    ["particles", String(particlesOf(s))],
    ["impacts", String(s.impacts)],
    ["release_height", float(s.release_height)],
    ["gravity", float(s.gravity)],
    ["orientation", orientationOf(s) === "given" ? `[${float(s.angle)}]` : quoted(orientationOf(s))],
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
    table("body", [["shape", quoted(s.shape)], ...body(s)]),
    table("law", [["type", quoted(s.law)], ...ofKind(lawOf(s), s)]),
    table("run", run(s)),
  ].join("\n");
}

/** The lines of Python that make the same data, to the last bit. */
export function python(s: Setup): string {
  const list = (rows: [string, string][], separator: string) =>
    rows.map(([key, value]) => `${key}=${value}`).join(separator);
  const names = digested(s).map(quoted).join(", ");
  return `import hashlib

import restitution as rs

body = rs.${bodyOf(s).name}(${list(body(s), ", ")})
law = rs.${lawOf(s).name}(${list(ofKind(lawOf(s), s), ", ")})
data = rs.simulate(
    body,
    law,
    ${list(run(s), ",\n    ")},
)
columns = (${names})
print(hashlib.sha256(b"".join(data[name].values.tobytes() for name in columns)).hexdigest())
`;
}

/** The lines of Python that follow the same encounter: as it is drawn, or from its beginning. */
export function pairPython(s: Setup, number: number, { flights }: Encounter): string {
  const list = (rows: [string, string][]) => rows.map(([key, value]) => `${key}=${value}`).join(", ");
  const [drawn, states] = [s.meeting === "drawn", flights[0].bodies];
  const both = (of: (body: Body) => number[]) => `[[${states.map((state) => `[${of(state).map(float).join(", ")}]`).join(",\n     ")}]]`;
  const start = `names = ["encounter", "particle", "component"]
states = xr.Dataset({
    "position": (names, ${both(({ place }) => place.toArray())}),
    "velocity": (names, ${both(({ velocity }) => velocity.toArray())}),
    "angular_velocity": (names, ${both(({ spin }) => spin.toArray())}),
    "attitude": (names[:2] + ["quaternion"], ${both(({ attitude: { w, x, y, z } }) => [w, x, y, z])}),
})
`;
  const given = drawn
    ? `    encounters=${number + 1},
    translational_temperature=temperature,
    rotational_temperature=${float(s.temperature_ratio)} * temperature,
    seed=${s.seed},
`
    : "    states=states,\n";
  return `import restitution as rs
${drawn ? "" : "import xarray as xr\n"}
body = rs.${bodyOf(s).name}(${list(body(s))})
law = rs.${lawOf(s).name}(${list(ofKind(lawOf(s), s))})
${drawn ? `temperature = body.mass * ${float(s.thermal_speed)} ** 2\n` : start}data = rs.pair.encounters(
    body,
    body,
    law,
${given}    record="contacts",
)
print(data.isel(encounter=${drawn ? number : 0}))
`;
}

/** One line an impact. */
export function csv({ columns, counts, particles, setup }: Run): string {
  const names = COLUMNS.filter((name) => name !== "angle" || !isRigid(setup));
  const lines = [`particle,impact,${names.join(",")}`];
  for (let particle = 0; particle < particles; particle++) {
    for (let i = 0; i < counts[particle]; i++) {
      const place = particle * setup.impacts + i;
      lines.push(`${particle},${i},${names.map((name) => columns[name][place]).join(",")}`);
    }
  }
  return lines.join("\n") + "\n";
}
