/** The time in the scene: physical time, slowed down. */

import type { Path } from "./path";

/** Slow motion: a factor, or "even", where every flight takes as long as every other. */
export const PACES = ["even", "1", "0.2", "0.05", "0.01"] as const;
export type Pace = (typeof PACES)[number];
/** Duration of a flight at even pace, in s. */
const EVEN = 1.4;

export class Clock {
  time = 0;
  playing = false;
  pace: Pace = "even";
  /** Where it stops and holds. */
  until = Infinity;

  /** Goes on for some time of the viewer; stops at the end. */
  advance(path: Path, lasted: number): void {
    if (!this.playing) return;
    const number = path.flightAt(this.time);
    const rate = this.pace === "even" ? Math.max(path.duration(number), 1e-9) / EVEN : Number(this.pace);
    const next = path.flights[number + 1];
    this.time += rate * lasted;
    // A slow picture shall not skip impacts at even pace.
    if (this.pace === "even" && next && this.time > next.start) this.time = next.start;
    const end = Math.min(this.until, path.finish);
    if (this.time >= end) {
      this.time = end;
      this.playing = false;
    }
  }

  /** Goes to shortly before an impact, half of the flight that leads to it, and will hold at it. */
  before(path: Path, impact: number): void {
    const number = Math.min(impact, path.flights.length - 1);
    this.time = path.flights[number].start + 0.5 * path.duration(number);
    this.until = path.impact(impact);
  }
}
