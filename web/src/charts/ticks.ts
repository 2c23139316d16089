/** Round values on an axis, and how they are written. */

import type { Axis } from "./picture";

export interface Tick {
  value: number;
  /** Empty: a tick without a number. */
  text: string;
}

const RAISED = "⁰¹²³⁴⁵⁶⁷⁸⁹";

/** A power of ten: as a number where that is short. */
function power(exponent: number): string {
  if (exponent >= -3 && exponent <= 3) return String(Number(`1e${exponent}`));
  const digits = [...String(Math.abs(exponent))].map((digit) => RAISED[Number(digit)]).join("");
  return `10${exponent < 0 ? "⁻" : ""}${digits}`;
}

/** Ticks of an axis, no more than about `most` of them with a number. */
export function ticks({ low, high, log }: Axis, most: number): Tick[] {
  return log ? logarithmic(low, high, most) : linear(low, high, most);
}

function linear(low: number, high: number, most: number): Tick[] {
  const rough = (high - low) / Math.max(most, 1);
  const unit = 10 ** Math.floor(Math.log10(rough));
  const step = [1, 2, 5, 10].map((k) => k * unit).find((x) => x >= 0.8 * rough)!;
  // As many decimals as the step needs: neighbours never read alike.
  const decimals = Math.max(0, -Math.floor(Math.log10(step) + 1e-9));
  const first = Math.ceil(low / step - 1e-9);
  const number = Math.floor(high / step + 1e-9) - first + 1;
  return Array.from({ length: Math.max(number, 0) }, (_, k) => {
    const value = Number(((first + k) * step).toPrecision(12));
    return { value, text: value.toFixed(decimals).replace("-", "−") };
  });
}

function logarithmic(low: number, high: number, most: number): Tick[] {
  const [from, to] = [Math.floor(Math.log10(low)), Math.ceil(Math.log10(high))];
  const decades = Math.log10(high / low);
  const inside = (x: number) => x >= low * (1 - 1e-9) && x <= high * (1 + 1e-9);
  // Every so many decades has a number; of few decades the 2 and the 5, too.
  const every = Math.max(1, Math.ceil(decades / most));
  const within = decades < most / 2.5 ? [2, 5] : [];
  const found: Tick[] = [];
  for (let exponent = from; exponent <= to; exponent++) {
    for (let k = 1; k < 10; k++) {
      const value = k * 10 ** exponent;
      if (!inside(value)) continue;
      const whole = k === 1 && exponent % every === 0;
      const text = whole ? power(exponent) : within.includes(k) ? String(Number(value.toPrecision(1))) : "";
      found.push({ value, text });
    }
  }
  return found;
}
