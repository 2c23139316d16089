/** The worker: does one job after the other, and answers each by its number. */

import { sha256 } from "@noble/hashes/sha2.js";
import { bytesToHex } from "@noble/hashes/utils.js";
import { Engine } from "./module";
import type { Job, Answer } from "./jobs";

let engine: Engine | undefined;

function work(job: Job): Float64Array | string {
  switch (job.kind) {
    case "module":
      engine = new Engine(job.module);
      return "";
    case "simulate":
      return engine!.simulate(job.parameters, job.first, job.count);
    case "follow":
      return engine!.follow(job.parameters, job.particle);
    case "meet":
      return engine!.meet(job.parameters, job.encounter);
    case "survey":
      return engine!.survey(job.parameters, job.first, job.count);
    case "cool":
      return engine!.cool(job.parameters, job.states);
    case "digest": {
      const hash = sha256.create();
      for (const column of job.columns) hash.update(new Uint8Array(column.buffer, column.byteOffset, column.byteLength));
      return bytesToHex(hash.digest());
    }
  }
}

self.onmessage = ({ data: job }: MessageEvent<Job>) => {
  let answer: Answer;
  try {
    answer = { number: job.number, result: work(job) };
  } catch (error) {
    answer = { number: job.number, error: (error as Error).message };
  }
  const result = "result" in answer ? answer.result : "";
  (self as unknown as Worker).postMessage(answer, typeof result === "string" ? [] : [result.buffer as ArrayBuffer]);
};
