/** The workers. Jobs wait in one queue for whichever worker is free; those that nobody wants any more can be taken out. */

import type { Answer, Task } from "./jobs";

interface Waiting {
  task: Task;
  owner: object | undefined;
  done: (result: Float64Array | string) => void;
  failed: (error: Error) => void;
}

export class Pool {
  private readonly idle: Worker[] = [];
  private readonly queue: Waiting[] = [];
  private readonly busy = new Map<number, Waiting>();
  private count = 0;

  constructor(source: string, module: WebAssembly.Module, readonly size = Pool.cores()) {
    const url = URL.createObjectURL(new Blob([source], { type: "text/javascript" }));
    for (let i = 0; i < size; i++) {
      const worker = new Worker(url);
      worker.onmessage = ({ data }: MessageEvent<Answer>) => this.finish(worker, data);
      this.send(worker, { task: { kind: "module", module }, owner: undefined, done: () => {}, failed: () => {} });
    }
  }

  static cores(): number {
    return Math.max(1, Math.min(8, (navigator.hardwareConcurrency || 2) - 1));
  }

  /** Does a task; `urgent` ones go first. */
  run(task: Task, owner?: object, urgent = false): Promise<Float64Array | string> {
    return new Promise((done, failed) => {
      const waiting = { task, owner, done, failed };
      if (urgent) this.queue.unshift(waiting);
      else this.queue.push(waiting);
      this.next();
    });
  }

  /** Forgets what `owner` has in the queue. */
  drop(owner: object): void {
    for (let i = this.queue.length - 1; i >= 0; i--) {
      if (this.queue[i].owner === owner) this.queue.splice(i, 1);
    }
  }

  private next(): void {
    while (this.idle.length && this.queue.length) this.send(this.idle.pop()!, this.queue.shift()!);
  }

  private send(worker: Worker, waiting: Waiting): void {
    const number = this.count++;
    this.busy.set(number, waiting);
    worker.postMessage({ ...waiting.task, number });
  }

  private finish(worker: Worker, answer: Answer): void {
    const waiting = this.busy.get(answer.number)!;
    this.busy.delete(answer.number);
    this.idle.push(worker);
    if ("error" in answer) waiting.failed(new Error(answer.error));
    else waiting.done(answer.result);
    this.next();
  }
}
