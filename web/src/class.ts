/** What a class has measured: one number, its error, and what differs between tables and between drops. */

export interface Mean {
  value: number;
  error: number;
  /** Standard deviation of what differs beyond the errors. */
  between: number;
}

/**
 * The mean of values that differ by more than their errors s: each has the weight 1/(s² + τ²), with the least τ ≥ 0 for which
 * Σ(x − μ)²/(s² + τ²) is at most n − 1 (Paule and Mandel, J. Res. Natl. Bur. Stand. 87, 377 (1982)).
 */
export function pooled(values: number[], errors: number[]): Mean {
  const sum = (of: number[]) => of.reduce((a, b) => a + b, 0);
  const at = (square: number) => {
    const weights = errors.map((s) => 1 / (s * s + square));
    const value = sum(weights.map((w, k) => w * values[k]!)) / sum(weights);
    return { value, error: 1 / Math.sqrt(sum(weights)), misfit: sum(weights.map((w, k) => w * (values[k]! - value) ** 2)) };
  };
  const middle = sum(values) / values.length;
  let low = 0;
  let high = sum(values.map((x) => (x - middle) ** 2)); // the sum is 1 at most there
  if (at(0).misfit <= values.length - 1) high = 0;
  for (let k = 0; k < 60 && high > 0; k++) {
    const half = 0.5 * (low + high);
    if (at(half).misfit > values.length - 1) low = half;
    else high = half;
  }
  const { value, error } = at(high);
  return { value, error, between: Math.sqrt(high) };
}

/** A table's name, ε and its error, with "±", blanks or other marks between them. */
const LINE = /^(.*?)[\s:;,]*(?<![\d.])([01]?\.\d+)\s*(?:±|\+-|\+\/-|[\s;,])\s*(\d*\.?\d+(?:e-?\d+)?)\s*$/i;

/** Reads a line for each drop and says what follows; lines without a name are tables of their own. */
export function answer(text: string): string {
  const tables = new Map<string, { values: number[]; errors: number[] }>();
  const unread: number[] = [];
  text.split("\n").forEach((raw, k) => {
    const line = raw.includes(".") ? raw : raw.replace(/(\d),(\d)/g, "$1.$2"); // 0,93 as in German
    const [, name, value, error] = LINE.exec(line) ?? [];
    if (value && Number(error) > 0) {
      const key = name!.trim() || `line ${k}`;
      const table = tables.get(key) ?? { values: [], errors: [] };
      table.values.push(Number(value));
      table.errors.push(Number(error));
      tables.set(key, table);
    } else if (raw.trim()) unread.push(k + 1);
  });
  const means = [...tables.values()].map(({ values, errors }) => pooled(values, errors));
  const warning = unread.length ? ` Not read: line ${unread.join(", ")}; each needs ε and an error > 0.` : "";
  if (means.length < 2) return `${tables.size ? "One table; a class has two at least." : ""}${warning}`.trim();
  const { value, error, between } = pooled(means.map((one) => one.value), means.map((one) => one.error));
  const digits = Math.min(Math.max(1 - Math.floor(Math.log10(error)), 0), 12);
  const differ = (of: number) => (of > 0 ? `by ${Number(of.toPrecision(2))}` : "by no more than their errors");
  const repeated = [...tables.values()].map(({ values }, k) => (values.length > 1 ? means[k]!.between ** 2 : -1)).filter((x) => x >= 0);
  const drops = repeated.length ? `; drops at one table ${differ(Math.sqrt(repeated.reduce((a, b) => a + b) / repeated.length))}` : "";
  return `ε = ${value.toFixed(digits)} ± ${error.toFixed(digits)} from ${means.length} tables, which differ ${differ(between)}${drops}.${warning}`;
}
