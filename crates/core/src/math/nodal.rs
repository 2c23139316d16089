//! Functions on [0, 1] by their values at the nodes of Gauss's rule, that is by the polynomial through them: its integrals, its series in
//! Legendre's polynomials, and where it takes a value.
//!
//! Every sum over the nodes is formed from products and sums alone and in the same order, so that it has the same bits at every SIMD
//! level, for which the compiler takes several nodes at once.

use std::f64::consts::PI;

/// Nodes.
pub(crate) const NODES: usize = 24;
/// A function by its values.
pub(crate) type Nodal = [f64; NODES];

/// Gauss's rule on [0, 1] and what follows from it.
pub(crate) struct Quadrature {
    pub nodes: Nodal,
    pub weights: Nodal,
    /// The weights of barycentric interpolation.
    barycentric: Nodal,
    /// Row j, column i: the integral from 0 to node i of the polynomial that is 1 at node j and 0 at the others; and transposed.
    pub integral: [Nodal; NODES],
    integral_of: [Nodal; NODES],
    /// Row k, column j: (2k + 1) w_j P_k(t_j), which turns values into coefficients of Legendre's series; and transposed.
    pub legendre: [Nodal; NODES],
    legendre_of: [Nodal; NODES],
}

pub(crate) static QUADRATURE: Quadrature = Quadrature::new();

impl Quadrature {
    const fn new() -> Self {
        let mut rule = Self {
            nodes: [0.0; NODES],
            weights: [0.0; NODES],
            barycentric: [0.0; NODES],
            integral: [[0.0; NODES]; NODES],
            integral_of: [[0.0; NODES]; NODES],
            legendre: [[0.0; NODES]; NODES],
            legendre_of: [[0.0; NODES]; NODES],
        };
        let mut at = [[0.0; NODES + 1]; NODES];
        let n = NODES as f64;
        let mut j = 0;
        while j < NODES {
            // Newton's method from cos(π(j + ¾)/(n + ½)), whose error is below a tenth of the distance to the next.
            let mut x = -cosine(PI * (j as f64 + 0.75) / (n + 0.5));
            let mut slope = 0.0;
            let mut steps = 0;
            while steps < 6 {
                at[j] = polynomials(x);
                slope = n * (x * at[j][NODES] - at[j][NODES - 1]) / (x * x - 1.0);
                x -= at[j][NODES] / slope;
                steps += 1;
            }
            at[j] = polynomials(x);
            rule.nodes[j] = 0.5 * (1.0 + x);
            rule.weights[j] = 1.0 / ((1.0 - x * x) * slope * slope);
            let sign = if j % 2 == 0 { 1.0 } else { -1.0 };
            rule.barycentric[j] = sign / slope.abs();
            j += 1;
        }
        let mut j = 0;
        while j < NODES {
            let mut k = 0;
            while k < NODES {
                let entry = (2 * k + 1) as f64 * rule.weights[j] * at[j][k];
                rule.legendre[k][j] = entry;
                rule.legendre_of[j][k] = entry;
                // ∫P_k = (P_{k+1} − P_{k−1})/(2(2k + 1)) from 0 to t.
                let mut sum = rule.nodes[k];
                let mut l = 1;
                while l < NODES {
                    sum += at[j][l] * 0.5 * (at[k][l + 1] - at[k][l - 1]);
                    l += 1;
                }
                rule.integral[j][k] = rule.weights[j] * sum;
                rule.integral_of[k][j] = rule.weights[j] * sum;
                k += 1;
            }
            j += 1;
        }
        rule
    }

    /// The weights with which values at the nodes give that of their polynomial at t.
    #[inline(always)]
    fn interpolation(&self, t: f64) -> Nodal {
        let parts = each(|j| {
            let off = t - self.nodes[j];
            self.barycentric[j] / if off == 0.0 { 1e-30 } else { off }
        });
        let whole = 1.0 / total(&parts);
        each(|j| parts[j] * whole)
    }

    /// The weights of an integral from 0 to t.
    #[inline(always)]
    pub fn until(&self, t: f64) -> Nodal {
        rows(&self.integral_of, &self.interpolation(t))
    }

    /// The integral of s^(a−1)F(s) from 0 to t over t^a, a > 0: V with tV′ + aV = F, which is a back-substitution for the coefficients of
    /// Legendre's series.
    #[inline(always)]
    pub fn divided(&self, values: &Nodal, power: f64) -> Nodal {
        let inverse = each(|k| 1.0 / (power + k as f64));
        let mut series = rows(&self.legendre_of, values);
        let mut sum = 0.0;
        for (k, term) in series.iter_mut().enumerate().rev() {
            let factor = (2 * k + 1) as f64;
            let v = (*term - factor * sum) * inverse[k];
            sum += v;
            *term = v / factor;
        }
        rows(&self.legendre, &series)
    }

    /// The largest of the last two coefficients of Legendre's series.
    #[inline(always)]
    pub fn last(&self, values: &Nodal) -> f64 {
        let one = dot(&self.legendre[NODES - 2], values).abs();
        one.max(dot(&self.legendre[NODES - 1], values).abs())
    }

    /// The place between `low` and `high` at which the integral from 0 of a function that keeps its sign there has this value: Newton's
    /// method within a bracket.
    #[inline(always)]
    pub fn located(
        &self,
        density: &Nodal,
        whole: &Nodal,
        value: f64,
        (from, end): (f64, f64),
    ) -> f64 {
        let rising = dot(&self.weights, density) > value;
        let is_before = |x: f64| (x < value) == rising;
        let (mut low, mut high) = (from, end);
        let before = total(&each(|j| {
            f64::from(self.nodes[j] <= from || is_before(whole[j]))
        })) as usize;
        let mut t = f64::NAN;
        if before > 0 && self.nodes[before - 1] > low {
            low = self.nodes[before - 1];
            if before < NODES && self.nodes[before] < high {
                // Hermite's cubic of t as a function of the integral between two nodes.
                high = self.nodes[before];
                let change = whole[before] - whole[before - 1];
                let u = (value - whole[before - 1]) / change;
                let [near, far] = [before - 1, before].map(|j| change / density[j]);
                let (v, width) = (1.0 - u, high - low);
                t = low + u * u * (3.0 - 2.0 * u) * width + u * v * (near * v - far * u);
            }
        } else if before < NODES {
            high = high.min(self.nodes[before]);
        }
        if !(low <= t && t <= high) {
            t = 0.5 * (low + high);
        }
        for _ in 0..60 {
            let weights = self.interpolation(t);
            let found = dot(&weights, whole);
            if is_before(found) {
                low = t;
            } else {
                high = t;
            }
            let newton = t + (value - found) / dot(&weights, density);
            let next = if low <= newton && newton <= high {
                newton
            } else {
                0.5 * (low + high)
            };
            let step = (next - t).abs();
            t = next;
            // The next step is as its square.
            if step <= 1e-8 * (t - from) {
                break;
            }
        }
        t
    }
}

/// Legendre's polynomials up to degree [`NODES`] at x.
const fn polynomials(x: f64) -> [f64; NODES + 1] {
    let mut p = [1.0; NODES + 1];
    p[1] = x;
    let mut k = 1;
    while k < NODES {
        let n = k as f64;
        p[k + 1] = ((2.0 * n + 1.0) * x * p[k] - n * p[k - 1]) / (n + 1.0);
        k += 1;
    }
    p
}

/// cos x for 0 ≤ x ≤ π, as a power series.
const fn cosine(x: f64) -> f64 {
    let mut sum = 0.0;
    let mut k = 16;
    while k > 0 {
        sum = 1.0 - sum * x * x / ((2 * k) * (2 * k - 1)) as f64;
        k -= 1;
    }
    sum
}

/// A value at every node.
#[inline(always)]
pub(crate) fn each(value: impl Fn(usize) -> f64) -> Nodal {
    let mut values = [0.0; NODES];
    for (j, place) in values.iter_mut().enumerate() {
        *place = value(j);
    }
    values
}

/// Sums over the nodes are formed in eight parts, in the same order at every SIMD level.
#[inline(always)]
pub(crate) fn total(values: &Nodal) -> f64 {
    let mut sums = [0.0; 8];
    for (i, sum) in sums.iter_mut().enumerate() {
        *sum = values[i] + values[i + 8] + values[i + 16];
    }
    let [a, b, c, d, e, f, g, h] = sums;
    ((a + e) + (b + f)) + ((c + g) + (d + h))
}

#[inline(always)]
pub(crate) fn dot(a: &Nodal, b: &Nodal) -> f64 {
    total(&each(|j| a[j] * b[j]))
}

/// Σ_j v_j times row j.
#[inline(always)]
pub(crate) fn rows(matrix: &[Nodal; NODES], v: &Nodal) -> Nodal {
    let mut sums = [[0.0; NODES]; 2];
    for j in (0..NODES).step_by(2) {
        for i in 0..NODES {
            sums[0][i] += v[j] * matrix[j][i];
            sums[1][i] += v[j + 1] * matrix[j + 1][i];
        }
    }
    each(|i| sums[0][i] + sums[1][i])
}

/// ∫s^(a−1)P_k(s) ds over [0, 1], with Legendre's polynomials of that interval.
#[inline(always)]
pub(crate) fn moments(power: f64) -> Nodal {
    let mut moments = [1.0 / power; NODES];
    for k in 1..NODES {
        let n = k as f64;
        moments[k] = moments[k - 1] * ((power - n) / (power + n));
    }
    moments
}
