/** What the page shows of two bodies that meet: the replay of an encounter, and its numbers. */

import { Bars } from "../energies";
import { pairNumbers } from "../engine/layout";
import type { Pool } from "../engine/pool";
import { pairPython } from "../export/text";
import type { State } from "../link";
import { part } from "../page";
import { Clock } from "../stage/clock";
import { Space } from "../stage/space";
import { short } from "../stage/overlay";
import { eachFrame, viewIn } from "../stage/view";
import { Encounter, ENDINGS, type Two } from "./encounter";

/** Encounters to look for; one is its number of contacts, how it ended, and √(E'/E). */
export const PAIR_KINDS: Record<string, [string, (contacts: number, ending: number, energy: number) => boolean]> = {
  touch: ["With contact", (contacts) => contacts > 0],
  several: ["With several contacts", (contacts) => contacts > 1],
  three: ["With three contacts and more", (contacts) => contacts > 2],
  gain: ["That creates energy", (_, __, energy) => energy > 1 + 1e-12],
  every: ["Every one, misses too", () => true],
};
/** Encounters that are looked through at a time, and at most. */
const [BLOCK, MOST] = [200, 20_000];
const ROWS: [string, string][] = [["motion", "velocity"], ["rotation", "spin"], ["· first", "a"], ["· second", "b"], ["all", "ink"]];
const sum = (values: number[]) => values.reduce((a, b) => a + b);

/** Energies in J: translation and rotation of both, rotation of each, all. */
function energiesOf(bodies: Two): number[] {
  const [translation, rotation] = [sum(bodies.map((body) => body.translation)), bodies.map((body) => body.rotation)];
  return [translation, sum(rotation), ...rotation, translation + sum(rotation)];
}

export class Pairs {
  readonly clock = new Clock();
  readonly space = viewIn(part("pair-stage"), Space);
  private encounter: Encounter | undefined;
  private readonly bars = new Bars(part("pair-energies"), ROWS);
  private asked = 0;
  private told = NaN;

  /** `changed` hears when the play starts or ends. */
  constructor(private readonly pool: Pool, private readonly changed: () => void) {
    eachFrame((lasted) => this.draw(lasted));
  }

  /** Shows the encounter of a state, from its beginning, or held after its contacts. Throws where the core refuses it. */
  async show({ a, encounter }: State, play: boolean): Promise<void> {
    const asked = ++this.asked;
    const table = await this.pool.run({ kind: "meet", parameters: pairNumbers(a), encounter }, undefined, true);
    if (asked !== this.asked) return;
    const shown = new Encounter(table as Float64Array);
    this.encounter = shown;
    this.space?.show(shown, a);
    this.clock.until = Infinity;
    this.clock.time = play ? 0 : shown.hits.at(-1)?.time ?? shown.finish / 2;
    this.clock.playing = play;
    this.told = NaN;
    this.tell(shown, encounter);
    part("pair-code").textContent = pairPython(a, encounter, shown);
    this.changed();
  }

  get playing(): boolean {
    return this.clock.playing;
  }

  play(playing: boolean): void {
    if (playing && this.encounter && this.clock.time >= this.encounter.finish) this.clock.time = 0;
    this.clock.playing = playing;
    this.changed();
  }

  /** Goes to just after the contact before or after the present one. */
  step(by: number): void {
    const { encounter } = this;
    if (!encounter) return;
    this.go(encounter.flightAt(this.clock.time) + by);
  }

  private go(flight: number): void {
    const { flights } = this.encounter!;
    this.clock.time = flights[Math.min(Math.max(flight, 0), flights.length - 1)].start;
    this.told = NaN;
    this.play(false);
  }

  /** The number of the next encounter of a kind, or of the one before; where there is none, it says so. */
  async find(kind: string, { a, encounter }: State, by: 1 | -1): Promise<number | undefined> {
    const fits = PAIR_KINDS[kind][1];
    const [output, parameters, asked] = [part("pair-found"), pairNumbers(a), this.asked];
    for (let from = encounter + by, looked = 0; looked < MOST && from >= 0; looked += BLOCK, from += by * BLOCK) {
      const first = by > 0 ? from : Math.max(from - BLOCK + 1, 0);
      const count = by > 0 ? BLOCK : from - first + 1;
      const table = (await this.pool.run({ kind: "survey", parameters, first, count }, undefined, true)) as Float64Array;
      const numbers = Array.from({ length: count }, (_, k) => (by > 0 ? k : count - 1 - k));
      const at = numbers.find((k) => fits(table[3 * k], table[3 * k + 1], table[3 * k + 2]));
      // Another encounter is shown by now.
      if (asked !== this.asked) return undefined;
      output.textContent = at === undefined ? `${looked + count} looked at` : "";
      if (at !== undefined) return first + at;
    }
    output.textContent = by > 0 ? `none among the next ${MOST.toLocaleString("en")}` : "none before";
    return undefined;
  }

  private draw(lasted: number): void {
    const { encounter, clock } = this;
    if (!encounter || !part("pair-stage").clientWidth) return;
    const was = clock.playing;
    clock.advance(encounter, lasted);
    if (was !== clock.playing) this.changed();
    const flight = encounter.flightAt(clock.time);
    this.space?.draw(clock.time, was || this.told !== flight);
    if (this.told === flight) return;
    this.told = flight;
    const [before, now] = [encounter.flights[0], encounter.flights[flight]].map(({ bodies }) => energiesOf(bodies));
    const share = (values: number[]) => values.map((value) => value / before[4]);
    this.bars.put(share(now), share(before), flight ? share(now.map((value, k) => value - before[k])) : []);
    part("pair-change").textContent = flight ? "change" : "";
    document.querySelectorAll("#pair-contacts tbody tr").forEach((row, k) => row.toggleAttribute("data-now", k === flight - 1));
  }

  /** The encounter in numbers. */
  private tell({ values, flights, hits }: Encounter, number: number): void {
    const { contacts, ending } = values;
    const how = {
      missed: "",
      parted: "",
      collapse: ", which accumulate or last: the bodies stay together",
      lasted: ", and a lasting one, which is not drawn: the bodies slide on each other before they part",
    }[ENDINGS[ending]];
    part("pair-title").textContent = `Encounter ${number}: ${contacts ? `${contacts} contact${contacts > 1 ? "s" : ""}${how}` : "missed"}`;
    const number4 = (x: number) => (Number.isFinite(x) ? x.toPrecision(4).replace("-", "−") : "–");
    for (const name of ["centres", "contact", "energy"] as const) part(`pair-${name}`).textContent = number4(values[`restitution_${name}`]);
    part("pair-deflection").textContent = Number.isFinite(values.deflection) ? `${((values.deflection * 180) / Math.PI).toFixed(1)}°` : "–";
    const [before, after] = [flights[0], flights.at(-1)!].map(({ bodies }) => energiesOf(bodies));
    const micro = (joule: number) => short(joule * 1e6);
    ["translation", "rotation"].forEach((name, k) => {
      part(`pair-${name}-before`).textContent = micro(before[k]);
      part(`pair-${name}-after`).textContent = micro(after[k]);
    });
    const row = ({ time, approach, separation, impulse }: (typeof hits)[number], k: number) =>
      `<tr><th scope="row"><button type="button" class="plain" aria-label="Go to contact ${k + 1}">${k + 1}</button></th><td>${short(time * 1e3)}</td><td>${short(approach)}</td><td>${short(separation)}</td><td>${short(impulse.length() * 1e6)}</td></tr>`;
    const table = part("pair-contacts");
    table.hidden = !hits.length;
    table.querySelector("tbody")!.innerHTML = hits.map(row).join("");
    table.querySelectorAll("button").forEach((button, k) => button.addEventListener("click", () => this.go(k + 1)));
  }
}
