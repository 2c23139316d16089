/** Energies of the body in the scene, as bars; the last impact, as a table. */

import type { Run } from "./engine/run";
import type { Moment, Path } from "./stage/path";

const NAMES = ["of height", "up and down", "sideways", "of rotation", "all"] as const;
const HUES = ["var(--soft)", "var(--a)", "var(--a)", "var(--b)", "var(--ink)"];

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

const ROWS: [string, (run: Run, place: number) => string][] = [
  ["impact velocity v", (run, i) => `${run.columns.impact_velocity[i].toPrecision(4)} m/s`],
  ["restitution ε", (run, i) => run.columns.restitution[i].toPrecision(4)],
  ["axis to the normal θ", (run, i) => `${((run.columns.angle[i] * 180) / Math.PI).toFixed(1)}°`],
  ["E_rot/E_tot before", (run, i) => run.columns.rotational_fraction[i].toPrecision(3)],
  ["kinetic energy after/before", (run, i) => run.columns.energy_ratio[i].toFixed(4)],
  ["end that touched", (run, i) => String(run.columns.contact[i])],
  ["time since release", (run, i) => `${(run.columns.time[i] * 1e3).toFixed(2)} ms`],
];

export function showImpact(table: HTMLTableElement, run: Run, particle: number, impact: number): void {
  const place = particle * run.setup.impacts + impact;
  const there = impact >= 0 && impact < run.counts[particle];
  const head = there ? `Impact ${impact + 1} of particle ${particle}` : "No impact yet";
  const rows = ROWS.map(([name, value]) => `<tr><th scope="row">${name}</th><td>${there ? value(run, place) : "–"}</td></tr>`);
  table.innerHTML = `<caption>${head}</caption><tbody>${rows.join("")}</tbody>`;
}
