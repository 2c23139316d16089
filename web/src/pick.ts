/** Impacts worth a look, found in the table. */

import type { Run } from "./engine/run";

export interface Impact {
  particle: number;
  impact: number;
}

export const KINDS = {
  gain: "Creates most energy",
  superelastic: "Largest ε with v > fall/10",
  downward: "ε < 0: goes on downwards",
  upward: "ε < 0: hit while it rises",
  locked: "Locked to its rotation",
} as const;
export type Kind = keyof typeof KINDS;

/** At most this many of a kind. */
const MOST = 50;
/** An orbit is locked where every impact is as fast as the one before the last within 3 %, for this many impacts. */
const IN_STEP = 40;
const STEP_TOLERANCE = 0.03;

/** The impacts of a kind, the most remarkable first. */
export function notable(run: Run, kind: Kind): Impact[] {
  if (kind === "locked") return locked(run);
  const { columns, counts, particles, setup } = run;
  const [v, ratio, epsilon] = [columns.impact_velocity, columns.energy_ratio, columns.restitution];
  const fall = v[0];
  const score: Record<Exclude<Kind, "locked">, (i: number) => number> = {
    gain: (i) => (ratio[i] > 1 + 1e-12 ? ratio[i] : NaN),
    superelastic: (i) => (epsilon[i] > 1 && v[i] > 0.1 * fall ? epsilon[i] : NaN),
    downward: (i) => (epsilon[i] < 0 && v[i] > 0 ? -epsilon[i] * v[i] : NaN),
    upward: (i) => (epsilon[i] < 0 && v[i] < 0 ? -v[i] : NaN),
  };
  const found: [number, Impact][] = [];
  for (let particle = 0; particle < particles; particle++) {
    for (let impact = 0; impact < counts[particle]; impact++) {
      const value = score[kind](particle * setup.impacts + impact);
      if (!Number.isNaN(value)) found.push([value, { particle, impact }]);
    }
  }
  return found.sort((a, b) => b[0] - a[0]).slice(0, MOST).map(([, place]) => place);
}

function locked({ columns, counts, particles, setup }: Run): Impact[] {
  const found: [number, Impact][] = [];
  for (let particle = 0; particle < particles; particle++) {
    const row = columns.impact_velocity.subarray(particle * setup.impacts, particle * setup.impacts + counts[particle]);
    let [length, longest, start] = [0, 0, 0];
    for (let i = 2; i < row.length; i++) {
      length = Math.abs(row[i] / row[i - 2] - 1) < STEP_TOLERANCE ? length + 1 : 0;
      // Early impacts of nearly equal speed are no lock: a fall in small steps. A locked particle climbs.
      if (length > longest && row[i] > row[i - length]) [longest, start] = [length, i - length + 1];
    }
    if (longest >= IN_STEP) found.push([longest, { particle, impact: start }]);
  }
  return found.sort((a, b) => b[0] - a[0]).slice(0, MOST).map(([, place]) => place);
}

/** How many impacts in a row about this place in the table are as fast as the one before the last. */
export function inStep({ columns, setup }: Run, place: number): number {
  const v = columns.impact_velocity;
  const first = place - (place % setup.impacts);
  const repeats = (i: number) => i >= first + 2 && i < first + setup.impacts && Math.abs(v[i] / v[i - 2] - 1) < STEP_TOLERANCE;
  let [from, to] = [place, place];
  while (repeats(from)) from--;
  while (repeats(to + 1)) to++;
  return to - from;
}

/** Why particles ended, in words: in the order of the engine's reasons. */
export const endings = ({ setup }: Run): string[] => [
  `reached ${setup.impacts.toLocaleString("en")} ${setup.impacts === 1 ? "impact" : "impacts"}`,
  `slower than ${setup.minimum_speed} m/s`,
  "collapsed: impacts accumulate",
  "turned too far before the next impact",
  "interrupted",
];
