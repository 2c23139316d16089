/** An encounter of two bodies, from the table of the core: crates/web/src/pair.rs. */

import { Quaternion, Vector3 } from "three";
import { turnOf } from "../outline";
import { Timeline } from "../stage/clock";
import type { Turn } from "../stage/path";

/** The numbers of an encounter, the last the largest distance of the surface of a body from its centre of mass; and what its rotation follows from. */
const VALUES = ["contacts", "ending", "duration", "deflection", "contact_speed", "restitution_centres", "restitution_contact", "restitution_energy", "reach"] as const;
const ROTOR = 7;
/** Columns of a flight, of each body in it, and of a contact. */
const [FLIGHT, BODY, HIT] = [31, 15, 12];
/** How an encounter ended, by number. */
export const ENDINGS = ["missed", "parted", "collapse", "lasted"] as const;

export interface Body {
  place: Vector3;
  velocity: Vector3;
  attitude: Quaternion;
  spin: Vector3;
  /** Energies of translation and rotation, J. */
  translation: number;
  rotation: number;
}
export type Two = [Body, Body];

/** A contact; the speeds are normal ones, towards each other before and from each other after. */
export interface Hit {
  time: number;
  normal: Vector3;
  point: Vector3;
  impulse: Vector3;
  approach: number;
  separation: number;
}

export class Encounter extends Timeline {
  readonly values: Record<(typeof VALUES)[number], number>;
  readonly flights: { start: number; bodies: Two }[] = [];
  readonly hits: Hit[] = [];
  private readonly turn: Turn;

  constructor(table: Float64Array) {
    super();
    this.values = Object.fromEntries(VALUES.map((name, k) => [name, table[k]])) as Encounter["values"];
    this.turn = turnOf([...table.subarray(VALUES.length, VALUES.length + ROTOR)]);
    const vector = (at: number) => new Vector3().fromArray(table, at);
    const body = (at: number): Body => ({
      place: vector(at),
      velocity: vector(at + 3),
      attitude: new Quaternion(table[at + 7], table[at + 8], table[at + 9], table[at + 6]),
      spin: vector(at + 10),
      translation: table[at + 13],
      rotation: table[at + 14],
    });
    let at = VALUES.length + ROTOR;
    for (let k = 0; k <= this.values.contacts; k++, at += FLIGHT) this.flights.push({ start: table[at], bodies: [body(at + 1), body(at + 1 + BODY)] });
    for (; at < table.length; at += HIT) {
      this.hits.push({ time: table[at], normal: vector(at + 1), point: vector(at + 4), impulse: vector(at + 7), approach: table[at + 10], separation: table[at + 11] });
    }
  }

  override duration(flight: number): number {
    return (this.flights[flight + 1]?.start ?? this.values.duration) - this.flights[flight].start;
  }

  /** Both bodies at a time, turning freely between contacts. */
  at(time: number): { bodies: Two; contacts: number } {
    const contacts = this.flightAt(time);
    const { start, bodies } = this.flights[contacts];
    const lasted = time - start;
    const later = (body: Body): Body => ({ ...body, place: body.place.clone().addScaledVector(body.velocity, lasted), ...this.turn(body.attitude, body.spin, lasted) });
    return { bodies: [later(bodies[0]), later(bodies[1])], contacts };
  }

  /** The centre of mass of both, which are alike, at a time. */
  centre(time: number): Vector3 {
    const [one, two] = this.at(time).bodies;
    return one.place.add(two.place).multiplyScalar(0.5);
  }
}
