//! The rotation without torque of a body with three different moments of inertia, by Jacobi's elliptic functions.
//!
//! R. van Zon and J. Schofield, *Numerical implementation of the exact dynamics of free rigid bodies*, J. Comput. Phys. **225**, 145 (2007),
//! with axis 3 that about which **Λ** turns: J₃ is the largest moment where Λ² > 2EJ₂, else the least; J₂ is the middle one. Then
//! ω₁ = Ω₁cn(u), ω₂ = Ω₂sn(u), ω₃ = Ω₃dn(u) with u = ω_p t + u₀, and the axes of the body are turned about **Λ** by
//! ψ = A₂t − arg ϑ₁(ν − iη) + constant, ν = πu/2K. Everything is by theta functions of the nome q. Of A₂ they give Λ/J₁ less a logarithmic derivative
//! of ϑ₁; here it is Λ/J₂ less that of ϑ₂, which is the same and loses no digits where **Λ** passes near axis 3.
//!
//! Near the separatrix q is nearly 1, and with **Λ** along axis 3 η is infinite: there is none, and a series is used.

use super::top::energy_error;
use crate::math::{Quaternion, Quaternions, Vectors};
use crate::shape::Top;
use crate::simd::elementary::{exp_m1_in_lanes, sincos_in_lanes};
use crate::simd::{Mask, Pack};
use pulp::Simd;
use std::f64::consts::PI;

/// Terms of the theta functions, and the largest nome for which these are enough: q to the power `TERMS`² is less than rounding.
const TERMS: usize = 7;
const LARGEST: f64 = 0.42;
/// Least modulus: below it **Λ** is so near to axis 3 that η is large.
const LEAST: f64 = 1e-10;
/// See [`nome`]; and the coefficients of its series.
const SERIES: f64 = 0.17;
const NOME: [f64; 9] = [
    1.0,
    2.0,
    15.0,
    150.0,
    1707.0,
    20910.0,
    268_616.0,
    3_567_400.0,
    48_555_069.0,
];
/// Terms less than this part of the first one are left out.
const SMALL: f64 = 1e-18;

/// A rotation in each lane.
#[derive(Debug, Clone)]
pub(super) struct Elliptic<S: Simd> {
    /// The axes of the body from the least moment to the largest: axes 1, 2 and 3 in the lanes that are `above`, else axes 3, 2 and 1. Axis 3 is turned round
    /// where they would be left-handed.
    order: [usize; 3],
    above: Mask<S>,
    hand: Pack<S>,
    moments: [Pack<S>; 3],
    /// ω at the beginning.
    first: [Pack<S>; 3],
    /// J₁(J₁ − J₃) and J₂(J₂ − J₃): times ω₁² and ω₂² they are together Λ² − 2EJ₃, which is this.
    across: [Pack<S>; 2],
    beyond: Pack<S>,
    /// ν = `rate` t + `phase`.
    rate: Pack<S>,
    phase: Pack<S>,
    /// ½A₂.
    turn: Pack<S>,
    /// Ω₁, Ω₂, Ω₃, each with the ratio of theta functions of 0.
    sizes: [Pack<S>; 3],
    /// The number of terms that are needed: of ϑ₃, of ϑ₁ and the real part of ϑ₁(ν − iη), and of ϑ₂ and the imaginary part.
    terms: usize,
    squares: [Pack<S>; TERMS],
    sines: [Pack<S, 2>; TERMS],
    cosines: [Pack<S, 2>; TERMS],
    /// The attitude at the beginning after the rotation back from that at the time 0 in the axes of **Λ**, in axes 1, 2 and 3.
    start: Quaternions<S>,
}

/// The nome of a modulus m with its complement m′: A. Abramowitz and I. A. Stegun, *Handbook of Mathematical Functions*, 17.3.21, whose terms beyond these
/// are less than rounding for ε ≤ [`SERIES`]. Where ε is larger, it is the root of that of the modulus after a step of Landen's, which is q².
#[inline(always)]
fn nome<S: Simd>(modulus: Pack<S>, complement: Pack<S>) -> Pack<S> {
    // ½(1 − √k′)/(1 + √k′) without the difference.
    #[inline(always)]
    fn epsilon<S: Simd>(m: Pack<S>, k: Pack<S>, root: Pack<S>) -> Pack<S> {
        0.5 * m / ((1.0 + k) * ((1.0 + root) * (1.0 + root)))
    }
    let k = complement.sqrt();
    let root = k.sqrt();
    let mut e = epsilon(modulus, k, root);
    let small = e.le(SERIES);
    let stepped = !small.all();
    if stepped {
        let part = modulus / ((1.0 + k) * (1.0 + k));
        let k = 2.0 * root / (1.0 + k);
        e = small.select(e, epsilon(part * part, k, k.sqrt()));
    }
    let e4 = (e * e) * (e * e);
    let mut sum = Pack::splat(e.simd(), NOME[8]);
    for n in (0..8).rev() {
        sum = sum * e4 + NOME[n];
    }
    let q = e * sum;
    if stepped {
        small.select(q, q.sqrt())
    } else {
        q
    }
}

/// R_F of three numbers in order, of two sets side by side: B. C. Carlson, *Numer. Algorithms* **10**, 13 (1995); his series in the differences from
/// the mean, here to the eleventh order, is DLMF 19.19.7. The incomplete integral F(φ) is sin φ R_F(cos²φ, 1 − k²sin²φ, 1).
#[inline(always)]
fn carlson<S: Simd>(mut x: Pack<S, 2>, mut y: Pack<S, 2>, mut z: Pack<S, 2>) -> Pack<S, 2> {
    let mean = loop {
        let mean = (x + y + z) * (1.0 / 3.0);
        let [one, other] = both((z - x) - 0.1 * mean);
        // Both sets of a lane go on together, but no lane with others.
        let wide = !(one.le(0.0) & other.le(0.0));
        if !wide.any() {
            break mean;
        }
        let wide = wide.repeat();
        let (a, b, c) = (x.sqrt(), y.sqrt(), z.sqrt());
        let sum = a * b + b * c + c * a;
        x = wide.select(0.25 * (x + sum), x);
        y = wide.select(0.25 * (y + sum), y);
        z = wide.select(0.25 * (z + sum), z);
    };
    let (x, y) = (1.0 - x / mean, 1.0 - y / mean);
    let z = -x - y;
    let (e2, e3) = (x * y - z * z, x * y * z);
    let square = e2 * e2;
    // The powers 0, 1, 2 and 3 of E₃.
    let none = e2 * (-1.0 / 10.0)
        + square
            * ((1.0 / 24.0 - e2 * (5.0 / 208.0)) + square * (35.0 / 2176.0 - e2 * (3.0 / 256.0)));
    let first = (1.0 / 14.0 - e2 * (3.0 / 44.0))
        + square * ((1.0 / 16.0 - e2 * (35.0 / 608.0)) + square * (315.0 / 5888.0));
    let second = 3.0 / 104.0 + e2 * (e2 * (5.0 / 64.0) - 15.0 / 272.0);
    let third = 5.0 / 304.0 - e2 * (35.0 / 736.0);
    (1.0 + (none + e3 * (first + e3 * (second + e3 * third)))) / mean.sqrt()
}

/// Two vectors side by side.
#[inline(always)]
fn two<S: Simd>(one: Pack<S>, other: Pack<S>) -> Pack<S, 2> {
    let mut pair = one.repeat();
    pair.set_part(1, &other);
    pair
}

#[inline(always)]
fn both<S: Simd>(pair: Pack<S, 2>) -> [Pack<S>; 2] {
    [pair.part(0), pair.part(1)]
}

/// A number that is not negative with the sign of another.
#[inline(always)]
fn signed<S: Simd>(x: Pack<S>, like: Pack<S>) -> Pack<S> {
    like.bit(63).select(-x, x)
}

impl<S: Simd> Elliptic<S> {
    /// The rotation from this attitude and this ω, and the lanes in which it can be computed so.
    #[inline(always)]
    pub fn new(top: &Top, attitude: Quaternions<S>, spin: Vectors<S>) -> (Self, Mask<S>) {
        let simd = spin.x.simd();
        let (zero, unit) = (Pack::splat(simd, 0.0), Pack::splat(simd, 1.0));
        let w = spin.parts();
        let moments = top.moments();
        let order = top.order;
        let [low, middle, high] = order;
        let [a, b, c] = [moments[low], moments[middle], moments[high]];
        // Λ² − 2EJ₂.
        let beyond = c * (c - b) * w[high] * w[high] - a * (b - a) * w[low] * w[low];
        let above = zero.lt(beyond);
        let hand = if (low + 1) % 3 == middle { 1.0 } else { -1.0 };
        let hand = above.select(Pack::splat(simd, hand), -hand);
        let [j1, j2, j3] = [
            above.select(Pack::splat(simd, a), c),
            Pack::splat(simd, b),
            above.select(Pack::splat(simd, c), a),
        ];
        let w1 = above.select(w[low], w[high]);
        let w2 = w[middle];
        let w3 = hand * above.select(w[high], w[low]);
        let momentum = (j1 * j1 * w1 * w1 + j2 * j2 * w2 * w2 + j3 * j3 * w3 * w3).sqrt();
        // Λ² − 2EJ₃ and Λ² − 2EJ₁.
        let across = [j1 * (j1 - j3), j2 * (j2 - j3)];
        let d3 = across[0] * w1 * w1 + across[1] * w2 * w2;
        let d1 = j2 * (j2 - j1) * w2 * w2 + j3 * (j3 - j1) * w3 * w3;
        let size1 = (d3 / across[0]).sqrt();
        let size2 = -(d3 / across[1]).sqrt();
        let size3 = signed((d1 / (j3 * (j3 - j1))).sqrt(), w3);
        let (sine, cosine) = (j3 * size3.abs() / momentum, j1 * size1 / momentum);
        let whole = d1 * (j3 - j2);
        let modulus = d3 * (j1 - j2) / whole;
        let complement = beyond * (j3 - j1) / whole;
        let nome = nome(modulus, complement);
        // Not where there is no number.
        let serves = Pack::splat(simd, LEAST).lt(modulus) & zero.lt(complement) & nome.le(LARGEST);
        // ϑ₃ = 1 + 2q + 2q⁴ + ..., whose square is 2K/π.
        let square = nome * nome;
        let (fourth, fifth) = (square * square, square * square * nome);
        let seventh = fifth * square;
        let (ninth, eleventh) = (fifth * fourth, seventh * fourth);
        let theta = 1.0 + fifth * (1.0 + seventh * (1.0 + ninth * (1.0 + eleventh)));
        let theta = 1.0 + 2.0 * (nome + fourth * theta);
        let to_nu = 1.0 / (theta * theta);
        let rate = to_nu * ((j3 - j2) / j1) * (size2 * size3 / size1);
        // F of the angle from axis 1 to ω, which has up to 2K, and K′ − F′ of the angle of **Λ**, without the difference.
        let (x, y) = (w1 / size1, w2 / size2);
        let level = modulus * sine * sine;
        let [xx, yy] = [x * x, x * x + complement * y * y];
        let whole = cosine * cosine + level;
        let integrals = carlson(
            two(serves.select(xx, 1.0), serves.select(level, 1.0)),
            two(serves.select(yy, 1.0), serves.select(modulus, 1.0)),
            two(unit, serves.select(whole, 1.0)),
        );
        let [angle, left] = both(integrals);
        let quarter = to_nu * (y * angle);
        let phase = x.lt(0.0).select(signed(unit * PI, y) - quarter, quarter);
        let eta = signed(to_nu * (cosine * left), size3);

        // The hyperbolic sine and cosine of η and of 2η; by them nothing cancels where η is small.
        let grown = exp_m1_in_lanes(eta.abs());
        let shrunk = grown / (1.0 + grown);
        let (sinh, cosh) = (
            signed(0.5 * (grown + shrunk), eta),
            1.0 + 0.5 * grown * shrunk,
        );
        let (double_sinh, double_cosh) = (2.0 * sinh * cosh, 1.0 + 2.0 * sinh * sinh);
        // q to the powers n² and n(n + 1).
        let (mut squared, mut product) = (unit, unit);
        let mut squares = [unit; TERMS];
        let (mut sines, mut cosines) = ([two(zero, zero); TERMS], [two(zero, zero); TERMS]);
        let (mut power, mut s, mut c, mut sign) = (unit, sinh, cosh, 1.0);
        // ϑ₂, ϑ₃ and ϑ₄ of 0.
        let (mut second, mut third, mut fourth) = (unit, unit, unit);
        // ϑ₂(iη) and its derivative by η, of which no term is negative but by the sign of η.
        let (mut value, mut slope) = (zero, zero);
        let (mut odd, mut terms) = (1.0, 0);
        for n in 0..TERMS {
            if n > 0 {
                // n² − n(n − 1) = n, and n(n + 1) − n² = n.
                power = power * nome;
                squared = product * power;
                product = squared * power;
                squares[n] = 2.0 * squared;
                sign = -sign;
                third = third + squares[n];
                fourth = fourth + sign * squares[n];
                second = second + product;
                // Those of an argument that is 2η more.
                (s, c) = (
                    s * double_cosh + c * double_sinh,
                    c * double_cosh + s * double_sinh,
                );
            }
            let enough = squared.lt(SMALL) & (product * c).lt(SMALL * cosh);
            if enough.all() {
                break;
            }
            // No lane has more terms because others have.
            product = enough.select(0.0, product);
            let alternating = sign * product;
            sines[n] = two(alternating, alternating * c);
            cosines[n] = two(product, -alternating * s);
            value = value + product * c;
            slope = slope + odd * (product * s);
            odd += 2.0;
            terms = n + 1;
        }
        let mut found = Self {
            order,
            above,
            hand,
            moments: [j1, j2, j3],
            first: [w1, w2, w3],
            across,
            beyond: d3,
            rate,
            phase,
            turn: 0.5 * (momentum / j2 + rate * (slope / value)),
            sizes: [
                size1 * fourth / second,
                size2 * third / second,
                size3 * fourth / third,
            ],
            terms,
            squares,
            sines,
            cosines,
            start: Quaternions::splat(simd, Quaternion::IDENTITY),
        };
        let v = attitude.vector().parts();
        let (x, z) = (above.select(v[low], v[high]), above.select(v[high], v[low]));
        let (sine, cosine) = sincos_in_lanes(phase);
        let (_, argument) = found.thetas(sine, cosine);
        let turned = found.frame([w1, w2, w3], argument, (zero, unit), zero);
        found.start = Quaternions::new(attitude.w, x, v[middle], hand * z) * turned.inverse();
        (found, serves)
    }

    /// Attitude and ω at a time.
    #[inline(always)]
    pub fn at(&self, time: Pack<S>) -> (Quaternions<S>, Vectors<S>) {
        let (sines, cosines) =
            sincos_in_lanes(two(self.rate * time + self.phase, self.turn * time));
        let [[sine, turn_sine], [cosine, turn_cosine]] = [both(sines), both(cosines)];
        let (theta, argument) = self.thetas(sine, cosine);
        let [one, two, three] = self.sizes;
        let w = [one * theta[0], two * theta[1], three * theta[2]];
        let (spin, more) = self.spin(w);
        let turn = self.frame(w, argument, (turn_sine, turn_cosine), more);
        let own = self.start.turned(turn);
        let attitude = Quaternions::of(own.w, self.of_body(own.vector().parts()));
        (attitude, self.of_body(spin))
    }

    /// A vector along axes 1, 2 and 3 in those of the body.
    #[inline(always)]
    fn of_body(&self, [x, y, z]: [Pack<S>; 3]) -> Vectors<S> {
        let z = self.hand * z;
        let parts = [self.above.select(x, z), y, self.above.select(z, x)];
        Vectors::new(
            self.along(0, parts),
            self.along(1, parts),
            self.along(2, parts),
        )
    }

    /// That part along an axis of the body of those from the least moment to the largest; stores by index would have to end before loads of two numbers at once.
    #[inline(always)]
    fn along(&self, axis: usize, [least, middle, most]: [Pack<S>; 3]) -> Pack<S> {
        let [low, between, _] = self.order;
        if axis == low {
            least
        } else if axis == between {
            middle
        } else {
            most
        }
    }

    /// ϑ₂, ϑ₁ and ϑ₃ of ν, and the real and the imaginary part of ϑ₁(ν − iη), each but for a factor, from the sine and the cosine of ν.
    #[inline(always)]
    fn thetas(&self, sine: Pack<S>, cosine: Pack<S>) -> ([Pack<S>; 3], [Pack<S>; 2]) {
        let (s2, c2) = (2.0 * sine * cosine, 1.0 - 2.0 * sine * sine);
        let zero = Pack::splat(sine.simd(), 0.0);
        // The sine and the cosine of (2n + 1)ν, and the cosine of 2nν.
        let (mut s, mut c) = (sine, cosine);
        let (mut even, mut before) = (zero + 1.0, c2);
        let mut third = zero;
        let (mut odd, mut level) = (two(zero, zero), two(zero, zero));
        for n in 0..self.terms {
            odd = odd + self.sines[n] * s.repeat();
            level = level + self.cosines[n] * c.repeat();
            third = third + self.squares[n] * even;
            (s, c) = (s * c2 + c * s2, c * c2 - s * s2);
            (even, before) = (2.0 * c2 * even - before, even);
        }
        let [[first, real], [second, imaginary]] = [both(odd), both(level)];
        ([second, first, third], [real, imaginary])
    }

    /// ω along axes 1, 2 and 3, from what is ω but for a factor and rounding. Both constants of the motion are kept, or rounding would add up over many
    /// flights: Λ² − 2EJ₃, in which all terms have one sign, by the factor, and then the energy by ω₃, which is never 0 and becomes larger by the
    /// part that is returned, too.
    #[inline(always)]
    fn spin(&self, w: [Pack<S>; 3]) -> ([Pack<S>; 3], Pack<S>) {
        let [a, b] = self.across;
        let part = (self.beyond / (a * w[0] * w[0] + b * w[1] * w[1])).sqrt();
        let [x, y, z] = [part * w[0], part * w[1], part * w[2]];
        let per = 0.5 / (self.moments[2] * z * z);
        let more = per * energy_error(self.moments, self.first, [x, y, z]);
        ([x, y, z + more * z], more)
    }

    /// The rotation from axes 1, 2 and 3 to axes that do not move, with **Λ** along z, but for a constant turn about it: from ω but for a
    /// factor, theta functions, the sine and the cosine of ½A₂t, and the small part by which ω₃ is larger.
    #[inline(always)]
    fn frame(
        &self,
        w: [Pack<S>; 3],
        [real, imaginary]: [Pack<S>; 2],
        turn: (Pack<S>, Pack<S>),
        more: Pack<S>,
    ) -> Quaternions<S> {
        let [a, b, c] = self.moments;
        let [x, y, z] = [a * w[0], b * w[1], c * w[2]];
        let square = x * x + y * y;
        let [across, whole] = both(two(square, square + z * z).sqrt());
        let length = across * (real * real + imaginary * imaginary).sqrt();
        // Half the tilt of **Λ**; half the sum of its angle about axis 3 and that of ϑ₁; and half the difference, which is the former less that.
        let (sines, cosines) = half(
            two(across, y * real + x * imaginary),
            two(z, x * real - y * imaginary),
            two(whole, length),
        );
        let [[tilt_sine, plus_sine], [tilt_cosine, plus_cosine]] = [both(sines), both(cosines)];
        // By a larger ω₃ the tilt becomes smaller.
        let back = 0.5 * more * (across * z / (square + z * z));
        let (tilt_sine, tilt_cosine) = (
            tilt_sine - back * tilt_cosine,
            tilt_cosine + back * tilt_sine,
        );
        let (about_sine, about_cosine) = (y / across, x / across);
        let minus_sine = about_sine * plus_cosine - about_cosine * plus_sine;
        let minus_cosine = about_cosine * plus_cosine + about_sine * plus_sine;
        // By ψ about the third axis, back by the tilt about the second and back by the angle about the third.
        let (sine, cosine) = turn;
        Quaternions::new(
            tilt_cosine * (cosine * plus_cosine + sine * plus_sine),
            tilt_sine * (sine * minus_cosine + cosine * minus_sine),
            -tilt_sine * (cosine * minus_cosine - sine * minus_sine),
            tilt_cosine * (sine * plus_cosine - cosine * plus_sine),
        )
    }
}

/// Sines and cosines of half the angles of two vectors (x, y) of these lengths.
#[inline(always)]
fn half<S: Simd>(y: Pack<S, 2>, x: Pack<S, 2>, length: Pack<S, 2>) -> (Pack<S, 2>, Pack<S, 2>) {
    // The sum of the vector, or of the one that x < 0 mirrors, and one of this length along x.
    let sum = length + x.abs();
    let part = 1.0 / (2.0 * length * sum).sqrt();
    let (larger, smaller) = (sum * part, y * part);
    let (back, left) = (x.lt(0.0), y.lt(0.0));
    let signed = left.select(-larger, larger);
    (
        back.select(signed, smaller),
        back.select(smaller.abs(), larger),
    )
}
