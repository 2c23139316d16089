/** What the charts show, counted as portions arrive: lattices of (v, ε) and (v, E_rot/E_tot), and moments by v. */

import type { Portion, Run } from "./engine/run";
import { fallSpeed, type Setup } from "./setup";

/** Uniform bins [low + k step, low + (k + 1) step). */
export class Bins {
  readonly count: number;

  constructor(readonly low: number, high: number, readonly step: number) {
    this.count = Math.round((high - low) / step);
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
}

/** Counts over rows of v and columns of another number. */
export class Lattice {
  readonly counts: Uint32Array;
  /** Everything that was counted, also outside: it tells whether a drawing is of now. */
  seen = 0;

  constructor(readonly v: Bins, readonly other: Bins) {
    this.counts = new Uint32Array(v.count * other.count);
  }

  add(v: number, other: number): void {
    const row = this.v.of(v);
    const column = this.other.of(other);
    this.seen++;
    if (row >= 0 && column >= 0) this.counts[row * this.other.count + column]++;
  }

  /** The sum over the rows whose middle is in [low, high). */
  over(low: number, high: number): { counts: Float64Array; total: number } {
    const counts = new Float64Array(this.other.count);
    let total = 0;
    for (let row = 0; row < this.v.count; row++) {
      const middle = this.v.middle(row);
      if (middle < low || middle >= high) continue;
      for (let k = 0; k < counts.length; k++) {
        const count = this.counts[row * counts.length + k];
        counts[k] += count;
        total += count;
      }
    }
    return { counts, total };
  }
}

/** 1, 2 or 5 times a power of ten, at least `value`. */
function nice(value: number): number {
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 2, 5, 10].map((k) => k * power).find((x) => x >= value * (1 - 1e-9))!;
}

/** Mesh of v: the paper's 0.002 m/s for the paper's fall. */
export const meshOf = (s: Setup): number => nice(Math.max(fallSpeed(s), 1e-3) / 600);

/** ε of the lattices: the range of Fig. 7, at the mesh of Fig. 2. */
export const RESTITUTION = { low: -3, high: 4, step: 0.01 };
export const FRACTION = { low: 0, high: 1, step: 0.005 };
/** Half-width of the window about a speed, as a share of it; the paper's redrawing takes the same. */
export const WINDOW = 0.05;

export class Statistics {
  readonly v: Bins;
  readonly restitution: Lattice;
  readonly fraction: Lattice;
  /** Per bin of v: number, and sums of ε − ε_n, its square, and E_rot/E_tot. */
  readonly number: Float64Array;
  readonly first: Float64Array;
  readonly second: Float64Array;
  readonly share: Float64Array;
  /** Impacts that multiplied the kinetic energy by more than 1 + 10⁻¹², and the largest factor. */
  created = 0;
  largest = 1;
  negative = 0;
  readonly stops = new Uint32Array(5);

  constructor(readonly run: Run) {
    const mesh = meshOf(run.setup);
    const most = Math.ceil((1.1 * fallSpeed(run.setup)) / (10 * mesh)) * 10 * mesh;
    this.v = new Bins(-Math.ceil((0.1 * most) / (10 * mesh)) * 10 * mesh, most, mesh);
    this.restitution = new Lattice(this.v, new Bins(RESTITUTION.low, RESTITUTION.high, RESTITUTION.step));
    this.fraction = new Lattice(this.v, new Bins(FRACTION.low, FRACTION.high, FRACTION.step));
    const row = () => new Float64Array(this.v.count);
    [this.number, this.first, this.second, this.share] = [row(), row(), row(), row()];
  }

  add({ first, count }: Portion): void {
    const { columns, counts, reasons, setup } = this.run;
    for (let particle = first; particle < first + count; particle++) {
      this.stops[reasons[particle]]++;
      const start = particle * setup.impacts;
      for (let i = start; i < start + counts[particle]; i++) {
        const v = columns.impact_velocity[i];
        const epsilon = columns.restitution[i];
        const fraction = columns.rotational_fraction[i];
        const ratio = columns.energy_ratio[i];
        this.restitution.add(v, epsilon);
        this.fraction.add(v, fraction);
        if (ratio > 1 + 1e-12) this.created++;
        if (ratio > this.largest) this.largest = ratio;
        if (epsilon < 0) this.negative++;
        const bin = this.v.of(v);
        if (bin < 0 || !Number.isFinite(epsilon)) continue;
        const off = epsilon - setup.normal;
        this.number[bin]++;
        this.first[bin] += off;
        this.second[bin] += off * off;
        this.share[bin] += fraction;
      }
    }
  }

  /** σ(ε), the mean of ε and that of E_rot/E_tot where v is in [low, high). */
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
}
