/** What plays in the scene: the same particle of one or two runs. */

import { Energies, showImpact } from "./energies";
import type { Run } from "./engine/run";
import { part } from "./page";
import { Clock } from "./stage/clock";
import { Path } from "./stage/path";
import { Stage } from "./stage/stage";

export class Player {
  readonly clock = new Clock();
  stage: Stage | undefined;
  private paths: Path[] = [];
  private runs: Run[] = [];
  private particle = 0;
  private shown = NaN;
  /** The impact that is being approached; until it comes, it is the one to look at. */
  private awaited = 0;
  private last = performance.now();
  private readonly energies = new Energies(part("energies"));
  private asked = 0;

  /** `moved` hears of every impact that is passed, with its number; `stopped` when the play starts or ends. */
  constructor(private readonly moved: (impact: number) => void, private readonly stopped: () => void) {
    try {
      this.stage = new Stage(part("stage"));
    } catch {
      part("stage").textContent = "This browser shows no three-dimensional graphics (WebGL 2). All else works.";
    }
    const draw = (now: number) => {
      this.draw(Math.min((now - this.last) / 1000, 0.1));
      this.last = now;
      requestAnimationFrame(draw);
    };
    requestAnimationFrame(draw);
  }

  /** Shows a particle of the runs, shortly before an impact, or from its release. */
  async show(runs: Run[], particle: number, impact: number | undefined, play: boolean): Promise<void> {
    const asked = ++this.asked;
    const rows = await Promise.all(runs.map((run) => run.follow(Math.min(particle, run.particles - 1))));
    if (asked !== this.asked) return;
    this.paths = rows.map((row, k) => new Path(row, runs[k].setup.gravity, runs[k].setup.incline));
    [this.runs, this.particle, this.shown] = [runs, particle, NaN];
    this.stage?.show(this.paths.map((path, k) => ({ path, setup: runs[k].setup, of: k ? "b" : "a" })));
    this.awaited = impact ?? 0;
    if (impact === undefined) this.clock.time = 0;
    else if (play) this.clock.before(this.paths[0], impact);
    else this.clock.after(this.paths[0], impact);
    this.play(play);
  }

  play(playing: boolean): void {
    const path = this.paths[0];
    if (playing && path && this.clock.time >= path.end + path.duration(path.flights.length - 1)) this.clock.time = this.awaited = 0;
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

  private draw(lasted: number): void {
    const path = this.paths[0];
    if (!path) return;
    const was = this.clock.playing;
    this.clock.advance(path, lasted);
    if (was !== this.clock.playing) this.stopped();
    const moment = this.stage ? this.stage.draw(this.clock.time, lasted, was || this.shown !== this.number(path)) : path.at(this.clock.time);
    if (!moment) return;
    if (was || moment.impacts !== this.shown) this.energies.show(path, moment);
    if (moment.impacts === this.shown) return;
    this.shown = moment.impacts;
    showImpact(part("impact"), this.runs[0], this.particle, moment.impacts - 1);
    if (moment.impacts > this.awaited) this.moved(moment.impacts - 1);
  }

  private number(path: Path): number {
    return path.flightAt(this.clock.time);
  }
}
