//! The rotation without torque of a body with three different moments of inertia, by Jacobi's elliptic functions.
//!
//! R. van Zon and J. Schofield, *Numerical implementation of the exact dynamics of free rigid bodies*, J. Comput. Phys. **225**, 145 (2007),
//! with axis 3 that about which **Λ** turns: J₃ is the largest moment where Λ² > 2EJ₂, else the least; J₂ is the middle one. Then
//! ω₁ = Ω₁cn(u), ω₂ = Ω₂sn(u), ω₃ = Ω₃dn(u) with u = ω_p t + u₀, and the axes of the body are turned about **Λ** by
//! ψ = A₂t − arg ϑ₁(ν − iη) + constant, ν = πu/2K. Everything is by theta functions of the nome q.
//!
//! Near the separatrix q is nearly 1, and for **Λ** near axis 3 the angles are not determined: there is none, and a series is used.

use super::top::Top;
use crate::math::{Quaternion, Vector};
use crate::simd::elementary::{exp_in_lanes, sincos};
use crate::simd::one;
use std::f64::consts::FRAC_PI_2;

/// Terms of the theta functions, and the largest nome for which these are enough: q to the power `TERMS`² is less than rounding.
const TERMS: usize = 6;
const LARGEST: f64 = 0.33;
/// Least sine of the angle between **Λ** and axis 3.
const APART: f64 = 0.1;
/// Terms less than this part of the first one are left out.
const SMALL: f64 = 1e-18;

#[derive(Debug, Clone)]
pub(super) struct Elliptic {
    /// Axes 1, 2 and 3 among those of the body; the last one is turned round where they were left-handed.
    order: [usize; 3],
    hand: f64,
    moments: [f64; 3],
    /// 2E.
    energy: f64,
    /// ν = `rate` t + `phase`.
    rate: f64,
    phase: f64,
    /// ½A₂.
    turn: f64,
    /// Ω₁, Ω₂, Ω₃, each with the ratio of theta functions of 0.
    sizes: [f64; 3],
    /// The number of terms that are needed; q to the powers n² and n(n + 1), these with the real and the imaginary part of ϑ₁(ν − iη), too.
    terms: usize,
    squares: [f64; TERMS],
    products: [f64; TERMS],
    real: [f64; TERMS],
    imaginary: [f64; TERMS],
    /// The attitude at the beginning, and then the rotation back from that at the time 0 in the axes of **Λ**.
    attitude: Quaternion,
    start: Quaternion,
}

/// The complete integral K of the modulus with this complement, by the arithmetic-geometric mean.
#[inline(always)]
fn complete(complement: f64) -> f64 {
    let (mut a, mut b) = (1.0, complement);
    while (a - b).abs() > 1e-15 * a {
        (a, b) = (0.5 * (a + b), (a * b).sqrt());
    }
    FRAC_PI_2 / a
}

/// R_F of three numbers in order: B. C. Carlson, *Numer. Algorithms* **10**, 13 (1995); his series in the differences from the mean, here to the
/// seventh order, is DLMF 19.36.1. The incomplete integral F(φ) is sin φ R_F(cos²φ, 1 − k²sin²φ, 1).
#[inline(always)]
fn carlson(mut x: f64, mut y: f64, mut z: f64) -> f64 {
    let mean = loop {
        let mean = (x + y + z) / 3.0;
        if z - x <= 1e-2 * mean {
            break mean;
        }
        let (a, b, c) = (x.sqrt(), y.sqrt(), z.sqrt());
        let sum = a * b + b * c + c * a;
        (x, y, z) = (0.25 * (x + sum), 0.25 * (y + sum), 0.25 * (z + sum));
    };
    let (x, y) = (1.0 - x / mean, 1.0 - y / mean);
    let z = -x - y;
    let (e2, e3) = (x * y - z * z, x * y * z);
    let second = -1.0 / 10.0 + e2 * (1.0 / 24.0 - e2 * (5.0 / 208.0)) - e3 * (3.0 / 44.0);
    let third = 1.0 / 14.0 + e3 * (3.0 / 104.0) + e2 * e2 / 16.0;
    (1.0 + (e2 * second + e3 * third)) / mean.sqrt()
}

impl Elliptic {
    /// The rotation from this attitude and this ω ≠ 0, where it can be computed so.
    #[inline(always)]
    pub fn new(top: &Top, attitude: Quaternion, spin: Vector) -> Option<Self> {
        let w = [spin.x, spin.y, spin.z];
        let moments = top.moments();
        let [low, middle, high] = top.order();
        let [a, b, c] = [moments[low], moments[middle], moments[high]];
        // Λ² − 2EJ₂.
        let above = c * (c - b) * w[high] * w[high] - a * (b - a) * w[low] * w[low];
        let order = if above > 0.0 {
            [low, middle, high]
        } else {
            [high, middle, low]
        };
        let hand = if (order[0] + 1) % 3 == order[1] {
            1.0
        } else {
            -1.0
        };
        let [j1, j2, j3] = [moments[order[0]], moments[order[1]], moments[order[2]]];
        let [w1, w2, w3] = [w[order[0]], w[order[1]], hand * w[order[2]]];
        let momentum = (j1 * j1 * w1 * w1 + j2 * j2 * w2 * w2 + j3 * j3 * w3 * w3).sqrt();
        // Λ² − 2EJ₃ and Λ² − 2EJ₁.
        let d3 = j1 * (j1 - j3) * w1 * w1 + j2 * (j2 - j3) * w2 * w2;
        let d1 = j2 * (j2 - j1) * w2 * w2 + j3 * (j3 - j1) * w3 * w3;
        let size1 = (d3 / (j1 * (j1 - j3))).sqrt();
        let size2 = -(d3 / (j2 * (j2 - j3))).sqrt();
        let size3 = (d1 / (j3 * (j3 - j1))).sqrt().copysign(w3);
        let (sine, cosine) = (j3 * size3.abs() / momentum, j1 * size1 / momentum);
        let whole = d1 * (j3 - j2);
        let modulus = d3 * (j1 - j2) / whole;
        let complement = above * (j3 - j1) / whole;
        // Also where there is no number.
        if !(cosine > APART && modulus > 0.0 && complement > 1e-3) {
            return None;
        }
        let (k, k_prime) = (complete(complement.sqrt()), complete(modulus.sqrt()));
        let logarithm = -2.0 * FRAC_PI_2 * k_prime / k;
        if logarithm < -32.0 {
            return None;
        }
        let nome = exp(logarithm);
        if nome > LARGEST {
            return None;
        }
        let to_nu = FRAC_PI_2 / k;
        let rate = to_nu * ((j3 - j2) / j1) * (size2 * size3 / size1);
        // F of the angle from axis 1 to ω, which has up to 2K.
        let (x, y) = (w1 / size1, w2 / size2);
        let quarter = y * carlson(x * x, x * x + complement * y * y, 1.0);
        let phase = if x < 0.0 {
            to_nu * ((2.0 * k).copysign(y) - quarter)
        } else {
            to_nu * quarter
        };
        // K′ − F′ of the angle of **Λ**, without the difference.
        let level = modulus * sine * sine;
        let left = cosine * carlson(level, modulus, cosine * cosine + level);
        let eta = (to_nu * left).copysign(size3);

        let (e, back) = (exp(eta), exp(-eta));
        let (xi, xi_back) = (e * e, back * back);
        let mut sum = (xi + 1.0) / (xi - 1.0);
        let square = nome * nome;
        let (mut power, mut up, mut down) = (square, xi, xi_back);
        while power * up.max(down) > 1e-18 {
            sum -= 2.0 * power / (1.0 - power) * (up - down);
            power *= square;
            up *= xi;
            down *= xi_back;
        }
        let turn = 0.5 * (momentum / j1 + rate * sum);

        let (mut squares, mut products) = ([1.0; TERMS], [1.0; TERMS]);
        let (mut real, mut imaginary) = ([0.0; TERMS], [0.0; TERMS]);
        let (mut power, mut up, mut down, mut sign) = (1.0, e, back, 1.0);
        let (mut third, mut second) = (1.0, 1.0);
        let mut terms = 0;
        for n in 0..TERMS {
            if n > 0 {
                // n² − n(n − 1) = n, and n(n + 1) − n² = n.
                power *= nome;
                squares[n] = products[n - 1] * power;
                products[n] = squares[n] * power;
                third += 2.0 * squares[n];
                second += products[n];
                up *= xi;
                down *= xi_back;
                sign = -sign;
            }
            real[n] = sign * products[n] * (up + down);
            imaginary[n] = -sign * products[n] * (up - down);
            terms = n + 1;
            if squares[n] < SMALL && real[n].abs() < SMALL * real[0] {
                break;
            }
        }
        let mut fourth = 1.0;
        for (n, term) in squares[..terms].iter().enumerate().skip(1) {
            fourth += if n % 2 == 0 { 2.0 } else { -2.0 } * term;
        }
        let mut found = Self {
            order,
            hand,
            moments: [j1, j2, j3],
            energy: j1 * w1 * w1 + j2 * w2 * w2 + j3 * w3 * w3,
            rate,
            phase,
            turn,
            sizes: [
                size1 * fourth / second,
                size2 * third / second,
                size3 * fourth / third,
            ],
            terms,
            squares,
            products,
            real,
            imaginary,
            attitude,
            start: Quaternion::IDENTITY,
        };
        found.start = found.turned(0.0).0.inverse();
        Some(found)
    }

    /// Attitude and ω at a time.
    #[inline(always)]
    pub fn at(&self, time: f64) -> (Quaternion, Vector) {
        let (turned, spin) = self.turned(time);
        let Quaternion { w, x, y, z } = self.start * turned;
        let (v, s) = (self.of_body([x, y, z]), self.of_body(spin));
        let turned = Quaternion::new(w, v.x, v.y, v.z);
        ((self.attitude * turned).normalized(), s)
    }

    /// A vector along axes 1, 2 and 3 in those of the body.
    #[inline(always)]
    fn of_body(&self, parts: [f64; 3]) -> Vector {
        let mut v = [0.0; 3];
        v[self.order[0]] = parts[0];
        v[self.order[1]] = parts[1];
        v[self.order[2]] = self.hand * parts[2];
        Vector::new(v[0], v[1], v[2])
    }

    /// The rotation from axes 1, 2 and 3 to axes that do not move, with **Λ** along z, but for a constant turn about it; and ω along the former.
    #[inline(always)]
    fn turned(&self, time: f64) -> (Quaternion, [f64; 3]) {
        let (sine, cosine) = sincos(self.rate * time + self.phase);
        let (s2, c2) = (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine);
        // The sine and the cosine of (2n + 1)ν, and the cosine of 2nν.
        let (mut s, mut c) = (sine, cosine);
        let (mut even, mut before) = (1.0, c2);
        let (mut first, mut second, mut third, mut fourth) = (0.0, 0.0, 0.0, 0.0);
        let (mut real, mut imaginary, mut sign) = (0.0, 0.0, 1.0);
        for n in 0..self.terms {
            first += sign * self.products[n] * s;
            second += self.products[n] * c;
            let term = if n == 0 {
                1.0
            } else {
                2.0 * self.squares[n] * even
            };
            third += term;
            fourth += sign * term;
            real += self.real[n] * s;
            imaginary += self.imaginary[n] * c;
            (s, c) = (s * c2 + c * s2, c * c2 - s * s2);
            (even, before) = (2.0 * c2 * even - before, even);
            sign = -sign;
        }
        let part = 1.0 / fourth;
        let [a, b, c] = self.sizes;
        let [j1, j2, j3] = self.moments;
        let (w1, w2, w3) = (a * part * second, b * part * first, c * part * third);
        let energy = j1 * w1 * w1 + j2 * w2 * w2 + j3 * w3 * w3;
        // The energy is kept to less than the last digit, lest rounding heat the body or cool it over many flights.
        let lost = 0.5 * (self.energy - energy) / energy;
        let exact = |size: f64, theta: f64| {
            let high = size * part;
            let low = size.mul_add(part, -high) + lost * high;
            theta.mul_add(high, theta * low)
        };
        let spin = [exact(a, second), exact(b, first), exact(c, third)];
        // Angles of Λ from axis 3 and about it, and ψ: halves of each.
        let (x, y, z) = (j1 * spin[0], j2 * spin[1], j3 * spin[2]);
        let across = (x * x + y * y).sqrt();
        let (tilt_sine, tilt_cosine) = half(across, z, (across * across + z * z).sqrt());
        let (about_sine, about_cosine) = half(y, x, across);
        let (own_sine, own_cosine) = half(
            imaginary,
            real,
            (real * real + imaginary * imaginary).sqrt(),
        );
        let (turn_sine, turn_cosine) = sincos(self.turn * time);
        let psi_sine = turn_sine * own_cosine - turn_cosine * own_sine;
        let psi_cosine = turn_cosine * own_cosine + turn_sine * own_sine;
        // By ψ about the third axis, back by the tilt about the second, back by the angle about the third.
        let (near, far) = (psi_cosine * about_cosine, psi_sine * about_sine);
        let (one, other) = (psi_sine * about_cosine, psi_cosine * about_sine);
        let turned = Quaternion::new(
            tilt_cosine * (near + far),
            tilt_sine * (one + other),
            tilt_sine * (far - near),
            tilt_cosine * (one - other),
        );
        (turned, spin)
    }
}

/// Sine and cosine of half the angle of the vector (x, y) of this length.
#[inline(always)]
fn half(y: f64, x: f64, length: f64) -> (f64, f64) {
    let larger = (0.5 * (1.0 + x.abs() / length)).sqrt();
    let smaller = 0.5 * y / (length * larger);
    if x >= 0.0 {
        (smaller, larger)
    } else {
        (larger.copysign(y), smaller.abs())
    }
}

/// To a few rounding errors for negative numbers, too; |x| ≤ 32.
#[inline(always)]
fn exp(x: f64) -> f64 {
    let large = exp_in_lanes(one(x.abs())).as_slice()[0];
    if x < 0.0 { 1.0 / large } else { large }
}
