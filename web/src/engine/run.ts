/** A run in the workers: its impacts come in portions, in any order, and fill one table. */

import { isRigid, particlesOf, type Setup } from "../setup";
import { COLUMNS, numbers, type Column } from "./layout";
import type { Pool } from "./pool";

/** Impacts in a portion: a few milliseconds of work. */
const PORTION = 2000;
/** The columns behind the digest, in its order; only a body with an axis has an angle. */
export const digested = (s: Setup): Column[] => ["time", "restitution", "energy_ratio", ...(isRigid(s) ? [] : (["angle"] as const))];

export type Portion = { first: number; count: number };

export class Run {
  readonly particles: number;
  readonly columns: Record<Column, Float64Array>;
  /** Number of impacts, stop reason, angle at release; one a particle. */
  readonly counts: Float64Array;
  readonly reasons: Float64Array;
  readonly angles: Float64Array;
  readonly parameters: Float64Array;
  /** Impacts so far. */
  impacts = 0;
  /** Particles so far. */
  finished = 0;
  digest = "";
  private cancelled = false;
  readonly started = performance.now();
  took = 0;

  constructor(readonly setup: Setup, private readonly pool: Pool) {
    this.particles = particlesOf(setup);
    this.parameters = numbers(setup);
    const size = this.particles * setup.impacts;
    const table = () => new Float64Array(size).fill(NaN);
    this.columns = Object.fromEntries(COLUMNS.map((name) => [name, table()])) as Record<Column, Float64Array>;
    this.counts = new Float64Array(this.particles);
    this.reasons = new Float64Array(this.particles);
    this.angles = new Float64Array(this.particles);
  }

  /** Bounces every particle; `arrived` sees each portion. Resolves when all is done, with its digest. */
  async start(arrived: (portion: Portion) => void): Promise<void> {
    const step = Math.max(1, Math.floor(PORTION / this.setup.impacts));
    const portions: Promise<void>[] = [];
    for (let first = 0; first < this.particles; first += step) {
      const count = Math.min(step, this.particles - first);
      const task = { kind: "simulate", parameters: this.parameters, first, count } as const;
      portions.push(
        this.pool.run(task, this).then((table) => {
          if (this.cancelled) return;
          this.take(table as Float64Array, first, count);
          arrived({ first, count });
        }),
      );
    }
    await Promise.all(portions);
    this.took = performance.now() - this.started;
    const columns = digested(this.setup).map((name) => this.columns[name]);
    this.digest = (await this.pool.run({ kind: "digest", columns }, this)) as string;
  }

  cancel(): void {
    this.cancelled = true;
    this.pool.drop(this);
  }

  /** The flights of a particle. */
  async follow(particle: number): Promise<Float64Array> {
    const task = { kind: "follow", parameters: this.parameters, particle } as const;
    return (await this.pool.run(task, undefined, true)) as Float64Array;
  }

  private take(table: Float64Array, first: number, count: number): void {
    const size = count * this.setup.impacts;
    COLUMNS.forEach((name, k) => {
      this.columns[name].set(table.subarray(k * size, (k + 1) * size), first * this.setup.impacts);
    });
    const rest = table.subarray(COLUMNS.length * size);
    [this.counts, this.reasons, this.angles].forEach((column, k) => {
      column.set(rest.subarray(k * count, (k + 1) * count), first);
    });
    for (let i = 0; i < count; i++) this.impacts += rest[i];
    this.finished += count;
  }
}
