//! Coulomb friction for any K: the slip in closed form, up to one quadrature whose nodes fill the lanes.
//!
//! In the principal axes of the tangential block, K_t = diag(k₁, k₂) with k₁ ≥ k₂ and κ = (K_nx, K_ny), a slip **s** = ρ**d**,
//! **d** = (cos φ, sin φ), obeys d**s**/dp = κ − μK_t**d**. With dp = ρ dθ
//!
//! dφ/dθ = h(φ) = −κ₁ sin φ + κ₂ cos φ + μ(k₁ − k₂) sin φ cos φ, d ln ρ/dθ = r(φ) = κ·**d** − μ **d**ᵀK_t**d**.
//!
//! A zero of h is a ray that the slip does not leave. Since dh/dφ = −r − μk_⊥ there, k_⊥ = **d**_⊥ᵀK_t**d**_⊥, every ray along which a slip grows
//! (r > 0) attracts. One ray that attracts lies in the quadrant of κ: κ − μK_t**d** = λ**d** with λ > −μk₂ means **d** = (μK_t + λ)⁻¹κ, whose length falls
//! with λ from infinity to 0 and is 1 once ([`PrincipalFrame::ray`]).
//!
//! Let δ be the angle from a ray that attracts to the slip, positive on its side, z = tan(δ/2), α and β the components of κ along the
//! ray and across, A and E those of μK_t, and m = A − E. Across, μK_t has the component β too, or the ray were none. Then
//!
//! dz/dθ = z C(z)/(1 + z²), C = (m − α) + 3βz − (m + α)z² − βz³,
//!
//! r = R(z)/(1 + z²)², R = (α − A) − 2βz + (2A − 4E)z² + 6βz³ − (α + A)z⁴.
//!
//! The slip stays between this ray and the next on its side, which repels: z_r = 1/k, k the largest real root of C(1/k)k³. With
//! C = (1 − kz) D(z) and w = z/(1 − kz), which goes from infinity to 0 as the slip turns from that ray to this one,
//!
//! d ln w/dθ = D/(1 + z²), d ln ρ/d ln w = R/((1 + z²)D),
//!
//! and both right-hand sides are analytic in ln w as far as ±i and the zeros of D, which where they are real are the other two rays. All that
//! an impact asks for, p, the friction, v_n and the work, is an integral of ρ times a rational function of z. A [`Panel`] is a piece of ln w
//! with 24 nodes of Gauss's rule; ln ρ at the nodes and every integral from the panel's beginning to a place in it are those of the
//! polynomial through the nodes, so that the end of the compression or of the restitution is a zero of a polynomial.
//!
//! On the way to the rest along a ray, ρ = w^a G(w) with a = R(0)/D(0) > 0 and G analytic. With V(t) the integral of s^(a−1)F(s) from 0 to
//! t over t^a, tV′ + aV = F, which for series in Legendre's polynomials is a back-substitution: one piece leads to where the slip vanishes.
//! A slip at rest stays if |K_t⁻¹κ| ≤ μ; else it leaves along the ray in the quadrant of κ. Along a ray everything is a straight line in p.
//!
//! v_n, with dv_n/dp = K_nn − μκ·**d**, can fall (a jam) where μ|κ| > K_nn. A panel therefore ends where dv_n/dp changes its sign, and a
//! contact that approaches again during the restitution is compressed again. Where the slip grows or sticks there is no jam, because K is
//! positive definite, so that each one ends.

use super::{Coulomb, Hypothesis, Sliding, phases::Gain, phases::ImpactSoFar};
use crate::law::{Compliance, Contact, Frictionless, ImpulseRule, Response};
use crate::math::flat::{cross, half_cotangent, norm, rotate, rotate_back, scalar};
use crate::math::nodal::{NODES, Nodal, QUADRATURE, dot, each, moments, rows};
use crate::math::roots::{deflated, largest_root, zeros};
use crate::math::{Vector, Vectors};
use crate::simd::elementary::{ln, plain_exp as exp, power_of_two, rough_ln};
use crate::simd::{Lanewise, Level, Pack, one};
use pulp::{Scalar, Simd, WithSimd};
use std::f64::consts::{FRAC_PI_2, PI};

/// Largest error of an impulse, relative to the impulse so far.
const TINY: f64 = 0.125 * f64::EPSILON;
/// The angle between a slip and a ray that attracts it that does not count.
const ALONG: f64 = 2.0 * f64::EPSILON;
/// Pieces of a path after which it is given up; the most seen in millions of impacts is some tens.
const MOST_PIECES: usize = 2000;
/// The sum of the distances of a singularity from both ends of a panel, over its length, from which 24 nodes lose nothing: (B + 1/B)/2
/// for Bernstein's ellipse with B = 4.8, and B^−24 = 10^−16.
const CLEAR: f64 = 2.5;
/// The largest changes of ln ρ in a panel in which places are located, and in one that is only passed.
const STEEP: f64 = 9.0;
const STEEPEST: f64 = 30.0;
/// The most by which a panel is longer than the way to the end of the impact, as far as one can tell.
const AMPLE: f64 = 2.2;
/// The largest length of a panel in ln w.
const LONGEST: f64 = 6.0;
/// The largest a from which the way to the rest is one piece; beyond it ρ falls before the slip has turned.
const MOST_POWER: f64 = 20.0;
/// The last two coefficients of Legendre's series, relative to the sum, below which the polynomial through the nodes is exact.
const RESOLVED: f64 = 2e-14;
/// The discriminant of D over the square of its linear coefficient below which D is written about its minimum: two rays are about to merge there, the
/// slip turns so slowly that it may come to rest meanwhile, and the sum of the powers of z would be rounding only.
const MERGING: f64 = 1e-4;

impl Sliding<Scalar> for Compliance {
    fn slide(
        &self,
        rule: &Coulomb,
        velocity: Vectors<Scalar>,
        restitution: Pack<Scalar>,
    ) -> Response<Pack<Scalar>> {
        if rule.friction == 0.0 {
            let contact = Contact {
                velocity,
                compliance: *self,
            };
            return Frictionless.respond::<_, true>(&contact, restitution);
        }
        let velocity = velocity.lane(0);
        let approach = velocity.z.abs();
        let size = approach + velocity.x.abs() + velocity.y.abs();
        if size == 0.0 {
            return Response::none(Scalar::new());
        }
        // Powers of two, so that nothing is rounded here.
        let (speed_unit, response_unit) = (power_of_two(size), power_of_two(self.normal()));
        let axes = PrincipalFrame::new(self, 1.0 / response_unit, rule.friction);
        let unit = 1.0 / speed_unit;
        let slip = rotate(axes.first, [velocity.x * unit, velocity.y * unit]);
        let e = restitution.as_slice()[0];
        let mut path = OngoingImpact {
            axes: &axes,
            slip,
            now: ImpactSoFar::new(rule.hypothesis, e, approach * unit),
            rest_is_beyond: false,
        };
        Level::best().run(&mut path);
        let scale = speed_unit / response_unit;
        let [along, across] = rotate_back(axes.first, path.now.friction);
        Response {
            impulse: (Vector::new(along, across, path.now.normal) * scale).in_lane(),
            separation_speed: one(path.now.speed.max(0.0) * speed_unit),
        }
    }
}

/// K and μ in the principal axes of K_t.
struct PrincipalFrame {
    /// Cosine and sine of the angle from x to the first axis.
    first: [f64; 2],
    nn: f64,
    coupling: [f64; 2],
    tangential: [f64; 2],
    friction: f64,
    /// The largest rate; θ is measured in its inverse.
    rate: f64,
    /// κ, μk₁ and μk₂, and μ(k₁ − k₂), over that rate.
    drive: [f64; 2],
    brake: [f64; 2],
    spread: f64,
    /// True if dv_n/dp can be negative.
    may_jam: bool,
}

/// Rates at a direction of the slip, in units of [`PrincipalFrame::rate`].
struct SlipRates {
    /// h(φ).
    turn: f64,
    /// r(φ).
    growth: f64,
    /// μk_⊥.
    across: f64,
    /// dh/dφ on a ray.
    turn_slope: f64,
}

impl PrincipalFrame {
    fn new(k: &Compliance, unit: f64, friction: f64) -> Self {
        let k = k.entries();
        let (xx, yy, xy) = (k.xx * unit, k.yy * unit, k.xy * unit);
        let (mut first, mut tangential) = ([1.0, 0.0], [xx, yy]);
        if xy != 0.0 {
            // Jacobi's rotation by the smaller angle, of tangent t.
            let tau = 0.5 * (yy - xx) / xy;
            let t = 1.0_f64.copysign(tau) / (tau.abs() + (1.0 + tau * tau).sqrt());
            let cosine = 1.0 / (1.0 + t * t).sqrt();
            first = [cosine, -t * cosine];
            tangential = [xx - t * xy, yy + t * xy];
        }
        if tangential[0] < tangential[1] {
            first = [-first[1], first[0]];
            tangential = [tangential[1], tangential[0]];
        }
        let coupling = rotate(first, [k.xz * unit, k.yz * unit]);
        let nn = k.zz * unit;
        let brake = tangential.map(|t| friction * t);
        let rate = coupling[0].abs() + coupling[1].abs() + brake[0];
        Self {
            first,
            nn,
            coupling,
            tangential,
            friction,
            rate,
            drive: coupling.map(|c| c / rate),
            brake: brake.map(|b| b / rate),
            spread: friction * (tangential[0] - tangential[1]) / rate,
            may_jam: friction * norm(coupling) > nn,
        }
    }

    fn rates(&self, d: [f64; 2]) -> SlipRates {
        let [along, across] = self.braking(d);
        let growth = scalar(self.drive, d) - along;
        SlipRates {
            turn: cross(d, self.drive) + self.spread * d[0] * d[1],
            growth,
            across,
            turn_slope: -growth - across,
        }
    }

    /// The components of μK_t along a direction and across.
    fn braking(&self, d: [f64; 2]) -> [f64; 2] {
        let squares = d.map(|x| x * x);
        let [c2, s2] = squares;
        [scalar(self.brake, squares), scalar(self.brake, [s2, c2])]
    }

    /// The tangential impulse per normal impulse of a slip in this direction.
    fn pull(&self, d: [f64; 2]) -> [f64; 2] {
        d.map(|x| -self.friction * x)
    }

    /// The same of a slip at rest: what keeps it there, or that of the ray along which it leaves.
    fn hold(&self) -> [f64; 2] {
        let hold = [0, 1].map(|i| -self.coupling[i] / self.tangential[i]);
        if norm(hold) <= self.friction {
            hold
        } else {
            self.pull(self.ray())
        }
    }

    /// dv_n/dp with a tangential impulse per normal impulse.
    fn stiffness(&self, pull: [f64; 2]) -> f64 {
        self.nn + scalar(self.coupling, pull)
    }

    /// The ray that attracts in the quadrant of κ: **d** = (μK_t + λ)⁻¹κ of length 1, with λ > −μk₂. The inverse of the length is
    /// concave in η = λ + μk₂, so that Newton's steps from where one component has the length 1 stay on the near side.
    fn ray(&self) -> [f64; 2] {
        let [a, b] = self.drive.map(f64::abs);
        let along = |[x, y]: [f64; 2]| [x.copysign(self.drive[0]), y.copysign(self.drive[1])];
        if b == 0.0 && a <= self.spread {
            // A pair of rays aside of the first axis, or, without coupling, the second axis.
            let x = if a == 0.0 { 0.0 } else { a / self.spread };
            return along([x, ((1.0 - x) * (1.0 + x)).sqrt()]);
        }
        let mut eta = b.max(a - self.spread);
        let mut d = [1.0; 2];
        for _ in 0..60 {
            let rates = [self.spread + eta, eta];
            d = [a / rates[0], b / rates[1]];
            let square = scalar(d, d);
            let slope = d[0] * d[0] / rates[0] + d[1] * d[1] / rates[1];
            let step = square * (square.sqrt() - 1.0) / slope;
            eta += step;
            if step <= f64::EPSILON * eta {
                break;
            }
        }
        let size = norm(d);
        along(d.map(|x| x / size))
    }

    /// A direction next to a ray, turned to it by Newton's method.
    fn onto_ray(&self, mut d: [f64; 2]) -> [f64; 2] {
        for _ in 0..2 {
            let rates = self.rates(d);
            let delta = -rates.turn / rates.turn_slope;
            if delta.abs() < 1e-3 {
                let turned = [d[0] - delta * d[1], d[1] + delta * d[0]];
                let size = norm(turned);
                d = turned.map(|x| x / size);
            }
        }
        d
    }

    /// The coefficients of C about a ray.
    fn cubic(&self, ray: [f64; 2]) -> [f64; 4] {
        let [alpha, beta] = rotate(ray, self.drive);
        let m = self.spread * (ray[0] - ray[1]) * (ray[0] + ray[1]);
        [m - alpha, 3.0 * beta, -(alpha + m), -beta]
    }
}

/// The directions between a ray that attracts and the next on one side, which repels.
struct Sector {
    ray: [f64; 2],
    side: f64,
    /// cot(δ/2) of the ray that repels.
    k: f64,
    /// The coefficients of D in powers of z less `middle`, which is 0 but where two rays are about to merge.
    about: [f64; 3],
    middle: f64,
    /// The coefficients of R, and α and β.
    growth: [f64; 5],
    drive: [f64; 2],
    /// a, d ln ρ/d ln w on the ray.
    power: f64,
    /// The singularities in the upper half of the plane of w.
    singular: [[f64; 2]; 3],
    /// And in that of ln w, roughly.
    singular_ln: [[f64; 2]; 3],
}

impl Sector {
    /// The sector in which a direction lies, which is none of a ray, and its w there.
    fn of(axes: &PrincipalFrame, d: [f64; 2]) -> (Self, f64) {
        let mut ray = axes.ray();
        let mut cubic = axes.cubic(ray);
        let (mut k, real) = largest_root(cubic);
        let cot = half_cotangent(ray, d, 1.0);
        let mut side = if cot >= k { 1.0 } else { -1.0 };
        let [middle, last] = zeros(deflated(cubic, k));
        if real && last.is_finite() {
            // From the ray on, one repels, one attracts, one repels.
            if cot < k && cot > last {
                let [before, this, after] = [k, middle, last].map(|k| {
                    let whole = 1.0 / (k * k + 1.0);
                    rotate_back(ray, [(k * k - 1.0) * whole, 2.0 * k * whole])
                });
                ray = axes.onto_ray(this);
                cubic = axes.cubic(ray);
                side = if cross(ray, d) >= 0.0 { 1.0 } else { -1.0 };
                k = half_cotangent(ray, if side > 0.0 { after } else { before }, side);
            } else if side < 0.0 {
                k = -last;
            }
        } else {
            k *= side;
        }
        let cubic = [cubic[0], side * cubic[1], cubic[2], side * cubic[3]];
        let slope = (3.0 * cubic[0] * k + 2.0 * cubic[1]) * k + cubic[2];
        let step = (((cubic[0] * k + cubic[1]) * k + cubic[2]) * k + cubic[3]) / slope;
        if step.abs() < 1e-6 * (1.0 + k.abs()) {
            k -= step;
        }
        let turn = deflated(cubic, k);
        let [alpha, beta] = rotate(ray, axes.drive);
        let beta = side * beta;
        let [along, across] = axes.braking(ray);
        // w of z = x + iy.
        let place = |x: f64, y: f64| {
            let (a, b) = (1.0 - k * x, -k * y);
            let inverse = 1.0 / (a * a + b * b);
            [(x * a + y * b) * inverse, ((y * a - x * b) * inverse).abs()]
        };
        let discriminant = turn[1] * turn[1] - 4.0 * turn[0] * turn[2];
        let mut singular = [place(0.0, 1.0); 3];
        if discriminant < 0.0 {
            let part = 0.5 / turn[2];
            singular[1] = place(-turn[1] * part, (-discriminant).sqrt() * part);
        } else {
            for (singular, k) in singular[1..].iter_mut().zip(zeros(turn)) {
                if (1.0 / k).is_finite() {
                    *singular = place(1.0 / k, 0.0);
                }
            }
        }
        let (mut middle, mut about) = (0.0, turn);
        if discriminant.abs() < MERGING * turn[1] * turn[1] {
            middle = -0.5 * turn[1] / turn[2];
            about = [-0.25 * discriminant / turn[2], 0.0, turn[2]];
        }
        let sector = Self {
            ray,
            side,
            k,
            about,
            middle,
            growth: [
                alpha - along,
                -2.0 * beta,
                2.0 * along - 4.0 * across,
                6.0 * beta,
                -(alpha + along),
            ],
            drive: [alpha, beta],
            power: (alpha - along) / turn[0],
            singular,
            singular_ln: singular.map(|[x, y]| {
                let angle = FRAC_PI_2 * y / (x.abs() + y); // to within 0.08
                [
                    0.5 * rough_ln(x * x + y * y),
                    if x < 0.0 { PI - angle } else { angle },
                ]
            }),
        };
        (sector, 1.0 / (half_cotangent(ray, d, side) - k))
    }

    /// The direction at w.
    #[inline(always)]
    fn direction(&self, w: f64) -> [f64; 2] {
        let q = 1.0 + self.k * w;
        let whole = 1.0 / (w * w + q * q);
        let (cosine, sine) = ((q - w) * (q + w) * whole, 2.0 * q * w * whole);
        rotate_back(self.ray, [cosine, self.side * sine])
    }

    /// −d ln w/dθ.
    #[inline(always)]
    fn pace(&self, w: f64) -> f64 {
        let q = 1.0 + self.k * w;
        let t = w - self.middle * q;
        let [a, b, c] = self.about;
        -(a * q * q + b * q * t + c * t * t) / (q * q + w * w)
    }

    /// The longest panel from w on in which the functions are polynomials to rounding: from (|x₀ − x_i| + |x₁ − x_i|)/|x₀ − x₁| = [`CLEAR`].
    #[inline(always)]
    fn reach(&self, w: f64) -> f64 {
        let x = rough_ln(w);
        let mut length = LONGEST;
        for [re, im] in self.singular_ln {
            let (u, v) = (re - x, im);
            let distance = (u * u + v * v).sqrt();
            length = length.min(2.0 * (u + CLEAR * distance) / (CLEAR * CLEAR - 1.0));
        }
        length
    }

    /// Returns whether the functions are polynomials in w from 0 on.
    #[inline(always)]
    fn is_clear(&self, w: f64) -> bool {
        self.singular
            .iter()
            .all(|&[x, y]| norm([x - w, y]) + norm([x, y]) >= CLEAR * w)
    }

    /// The length in ln w to the next place where dv_n/dp is 0.
    #[inline(always)]
    fn monotone(&self, axes: &PrincipalFrame, w: f64) -> f64 {
        let mut length = f64::INFINITY;
        if axes.may_jam {
            let nn = axes.nn / axes.rate;
            let [along, across] = self.drive.map(|x| x * axes.friction);
            for cot in zeros([nn - along, -2.0 * across, nn + along]) {
                // w = 1/(cot δ/2 − k)
                let ratio = w * (cot - self.k);
                if ratio > 1.0 + 1e-9 {
                    length = length.min(ln(ratio));
                }
            }
        }
        length
    }

    /// d ln ρ/d ln w, dθ/d ln w, cos δ and sin δ at the nodes.
    #[inline(always)]
    fn functions(&self, w: &Nodal) -> [Nodal; 4] {
        let mut found = [[0.0; NODES]; 4];
        let [a, b, c] = self.about;
        let [r0, r1, r2, r3, r4] = self.growth;
        for j in 0..NODES {
            let z = w[j];
            let q = 1.0 + self.k * z;
            let (zz, qq, zq) = (z * z, q * q, z * q);
            let size = zz + qq;
            let t = z - self.middle * q;
            let turn = a * qq + b * (t * q) + c * (t * t);
            let growth = qq * (r0 * qq + r1 * zq) + zz * (r2 * qq + r3 * zq + r4 * zz);
            let inverse = 1.0 / (size * turn);
            let whole = 1.0 / size;
            found[0][j] = growth * inverse;
            found[1][j] = size * size * inverse;
            found[2][j] = (qq - zz) * whole;
            found[3][j] = 2.0 * zq * whole;
        }
        found
    }

    /// dp, and dp times cos δ and sin δ.
    #[inline(always)]
    fn parts(impulse: Nodal, cosine: &Nodal, sine: &Nodal) -> [Nodal; 3] {
        // A closure over arrays would be compiled for the least SIMD level.
        let along = each(|j| impulse[j] * cosine[j]);
        let across = each(|j| impulse[j] * sine[j]);
        [impulse, along, across]
    }

    /// Sums of these with weights.
    #[inline(always)]
    fn sums(weights: &Nodal, [impulse, along, across]: &[Nodal; 3]) -> [f64; 3] {
        [
            dot(weights, impulse),
            dot(weights, along),
            dot(weights, across),
        ]
    }

    /// dv_n from these.
    #[inline(always)]
    fn rise(&self, axes: &PrincipalFrame, [impulse, along, across]: &[Nodal; 3]) -> Nodal {
        let nn = axes.nn / axes.rate;
        let [a, b] = self.drive.map(|x| x * axes.friction);
        each(|j| nn * impulse[j] - (a * along[j] + b * across[j]))
    }
}

/// A piece of ln w, from w down, and what an impact integrates over it.
struct Panel {
    w: f64,
    rho: f64,
    length: f64,
    /// d ln ρ over the panel's length; dp, and dp times cos δ and sin δ; dv_n. The last four are in units of the inverse of the rate.
    growth: Nodal,
    parts: [Nodal; 3],
    rise: Nodal,
    /// v_n at the nodes less that at the beginning of the panel.
    risen: Nodal,
    /// The impact is at this part of the panel, and the weights of an integral from its beginning to there.
    at: f64,
    past: Nodal,
}

impl Panel {
    /// A panel of this length or shorter, in which ln ρ is good to rounding.
    #[inline(always)]
    fn new(axes: &PrincipalFrame, sector: &Sector, w: f64, rho: f64, mut length: f64) -> Self {
        let mut before = f64::INFINITY;
        loop {
            let panel = Self::of_length(axes, sector, w, rho, length);
            let change = dot(&QUADRATURE.weights, &panel.growth).abs().max(1.0);
            let last = QUADRATURE.last(&panel.growth);
            // Also if it is not a number.
            let is_rough = last > 1.5 * RESOLVED * change;
            // What is of rounding falls with the length, and what is not with its 24th power.
            let is_rounding = last > 0.1 * before;
            if change > 1.5 * STEEPEST {
                length *= STEEPEST / change;
            } else if is_rough && !is_rounding && length > 1e-9 {
                before = last;
                length *= 0.6;
            } else {
                return panel;
            }
        }
    }

    #[inline(always)]
    fn of_length(axes: &PrincipalFrame, sector: &Sector, w: f64, rho: f64, length: f64) -> Self {
        let [growth, pace, cosine, sine] =
            sector.functions(&each(|j| w * exp(-length * QUADRATURE.nodes[j])));
        let growth = each(|j| -length * growth[j]);
        let change = rows(&QUADRATURE.integral, &growth);
        let size = -length * rho;
        let impulse = each(|j| size * exp(change[j]) * pace[j]);
        let parts = Sector::parts(impulse, &cosine, &sine);
        let rise = sector.rise(axes, &parts);
        Self {
            w,
            rho,
            length,
            growth,
            risen: rows(&QUADRATURE.integral, &rise),
            rise,
            parts,
            at: 0.0,
            past: [0.0; NODES],
        }
    }

    /// w and ρ where the impact is.
    #[inline(always)]
    fn state(&self) -> [f64; 2] {
        let growth = dot(&self.past, &self.growth);
        [self.w * exp(-self.length * self.at), self.rho * exp(growth)]
    }

    /// v_n dp, if v_n has this value where the impact is.
    #[inline(always)]
    fn work(&self, speed: f64) -> Nodal {
        let start = speed - dot(&self.past, &self.rise);
        each(|j| (start + self.risen[j]) * self.parts[0][j])
    }

    /// The part of the panel, up to `end`, at which an integral from where the impact is, of `density`, has this value; `whole` is that from
    /// the panel's beginning to the nodes.
    #[inline(always)]
    fn located(&self, density: &Nodal, whole: &Nodal, gain: f64, end: f64) -> f64 {
        let value = gain + dot(&self.past, density);
        QUADRATURE.located(density, whole, value, (self.at, end))
    }
}

/// An impact under way.
struct OngoingImpact<'a> {
    axes: &'a PrincipalFrame,
    slip: [f64; 2],
    now: ImpactSoFar,
    /// The present phase is over before the slip comes to rest.
    rest_is_beyond: bool,
}

impl WithSimd for &mut OngoingImpact<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        if self.now.approach == 0.0 {
            let rho = norm(self.slip);
            let pull = self.axes.pull(self.slip.map(|x| x / rho));
            if self.axes.stiffness(pull) >= 0.0 {
                return; // it touches, and is not pressed together
            }
        }
        for _ in 0..MOST_PIECES {
            let over = match self.straight_way() {
                Some(over) => over,
                None => self.turn(),
            };
            if over {
                return;
            }
        }
        self.now.normal = f64::NAN;
    }
}

impl OngoingImpact<'_> {
    /// An impulse along the plane that does not count is below this, times the rate.
    #[inline(always)]
    fn negligible(&self) -> f64 {
        let axes = self.axes;
        // No impact has less impulse than this.
        let least = self.now.approach / (axes.nn + axes.friction * norm(axes.coupling));
        TINY * self.now.normal.max(least) * axes.rate
    }

    /// The next piece, if the slip is at rest or along a ray; whether the impact is over.
    fn straight_way(&mut self) -> Option<bool> {
        let axes = self.axes;
        let rho = norm(self.slip);
        let tiny = self.negligible();
        let push = axes.friction * rho;
        if push <= tiny * axes.brake[1] {
            self.slip = [0.0; 2];
            return Some(self.straight(axes.hold(), f64::INFINITY));
        }
        let mut d = self.slip.map(|x| x / rho);
        let rates = axes.rates(d);
        let slope = rates.turn_slope;
        if slope < 0.0 {
            let off = (rates.turn / slope).abs();
            if off > ALONG && push * off > tiny * rates.across {
                return None;
            }
            d = axes.onto_ray(d);
        } else if push * rates.turn.abs() > -tiny * rates.growth * rates.across {
            return None;
        }
        Some(self.along(d, rho))
    }

    /// A piece along a ray.
    fn along(&mut self, ray: [f64; 2], rho: f64) -> bool {
        let growth = self.axes.rates(ray).growth;
        let most = if growth < 0.0 {
            rho / (-growth * self.axes.rate)
        } else {
            f64::INFINITY
        };
        self.straight(self.axes.pull(ray), most)
    }

    /// A piece with the same friction per impulse all the way, at most until the slip stops after the impulse `most`.
    fn straight(&mut self, pull: [f64; 2], most: f64) -> bool {
        let axes = self.axes;
        let mut stiffness = axes.stiffness(pull);
        if most == f64::INFINITY {
            // What sticks, or slips faster, does not jam, but for rounding.
            stiffness = stiffness.max(f64::EPSILON * axes.nn);
        }
        let speed = self.now.speed;
        let length = self.now.left(stiffness)[0].max(0.0);
        let back = if !self.now.compressing && stiffness < 0.0 {
            -speed / stiffness
        } else {
            f64::INFINITY
        };
        let event = length.min(back);
        let p = event.min(most);
        self.now.add(&Gain {
            normal: p,
            friction: pull.map(|x| x * p),
            speed: stiffness * p,
            work: p * (speed + 0.5 * stiffness * p),
        });
        if most < event {
            self.slip = [0.0; 2];
            return false;
        }
        for (i, pull) in pull.into_iter().enumerate() {
            self.slip[i] += (axes.coupling[i] + axes.tangential[i] * pull) * p;
        }
        self.over(if length <= back {
            ImpactSoFar::reached
        } else {
            ImpactSoFar::pressed_again
        })
    }

    /// A phase is over; whether the impact is.
    fn over(&mut self, change: fn(&mut ImpactSoFar) -> bool) -> bool {
        self.rest_is_beyond = false;
        change(&mut self.now)
    }

    /// The slip as it turns, until the impact is over or the slip is at rest or along a ray.
    #[inline(always)]
    fn turn(&mut self) -> bool {
        let axes = self.axes;
        let mut rho = norm(self.slip);
        let (sector, mut w) = Sector::of(axes, self.slip.map(|x| x / rho));
        let across = axes.rates(sector.ray).across;
        let mut most = f64::INFINITY;
        for _ in 0..MOST_PIECES {
            let tiny = self.negligible();
            let (push, off) = (axes.friction * rho, 2.0 * w);
            if push <= tiny * axes.brake[1] || off <= ALONG || push * off <= tiny * across {
                self.slip = sector.ray.map(|x| x * rho);
                return self.along(sector.ray, rho);
            }
            let [growth, phase, whole] = self.outlook(&sector, [w, rho]);
            if self.rests(&sector, [w, rho], growth, phase) {
                self.slip = [0.0; 2];
                return false;
            }
            let length = self.length(&sector, w, growth, whole).min(most);
            let mut panel = Panel::new(axes, &sector, w, rho, length);
            most = f64::INFINITY;
            while panel.at < 0.999 {
                let gain = self.gain(&sector, &panel, &QUADRATURE.weights);
                if !self.now.passes(&gain) {
                    self.now.add(&gain);
                    (panel.at, panel.past) = (1.0, QUADRATURE.weights);
                } else if !self.is_resolved(&sector, &panel, &gain) {
                    self.rest_is_beyond = true;
                    most = 0.5 * length;
                    break;
                } else if self.event(&sector, &mut panel, gain.speed) {
                    return true;
                }
            }
            [w, rho] = panel.state();
        }
        self.now.normal = f64::NAN;
        true
    }

    /// d ln ρ/dθ, and θ until the present phase and until the impact is over if ρ and dv_n/dp stayed what they are.
    #[inline(always)]
    fn outlook(&self, sector: &Sector, [w, rho]: [f64; 2]) -> [f64; 3] {
        let axes = self.axes;
        let d = sector.direction(w);
        let ways = self.now.left(axes.stiffness(axes.pull(d)));
        let [phase, whole] = ways.map(|p| p.min(1e100) * axes.rate / rho);
        [axes.rates(d).growth, phase, whole]
    }

    /// The length of the next panel: as long as the functions are resolved, but not much longer than until the impact is over.
    #[inline(always)]
    fn length(&self, sector: &Sector, w: f64, growth: f64, left: f64) -> f64 {
        let pace = sector.pace(w);
        let clear = sector.reach(w).min(sector.monotone(self.axes, w));
        let steep = (growth / pace).abs();
        // p = ρ₀(e^{rθ} − 1)/r
        let needed = AMPLE * left;
        let size = 1.0 + growth * needed;
        if size > 0.0 {
            let theta = if (growth * needed).abs() < 1e-3 {
                needed
            } else {
                ln(size) / growth
            };
            (theta * pace).min(STEEP / steep).min(clear)
        } else if self.rest_is_beyond || self.now.hypothesis == Hypothesis::Stronge {
            (STEEP / steep).min(clear)
        } else {
            (STEEPEST / steep).min(clear)
        }
    }

    /// Goes on to where the slip comes to rest, if one piece leads there, v_n is monotone until then, and nothing else happens before.
    #[inline(always)]
    fn rests(&mut self, sector: &Sector, [w, rho]: [f64; 2], growth: f64, left: f64) -> bool {
        let power = sector.power;
        let growth = growth.max(sector.growth[0]);
        if self.rest_is_beyond
            || !(0.0 < power && power < MOST_POWER)
            || -growth * left < 0.8
            || !sector.is_clear(w)
            || sector.monotone(self.axes, w) < f64::INFINITY
        {
            return false;
        }
        self.rest(sector, w, rho).is_some_and(|gain| {
            self.rest_is_beyond = self.now.passes(&gain);
            if !self.rest_is_beyond {
                self.now.add(&gain);
            }
            !self.rest_is_beyond
        })
    }

    /// The gain until the slip is at rest. None if the polynomials are not good to rounding.
    #[inline(always)]
    fn rest(&self, sector: &Sector, w: f64, rho: f64) -> Option<Gain> {
        let power = sector.power;
        let [growth, pace, cosine, sine] = sector.functions(&each(|j| w * QUADRATURE.nodes[j]));
        let change = each(|j| (power - growth[j]) / QUADRATURE.nodes[j]);
        // ln G is the integral from t to 1.
        let whole = dot(&QUADRATURE.weights, &change);
        let past = rows(&QUADRATURE.integral, &change);
        let impulse = each(|j| -rho * exp(whole - past[j]) * pace[j]);
        let parts = Sector::parts(impulse, &cosine, &sine);
        let weights = rows(&QUADRATURE.legendre, &moments(power));
        let sums = Sector::sums(&weights, &parts);
        let is_rough = QUADRATURE.last(&change) > 1.5 * RESOLVED * whole.abs().max(1.0)
            || QUADRATURE.last(&impulse) > RESOLVED * sums[0];
        if is_rough {
            return None;
        }
        let mut gain = self.gain_from(sector, sums);
        if self.now.hypothesis == Hypothesis::Stronge {
            // What is left of the rise at a node is t^a V.
            let rise = sector.rise(self.axes, &parts);
            let left = QUADRATURE.divided(&rise, power);
            let left = each(|j| left[j] * impulse[j] / QUADRATURE.weights[j]);
            let weights = rows(&QUADRATURE.legendre, &moments(2.0 * power));
            let lost = dot(&weights, &left) / self.axes.rate;
            gain.work = (self.now.speed + gain.speed) * gain.normal - lost;
        }
        Some(gain)
    }

    /// Returns whether an event can be located in a panel to rounding: where much of it is left until then, and the functions are good to
    /// rounding, which but for rounding errors they are in a short panel.
    #[inline(always)]
    fn is_resolved(&self, sector: &Sector, panel: &Panel, gain: &Gain) -> bool {
        if panel.at > 0.0 && self.now.is_almost_over(gain) {
            return false;
        }
        let density = self.given(panel);
        let size = dot(&QUADRATURE.weights, &density.map(f64::abs));
        QUADRATURE.last(&density) <= RESOLVED * size
            || panel.length < 0.5 * sector.reach(panel.w)
                && dot(&QUADRATURE.weights, &panel.growth).abs() < 1.0
    }

    /// The work or, by the other hypotheses, the impulse that the restitution has to give, over a panel.
    #[inline(always)]
    fn given(&self, panel: &Panel) -> Nodal {
        match self.now.hypothesis {
            Hypothesis::Stronge => panel.work(self.now.speed),
            _ => panel.parts[0],
        }
    }

    /// The gain from where the impact is in a panel to the place with these weights.
    #[inline(always)]
    fn gain(&self, sector: &Sector, panel: &Panel, weights: &Nodal) -> Gain {
        let rest = each(|j| weights[j] - panel.past[j]);
        let sums = Sector::sums(&rest, &panel.parts);
        let mut gain = self.gain_from(sector, sums);
        if self.now.hypothesis == Hypothesis::Stronge {
            gain.work = dot(&rest, &panel.work(self.now.speed)) / self.axes.rate;
        }
        gain
    }

    /// The gain, apart from work, from the integrals of dp and of dp times cos δ and sin δ.
    fn gain_from(&self, sector: &Sector, [impulse, along, across]: [f64; 3]) -> Gain {
        let axes = self.axes;
        let normal = impulse / axes.rate;
        let [a, b] = sector.drive;
        let pull = -axes.friction / axes.rate;
        Gain {
            normal,
            friction: rotate_back(sector.ray, [pull * along, pull * sector.side * across]),
            speed: axes.nn * normal - axes.friction * (a * along + b * across),
            work: 0.0,
        }
    }

    /// Goes on in a panel to where the phase is over or a new compression begins; whether the impact is over.
    #[inline(always)]
    fn event(&mut self, sector: &Sector, panel: &mut Panel, rise: f64) -> bool {
        let mut end = 1.0;
        if !self.now.compressing && self.now.speed + rise < 0.0 {
            // Where it would be pressed together again, unless it is over by then.
            end = panel.located(&panel.rise, &panel.risen, -self.now.speed, 1.0);
            let weights = QUADRATURE.until(end);
            let mut gain = self.gain(sector, panel, &weights);
            gain.speed = -self.now.speed;
            if !self.now.passes(&gain) {
                self.now.add(&gain);
                (panel.at, panel.past) = (end, weights);
                return self.over(ImpactSoFar::pressed_again);
            }
        }
        let t = if self.now.compressing {
            let gain = self.now.wanted_speed() - self.now.speed;
            panel.located(&panel.rise, &panel.risen, gain, end)
        } else {
            let density = self.given(panel);
            let whole = rows(&QUADRATURE.integral, &density);
            panel.located(&density, &whole, self.now.missing() * self.axes.rate, end)
        };
        let weights = QUADRATURE.until(t);
        let gain = self.gain(sector, panel, &weights);
        self.now.add(&gain);
        (panel.at, panel.past) = (t, weights);
        self.over(ImpactSoFar::reached)
    }
}
