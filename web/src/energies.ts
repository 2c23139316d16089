/** Energies of the body in the scene, as bars; the last impact, as a table. */

import type { Run } from "./engine/run";
import type { Vector3 } from "three";
import { part } from "./page";
import { isRigid } from "./setup";
import { arrivalOf, type Moment, type Path } from "./stage/path";

const ROWS: [string, string][] = [["height", "soft"], ["vertical", "velocity"], ["sideways", "velocity"], ["rotation", "spin"], ["all", "ink"]];

/** Over the mass, in m²/s²: of motion up and down, sideways, and of rotation. */
const motion = (velocity: Vector3, rotation: number) => [velocity.z ** 2 / 2, (velocity.x ** 2 + velocity.y ** 2) / 2, rotation];
const sum = (parts: number[]) => parts.reduce((a, b) => a + b);
const percent = (x: number, digits: number) => (100 * x).toFixed(digits).replace("-", "−");

/** Shares as bars, what they were before as a line in each; and what has changed. */
export class Bars {
  private readonly bars: { row: HTMLElement; now: HTMLElement; change: HTMLElement }[];

  /** The rows have a name and a colour of the theme. */
  constructor(host: HTMLElement, rows: [string, string][]) {
    this.bars = rows.map(([name, hue]) => {
      const row = document.createElement("div");
      row.className = "bar";
      row.style.setProperty("--hue", `var(--${hue})`);
      row.innerHTML = `<span>${name}</span><i class="level"></i><b></b><i class="change"></i><b></b>`;
      host.append(row);
      const [now, change] = row.querySelectorAll("b");
      return { row, now, change };
    });
  }

  /** Where nothing is known of before, or of a change, there is none. */
  put(shares: number[], before: (number | undefined)[], change: (number | undefined)[]): void {
    const most = Math.max(...change.map((x) => Math.abs(x ?? 0)), 1e-12);
    // No bar is cut: where energy grows, all are drawn smaller.
    const full = Math.max(1, ...shares);
    this.bars.forEach(({ row, ...text }, k) => {
      const changed = change[k];
      row.style.setProperty("--share", String(Math.max(shares[k], 0) / full));
      row.style.setProperty("--before", String((before[k] ?? 0) / full));
      row.style.setProperty("--change", String((changed ?? 0) / most));
      text.now.textContent = percent(shares[k], 1);
      text.change.textContent = changed === undefined ? "" : `${changed > 0 ? "+" : ""}${percent(changed, 2)}`;
    });
  }
}

/** Each energy in shares of the energy of motion before the last impact, and what the impact changed. */
export class Energies extends Bars {
  constructor(host: HTMLElement) {
    super(host, ROWS);
  }

  show(path: Path, { place, velocity, flight, impacts }: Moment): void {
    const contact = path.flights[Math.min(Math.max(impacts, 1), path.flights.length - 1)].place;
    const height = path.gravity.clone().negate().dot(place.clone().sub(contact));
    const now = motion(velocity, flight.rotation);
    const after = motion(flight.velocity, flight.rotation);
    const before = impacts ? motion(arrivalOf(path, impacts), path.flights[impacts - 1].rotation) : [];
    // Before the first impact: all that there is.
    const unit = impacts ? sum(before) : height + sum(now);
    const change = impacts ? [undefined, ...after.map((value, k) => (value - before[k]) / unit), (sum(after) - unit) / unit] : [];
    const shares = [height, ...now, height + sum(now)].map((value) => value / unit);
    part("ledger-unit").textContent = `; ${impacts ? "before" : "all"} = 100`;
    part("ledger-change").textContent = impacts ? "change" : "";
    this.put(shares, impacts ? [undefined, ...before.map((value) => value / unit), 1] : [], change);
  }
}

/** A duration as one says it: 11.7 s, 111 ms. */
export const duration = (seconds: number): string =>
  seconds < 1 ? `${Number((seconds * 1e3).toPrecision(3))} ms` : `${Number(seconds.toPrecision(3))} s`;

/** A ratio with four decimals; what has not changed but by rounding is 1. */
const ratio = (x: number) => (Math.abs(x - 1) < 1e-12 ? "1" : x.toFixed(4));

const LINES: [string, (run: Run, place: number) => string][] = [
  ["impact velocity v", (run, i) => `${run.columns.impact_velocity[i].toPrecision(3).replace("-", "−")} m/s`],
  ["restitution ε", (run, i) => run.columns.restitution[i].toPrecision(4).replace("-", "−")],
  ["rotational share", (run, i) => `${(100 * run.columns.rotational_fraction[i]).toPrecision(3)} %`],
  ["energy after/before", (run, i) => ratio(run.columns.energy_ratio[i])],
  ["time since release", (run, i) => duration(run.columns.time[i])],
];

const tilt = (run: Run, i: number) => `${((run.columns.angle[i] * 180) / Math.PI).toFixed(1)}°`;
/** What describes the contact: the tilt, or which ball, vertex or rim it is; an ellipsoid has none. */
function contact({ setup }: Run): typeof LINES {
  if (!isRigid(setup)) return [["tilt θ of the axis", tilt]];
  return setup.shape.endsWith("ellipsoid") ? [] : [["part that touched", (run, i) => String(run.columns.contact[i])]];
}

export function showImpact(table: HTMLTableElement, run: Run, particle: number, impact: number): void {
  const place = particle * run.setup.impacts + impact;
  const there = impact >= 0 && impact < run.counts[particle];
  const head = there ? `Impact ${impact + 1} of particle ${particle}` : "No impact yet";
  const rows = [...LINES.slice(0, 2), ...contact(run), ...LINES.slice(2)].map(([name, value]) => `<tr><th scope="row">${name}</th><td>${there ? value(run, place) : "–"}</td></tr>`);
  table.innerHTML = `<caption>${head}</caption><tbody>${rows.join("")}</tbody>`;
}
