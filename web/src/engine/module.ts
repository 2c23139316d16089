/** The core, compiled to WebAssembly: one instance, in the thread that calls it. */

interface Exports {
  memory: WebAssembly.Memory;
  parameters(count: number): number;
  simulate(first: number, count: number): number;
  follow(particle: number): number;
  meet(number: number): number;
  survey(first: number, count: number): number;
  cool(states: number): number;
  table(): number;
  outline(): number;
  drawing(): number;
  farthest(count: number): number;
  turn(): number;
  message(): number;
  message_length(): number;
}

export class Engine {
  private readonly core: Exports;

  constructor(module: WebAssembly.Module) {
    this.core = new WebAssembly.Instance(module).exports as unknown as Exports;
  }

  /** Impacts of some particles; see crates/web/src/records.rs. */
  simulate(parameters: Float64Array, first: number, count: number): Float64Array {
    return this.call(parameters, () => this.core.simulate(first, count));
  }

  /** The flights of one particle; see crates/web/src/path.rs. */
  follow(parameters: Float64Array, particle: number): Float64Array {
    return this.call(parameters, () => this.core.follow(particle));
  }

  /** One encounter of two bodies; see crates/web/src/pair.rs. */
  meet(parameters: Float64Array, number: number): Float64Array {
    return this.call(parameters, () => this.core.meet(number));
  }

  /** Contacts, ending and √(E'/E) of some encounters. */
  survey(parameters: Float64Array, first: number, count: number): Float64Array {
    return this.call(parameters, () => this.core.survey(first, count));
  }

  /** A step of a gas; `parameters` end with the states of so many particles. See crates/web/src/gas.rs. */
  cool(parameters: Float64Array, states: number): Float64Array {
    return this.call(parameters, () => this.core.cool(states));
  }

  /** The outline of the body; see crates/web/src/lib.rs. */
  outline(parameters: Float64Array): Float64Array {
    return this.call(parameters, () => this.core.outline());
  }

  /** Points and triangles, or the profile, of a rigid body; see crates/web/src/rigid.rs. */
  drawing(parameters: Float64Array): Float64Array {
    return this.call(parameters, () => this.core.drawing());
  }

  /** The places of a rigid body that lie farthest in some directions; see crates/web/src/rigid.rs. */
  farthest(parameters: Float64Array, directions: Float64Array): Float64Array {
    return this.call(Float64Array.of(...parameters, ...directions), () => this.core.farthest(directions.length / 3));
  }

  /** Attitude and ω of a free body after a time; see crates/web/src/rigid.rs. */
  turn(given: Float64Array): Float64Array {
    return this.call(given, () => this.core.turn());
  }

  private call(parameters: Float64Array, work: () => number): Float64Array {
    const core = this.core;
    const place = core.parameters(parameters.length); // which may move the memory
    new Float64Array(core.memory.buffer, place, parameters.length).set(parameters);
    const size = work();
    if (size < 0) throw new Error(this.message());
    return new Float64Array(core.memory.buffer, core.table(), size).slice();
  }

  private message(): string {
    const text = new Uint8Array(this.core.memory.buffer, this.core.message(), this.core.message_length());
    return new TextDecoder().decode(text);
  }
}
