//! Real zeros of polynomials of second and third degree.

/// The largest real zero of c₀k³ + c₁k² + c₂k + c₃, and whether all three are real: Halley's method from outside.
pub(crate) fn largest_root(c: [f64; 4]) -> (f64, bool) {
    let [b, c, d] = [1, 2, 3].map(|i| c[i] / c[0]);
    let middle = -b / 3.0;
    // y³ + py + q, with k = y + middle
    let p = c - b * b / 3.0;
    let q = ((middle + b) * middle + c) * middle + d;
    let real = p < 0.0 && -4.0 * p * p * p >= 27.0 * q * q;
    let bound = 2.0 * (-p / 3.0).max(0.0).sqrt();
    let mut y = if real {
        bound
    } else {
        // More than the cube root of |q|.
        let root = 1.1 * f64::from_bits(q.abs().max(f64::MIN_POSITIVE).to_bits() / 3 + CUBE_ROOT);
        (root.max(bound) + root).copysign(-q)
    };
    for _ in 0..80 {
        let value = (y * y + p) * y + q;
        let slope = 3.0 * y * y + p;
        let step = value * slope / (slope * slope - 3.0 * y * value);
        if step.is_nan() {
            break;
        }
        y -= step;
        if step.abs() <= f64::EPSILON * (y.abs() + middle.abs()) {
            break;
        }
    }
    (y + middle, real)
}

/// Two thirds of the bits of 1, with which a third of the bits of a number is its cube root to within 6 %.
const CUBE_ROOT: u64 = 0x2a9f_7893_0000_0000;

/// The coefficients of (c₀ + c₁z + c₂z² + c₃z³)/(1 − kz), one of whose zeros is 1/k, from the side on which rounding errors do not grow.
pub(crate) fn deflated(c: [f64; 4], k: f64) -> [f64; 3] {
    if k.abs() <= 1.0 {
        let d1 = c[1] + k * c[0];
        [c[0], d1, c[2] + k * d1]
    } else {
        let d2 = -c[3] / k;
        [c[0], (d2 - c[2]) / k, d2]
    }
}

/// The real zeros of c₀k² + c₁k + c₂, the larger one first; not numbers if there are none.
pub(crate) fn zeros(c: [f64; 3]) -> [f64; 2] {
    let root = (c[1] * c[1] - 4.0 * c[0] * c[2]).sqrt();
    let half = -0.5 * (c[1] + root.copysign(c[1]));
    let (one, other) = (half / c[0], c[2] / half);
    if one >= other {
        [one, other]
    } else {
        [other, one]
    }
}
