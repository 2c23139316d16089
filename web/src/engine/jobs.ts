/** What is asked of a worker, and what it answers. */

export type Task =
  | { kind: "module"; module: WebAssembly.Module }
  | { kind: "simulate"; parameters: Float64Array; first: number; count: number }
  | { kind: "follow"; parameters: Float64Array; particle: number }
  | { kind: "meet"; parameters: Float64Array; encounter: number }
  | { kind: "survey"; parameters: Float64Array; first: number; count: number }
  | { kind: "cool"; parameters: Float64Array; states: number }
  | { kind: "digest"; columns: Float64Array[] };

export type Job = Task & { number: number };
export type Answer = { number: number } & ({ result: Float64Array | string } | { error: string });
