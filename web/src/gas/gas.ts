/** What the page shows of a gas that cools: its particles in a box, and its temperatures. */

import { Chart } from "../charts/chart";
import type { Picture } from "../charts/picture";
import { gasNumbers } from "../engine/layout";
import type { Pool } from "../engine/pool";
import { part } from "../page";
import type { Setup } from "../setup";
import { BoxScene } from "../stage/box";
import { short } from "../stage/overlay";
import { eachFrame, viewIn } from "../stage/view";
import { stepOf, type Step } from "./step";

/** Collisions of a particle in a step, and after which the gas is not followed any more. */
const STEP = 0.1;
const MOST = 100;
/** Temperatures are drawn over so many decades at least. */
const DECADES = 1;

export class Gas {
  readonly scene = viewIn(part("gas-stage"), BoxScene);
  /** Collisions of a particle in a second of the viewer. */
  pace = 1;
  playing = false;
  private readonly chart = new Chart(part("gas-chart"));
  private setup: Setup | undefined;
  private now: Step | undefined;
  /** The step that comes next, once it is there. */
  private next: Step | undefined;
  private asked = 0;
  private number = 0;
  /** Time since the last step, and how long it lasts. */
  private since = 0;
  private time = 0;
  private collisions = 0;
  private readonly course: { time: number[]; translational: number[]; rotational: number[] } = { time: [], translational: [], rotational: [] };

  constructor(private readonly pool: Pool, private readonly changed: () => void, private readonly failed: (error: Error) => void) {
    eachFrame((lasted) => this.draw(lasted));
  }

  /** A gas from its beginning. */
  async start(setup: Setup, play: boolean): Promise<void> {
    this.asked++;
    [this.setup, this.now, this.next] = [setup, undefined, undefined];
    [this.number, this.since, this.time, this.collisions] = [0, 0, 0, 0];
    for (const values of Object.values(this.course)) values.length = 0;
    this.playing = play;
    await this.ask();
    if (this.next) this.take();
    this.changed();
  }

  restyle(): void {
    this.scene?.restyle();
    this.chart.draw();
  }

  /** For paper. */
  flatten(): void {
    this.scene?.flatten(this.at);
    this.chart.draw();
  }

  play(playing: boolean): void {
    this.playing = playing;
    this.changed();
  }

  /** Asks for the next step. */
  private async ask(): Promise<void> {
    const asked = this.asked;
    const states = this.now?.states ?? new Float64Array();
    const parameters = Float64Array.of(...gasNumbers(this.setup!, STEP, this.number++), ...states);
    const table = await this.pool.run({ kind: "cool", parameters, states: this.now?.count ?? 0 }, undefined, true);
    if (asked === this.asked) this.next = stepOf(table as Float64Array);
  }

  /** The next step begins. */
  private take(): void {
    const step = this.next!;
    const [first, then] = step.looks;
    if (!this.now) {
      this.note(0, first);
      this.scene?.show(step, this.setup!);
    }
    [this.now, this.next] = [step, undefined];
    this.scene?.take(step);
    this.time += then.time;
    this.collisions += then.collisions;
    this.note(this.time, then);
    this.tell();
    this.since = 0;
    if (this.collisions < MOST) this.ask().catch(this.failed);
    else this.play(false);
  }

  private note(time: number, { translational, rotational }: Step["looks"][number]): void {
    const { course } = this;
    course.time.push(time);
    course.translational.push(translational);
    course.rotational.push(rotational);
    this.chart.show(() => this.picture());
  }

  private draw(lasted: number): void {
    if (!this.now || !part("gas-stage").clientWidth) return;
    if (this.playing) this.since += (lasted * this.pace) / STEP;
    if (this.since >= 1 && this.next) this.take();
    this.scene?.draw(this.at, this.playing);
  }

  /** Time since the last step; until the next one is there the particles wait. */
  private get at(): number {
    return this.now ? Math.min(this.since, 1) * this.now.looks[1].time : 0;
  }

  private tell(): void {
    const { course } = this;
    const [translational, rotational] = [course.translational, course.rotational].map((values) => values.at(-1)! / course.translational[0]);
    const { contacts, collisions } = this.now!.looks[1];
    part("gas-text").textContent = `${short(this.time)} s, ${this.collisions.toFixed(1)} collisions of each particle: T_tr = ${translational.toPrecision(3)} T₀, T_rot = ${rotational.toPrecision(3)} T₀; T_rot/T_tr = ${(rotational / translational).toPrecision(3)}. Contacts of an encounter: ${(contacts / collisions).toFixed(2)}.`;
  }

  /** The temperatures so far. */
  private picture(): Picture {
    const { time, translational, rotational } = this.course;
    const share = (values: number[]) => values.map((value) => value / translational[0]);
    const seen = [...share(translational), ...share(rotational)].filter((value) => value > 0);
    const low = 10 ** Math.floor(Math.log10(Math.min(...seen, 10 ** -DECADES)) + 1e-9);
    return {
      title: "Temperatures of translation and rotation against time",
      x: { label: "time (s)", low: 0, high: Math.max(time.at(-1)!, 1e-9) },
      y: { label: "T / T₀", low, high: 2 * Math.max(...seen, 1), log: true },
      curves: [
        { label: "T_tr", of: "a", kind: "line", x: time, y: share(translational) },
        { label: "T_rot", of: "b", kind: "line", x: time, y: share(rotational) },
      ],
    };
  }
}
