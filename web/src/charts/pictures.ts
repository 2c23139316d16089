/** The pictures of the page, from what was counted. */

import { firstImpact } from "../first-impact";
import { Bins, type Lattice, type Statistics } from "../statistics";
import { fallSpeed } from "../setup";
import type { State } from "../link";
import type { Curve, Picture } from "./picture";

export interface Both {
  a: Statistics;
  b: Statistics | undefined;
}

const SPEED = "impact velocity v (m/s)";
const FRACTION = "E_rot/E_tot before the impact";
/** Bins of v in σ(v) and the mean of E_rot/E_tot: ten of the lattice's. */
const COARSE = 10;
/** Fewer impacts than this in a bin: no moment of them is drawn. */
const LEAST = 20;

const each = <T>({ a, b }: Both, make: (s: Statistics, of: "a" | "b") => T): T[] =>
  b ? [make(a, "a"), make(b, "b")] : [make(a, "a")];
const label = (of: "a" | "b") => `set-up ${of.toUpperCase()}`;

/** The range of v and ε that is asked for; the paper's numbers, scaled with the speed of the fall. */
export function rangeOf(state: State, s: Statistics): { v: [number, number]; epsilon: [number, number] } {
  const fall = fallSpeed(s.run.setup);
  if (state.range === "fig7") return { v: [-0.024 * fall, 0.1 * fall], epsilon: [-3, 4] };
  if (state.range === "all") return { v: [s.v.low, s.v.high], epsilon: [-3, 4] };
  return { v: [0, Math.min(1.1 * fall, s.v.high)], epsilon: [0.4, 1.6] };
}

/** Figs. 2 and 7: ε against v. */
export function scatter(state: State, s: Statistics, of: "a" | "b"): Picture {
  const { v, epsilon } = rangeOf(state, s);
  const { columns, setup } = s.run;
  const place = state.particle * setup.impacts + state.impact;
  return {
    title: `Restitution against impact velocity, ${label(of)}`,
    x: { label: SPEED, low: v[0], high: v[1] },
    y: { label: "coefficient of restitution ε", low: epsilon[0], high: epsilon[1] },
    at: [v[0], v[1]],
    curves: [],
    lattice: s.restitution,
    mark: state.speed,
    ...(of === "a" && Number.isFinite(columns.restitution[place])
      ? { spot: [columns.impact_velocity[place], columns.restitution[place]] as [number, number] }
      : {}),
  };
}

/** Fig. 3: E_rot/E_tot against v, with its mean. */
export function reservoir(state: State, both: Both): Picture {
  const { v } = rangeOf(state, both.a);
  const { at, curves } = byVelocity(both, (moments) => moments.share, "line");
  return {
    title: "Rotational over total kinetic energy, set-up A; lines: means",
    x: { label: SPEED, low: v[0], high: v[1] },
    y: { label: FRACTION, low: 0, high: Math.max(...each(both, (s) => top(s.fraction))) },
    at,
    curves,
    lattice: both.a.fraction,
    mark: state.speed,
  };
}

/** Fig. 6: σ(ε) against v. */
export function scatterWidth(state: State, both: Both): Picture {
  const { v } = rangeOf({ ...state, range: state.range === "fig7" ? "fig7" : "fig2" }, both.a);
  const { at, curves } = byVelocity(both, (moments) => moments.deviation, "line");
  const seen = curves.flatMap((c) => c.y.filter((y, k) => y !== null && at[k] >= Math.max(v[0], 0.05 * v[1]))) as number[];
  const high = Math.max(...seen, 1e-3);
  return {
    title: "Standard deviation of the restitution",
    x: { label: SPEED, low: v[0], high: v[1] },
    y: { label: "σ(ε)", low: 0, high: 1.15 * Math.min(high, 1) },
    at,
    curves,
    mark: state.speed,
  };
}

/** Fig. 4: p(ε | v); Fig. 5: p(E_rot/E_tot | v); Fig. 9: p(ε) of the first impact, with the exact density. */
export function density(state: State, both: Both): Picture {
  const fraction = state.density === "fraction";
  const first = !fraction && both.a.run.setup.impacts === 1;
  const lattice = (s: Statistics) => (fraction ? s.fraction : s.restitution);
  const counted = each(both, (s, of) => ({ of, ...lattice(s).over(...(first ? ALL : s.window(state.speed))) }));
  const fine = lattice(both.a).other;
  const merged = Math.min(...counted.map(({ counts }) => merging(counts)));
  const bins = new Bins(fine.low, fine.high, merged * fine.step);
  const at = Array.from({ length: bins.count + 1 }, (_, k) => bins.edge(k));
  const curves: Curve[] = counted.map(({ of, counts, total }) => {
    const y = at.slice(1).map((_, k) => {
      const count = counts.subarray(k * merged, (k + 1) * merged).reduce((sum, n) => sum + n, 0);
      return count ? count / (total * bins.step) : null;
    });
    return { label: label(of), of, y: [...y, null], kind: "steps" };
  });
  if (first) {
    const exact = firstImpact(both.a.run.setup, bins);
    if (exact) curves.push({ label: "exact", of: "b", y: [...exact, null], kind: "steps" });
  }
  const seen = curves.flatMap((c) => c.y.filter((y): y is number => y !== null));
  const high = Math.max(...seen, 1);
  const filled = at.filter((_, k) => curves.some((c) => c.y[k] !== null));
  const at_speed = first ? "of the first impact" : `at v = ${state.speed.toPrecision(3)} m/s`;
  return {
    title: fraction ? `Density of E_rot/E_tot ${at_speed}` : `Density of the restitution ${at_speed}`,
    x: { label: fraction ? FRACTION : "coefficient of restitution ε", ...around(filled, bins) },
    y: { label: fraction ? "p(E_rot/E_tot | v)" : first ? "p(ε)" : "p(ε | v)", low: first ? 0 : decade(Math.max(high / 3000, Math.min(...seen))), high: 1.4 * high, log: !first },
    at,
    curves,
  };
}

const ALL: [number, number] = [-Infinity, Infinity];
const decade = (x: number) => 10 ** Math.floor(Math.log10(x));

/** How many bins to put together, so that some thirty show the bulk of these counts. */
function merging(counts: Float64Array): number {
  const total = counts.reduce((sum, n) => sum + n, 0);
  const quantile = (share: number) => {
    let [k, sum] = [0, 0];
    while (k < counts.length - 1 && (sum += counts[k]) < share * total) k++;
    return k;
  };
  const bulk = quantile(0.95) - quantile(0.05);
  return [10, 5, 2].find((many) => bulk / many >= 30) ?? 1;
}

/** A curve of moments for each set-up, over the bins of A. */
function byVelocity(
  both: Both,
  moment: (m: ReturnType<Statistics["moments"]>) => number,
  kind: Curve["kind"],
): { at: number[]; curves: Curve[] } {
  const bins = both.a.v;
  const step = COARSE * bins.step;
  const number = Math.floor(bins.count / COARSE);
  const edges = Array.from({ length: number }, (_, k) => bins.low + k * step);
  const curves = each(both, (s, of): Curve => {
    const y = edges.map((low) => {
      const found = s.moments(low, low + step);
      return found.number >= LEAST ? moment(found) : null;
    });
    return { label: label(of), of, y, kind };
  });
  return { at: edges.map((low) => low + step / 2), curves };
}

/** The range of the filled bins, with some room. */
function around(filled: number[], bins: Bins): { low: number; high: number } {
  if (!filled.length) return { low: 0, high: 1 };
  const [low, high] = [Math.min(...filled), Math.max(...filled) + bins.step];
  const room = 0.04 * (high - low) + bins.step;
  return { low: low - room, high: high + room };
}

/** The largest populated E_rot/E_tot, with some room. */
function top({ counts, other }: Lattice): number {
  let most = 0;
  for (let i = 0; i < counts.length; i++) if (counts[i]) most = Math.max(most, i % other.count);
  return Math.min(1, Math.max(0.02, 1.08 * other.edge(most + 1)));
}
