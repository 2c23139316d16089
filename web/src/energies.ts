/** Energies of the body in the scene, as bars; the last impact, as a table. */

import type { Run } from "./engine/run";
import { isRigid } from "./setup";
import type { Moment, Path } from "./stage/path";

const NAMES = ["potential energy", "vertical motion", "sideways motion", "rotational energy", "total energy"] as const;
const HUES = ["var(--soft)", "var(--velocity)", "var(--velocity)", "var(--spin)", "var(--ink)"];

export class Energies {
  private readonly bars: { bar: HTMLElement; text: HTMLElement }[];

  constructor(host: HTMLElement) {
    this.bars = NAMES.map((name, k) => {
      const row = document.createElement("div");
      row.className = "bar";
      row.innerHTML = `<span>${name}</span><i style="--hue: ${HUES[k]}"></i><b></b>`;
      host.append(row);
      return { bar: row.querySelector("i")!, text: row.querySelector("b")! };
    });
  }

  show(path: Path, { place, velocity, flight }: Moment): void {
    const g = -path.gravity.z;
    const start = path.flights[0];
    const along = path.gravity.x * (start.place.x - place.x);
    const parts = [
      g * place.z + along,
      velocity.z ** 2 / 2,
      (velocity.x ** 2 + velocity.y ** 2) / 2,
      flight.rotation,
    ];
    const unit = g * start.place.z + start.velocity.lengthSq() / 2 + start.rotation;
    [...parts, parts.reduce((a, b) => a + b)].forEach((value, k) => {
      this.bars[k].bar.style.setProperty("--share", String(Math.min(Math.max(value / unit, 0), 1)));
      this.bars[k].text.textContent = (value / unit).toFixed(3);
    });
  }
}

/** A duration as one says it: 11.7 s, 111 ms. */
export const duration = (seconds: number): string =>
  seconds < 1 ? `${Number((seconds * 1e3).toPrecision(3))} ms` : `${Number(seconds.toPrecision(3))} s`;

/** A ratio with four decimals; what has not changed but by rounding is 1. */
const ratio = (x: number) => (Math.abs(x - 1) < 1e-12 ? "1" : x.toFixed(4));

const ROWS: [string, (run: Run, place: number) => string][] = [
  ["impact velocity v", (run, i) => `${run.columns.impact_velocity[i].toPrecision(3).replace("-", "−")} m/s`],
  ["restitution ε", (run, i) => run.columns.restitution[i].toPrecision(4).replace("-", "−")],
  ["rotational share", (run, i) => `${(100 * run.columns.rotational_fraction[i]).toPrecision(3)} %`],
  ["energy after/before", (run, i) => ratio(run.columns.energy_ratio[i])],
  ["time since release", (run, i) => duration(run.columns.time[i])],
];

const tilt = (run: Run, i: number) => `${((run.columns.angle[i] * 180) / Math.PI).toFixed(1)}°`;
/** What describes the contact: the tilt, or which ball, vertex or rim it is; an ellipsoid has none. */
function contact({ setup }: Run): typeof ROWS {
  if (!isRigid(setup)) return [["tilt θ of the axis", tilt]];
  return setup.shape.endsWith("ellipsoid") ? [] : [["part that touched", (run, i) => String(run.columns.contact[i])]];
}

export function showImpact(table: HTMLTableElement, run: Run, particle: number, impact: number): void {
  const place = particle * run.setup.impacts + impact;
  const there = impact >= 0 && impact < run.counts[particle];
  const head = there ? `Impact ${impact + 1} of particle ${particle}` : "No impact yet";
  const rows = [...ROWS.slice(0, 2), ...contact(run), ...ROWS.slice(2)].map(([name, value]) => `<tr><th scope="row">${name}</th><td>${there ? value(run, place) : "–"}</td></tr>`);
  table.innerHTML = `<caption>${head}</caption><tbody>${rows.join("")}</tbody>`;
}
