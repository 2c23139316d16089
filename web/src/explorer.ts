/** The state of the page, its runs and its pictures; what people do to it is in main.ts. */

import { Chart } from "./charts/chart";
import * as pictures from "./charts/pictures";
import { Run } from "./engine/run";
import type { Pool } from "./engine/pool";
import { Paper } from "./charts/drawing";
import { duration } from "./energies";
import { initial, toHash, type State } from "./link";
import { part } from "./page";
import { endings, inStep, KINDS, notable, type Kind } from "./pick";
import { Gas } from "./gas/gas";
import { Pairs } from "./pair/pairs";
import { Player } from "./player";
import type { Setup } from "./setup";
import { Statistics } from "./statistics";

/** While impacts arrive the charts are drawn no more often than this, in ms. */
const PATIENCE = 80;
export type ChartName = "scatter-a" | "scatter-b" | "density" | "sigma" | "reservoir" | "orbit";

export class Explorer {
  state: State = initial();
  runs: { a?: Statistics; b?: Statistics } = {};
  readonly charts: Record<ChartName, Chart>;
  readonly paper = new Paper(part("drawing"));
  readonly player: Player;
  private pairs: Pairs | undefined;
  private cooling: Gas | undefined;
  private drawing = false;
  private drawn = 0;
  private ended = 0;

  constructor(private readonly pool: Pool, private readonly changed: () => void) {
    this.player = new Player((impact) => this.spot(impact), () => this.changed());
    const drag = (speed: number) => this.setSpeed(speed);
    this.charts = {
      "scatter-a": new Chart(part("scatter-a"), { drag, pick: (...at) => this.pick("a", ...at) }),
      "scatter-b": new Chart(part("scatter-b"), { drag, pick: (...at) => this.pick("b", ...at) }),
      density: new Chart(part("density-chart")),
      sigma: new Chart(part("sigma-chart"), { drag }),
      reservoir: new Chart(part("reservoir-chart"), { drag }),
      orbit: new Chart(part("orbit-chart"), { drag: (number) => this.take(this.state.particle, Math.max(Math.round(number) - 1, 0), false) }),
    };
  }

  /** Two bodies, once somebody looks at them. */
  get meeting(): Pairs {
    return (this.pairs ??= new Pairs(this.pool, () => this.changed()));
  }

  /** A gas, likewise. */
  get gas(): Gas {
    return (this.cooling ??= new Gas(this.pool, () => this.changed(), (error) => this.problem(error.message)));
  }

  /** What plays now. */
  get playing(): Player | Pairs | Gas {
    return { plane: this.player, pair: this.pairs, gas: this.cooling }[this.state.show] ?? this.player;
  }

  /** Whether all impacts are there. */
  get done(): boolean {
    return this.ended === this.wanted.length;
  }

  private get wanted(): ("a" | "b")[] {
    return this.state.b ? ["a", "b"] : ["a"];
  }

  /** Takes a state, and computes what is new in it. */
  go(state: State, play = false, kind?: Kind): void {
    part("found").textContent = "";
    this.waiting = [];
    this.state = state;
    if (state.show !== "plane") return void this.fly(play);
    for (const which of ["a", "b"] as const) {
      const setup = state[which];
      if (setup && JSON.stringify(this.runs[which]?.run.setup) === JSON.stringify(setup)) continue;
      this.runs[which]?.run.cancel();
      delete this.runs[which];
      if (setup) this.start(which, setup);
    }
    this.ended = this.wanted.filter((which) => this.runs[which]?.run.digest).length;
    if (kind) this.whenDone(() => this.find(kind, 0, play));
    else void this.replay(state.impact > 0 ? state.impact : undefined, play);
    this.redraw();
    this.changed();
  }

  /** Shows the encounter of the state, or its gas. */
  private async fly(play: boolean): Promise<void> {
    this.player.clock.playing = false;
    this.problem("");
    this.changed();
    const { a, show } = this.state;
    try {
      await (show === "pair" ? this.meeting.show(this.state, play) : this.gas.start(a, play));
      document.documentElement.dataset.state = "done";
    } catch (error) {
      this.problem((error as Error).message.replace("this body", a.shape));
    }
  }

  /** One run, from its first impact to its digest. */
  private start(which: "a" | "b", setup: Setup): void {
    const statistics = new Statistics(new Run(setup, this.pool));
    this.runs[which] = statistics;
    const { run } = statistics;
    this.problem("");
    const started = run.start((portion) => {
      statistics.add(portion);
      if (this.state.particle >= portion.first && this.state.particle < portion.first + portion.count) this.player.refresh();
      // Portions come in milliseconds; the engine needs the time that drawing each of them would take.
      if (performance.now() - this.drawn > PATIENCE) this.redraw();
    });
    started.then(
      () => {
        if (this.runs[which] !== statistics) return;
        this.ended += 1;
        this.redraw();
        this.changed();
        if (this.done) for (const act of this.waiting.splice(0)) act();
      },
      (error: Error) => {
        if (this.runs[which] === statistics) this.problem(error.message);
      },
    );
  }

  private waiting: (() => void)[] = [];
  private whenDone(act: () => void): void {
    if (this.done) act();
    else this.waiting = [act];
  }

  /** Says what is wrong with the set-up; nothing: "". */
  problem(text: string, mend?: { name: string; act: () => void }): void {
    part("problem").hidden = !text;
    part("problem").textContent = text;
    if (!mend) return;
    const button = document.createElement("button");
    [button.type, button.textContent] = ["button", mend.name];
    button.addEventListener("click", mend.act);
    part("problem").append(" ", button);
  }

  async replay(impact: number | undefined, play: boolean): Promise<void> {
    const runs = this.wanted.flatMap((which) => this.runs[which]?.run ?? []);
    const particle = Math.min(this.state.particle, runs[0].particles - 1);
    this.state.particle = particle;
    try {
      await this.player.show(runs, particle, impact, play, this.state.chart === "orbit");
    } catch (error) {
      this.problem((error as Error).message);
    }
  }

  /** Replays the impact of a kind; gives how many of it there are. */
  find(kind: Kind, number: number, play = true): number {
    const run = this.runs.a!.run;
    const found = notable(run, kind);
    const at = found[number % Math.max(found.length, 1)];
    part("found").textContent = found.length
      ? `${(number % found.length) + 1} of ${found.length}${found.length === 50 ? " and more" : ""}: particle ${at.particle}, impact ${at.impact + 1}`
      : `none in this run: ${KINDS[kind].toLowerCase()}`;
    if (at) this.take(at.particle, at.impact, play);
    return found.length;
  }

  private take(particle: number, impact: number, play: boolean): void {
    this.state.particle = particle;
    this.state.impact = impact;
    void this.replay(impact, play);
    this.redraw();
    this.changed();
  }

  /** The impact nearest to a place in the scatter, if one is near; of those that can hardly be told apart that of the longest orbit. */
  private pick(which: "a" | "b", v: number, epsilon: number, [dv, de]: [number, number]): void {
    const { columns, setup } = this.runs[which]!.run;
    let [best, nearest, longest] = [-1, 14 ** 2, 0];
    for (let i = 0; i < columns.restitution.length; i++) {
      const off = ((columns.impact_velocity[i] - v) / dv) ** 2 + ((columns.restitution[i] - epsilon) / de) ** 2;
      const steps = off < 2 ** 2 ? inStep(this.runs[which]!.run, i) : 0;
      if (steps > longest || (!longest && off < nearest)) [best, nearest, longest] = [i, off, steps];
    }
    if (best < 0) this.setSpeed(v);
    else this.take(Math.floor(best / setup.impacts), best % setup.impacts, true);
  }

  /** The impact in the scene, shown in the scatter. */
  private spot(impact: number): void {
    this.state.impact = Math.max(impact, 0);
    this.redraw();
  }

  /** Draws also what is outside the window, for paper. */
  drawAll(): void {
    for (const chart of Object.values(this.charts)) chart.draw();
    this.paper.draw();
    this.player.stage?.flatten(this.player.clock.time);
    this.pairs?.space?.flatten(this.pairs.clock.time);
    this.cooling?.flatten();
  }

  /** Draws everything in the colours and the size in force. */
  restyle(): void {
    this.player.stage?.restyle();
    this.pairs?.space?.restyle();
    this.cooling?.restyle();
    this.redraw();
  }

  setSpeed(speed: number): void {
    this.state.speed = Number(speed.toPrecision(3));
    this.redraw();
    this.changed();
  }

  hash(): string {
    return toHash(this.state);
  }

  /** Draws at the next frame, however often it is asked. */
  redraw(): void {
    if (this.drawing) return;
    this.drawing = true;
    requestAnimationFrame(() => {
      this.drawing = false;
      this.draw();
      this.drawn = performance.now();
    });
  }

  private draw(): void {
    const { a, b } = this.runs;
    if (!a) return;
    const started = performance.now();
    const [both, { state, charts }] = [{ a, b }, this];
    charts["scatter-a"].show(() => pictures.scatter(state, a, "a", charts["scatter-a"].inner));
    if (b) charts["scatter-b"].show(() => pictures.scatter(state, b, "b", charts["scatter-b"].inner));
    charts.density.show(() => pictures.density(state, both));
    charts.sigma.show(() => pictures.scatterWidth(state, both));
    charts.reservoir.show(() => pictures.reservoir(state, both));
    charts.orbit.show(() => pictures.orbit(state, both));
    this.paper.show(this.player.struck);
    this.describe();
    // For those who wait for the page: how long this took, and whether all of it is there to be seen.
    document.documentElement.dataset.redraw = (performance.now() - started).toFixed(1);
    if (this.done) document.documentElement.dataset.state = "done";
  }

  /** The same in words and numbers. */
  private describe(): void {
    const { a, b } = this.runs;
    const { speed } = this.state;
    const words = ([a && (["A", a] as const), b && (["B", b] as const)].filter(Boolean) as [string, Statistics][]).map(([name, s]) => {
      const first = s.run.setup.impacts === 1;
      const found = s.moments(...(first ? ALL : s.window(speed)));
      const what = found.number
        ? `mean of ε ${found.mean.toFixed(4)}, ${found.number > 1 ? `σ ${found.deviation.toFixed(4)}, ` : ""}rotational share ${found.share.toFixed(3)}`
        : "none to average";
      return `${name}: ${found.number.toLocaleString("en")} ${first ? "first " : ""}impact${found.number === 1 ? "" : "s"}${first ? "" : ` within ±5 % of ${speed} m/s`}; ${what}.`;
    });
    part("density-text").textContent = words.join(" ");
    part("summary").innerHTML = summary([["A", a], ["B", b]]);
  }
}

const ALL: [number, number] = [-Infinity, Infinity];

function summary(runs: [string, Statistics | undefined][]): string {
  const there = runs.filter((x): x is [string, Statistics] => x[1] !== undefined);
  const row = (name: string, cell: (s: Statistics) => string) =>
    `<tr><th scope="row">${name}</th>${there.map(([, s]) => `<td>${cell(s)}</td>`).join("")}</tr>`;
  const whole = (x: number) => x.toLocaleString("en");
  const share = (x: number, all: number) => (all ? `${whole(x)} (${((100 * x) / all).toFixed(2)} %)` : "0");
  return `<table><thead><tr><td></td>${there.map(([name]) => `<th scope="col"><span class="key ${name.toLowerCase()}">${name}</span></th>`).join("")}</tr></thead><tbody>${[
    row("impacts computed", ({ run }) => `${whole(run.impacts)} of ${whole(run.finished)} particles${run.took ? `, in ${duration(run.took / 1e3)}` : " so far"}`),
    row("created kinetic energy", (s) => `${share(s.created, s.run.impacts)}${s.created ? `, at most ×${s.largest.toPrecision(s.largest < 1.05 ? 5 : 3)}` : ""}`),
    row("ε &lt; 0", (s) => share(s.negative, s.run.impacts)),
    row("why particles ended", (s) => [...s.stops].map((n, k) => (n ? `${whole(n)} ${endings(s.run)[k]}` : "")).filter(Boolean).join(", ")),
    row("SHA-256 of the numbers", ({ run }) => (run.digest ? `<code>${run.digest}</code>` : "when all are there")),
  ].join("")}</tbody></table><p class="soft small">The digest is of times, restitutions, energy ratios and angles.<span class="screen"> The lines of Python below print the same one: every number is the same to the last bit.</span></p>`;
}
