/** What plays in the scene: the same particle of one or two runs. */

import { drawing, type Struck } from "./charts/drawing";
import { Energies, showImpact } from "./energies";
import type { Run } from "./engine/run";
import { record, type Film } from "./export/record";
import { freely } from "./outline";
import { part } from "./page";
import { isRigid } from "./setup";
import { BODIES } from "./table";
import { Clock } from "./stage/clock";
import { Path } from "./stage/path";
import { Stage } from "./stage/stage";
import { eachFrame, viewIn } from "./stage/view";

export class Player {
  readonly clock = new Clock();
  readonly stage = viewIn(part("stage"), Stage);
  private paths: Path[] = [];
  private runs: Run[] = [];
  private particle = 0;
  private shown = NaN;
  /** The impact that is being approached; until it comes, it is the one to look at. */
  private awaited = 0;
  private readonly energies = new Energies(part("energies"));
  private asked = 0;
  /** A film that is being made: where each picture goes, and what to do at its end. */
  private film: { canvas: HTMLCanvasElement; finish: () => void } | undefined;

  /** `moved` hears of every impact that is passed, with its number; `stopped` when the play starts or ends. */
  constructor(private readonly moved: (impact: number) => void, private readonly stopped: () => void) {
    eachFrame((lasted) => this.draw(lasted));
  }

  /** Shows a particle of the runs, shortly before an impact, at which it holds, or from its release; as an orbit it goes on, and leaves ghosts. */
  async show(runs: Run[], particle: number, impact: number | undefined, play: boolean, orbit: boolean): Promise<void> {
    const asked = ++this.asked;
    this.film?.finish();
    const rows = await Promise.all(runs.map((run) => run.follow(Math.min(particle, run.particles - 1))));
    if (asked !== this.asked) return;
    this.paths = rows.map((row, k) => new Path(row, runs[k].setup.gravity, runs[k].setup.incline, freely(runs[k].setup)));
    [this.runs, this.particle, this.shown] = [runs, particle, NaN];
    if (this.stage) this.stage.ghosts = orbit;
    this.stage?.show(this.paths.map((path, k) => ({ path, setup: runs[k].setup, of: k ? "b" : "a" })));
    this.awaited = impact ?? 0;
    this.clock.until = Infinity;
    if (impact === undefined) this.clock.time = 0;
    else if (play) this.clock.before(this.paths[0], impact);
    else this.clock.time = this.paths[0].impact(impact);
    if (orbit) this.clock.until = Infinity;
    this.clock.playing = play;
    this.stopped();
  }

  get playing(): boolean {
    return this.clock.playing;
  }

  /** Plays on, from the start if it is at the end; or stops. */
  play(playing: boolean): void {
    const path = this.paths[0];
    if (playing && path && this.clock.time >= path.finish) this.clock.time = this.awaited = 0;
    this.clock.until = Infinity;
    this.clock.playing = playing;
    this.stopped();
  }

  /** Tells anew of the impact that is shown: its numbers have come. */
  refresh(): void {
    this.shown = NaN;
  }

  /** Goes to just after the impact before or after the present one. */
  step(by: number): void {
    const path = this.paths[0];
    if (!path) return;
    const number = Math.min(Math.max(path.flightAt(this.clock.time) + by, 0), path.flights.length - 1);
    this.clock.time = path.flights[number].start;
    this.awaited = 0;
    this.play(false);
  }

  /** A film of an impact: the flight that leads to it, and half of the next. */
  async record(impact: number): Promise<Film> {
    const path = this.paths[0];
    const last = path.flights.length - 1;
    const number = Math.max(Math.min(impact, last - 1), 0);
    this.clock.time = path.flights[number].start;
    this.awaited = number;
    const canvas = document.createElement("canvas");
    this.stage!.compose(canvas);
    const end = record(canvas);
    this.clock.until = path.impact(number) + 0.5 * path.duration(Math.min(number + 1, last));
    this.clock.playing = true;
    this.stopped();
    await new Promise<void>((finish) => (this.film = { canvas, finish }));
    this.film = undefined;
    return end();
  }

  /** The last impact before now, as it is drawn on paper, or why it is not. */
  get struck(): Struck | string {
    const path = this.paths[0];
    if (path && isRigid(this.runs[0].setup)) return `Only of these is the impact drawn in a plane: ${BODIES.map(({ key }) => key.replace("-", " ")).join(", ")}.`;
    const impacts = path?.flightAt(this.clock.time) ?? 0;
    return impacts > 0 ? drawing(path, this.runs[0].setup, impacts) : "No impact yet: play, or step to one.";
  }

  private draw(lasted: number): void {
    const path = this.paths[0];
    if (!path) return;
    const was = this.clock.playing;
    // A film takes twice the time: what takes a second or two is over before one has looked.
    this.clock.advance(path, this.film ? lasted / 2 : lasted);
    if (was !== this.clock.playing) this.stopped();
    const moment = this.stage ? this.stage.draw(this.clock.time, was || this.shown !== path.flightAt(this.clock.time)) : path.at(this.clock.time);
    if (!moment) return;
    if (this.film) {
      this.stage!.compose(this.film.canvas);
      if (!this.clock.playing) this.film.finish();
    }
    if (was || moment.impacts !== this.shown) this.energies.show(path, moment);
    if (moment.impacts === this.shown) return;
    this.shown = moment.impacts;
    showImpact(part("impact"), this.runs[0], this.particle, moment.impacts - 1);
    if (moment.impacts > this.awaited) this.moved(moment.impacts - 1);
  }
}
