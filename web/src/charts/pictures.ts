/** The pictures of the page, from what was counted. */

import { firstImpact } from "../first-impact";
import { density as laplaceDensity, laplace } from "../laplace";
import type { State } from "../link";
import { fallSpeed } from "../outline";
import { bodyOf, rounded } from "../setup";
import { beside } from "../table";
import { Bins, nice, quantile, type Statistics } from "../statistics";
import type { Curve, Picture } from "./picture";

export interface Both {
  a: Statistics;
  b: Statistics | undefined;
}

const SPEED = "impact velocity v (m/s)";
const SHARE = "rotational share of the kinetic energy";
/** On upright axes, which are short. */
const SHARE_UP = "rotational share";
const EPSILON_UP = "restitution ε";
const EPSILON = "coefficient of restitution ε";
/** Sites of the maps, about: two or three pixels each. */
const SITES = { v: 220, other: 140 };
/** Bins of v in σ(v) and the mean rotational share. */
const PARTS = 36;
/** Fewer impacts than this in a bin: no moment of them is drawn. */
const LEAST = 20;
/** Fewer impacts than this at a speed have no histogram: each is a tick. */
const FEW = 200;
/** Rounding scatters ε and the rotational share by less than this. */
export const EXACT = 1e-9;

const each = <T>({ a, b }: Both, make: (s: Statistics, of: "a" | "b") => T): T[] =>
  b ? [make(a, "a"), make(b, "b")] : [make(a, "a")];
/** By a parameter of the body in which the set-ups differ, a length beside the size of the body. */
const label = ({ run: { setup } }: Statistics, of: "a" | "b", { a, b }: Both) => {
  const other = b && (of === "a" ? b : a).run.setup;
  const one = other?.shape === setup.shape && bodyOf(setup).parameters.find(({ name }) => setup[name] !== other[name])?.name;
  if (!one) return `set-up ${of.toUpperCase()}`;
  const unit = beside(one);
  return `${of.toUpperCase()}: ${one}${unit ? `/${unit}` : ""} = ${rounded(Number(setup[one]) / Number(unit ? setup[unit] : 1))}`;
};
/** The range of v and ε that is asked for; the paper's numbers, scaled with the speed of the fall. */
function rangeOf(state: State, s: Statistics): { v: [number, number]; epsilon: [number, number] } {
  const fall = fallSpeed(s.run.setup);
  if (state.range === "fig7") return { v: [-0.024 * fall, 0.1 * fall], epsilon: [-3, 4] };
  if (state.range === "all") return { v: [s.v.low, s.v.high], epsilon: [-3, 4] };
  if (state.range === "slow") return { v: [0.0285 * fall, 0.285 * fall], epsilon: [0.6, 1.4] };
  const v: [number, number] = [0, Math.min(1.1 * fall, s.v.high)];
  if (state.range === "fig2") return { v, epsilon: [0.4, 1.6] };
  // What one impact each has is in a narrow window of v.
  return { v: s.run.setup.impacts === 1 ? roomy(s.range("impact_velocity"), 0.02 * fall) : v, epsilon: roomy(s.range("restitution"), 1e-3) };
}

/** A range with some room, to round numbers, so that it stays as impacts arrive. */
function roomy([low, high]: [number, number], least: number): [number, number] {
  const width = Math.max(high - low, least);
  const step = nice(width / 8);
  return [Math.floor((low - 0.1 * width) / step) * step, Math.ceil((high + 0.1 * width) / step) * step];
}

const cover = ([low, high]: [number, number], many: number) => Bins.cover(low, high, many);

/** Figs. 2 and 7: ε against v. Orbits of slow bodies are lines as thin as a pixel, of which there are so many. */
export function scatter(state: State, s: Statistics, of: "a" | "b", pixels: [number, number]): Picture {
  const { v, epsilon } = rangeOf(state, s);
  const { columns, setup } = s.run;
  const place = state.particle * setup.impacts + state.impact;
  const glow = state.range === "slow";
  const bins = ([low, high]: [number, number], many: number, pixels: number) => (glow ? new Bins(low, high, (high - low) / (pixels || many)) : cover([low, high], many));
  const levels = [{ y: 1, label: "ε = 1" }, { y: setup.normal, label: "εₙ" }];
  return {
    title: `Restitution against impact velocity, set-up ${of.toUpperCase()}`,
    x: { label: SPEED, low: v[0], high: v[1] },
    y: { label: EPSILON_UP, low: epsilon[0], high: epsilon[1] },
    curves: [],
    lattice: s.lattice("restitution", bins(v, SITES.v, pixels[0]), bins(epsilon, SITES.other, pixels[1])),
    glow,
    levels: glow ? [] : setup.normal === 1 ? levels.slice(0, 1) : levels,
    ...(setup.impacts > 1 && !glow ? { mark: state.speed } : {}),
    ...(of === "a" && Number.isFinite(columns.restitution[place])
      ? { spot: [columns.impact_velocity[place], columns.restitution[place]] as [number, number] }
      : {}),
  };
}

/** The impacts of the particle in the scene, in turn: one that is locked climbs. */
export function orbit(state: State, { a }: Both): Picture {
  const { columns, counts, setup } = a.run;
  const number = counts[state.particle] || 1;
  const first = state.particle * setup.impacts;
  const v = Array.from(columns.impact_velocity.subarray(first, first + number));
  return {
    title: `Impact velocity of particle ${state.particle} against the number of the impact`,
    x: { label: "number of the impact", low: 0, high: number },
    y: { label: "v (m/s)", low: 0, high: rangeOf(state, a).v[1] },
    curves: [{ label: "", of: "a", kind: "points", x: v.map((_, k) => k + 1), y: v }],
    mark: state.impact + 1,
  };
}

/** Fig. 3: the rotational share against v, with its mean. */
export function reservoir(state: State, both: Both): Picture {
  const { v } = rangeOf(state, both.a);
  const top = Math.max(...each(both, (s) => s.rotation));
  const axes = { x: { label: SPEED, low: v[0], high: v[1] }, title: "Rotational share of the kinetic energy, set-up A; lines: means" };
  if (top < EXACT) {
    const note = both.a.run.setup.impacts === 1 ? "Released without spin:\nbefore its first impact nothing rotates." : "Nothing rotates.";
    return { ...axes, y: { label: SHARE_UP, low: 0, high: 1 }, curves: [], note };
  }
  const high = Math.min(1, Math.max(...each(both, (s) => roomy(s.range("rotational_fraction"), 1e-6)[1])));
  const edges = cover(v, PARTS).edges;
  return {
    ...axes,
    y: { label: SHARE_UP, low: 0, high },
    curves: byVelocity(both, edges, (moments) => moments.share),
    lattice: both.a.lattice("rotational_fraction", cover(v, SITES.v), cover([0, high], SITES.other)),
    mark: state.speed,
  };
}

/** Fig. 6: σ(ε) against v, both logarithmic. */
export function scatterWidth(state: State, both: Both): Picture {
  const fall = fallSpeed(both.a.run.setup);
  const [low, high] = [0.03 * fall, Math.min(1.1 * fall, both.a.v.high)];
  const picture = {
    title: "Standard deviation of the restitution against impact velocity",
    x: { label: SPEED, low, high, log: true },
    y: { label: "standard deviation σ(ε)", low: 1e-4, high: 1, log: true },
    curves: [],
  };
  if (both.a.run.setup.impacts === 1) return { ...picture, note: "One impact each, all at nearly one speed." };
  if (both.a.run.impacts && Math.max(...each(both, (s) => s.scatter)) < EXACT) {
    return { ...picture, note: "No scatter: σ(ε) = 0 at every speed." };
  }
  const edges = Array.from({ length: PARTS + 1 }, (_, k) => low * (high / low) ** (k / PARTS));
  const curves = byVelocity(both, edges, (moments) => moments.deviation);
  const seen = curves.flatMap((c) => c.y.filter((y): y is number => y !== null && y > 0));
  if (!seen.length) return picture;
  const [least, most] = [Math.min(...seen), Math.max(...seen)];
  return { ...picture, y: { ...picture.y, low: least / 1.6, high: Math.max(most * 1.6, 10 * least) }, curves, mark: state.speed };
}

/** Fig. 4: p(ε | v) with an asymmetric Laplace density; Fig. 5: p of the rotational share; Fig. 9: p(ε) of the first impact, with the
 * exact density. */
export function density(state: State, both: Both): Picture {
  const share = state.density === "fraction";
  const first = both.a.run.setup.impacts === 1;
  const where = first ? "of the first impact" : `at v = ${state.speed} m/s`;
  const values = each(both, (s) => s.values(share ? "rotational_fraction" : "restitution", ...(first ? ALL : s.window(state.speed))));
  const picture: Picture = {
    title: `Density of ${share ? "the rotational share" : "the restitution"} ${where}`,
    x: { label: share ? SHARE : EPSILON, low: 0, high: 1 },
    y: { label: share ? "p(rotational share | v)" : first ? "p(ε)" : "p(ε | v)", low: 0.1, high: 100, log: !first },
    curves: [],
  };
  const found = values.filter((x) => x.length);
  if (!found.length) return { ...picture, note: both.a.run.impacts ? "No impact at this speed." : "" };
  const ends = (x: Float64Array, tail: number) => [quantile(x, tail), quantile(x, 1 - tail)];
  if (found.every((x) => x.at(-1)! - x[0] < EXACT)) {
    const [value] = found[0];
    const name = share ? "rotational share" : "ε";
    const text = share && value < EXACT ? "Nothing rotates." : `${found[0].length === 1 ? "The only impact has" : `All ${found[0].length.toLocaleString("en")} impacts have`} ${name} = ${Number(value.toPrecision(6))}:\na line, not a distribution.`;
    return { ...picture, x: { ...picture.x, ...between(value - 0.05, value + 0.05) }, mark: value, note: text };
  }
  const fewest = Math.min(...found.map((x) => x.length));
  if (fewest < FEW) {
    const [low, high] = roomy([Math.min(...found.map((x) => x[0])), Math.max(...found.map((x) => x.at(-1)!))], 1e-3);
    const curves = each(both, (s, of): Curve => {
      const x = values[of === "a" ? 0 : 1];
      return { label: `${label(s, of, both)}: ${x.length} impacts`, of, kind: "ticks", x, y: Array.from(x, () => (of === "a" ? 0.3 : 0.2)) };
    });
    return { ...picture, x: { ...picture.x, low, high }, y: { label: "", low: 0, high: 1 }, curves, note: `${fewest} ${fewest === 1 ? "impact" : "impacts"}: too few for a density.\nEach is a tick.` };
  }
  const fits = share || first ? [] : values.map((x) => (x.length ? laplace(x) : undefined));
  const bins = share || first ? Bins.cover(Math.min(...found.map((x) => x[0])), Math.max(...found.map((x) => ends(x, 0.001)[1])), 60) : cusped(found, both.a.run.setup.normal);
  const curves = each(both, (s, of): Curve => steps(values[of === "a" ? 0 : 1], bins, label(s, of, both), of));
  const high = Math.max(...curves.flatMap((c) => c.y.map((y) => y ?? 0)));
  const low = Math.min(...curves.flatMap((c) => c.y.filter((y): y is number => !!y)));
  for (const fit of fits) {
    if (!fit || !(fit.above + fit.below > EXACT)) continue;
    const x = Array.from({ length: 401 }, (_, k) => bins.low + ((bins.high - bins.low) * k) / 400).concat(fit.location).sort((p, q) => p - q);
    curves.push({ label: "Laplace fit", of: "ink", kind: "line", x, y: x.map((at) => laplaceDensity(fit, at)) });
  }
  if (first && !share) {
    const fine = new Bins(bins.low, bins.high, bins.step / 8);
    const exact = firstImpact(both.a.run.setup, fine);
    if (exact) curves.push({ label: "exact, Eq. 21", of: "ink", kind: "line", x: exact.map((_, k) => fine.middle(k)), y: exact });
  }
  const room = 0.03 * (bins.high - bins.low);
  return {
    ...picture,
    x: { ...picture.x, ...between(bins.low - (share ? 0 : room), bins.high + room) },
    y: { ...picture.y, low: first ? 0 : Math.max(low / 2, high / 1e4), high: first ? 1.15 * high : 4 * high },
    curves,
  };
}

const ALL: [number, number] = [-Infinity, Infinity];
const between = (low: number, high: number) => ({ low, high });

/** Bins that show the cusp, with ε_n at an edge: a fraction of the decay length of the flanks, or so wide that the bin at the cusp has
 * some hundred impacts. */
function cusped(values: Float64Array[], normal: number): Bins {
  const decay = Math.min(...values.map((x) => laplace(x)).map(({ above, below }) => (above + below) / 2));
  const number = Math.min(...values.map((x) => x.length));
  const low = Math.min(...values.map((x) => quantile(x, 0.0005)));
  const high = Math.max(...values.map((x) => quantile(x, 0.9995)));
  const step = nice(Math.max(decay / 15, (200 * decay) / number, (high - low) / 400));
  const ends = [Math.floor((low - normal) / step) * step, Math.max(1, Math.ceil((high - normal) / step)) * step];
  return new Bins(normal + ends[0], normal + ends[1], step);
}

function steps(values: Float64Array, bins: Bins, label: string, of: "a" | "b"): Curve {
  const counts = new Float64Array(bins.count);
  for (const value of values) {
    const k = bins.of(value);
    if (k >= 0) counts[k]++;
  }
  const y = Array.from(counts, (n) => (n ? n / (values.length * bins.step) : null));
  return { label, of, kind: "steps", x: bins.edges, y };
}

/** A moment against v, one curve for each set-up. */
function byVelocity(both: Both, edges: number[], moment: (m: ReturnType<Statistics["moments"]>) => number): Curve[] {
  const x = edges.slice(1).map((high, k) => (edges[k] + high) / 2);
  return each(both, (s, of): Curve => {
    const y = x.map((_, k) => {
      const found = s.moments(edges[k], edges[k + 1]);
      return found.number >= LEAST ? moment(found) : null;
    });
    return { label: label(s, of, both), of, kind: "line", x, y };
  });
}
