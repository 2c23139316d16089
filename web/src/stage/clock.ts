/** The time in the scene: physical time, slowed down. */

/** Flights, one after the other, with an impact between two. */
export abstract class Timeline {
  abstract readonly flights: readonly { start: number }[];
  abstract duration(flight: number): number;

  /** Time of an impact, counted from 0, or of the last. */
  impact(number: number): number {
    return this.flights[Math.min(number + 1, this.flights.length - 1)].start;
  }

  /** Time at which there is nothing more to show. */
  get finish(): number {
    const last = this.flights.length - 1;
    return this.flights[last].start + this.duration(last);
  }

  /** Number of the flight under way at a time. */
  flightAt(time: number): number {
    let [low, high] = [0, this.flights.length - 1];
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.flights[middle].start <= time) low = middle;
      else high = middle - 1;
    }
    return low;
  }
}

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
  advance(path: Timeline, lasted: number): void {
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
  before(path: Timeline, impact: number): void {
    const number = Math.min(impact, path.flights.length - 1);
    this.time = path.flights[number].start + 0.5 * path.duration(number);
    this.until = path.impact(impact);
  }
}
