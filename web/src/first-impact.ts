/** The first impact from rest of a dumbbell in closed form, for a comparison with the engine: it shares nothing with it. */

import { rounded, type Setup } from "./setup";
import type { Bins } from "./statistics";

/** J_xx/(mR²) of a dumbbell with this L/R, at most 2: (A3), (A8). */
export function transverseInertia(x: number): number {
  const mass = 4 / 3 + x - x ** 3 / 12; // (A3)
  return (8 / 15 + (3 / 4) * x + x ** 2 / 3 + x ** 3 / 24 + x ** 5 / 960) / mass; // (A8)
}

/** L/R. */
const elongation = (s: Setup): number => rounded(Number(s.separation) / Number(s.radius));

/** ε where |cos θ| = c, lengths in R. */
export function restitution(s: Setup, c: number): number {
  const [x, k] = [elongation(s), 1 + s.normal];
  const inertia = transverseInertia(x);
  if (s.law === "frictionless") return -1 + k / (1 + (x ** 2 * (1 - c * c)) / (4 * inertia));
  const top = 4 * inertia + x ** 2 * c * c + 4 * x * c + 4;
  return -1 + (k * top) / (4 * inertia + 4 * x * c + 4 + x ** 2); // (17)
}

/** The mean density in each bin of ε, or nothing where the closed form does not hold. ε grows with c, so that the
 * probability of a bin is that of an interval of c. */
export function firstImpact(s: Setup, bins: Bins): (number | null)[] | undefined {
  const closed =
    s.shape === "dumbbell" && elongation(s) > 0 && elongation(s) <= 2 && s.orientation !== "given" &&
    (s.law === "frictionless" || (s.law === "tangential-restitution" && s.tangential === 1)) &&
    [s.spin_y, s.spin_z, s.velocity_x, s.velocity_z, s.incline].every((x) => x === 0);
  if (!closed) return undefined;
  /** P(|cos θ| ≤ c): (18) for the lower sphere, or cos θ uniform. */
  const probability = (c: number) => (s.orientation === "isotropic" ? c : (2 / Math.PI) * Math.asin(c));
  /** c where the restitution is ε, by bisection. */
  const inverse = (epsilon: number): number => {
    let [low, high] = [0, 1];
    for (let i = 0; i < 60; i++) {
      const middle = (low + high) / 2;
      if (restitution(s, middle) < epsilon) low = middle;
      else high = middle;
    }
    return (low + high) / 2;
  };
  return Array.from({ length: bins.count }, (_, k) => {
    const mass = probability(inverse(bins.edge(k + 1))) - probability(inverse(bins.edge(k)));
    return mass > 0 ? mass / bins.step : null;
  });
}
