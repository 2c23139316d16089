/** What the charts show: lattices of (v, ε) and (v, rotational share) and moments by v, counted as portions arrive; values at a speed. */

import type { Column } from "./engine/layout";
import type { Portion, Run } from "./engine/run";
import { fallSpeed } from "./outline";
import type { Setup } from "./setup";

/** Uniform bins [low + k step, low + (k + 1) step). */
export class Bins {
  readonly count: number;

  constructor(readonly low: number, high: number, readonly step: number) {
    this.count = Math.max(1, Math.round((high - low) / step));
  }

  /** Some `many` bins with a round step that cover [low, high]. */
  static cover(low: number, high: number, many: number): Bins {
    const step = nice((high - low) / many);
    const first = Math.floor(low / step + 1e-9) * step;
    return new Bins(first, Math.ceil(high / step - 1e-9) * step, step);
  }

  /** The bin of a value; −1 outside. */
  of(value: number): number {
    const k = Math.floor((value - this.low) / this.step);
    return k >= 0 && k < this.count ? k : -1;
  }

  edge(k: number): number {
    return this.low + k * this.step;
  }

  middle(k: number): number {
    return this.low + (k + 0.5) * this.step;
  }

  get high(): number {
    return this.edge(this.count);
  }

  get edges(): number[] {
    return Array.from({ length: this.count + 1 }, (_, k) => this.edge(k));
  }
}

/** Counts over rows of v and columns of another number. */
export class Lattice {
  readonly counts: Uint32Array;
  /** The largest count. */
  most = 1;
  /** Everything that was counted, also outside: it tells whether a drawing is of now. */
  seen = 0;

  constructor(readonly v: Bins, readonly other: Bins) {
    this.counts = new Uint32Array(v.count * other.count);
  }

  add(v: number, other: number): void {
    const row = this.v.of(v);
    const column = this.other.of(other);
    this.seen++;
    if (row < 0 || column < 0) return;
    const count = ++this.counts[row * this.other.count + column];
    if (count > this.most) this.most = count;
  }
}

/** 1, 2 or 5 times a power of ten, at least `value`. */
export function nice(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((k) => k * power).find((x) => x >= value * (1 - 1e-9))!;
}

/** Mesh of v: the paper's 0.002 m/s for the paper's fall. */
export const meshOf = (s: Setup): number => nice(Math.max(fallSpeed(s), 1e-3) / 600);

/** Half-width of the window about a speed, as a share of it; the paper's redrawing takes the same. */
export const WINDOW = 0.05;
/** Lattices that are kept and counted on. */
const VIEWS = 4;
/** What is left out at either end of the values of a run where its range is asked for. */
const TAIL = 0.003;
/** Impacts that are looked at for that. */
const SAMPLE = 20_000;

type Counted = Extract<Column, "restitution" | "rotational_fraction">;

export class Statistics {
  readonly v: Bins;
  /** Per bin of v: number, and sums of ε − ε_n, its square, and the rotational share. */
  private readonly number: Float64Array;
  private readonly first: Float64Array;
  private readonly second: Float64Array;
  private readonly share: Float64Array;
  private found = { impacts: -1, values: new Map<string, Float64Array>() };
  private readonly views = new Map<string, { column: Counted; lattice: Lattice }>();
  /** Impacts that multiplied the kinetic energy by more than 1 + 10⁻¹², and the largest factor. */
  created = 0;
  largest = 1;
  negative = 0;
  /** Largest |ε − ε_n| and rotational share. */
  scatter = 0;
  rotation = 0;
  readonly stops = new Uint32Array(5);

  constructor(readonly run: Run) {
    const mesh = meshOf(run.setup);
    const most = Math.ceil((1.1 * fallSpeed(run.setup)) / (10 * mesh)) * 10 * mesh;
    this.v = new Bins(-Math.ceil((0.1 * most) / (10 * mesh)) * 10 * mesh, most, mesh);
    const row = () => new Float64Array(this.v.count);
    [this.number, this.first, this.second, this.share] = [row(), row(), row(), row()];
  }

  add({ first, count }: Portion): void {
    const { columns, reasons, setup } = this.run;
    for (let particle = first; particle < first + count; particle++) this.stops[reasons[particle]]++;
    for (const { column, lattice } of this.views.values()) this.count(column, lattice, first, count);
    this.each(first, count, (i) => {
      const v = columns.impact_velocity[i];
      const epsilon = columns.restitution[i];
      const fraction = columns.rotational_fraction[i];
      const ratio = columns.energy_ratio[i];
      if (ratio > 1 + 1e-12) this.created++;
      if (ratio > this.largest) this.largest = ratio;
      if (epsilon < 0) this.negative++;
      if (fraction > this.rotation) this.rotation = fraction;
      const off = epsilon - setup.normal;
      if (Math.abs(off) > this.scatter) this.scatter = Math.abs(off);
      const bin = this.v.of(v);
      if (bin < 0 || !Number.isFinite(epsilon)) return;
      this.number[bin]++;
      this.first[bin] += off;
      this.second[bin] += off * off;
      this.share[bin] += fraction;
    });
  }

  /** Impacts of v and another number, in these bins; kept, and counted on as portions arrive. */
  lattice(column: Counted, v: Bins, other: Bins): Lattice {
    const key = [column, v.low, v.count, v.step, other.low, other.count, other.step].join();
    let view = this.views.get(key);
    if (!view) {
      if (this.views.size >= VIEWS) this.views.delete(this.views.keys().next().value!);
      view = { column, lattice: new Lattice(v, other) };
      this.views.set(key, view);
      this.count(column, view.lattice, 0, this.run.particles);
    }
    return view.lattice;
  }

  /** The values of a column where v is in [low, high), in order. */
  values(column: Counted, low: number, high: number): Float64Array {
    return this.kept(`${column} ${low} ${high}`, () => {
      const { impact_velocity: v, [column]: values } = this.run.columns;
      const found: number[] = [];
      this.each(0, this.run.particles, (i) => {
        if (v[i] >= low && v[i] < high && Number.isFinite(values[i])) found.push(values[i]);
      });
      return Float64Array.from(found).sort();
    });
  }

  /** Where nearly all values of a column are, of the impacts faster than a twentieth of the fall. */
  range(column: Counted | "impact_velocity"): [number, number] {
    const sorted = this.kept(column, () => {
      const { impact_velocity: v, [column]: values } = this.run.columns;
      const slow = 0.05 * fallSpeed(this.run.setup);
      const every = Math.max(1, Math.floor(this.run.impacts / SAMPLE));
      const found: number[] = [];
      let k = 0;
      this.each(0, this.run.particles, (i) => {
        if (k++ % every === 0 && v[i] > slow && Number.isFinite(values[i])) found.push(values[i]);
      });
      return Float64Array.from(found).sort();
    });
    return sorted.length ? [quantile(sorted, TAIL), quantile(sorted, 1 - TAIL)] : [0, 1];
  }

  /** Mean and σ of ε, and the mean rotational share, where v is in [low, high). */
  moments(low: number, high: number): { number: number; mean: number; deviation: number; share: number } {
    let [n, a, b, c] = [0, 0, 0, 0];
    for (let k = 0; k < this.v.count; k++) {
      const middle = this.v.middle(k);
      if (middle < low || middle >= high) continue;
      n += this.number[k];
      a += this.first[k];
      b += this.second[k];
      c += this.share[k];
    }
    const mean = a / n;
    const deviation = n > 1 ? Math.sqrt(Math.max(0, (b - n * mean * mean) / (n - 1))) : NaN;
    return { number: n, mean: this.run.setup.normal + mean, deviation, share: c / n };
  }

  /** The window of v that stands for a speed. */
  window(speed: number): [number, number] {
    const half = Math.max(WINDOW * Math.abs(speed), 0.75 * this.v.step);
    return [speed - half, speed + half];
  }

  /** What was found among the impacts that are there, until there are more. */
  private kept(key: string, find: () => Float64Array): Float64Array {
    if (this.found.impacts !== this.run.impacts || this.found.values.size > 2 * VIEWS) this.found = { impacts: this.run.impacts, values: new Map() };
    const values = this.found.values.get(key) ?? find();
    this.found.values.set(key, values);
    return values;
  }

  private count(column: Counted, lattice: Lattice, first: number, count: number): void {
    const { columns } = this.run;
    this.each(first, count, (i) => lattice.add(columns.impact_velocity[i], columns[column][i]));
  }

  /** The places of the impacts of some particles; those that have not come yet have none. */
  private each(first: number, count: number, visit: (place: number) => void): void {
    const { counts, setup } = this.run;
    for (let particle = first; particle < first + count; particle++) {
      const start = particle * setup.impacts;
      for (let i = start; i < start + counts[particle]; i++) visit(i);
    }
  }
}

/** Of sorted values. */
export const quantile = (sorted: Float64Array, share: number): number =>
  sorted[Math.min(sorted.length - 1, Math.max(0, Math.floor(share * sorted.length)))];
