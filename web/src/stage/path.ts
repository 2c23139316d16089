/** The motion of one particle, from the starts of its flights: crates/web/src/path.rs. */

import { Quaternion, Vector3 } from "three";
import { Timeline } from "./clock";

const COLUMNS = 14;
/** Of a rigid body. */
const FREE = 19;

/** The attitude and ω of a free body of any shape some time after it had these. */
export type Turn = (attitude: Quaternion, spin: Vector3, time: number) => { attitude: Quaternion; spin: Vector3 };

export interface Flight {
  start: number;
  place: Vector3;
  velocity: Vector3;
  axis: Vector3;
  turning: Vector3;
  roll: number;
  /** ω at its start, of a rigid body; that of another is `turning` and `roll` about the axis. */
  spin: Vector3;
  /** Energy of rotation over the mass, m²/s². */
  rotation: number;
  /** The sphere, vertex or arc that touched, 0 at release. */
  sphere: number;
  /** Where a rigid body touched, from the centre of mass. */
  arm: Vector3;
  attitude: Quaternion;
}

export interface Moment {
  place: Vector3;
  velocity: Vector3;
  attitude: Quaternion;
  /** ω in rad/s. */
  spin: Vector3;
  flight: Flight;
  /** Number of impacts so far. */
  impacts: number;
}

const UP = new Vector3(0, 0, 1);

export class Path extends Timeline {
  readonly flights: Flight[] = [];
  readonly gravity: Vector3;

  /** `turn` is that of a rigid body, whose rows have other columns. */
  constructor(rows: Float64Array, gravity: number, incline: number, private readonly turn?: Turn) {
    super();
    this.gravity = new Vector3(gravity * Math.sin(incline), 0, -gravity * Math.cos(incline));
    for (let i = 0; i < rows.length; i += turn ? FREE : COLUMNS) {
      const at = (k: number) => rows[i + k];
      const vector = (k: number) => new Vector3(at(k), at(k + 1), at(k + 2));
      if (turn) {
        const attitude = new Quaternion(at(8), at(9), at(10), at(7));
        const none = { axis: UP.clone(), turning: new Vector3(), roll: 0 };
        this.flights.push({ ...none, start: at(0), place: vector(1), velocity: vector(4), attitude, spin: vector(11), rotation: at(14), sphere: at(15), arm: vector(16) });
        continue;
      }
      const flight: Flight = {
        start: at(0),
        place: new Vector3(0, 0, at(1)),
        velocity: vector(2),
        axis: vector(5),
        turning: vector(8),
        roll: at(11),
        spin: new Vector3(),
        rotation: at(12),
        sphere: at(13),
        arm: new Vector3(),
        attitude: new Quaternion().setFromUnitVectors(UP, vector(5)),
      };
      const last = this.flights.at(-1);
      if (last) {
        // The engine keeps no place along the plane, for the plane looks the same everywhere; and of the attitude the axis only.
        const end = this.during(last, flight.start - last.start);
        flight.place.setX(end.place.x).setY(end.place.y);
        const carried = UP.clone().applyQuaternion(end.attitude);
        flight.attitude = new Quaternion().setFromUnitVectors(carried, flight.axis).multiply(end.attitude);
      }
      this.flights.push(flight);
    }
  }

  at(time: number): Moment {
    const impacts = this.flightAt(time);
    const flight = this.flights[impacts];
    return { ...this.during(flight, Math.max(0, time - flight.start)), flight, impacts };
  }

  /** Duration of a flight; the last one has no end, and is shown for as long as it would take to come down again. */
  override duration(k: number): number {
    const next = this.flights[k + 1];
    return next ? next.start - this.flights[k].start : (2 * Math.max(this.flights[k].velocity.z, 0)) / -this.gravity.z;
  }

  /** Highest places of the centre of mass: of the first flight, of this one and of the one before. */
  peaks(k: number): number[] {
    return [0, Math.max(k - 1, 0), k].map((number) => {
      const { place, velocity } = this.flights[number];
      return place.z + Math.max(velocity.z, 0) ** 2 / (-2 * this.gravity.z);
    });
  }

  /** The largest vertical speed in a flight. */
  steepest(k: number): number {
    const { velocity } = this.flights[Math.max(k, 0)];
    return Math.max(Math.abs(velocity.z), Math.abs(velocity.z + this.gravity.z * this.duration(Math.max(k, 0))));
  }

  /** Speed of a body that has all energy of motion that this one has where it is lowest, in this flight or the one before. */
  speed(k: number): number {
    const energies = [Math.max(k - 1, 0), k].map((number) => {
      const { place, velocity, rotation } = this.flights[number];
      const fallen = number === 0 ? -this.gravity.z * (place.z - this.flights[Math.min(1, this.flights.length - 1)].place.z) : 0;
      return velocity.lengthSq() / 2 + rotation + Math.max(fallen, 0);
    });
    return Math.sqrt(2 * Math.max(...energies)) || 1;
  }

  /** Place, velocity and attitude some time after the start of a flight: (3), (5). */
  private during(flight: Flight, time: number): Omit<Moment, "flight" | "impacts"> {
    const place = flight.place.clone().addScaledVector(flight.velocity, time).addScaledVector(this.gravity, (time * time) / 2);
    const velocity = flight.velocity.clone().addScaledVector(this.gravity, time);
    if (this.turn) return { place, velocity, ...this.turn(flight.attitude, flight.spin, time) };
    const rate = flight.turning.length();
    const turned = new Quaternion();
    if (rate > 0) turned.setFromAxisAngle(flight.turning.clone().divideScalar(rate), rate * time);
    const rolled = new Quaternion().setFromAxisAngle(UP, flight.roll * time);
    const attitude = turned.multiply(flight.attitude).multiply(rolled);
    // The precession, and the roll about the axis.
    const spin = flight.turning.clone().addScaledVector(UP.clone().applyQuaternion(attitude), flight.roll);
    return { place, velocity, attitude, spin };
  }
}

/** Velocity at the end of the flight before an impact, in m/s; the first impact has number 1. */
export function arrivalOf(path: Path, impacts: number): Vector3 {
  const [before, after] = [path.flights[impacts - 1], path.flights[impacts]];
  return before.velocity.clone().addScaledVector(path.gravity, after.start - before.start);
}

/** P/m of an impact, in m/s: the change of the velocity. */
export const impulseOf = (path: Path, impacts: number): Vector3 => path.flights[impacts].velocity.clone().sub(arrivalOf(path, impacts));
