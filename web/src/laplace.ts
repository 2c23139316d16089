/** The asymmetric Laplace density, exp[−(ε−m)/a]/(a+b) above m and exp[−(m−ε)/b]/(a+b) below. */

export interface Laplace {
  location: number;
  above: number;
  below: number;
}

/** The fit of greatest likelihood to sorted values. With A and B the mean excesses above and below m it has a = A + √(AB) and
 * b = B + √(AB), and m is the value where √A + √B is least. */
export function laplace(sorted: Float64Array): Laplace {
  const n = sorted.length;
  const total = sorted.reduce((sum, x) => sum + x, 0);
  let [best, sum] = [Infinity, 0];
  let found: Laplace = { location: NaN, above: NaN, below: NaN };
  sorted.forEach((m, k) => {
    // Rounding must not make a mean excess negative.
    const below = Math.max(0, (k * m - sum) / n);
    const above = Math.max(0, (total - sum - (n - k) * m) / n);
    const width = Math.sqrt(above) + Math.sqrt(below);
    if (width < best) {
      best = width;
      const both = Math.sqrt(above * below);
      found = { location: m, above: above + both, below: below + both };
    }
    sum += m;
  });
  return found;
}

export function density({ location, above, below }: Laplace, x: number): number {
  const off = x - location;
  return Math.exp(off > 0 ? -off / above : off / below) / (above + below);
}
