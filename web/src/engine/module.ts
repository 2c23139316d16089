/** The core, compiled to WebAssembly: one instance, in the thread that calls it. */

interface Exports {
  memory: WebAssembly.Memory;
  run_parameters(): number;
  simulate(first: number, count: number): number;
  follow(particle: number): number;
  table(): number;
  outline(): number;
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

  /** The outline of the body; see crates/web/src/lib.rs. */
  outline(parameters: Float64Array): Float64Array {
    return this.call(parameters, () => this.core.outline());
  }

  private call(parameters: Float64Array, work: () => number): Float64Array {
    const core = this.core;
    new Float64Array(core.memory.buffer, core.run_parameters(), parameters.length).set(parameters);
    const size = work();
    if (size < 0) throw new Error(this.message());
    return new Float64Array(core.memory.buffer, core.table(), size).slice();
  }

  private message(): string {
    const text = new Uint8Array(this.core.memory.buffer, this.core.message(), this.core.message_length());
    return new TextDecoder().decode(text);
  }
}
