//! Coulomb friction where the slip turns: the contact slips across the plane of the axis, too. All lanes at once.
//!
//! With the slip **s** = (u, w), u taken along it, let A = (|**s**| + u)/2 and B = (|**s**| − u)/2, so that w² = 4AB, and
//! y = B/A = tan²(φ/2) with φ the direction of the slip. In θ with dp = |**s**|(1 + y) dθ the equation of the slip
//! d**s**/dp = K_nu **u** − μ K_t **s**/|**s**| reads
//!
//! dy/dθ = −2y(ρ₊ + ρ₋y), d ln A/dθ = −λ − κy, ρ± = K_nu ± μ(K_ww − K_uu), λ = μK_uu − K_nu, κ = μK_ww − ρ₋:
//!
//! 1/y is an exponential function of θ, ∫y dθ a logarithm, and A the exponential function of −∫(λ + κy) dθ. What is left are
//! quadratures of functions that are analytic next to the path ([`integrate_panel`]), and where the slip vanishes, a continued fraction
//! ([`VanishingSlip`]). The ends of compression and restitution follow from power series about a point next to
//! them ([`Near`]). Wherever the slip has come to rest the rest of the impact is a straight line in p.

#[cfg(test)]
#[path = "../../../tests/friction/parts.rs"]
mod tests;

use super::{Coulomb, Hypothesis};
use crate::law::{Compliant, Contact, ImpulseRule, MOST_CONTACTS, Response};
use crate::math::Vector;
use crate::simd::elementary::{exp_in_lanes, exp_m1_in_lanes, polynomial};
use crate::simd::{LANES, Lanewise, Mask, Pack};
use pulp::{Simd, WithSimd};
use std::f64::consts::PI;

/// Makes a struct of numbers, truth values and what all lanes share, and what takes some of its lanes from another one.
macro_rules! in_lanes {
    (
        $(#[$about:meta])* struct $name:ident {
            $($(#[$text:meta])* $number:ident,)*
            $(; masks: $($(#[$note:meta])* $mask:ident,)*)?
            $(; shared: $($(#[$said:meta])* $shared:ident: $kind:ty,)*)?
        }
    ) => {
        $(#[$about])*
        #[derive(Clone, Copy)]
        struct $name<S: Simd> {
            $($(#[$text])* pub $number: Pack<S>,)*
            $($($(#[$note])* pub $mask: Mask<S>,)*)?
            $($($(#[$said])* pub $shared: $kind,)*)?
        }

        impl<S: Simd> $name<S> {
            /// Lane by lane one or the other.
            #[inline(always)]
            pub fn choose(lanes: Mask<S>, a: &Self, b: &Self) -> Self {
                Self {
                    $($number: lanes.select(a.$number, b.$number),)*
                    $($($mask: lanes & a.$mask | !lanes & b.$mask,)*)?
                    $($($shared: b.$shared,)*)?
                }
            }
        }
    };
}

// ========================================================================================================
// K, in the frame of the slip, with friction
// ========================================================================================================

in_lanes! {
    /// K in the plane of **n** and the direction **u** along which the slip is positive, times μ where friction is.
    struct Rates {
        nn,
        nu,
        uu,
        ww,
        /// K_nn − K_nu²/K_uu.
        sticking,
        /// μK_ww.
        brake,
        /// ρ₊, ρ₋, λ, κ.
        plus,
        minus,
        decay,
        kappa,
        ; shared:
        friction: f64,
    }
}

impl<S: Simd> Rates<S> {
    #[inline(always)]
    pub fn new([nn, nu, uu, ww]: [Pack<S>; 4], friction: f64) -> Self {
        let square = nu * nu;
        let lost = nu.mul_add(nu, -square);
        let determinant = nn.mul_add(uu, -square) - lost;
        let mut rates = Self {
            friction,
            nn,
            nu,
            uu,
            ww,
            sticking: determinant / uu,
            brake: ww * friction,
            plus: nu,
            minus: nu,
            decay: nu,
            kappa: nu,
        };
        rates.turn(nu);
        rates
    }

    /// Takes **u** so that this is K_nu.
    #[inline(always)]
    pub fn turn(&mut self, nu: Pack<S>) {
        let (a, b) = (self.uu * self.friction, self.brake);
        self.nu = nu;
        self.plus = nu + (b - a);
        self.minus = nu - (b - a);
        self.decay = a - nu;
        self.kappa = b - self.minus;
    }

    /// Sum of the rates at which direction and size of the slip change in θ.
    #[inline(always)]
    pub fn pace(&self, y: Pack<S>) -> Pack<S> {
        let turning = self.minus.abs().mul_add(y, self.plus.abs());
        let growing = self.kappa.abs().mul_add(y, self.decay.abs());
        turning.mul_add(2.0, growing + 1e-30)
    }

    /// Δv_c^n after ∫A dθ, ∫Ay dθ and ∫Ay² dθ.
    #[inline(always)]
    pub fn velocity(&self, [x, y, z]: [Pack<S>; 3]) -> Pack<S> {
        let jam = self.nu * self.friction;
        let twice = 2.0 * self.nn;
        x.mul_add(self.nn - jam, y.mul_add(twice, z * (self.nn + jam)))
    }

    /// dv_c^n/dp times 1 + y.
    #[inline(always)]
    pub fn slope(&self, y: Pack<S>) -> Pack<S> {
        let jam = self.nu * self.friction;
        (self.nn + jam).mul_add(y, self.nn - jam)
    }
}

// ========================================================================================================
// Where an impact has come to, what ends it, and its end once the slip has come to rest
// ========================================================================================================

/// Slip at which it counts as vanished, relative to the contact velocity; the impulse is of the order of that.
const VANISHED: f64 = 1.0 / 18_014_398_509_481_984.0; // 2⁻⁵⁴

in_lanes! {
    /// The state of the impacts in progress.
    struct Course {
        /// Slip u and w ≥ 0, |**s**|, A, y.
        u,
        w,
        slip,
        a,
        y,
        /// ±1: whether **u** is that of the contact.
        mirror,
        /// v_c^n.
        v,
        /// Impulse so far.
        normal,
        along,
        across,
        /// Work of the normal force since the beginning or the last end of a compression.
        work,
        /// Impulse at its last end, and work of the normal force until then.
        compression,
        balance,
        /// The most work that was taken so far, and the work that the restitution is to give back.
        taken,
        due,
        /// Most by which to go on: a longer step was too long.
        limit,
        ; masks:
        /// Before the end of the compression, which in a jam may come more than once.
        compressing,
        over,
    }
}

in_lanes! {
    /// The condition that ends the restitution, and what else does not change.
    struct Goal {
        restitution,
        /// |v_c^n| before the impact.
        approach,
        /// ε_n|v_c^n|, Newton's goal.
        rebound,
        /// The unit of the velocities.
        scale,
        ; masks:
        /// By symmetry such a slip does not turn.
        aside,
        /// On which side **w** is.
        left,
        ; shared:
        hypothesis: Hypothesis,
    }
}

impl<S: Simd> Goal<S> {
    /// The part of the restitution that is still missing: < 0 once it is over.
    #[inline(always)]
    pub fn missing(&self, at: &Course<S>) -> Pack<S> {
        match self.hypothesis {
            Hypothesis::Newton => self.rebound - at.v,
            Hypothesis::Poisson => {
                self.restitution.mul_add(at.compression, at.compression) - at.normal
            }
            Hypothesis::Stronge => at.due - at.work,
        }
    }
}

impl<S: Simd> Course<S> {
    /// |**s**|, A and y from u and w.
    #[inline(always)]
    pub fn direction(&mut self) {
        self.slip = self.u.mul_add(self.u, self.w * self.w).sqrt();
        let sum = self.slip + self.u.abs();
        let tangent = self.w / sum;
        let square = sum.eq(0.0).select(0.0, tangent * tangent);
        let back = self.u.lt(0.0);
        self.a = 0.5 * sum * back.select(square, 1.0);
        self.y = back.select(1.0 / square, square);
        self.w = self.w.le(self.slip * VANISHED).select(0.0, self.w);
    }

    /// Turns **u** round in the lanes of the mask.
    #[inline(always)]
    pub fn turn_round(&mut self, mask: Mask<S>, rates: &mut Rates<S>) {
        self.u = mask.select(-self.u, self.u);
        self.along = mask.select(-self.along, self.along);
        self.mirror = mask.select(-self.mirror, self.mirror);
        rates.turn(mask.select(-rates.nu, rates.nu));
    }

    /// Returns whether it has gone beyond the next event.
    #[inline(always)]
    pub fn is_late(&self, goal: &Goal<S>) -> Mask<S> {
        let zero = Pack::splat(self.v.simd(), 0.0);
        let done = self.v.lt(0.0) | goal.missing(self).le(0.0);
        self.compressing & zero.le(self.v) | !self.compressing & done
    }

    /// Ends the compression, of the lanes in the mask, where v_c^n = 0.
    #[inline(always)]
    pub fn turn_back(&mut self, mask: Mask<S>, goal: &Goal<S>) {
        // The balance begins anew, so that a little restitution is not lost in a large compression.
        let balance = self.balance + self.work;
        let taken = self.taken.max(-balance);
        let e = goal.restitution;
        let due = (e * e).mul_add(taken, -(taken + balance));
        self.balance = mask.select(balance, self.balance);
        self.taken = mask.select(taken, self.taken);
        self.due = mask.select(due, self.due);
        self.work = mask.select(0.0, self.work);
        self.v = mask.select(0.0, self.v);
        self.compression = mask.select(self.normal, self.compression);
        self.compressing = self.compressing & !mask;
    }

    /// The end of the impact, where the slip has come to rest: it sticks, or slips on the way that K_nu drives it.
    #[inline(always)]
    pub fn finish(&mut self, rates: &Rates<S>, goal: &Goal<S>) {
        let friction = (-rates.nu / rates.uu)
            .max(-rates.friction)
            .min(rates.friction);
        let sticks = rates.nu.abs().le(rates.uu * rates.friction);
        let slope = sticks.select(
            rates.sticking,
            rates.nu.abs().mul_add(-rates.friction, rates.nn),
        );
        let inverse = 1.0 / slope;
        let start = self.normal;

        let further = self.compressing.select(-self.v * inverse, 0.0);
        self.work = (0.5 * self.v).mul_add(further, self.work);
        self.normal = self.normal + further;
        self.turn_back(self.compressing, goal);
        let missing = goal.missing(self).max(0.0);
        let (v, rest) = match goal.hypothesis {
            Hypothesis::Newton => (self.v + missing, missing * inverse),
            Hypothesis::Poisson => (slope.mul_add(missing, self.v), missing),
            Hypothesis::Stronge => {
                let twice = 2.0 * missing;
                let v = self.v.mul_add(self.v, twice * slope).sqrt();
                let sum = v + self.v;
                (v, sum.eq(0.0).select(0.0, twice / sum))
            }
        };
        self.v = v;
        self.normal = self.normal + rest;
        self.along = (self.normal - start).mul_add(friction, self.along);
    }
}

// ========================================================================================================
// The direction and size of a slip that turns, in closed form, and how far they are resolved by the nodes of a panel
//
// The direction has fixed points: y* = 0 and y* = −ρ₊/ρ₋, if that is positive. About the nearer one, with D = y − y*, σ = ρ₊ or −ρ₊
// and λ* = λ + κy*,
//
// dD/dθ = −2D(σ + ρ₋D), d ln A/dθ = −λ* − κD,
//
// and with ζ = D₀(1 − exp(−2σθ))/σ: D₀ − D = (σ + ρ₋D₀)ζ/(1 + ρ₋ζ), ∫D dθ = ln(1 + ρ₋ζ)/2ρ₋. About the other one ζ would grow
// exponentially where D vanishes.
//
// A and y are analytic but for the poles of y, where 1 + ρ₋ζ = 0. Gauss's quadrature of n nodes is off by the order of r⁻²ⁿ of the
// functions, where the ellipse whose foci are the ends of the panel and that goes through the nearest pole has the axes (r ± 1/r)/2
// in half lengths of the panel. The distances of the pole from both ends together are then (r + 1/r)/2 times its length.
// ========================================================================================================

/// Least sum of the distances of a pole from the ends of a panel, over its length: r = 2.85, and twenty nodes are off by 10⁻¹⁸.
const ASIDE: f64 = 1.6;
/// Most by which ln A changes on a panel, of it six times what the direction contributes: twenty nodes integrate an exponential
/// function that falls by e⁻²⁸, A², to rounding. Twice as much where the slip is so small that half the digits count.
const DECAY: f64 = 14.0;
const SHARPER: f64 = 6.0;
const FADED: f64 = 1.0 / 524_288.0; // 2⁻¹⁹
/// Most by which ln |D| changes by itself, where D is tiny, small, and where it is not.
const LONG_TURN: f64 = 30.0;
const TURN: f64 = 14.0;
const SHARP_TURN: f64 = 8.0;
/// Up to there |D| is small, and tiny; below the last it does not count beside 1.
const SMALL: f64 = 1.0 / 16.0;
const TINY: f64 = 1.0 / 1_048_576.0; // 2⁻²⁰
const NOTHING: f64 = 1.0 / 18_014_398_509_481_984.0; // 2⁻⁵⁴
/// Most by which y grows on a panel, for beyond 1 it is looked at from the other side.
const GROWN: f64 = 8.0;
/// |σ| below which the direction does not turn by it, |ρ₋D| below which it has no poles, and the least |σ| in quotients.
const STEADY: f64 = 1e-200;
/// Largest ratio of which a logarithm is bounded.
const FAR: f64 = 1e30;

/// Largest |s| in the series of artanh.
const STEEP: f64 = 0.45;
/// artanh(s)/s as a polynomial in s², |s| ≤ 0.45; error 10⁻¹⁷ (`tests/friction/tables.py`).
const ARTANH: [f64; 13] = [
    1.0,
    0.3333333333333263,
    0.20000000000191967,
    0.14285714265083493,
    0.1111111226052913,
    0.0909087109137827,
    0.07693110878969374,
    0.0665535339972996,
    0.05990548274556982,
    0.045616124173821285,
    0.07768094615369141,
    -0.036188137220939005,
    0.15022352089177232,
];

/// The hodograph from a point on.
struct Hodograph<S: Simd> {
    /// y, y* and D.
    y: Pack<S>,
    pub limit: Pack<S>,
    distance: Pack<S>,
    sigma: Pack<S>,
    minus: Pack<S>,
    /// λ + κy* and κ.
    decay: Pack<S>,
    kappa: Pack<S>,
    /// −D/σ and σ + ρ₋D.
    scale: Pack<S>,
    gamma: Pack<S>,
}

/// A point of it.
struct HodographPoint<S: Simd, const N: usize> {
    /// The decrease of y.
    pub lost: Pack<S, N>,
    /// ∫D dθ, and ln A less its first value.
    pub turn: Pack<S, N>,
    pub growth: Pack<S, N>,
}

impl<S: Simd> Hodograph<S> {
    #[inline(always)]
    pub fn new(rates: &Rates<S>, y: Pack<S>) -> Self {
        let (plus, minus) = (rates.plus, rates.minus);
        let bend = minus * y;
        let gamma = minus.mul_add(y, plus);
        let oblique = gamma.abs().lt(bend.abs());
        let limit = oblique.select(-plus / minus, 0.0);
        let distance = oblique.select(gamma / minus, y);
        let sigma = oblique.select(-plus, plus);
        let gone = distance.abs().le(NOTHING) & Pack::splat(y.simd(), 0.0).le(sigma);
        let straight = gone | sigma.abs().le(STEADY);
        let sigma = straight.select(STEADY, sigma);
        let distance = gone.select(0.0, distance);
        Self {
            y,
            limit,
            distance,
            sigma,
            minus,
            decay: rates.kappa.mul_add(limit, rates.decay),
            kappa: rates.kappa,
            scale: -distance / sigma,
            gamma: oblique.select(bend, gamma),
        }
    }

    /// With ζ = D₀(1 − exp(−2σθ))/σ: D₀ − D = (σ + ρ₋D₀)ζ/(1 + ρ₋ζ) and ∫D dθ = ln(1 + ρ₋ζ)/2ρ₋.
    #[inline(always)]
    pub fn at<const N: usize>(&self, theta: Pack<S, N>) -> HodographPoint<S, N> {
        let (sigma, minus) = (self.sigma.repeat(), self.minus.repeat());
        let zeta = exp_m1_in_lanes(-2.0 * sigma * theta) * self.scale.repeat();
        let q = minus * zeta;
        let (m, n) = (q + 1.0, q + 2.0);
        // One division for both; ln(1 + q) = 2 artanh(q/(2 + q)).
        let inverse = zeta / (m * n);
        let half = m * inverse;
        let s = minus * half;
        let turn = half * polynomial(ARTANH, s * s);
        HodographPoint {
            lost: self.gamma.repeat() * n * inverse,
            turn,
            growth: -self
                .decay
                .repeat()
                .mul_add(theta, self.kappa.repeat() * turn),
        }
    }

    /// The distance in θ until ρ₋ζ is too large for the series of artanh, or y has grown too much: infinitely far if it never does.
    #[inline(always)]
    fn steep(&self) -> Pack<S> {
        let bend = self.minus * self.distance;
        let (most, least) = (2.0 * STEEP / (1.0 - STEEP), -2.0 * STEEP / (1.0 + STEEP));
        let steep = bend * bend.lt(0.0).select(1.0 / least, 1.0 / most);
        let grown = self.sigma * self.distance * (-1.0 / GROWN);
        let one = Pack::splat(bend.simd(), 1.0);
        reach(self.sigma, one, one / steep.max(grown))
    }

    /// The distance in θ up to which it may be followed: where 1/y vanishes next to the path the functions have poles.
    #[inline(always)]
    fn resolved(&self) -> Pack<S> {
        // 1 + ρ₋ζ = 0 where exp(−2σθ) = E = 1 + σ/ρ₋D; |ln E| ≥ 16|q − 1|/(q + 1) with q⁸ = |E|.
        let bend = self.minus * self.distance;
        let ratio = self.gamma / bend;
        let q = ratio.abs().min(FAR).sqrt().sqrt().sqrt();
        let sum = (q + 1.0) * (q + 1.0);
        let square = q * q;
        // On the path, ahead of or behind its start, or beside it by π/2|σ|.
        let on = 8.0 / (sum * (square + 1.0) * square.mul_add(square, 1.0));
        let on = -on / bend;
        let beside = (q - 1.0) * (-8.0 / (q + 1.0)) / self.sigma;
        let away = (0.5 * PI) / self.sigma;
        let aside = ratio.lt(0.0);
        let real = aside.select(beside, on);
        let distance = aside.select(beside.mul_add(beside, away * away).sqrt(), on.abs());
        // |θ − θ_p| summed over both ends is ASIDE times the length.
        let length = distance.mul_add(ASIDE, -real) * (2.0 / (ASIDE * ASIDE - 1.0));
        bend.abs().le(STEADY).select(f64::INFINITY, length)
    }

    /// The longest panel on which the functions are resolved.
    #[inline(always)]
    pub fn longest(&self, rates: &Rates<S>, at: &Course<S>) -> Pack<S> {
        let y = self.y;
        let size = self.distance.abs();
        let still = size.eq(0.0);
        let singular = self.resolved().min(self.steep());
        let singular = still.select(f64::INFINITY, singular);
        let turn = size.lt(SMALL).select(2.0 / TURN, 2.0 / SHARP_TURN);
        let turn = size.lt(TINY).select(2.0 / LONG_TURN, turn);
        let turning = still.select(0.0, self.sigma.abs() * turn);
        let braked = rates.brake.mul_add(y.max(1.0), rates.brake);
        let growing = (rates.kappa.abs() * size).mul_add(SHARPER, self.decay.abs());
        let growing = growing * at.slip.le(FADED).select(0.5 / DECAY, 1.0 / DECAY);
        let braked = y.lt(TINY).select(0.0, braked * (1.0 / BRAKE));
        singular.min(1.0 / turning.max(growing).max(braked))
    }
}

/// Least way, in θ, on which ζ becomes so large: infinite if it never does.
#[inline(always)]
fn reach<S: Simd>(sigma: Pack<S>, distance: Pack<S>, zeta: Pack<S>) -> Pack<S> {
    // −ln(1 − t)/2σ with t = σζ/D; −ln(1 − t) ≥ 8(1 − q)/(1 + q) with q⁴ = 1 − t.
    let fourth = 1.0 - sigma * zeta / distance;
    let q = fourth.max(0.0).sqrt().sqrt();
    let least = 4.0 * zeta / ((q + 1.0) * (q + 1.0) * q.mul_add(q, 1.0) * distance);
    Pack::splat(sigma.simd(), 0.0)
        .lt(fourth)
        .select(least, f64::INFINITY)
}

// ========================================================================================================
// A panel: a part of the way of a slip that turns, by quadrature over its nodes
//
// With ∫A dθ, ∫Ay dθ and ∫Ay² dθ everything is known: dp = A(1 + y)² dθ, |**s**|-weighted friction −μA(1 − y²) dθ along
// **u**, dA = −A(λ + κy) dθ and dw = −μK_ww w(1 + y) dθ. With v_c^n as it follows from p and u, the work of the normal force is
//
// ∫v_c^n dp = v p + (K_nn − K_nu²/K_uu) p²/2 + (K_nu/K_uu) ∫(u − u₀) dp.
// ========================================================================================================

/// Most by which ln w changes on a panel.
const BRAKE: f64 = 32.0;

/// Nodes side by side, for the chain of operations at one of them is long.
const WIDE: usize = 10;

/// Sum over the vectors.
#[inline(always)]
fn sum<S: Simd>(terms: &Pack<S, WIDE>) -> Pack<S> {
    let mut sum = terms.part(0);
    for k in 1..WIDE {
        sum = sum + terms.part(k);
    }
    sum
}

/// Goes on by θ = `length`, integrated by quadrature.
#[inline(always)]
fn integrate_panel<S: Simd>(
    (rates, path): (&Rates<S>, &Hodograph<S>),
    goal: &Goal<S>,
    at: &Course<S>,
    length: Pack<S>,
) -> Course<S> {
    let end_turn = path.limit.mul_add(length, path.at(length).turn);
    let start = at.y.repeat::<WIDE>();
    let zero = Pack::<S, WIDE>::splat(at.y.simd(), 0.0);
    let [mut x, mut y, mut z, mut moment] = [zero; 4];
    for chunk in NODES.chunks_exact(WIDE) {
        let (mut theta, mut weight) = (zero, zero);
        for (k, &(node, share)) in chunk.iter().enumerate() {
            theta.set_part(k, &(length * node));
            weight.set_part(k, &Pack::<S>::splat(length.simd(), share));
        }
        let point = path.at(theta);
        let change = exp_m1_in_lanes(point.growth);
        let tangent = start - point.lost;
        let first = change.mul_add(weight, weight);
        let second = first * tangent;
        let third = second * tangent;
        (x, y, z) = (x + first, y + second, z + third);
        if goal.hypothesis == Hypothesis::Stronge {
            let gained = (1.0 - tangent).mul_add(change, point.lost); // of u, over A
            moment = (2.0_f64 * second + (first + third)).mul_add(gained, moment);
        }
    }
    let [x, y, z, moment] = [sum(&x), sum(&y), sum(&z), sum(&moment)];
    let size = at.a * length;
    let moments = [x * size, y * size, z * size];
    let mut end = *at;
    arrive(rates, &mut end, moments, length, end_turn);
    end.v = at.v + rates.velocity(moments);
    let p = moments[0] + moments[2] + 2.0 * moments[1];
    let mean = (0.5 * rates.sticking).mul_add(p, at.v);
    end.work = at.work + mean.mul_add(p, moment * (at.a * size) * rates.nu / rates.uu);
    end
}

/// The slip and the impulse after ∫A dθ, ∫Ay dθ, ∫Ay² dθ, θ and ∫y dθ.
#[inline(always)]
fn arrive<S: Simd>(
    rates: &Rates<S>,
    at: &mut Course<S>,
    [x, y, z]: [Pack<S>; 3],
    theta: Pack<S>,
    turn: Pack<S>,
) {
    let exponent = -rates.decay.mul_add(theta, rates.kappa * turn);
    let braked = (-(rates.brake * (theta + turn))).max(-BRAKE);
    let a = at.a * exp_in_lanes(exponent);
    let lost = at.w * exp_m1_in_lanes(braked); // Δw
    at.w = at.w * exp_in_lanes(braked);
    at.a = a;
    at.u = a - at.w * at.w / (4.0 * a);
    at.normal = at.normal + (x + z + 2.0 * y);
    at.along = at.along - (x - z) * rates.friction;
    at.across = at.across + lost / rates.ww;
}

/// Nodes and weights of the Gauss–Legendre quadrature of 20 nodes on [0, 1] (`tests/friction/tables.py`).
const NODES: [(f64, f64); 20] = [
    (0.0034357004074525377, 0.008807003569576059),
    (0.018014036361043106, 0.02030071490019347),
    (0.04388278587433705, 0.031336024167054534),
    (0.0804415140888906, 0.04163837078835238),
    (0.1268340467699246, 0.05096505990862022),
    (0.1819731596367425, 0.059097265980759206),
    (0.24456649902458646, 0.06584431922458832),
    (0.3131469556422902, 0.07104805465919102),
    (0.38610707442917747, 0.07458649323630187),
    (0.46173673943325133, 0.07637669356536292),
    (0.5382632605667487, 0.07637669356536292),
    (0.6138929255708225, 0.07458649323630187),
    (0.6868530443577098, 0.07104805465919102),
    (0.7554335009754135, 0.06584431922458832),
    (0.8180268403632576, 0.059097265980759206),
    (0.8731659532300754, 0.05096505990862022),
    (0.9195584859111094, 0.04163837078835238),
    (0.956117214125663, 0.031336024167054534),
    (0.9819859636389568, 0.02030071490019347),
    (0.9965642995925474, 0.008807003569576059),
];

// ========================================================================================================
// Power series
//
// Power series in x, one in each lane, and where they take a value.
// ========================================================================================================

/// Terms.
const ORDER: usize = 6;
/// Newton's steps towards a value.
const NEWTON_STEPS: usize = 2;

/// Coefficients of x, x², ...
#[derive(Clone, Copy)]
struct Polynomial<S: Simd>(pub [Pack<S>; ORDER]);

/// The argument at which a series takes a value.
struct Root<S: Simd> {
    pub x: Pack<S>,
    /// The slope there, and Newton's last step.
    pub slope: Pack<S>,
    pub step: Pack<S>,
}

impl<S: Simd> Polynomial<S> {
    #[inline(always)]
    pub fn at(&self, x: Pack<S>) -> Pack<S> {
        let mut sum = self.0[ORDER - 1];
        for k in (0..ORDER - 1).rev() {
            sum = sum.mul_add(x, self.0[k]);
        }
        sum * x
    }

    /// Finds the argument, beyond `from`, at which it is `value`; its slope at `from` is `slope`.
    #[inline(always)]
    pub fn reaches(&self, value: Pack<S>, from: Pack<S>, slope: Pack<S>) -> Root<S> {
        let rest = value - self.at(from);
        let mut x = from + parabola(slope, self.0[1], rest);
        let mut step = x;
        let mut slope = slope;
        for _ in 0..NEWTON_STEPS {
            let mut sum = self.0[ORDER - 1];
            let mut derivative = Pack::splat(x.simd(), 0.0);
            for k in (0..ORDER - 1).rev() {
                derivative = derivative.mul_add(x, sum);
                sum = sum.mul_add(x, self.0[k]);
            }
            slope = derivative.mul_add(x, sum);
            let off = sum.mul_add(x, -value);
            step = off.eq(0.0).select(0.0, off / slope);
            x = x - step;
        }
        Root { x, slope, step }
    }

    /// Size of what is left out at 1.
    #[inline(always)]
    pub fn rest(&self) -> Pack<S> {
        self.0[ORDER - 1].abs() + self.0[ORDER - 2].abs()
    }
}

/// Solves bx + cx² = `value`: the root next to 0, or the positive one where b = 0.
#[inline(always)]
fn parabola<S: Simd>(b: Pack<S>, c: Pack<S>, value: Pack<S>) -> Pack<S> {
    let root = b.mul_add(b, 4.0 * c * value).max(0.0).sqrt();
    let sum = b + b.lt(0.0).select(-root, root);
    sum.eq(0.0).select(0.0, 2.0 * value / sum)
}

/// |x| to the power of the first term left out.
#[inline(always)]
fn power<S: Simd>(x: Pack<S>) -> Pack<S> {
    let cube = x * x * x;
    (cube * cube * x).abs()
}

// ========================================================================================================
// How far to go on: to the next event, as far as one can tell from here, and back where that was too far
// ========================================================================================================

/// Guess of x up to which the series are asked.
const NEAR: f64 = 3.0;
/// Length over which v_c^n may have an extremum between its ends, times R.
const SHORT: f64 = 1.0 / 1_048_576.0; // 2⁻²⁰

/// The distance to the next event in θ if the velocity is linear in p and A(1 + y)² exponential in θ; infinite if there is none.
#[inline(always)]
fn guess<S: Simd>(rates: &Rates<S>, goal: &Goal<S>, at: &Course<S>) -> Pack<S> {
    let whole = 1.0 + at.y;
    let stiff = rates.slope(at.y) / whole;
    let zero = Pack::splat(at.v.simd(), 0.0);
    let missing = goal.missing(at);
    let restitution = match goal.hypothesis {
        Hypothesis::Newton => missing / stiff,
        Hypothesis::Poisson => missing,
        Hypothesis::Stronge => parabola(at.v, 0.5 * stiff, missing),
    };
    // In a jam v_c^n falls to 0, perhaps before that.
    let falls = zero.le(at.v) & stiff.lt(0.0);
    let rest = -at.v / stiff;
    let soon = match goal.hypothesis {
        Hypothesis::Newton => rest,
        _ => rest.min(restitution),
    };
    let p = at.compressing.select(rest, falls.select(soon, restitution));
    let gamma = rates.minus.mul_add(at.y, rates.plus);
    let growth = -(4.0 * at.y * gamma) / whole - rates.kappa.mul_add(at.y, rates.decay);
    let share = p / (at.slip * whole);
    let fourth = growth.mul_add(share, 1.0);
    let q = fourth.max(0.0).sqrt().sqrt();
    // ln(1 + t) = 8(q − 1)/(q + 1), nearly, with q⁴ = 1 + t.
    let theta = 8.0 * share / ((q + 1.0) * (q + 1.0) * q.mul_add(q, 1.0));
    // v_c^n rises, or falls towards an end of the restitution; the slip would not have vanished before.
    let leads = zero.lt(stiff) | !at.compressing;
    (leads & zero.le(p) & zero.lt(fourth)).select(theta, f64::INFINITY)
}

/// The distance in θ over which v_c^n certainly has no extremum, or almost certainly.
#[inline(always)]
fn crest<S: Simd>(rates: &Rates<S>, at: &Course<S>) -> Pack<S> {
    let zero = Pack::splat(at.y.simd(), 0.0);
    let (now, jam) = (rates.slope(at.y), rates.nu * rates.friction);
    // There y = c, and y₀ − y = (ρ₊ + ρ₋y₀)ζ/(1 + ρ₋ζ).
    let c = (jam - rates.nn) / (jam + rates.nn);
    let zeta = now / (rates.nn + jam) / rates.minus.mul_add(c, rates.plus);
    let certain = reach(rates.plus, at.y, zeta).max(SHORT / rates.pace(at.y));
    (zero.lt(at.y) & zero.lt(c) & zero.lt(zeta)).select(certain, f64::INFINITY)
}

/// Goes through the events that are near, and says how far the next one is, in θ: infinitely far if there is none.
#[inline(always)]
fn events<S: Simd>(rates: &Rates<S>, goal: &Goal<S>, at: &mut Course<S>) -> Pack<S> {
    let far = guess(rates, goal, at);
    let crest = crest(rates, at);
    let near = (at.is_late(goal) | (far * rates.pace(at.y)).le(NEAR)) & !at.over;
    if !near.any() {
        return far.min(crest);
    }
    let wanted = Near::new(rates, at).pass(rates, goal, near, crest, at);
    near.select(wanted, far).min(crest)
}

/// The lanes that have gone too far on the way from `at` to `end`: an event is too far behind the end for the series.
#[inline(always)]
fn beyond<S: Simd>(
    rates: &Rates<S>,
    goal: &Goal<S>,
    at: &Course<S>,
    end: &Course<S>,
    length: Pack<S>,
) -> Mask<S> {
    let zero = Pack::splat(at.v.simd(), 0.0);
    let y = end.w * end.w / (4.0 * end.a * end.a);
    let slip = end.a * (1.0 + y);
    let reach = 0.5 / rates.pace(y);
    let is_far = |off: Pack<S>, rate: Pack<S>| zero.lt(off) & !off.le(rate * reach);
    let after = rates.slope(y);
    let sign = at.compressing.select(1.0, zero - 1.0);
    let rests = is_far(sign * end.v, sign * slip * after);
    let rate = match goal.hypothesis {
        Hypothesis::Newton => slip * after,
        Hypothesis::Poisson => slip * (1.0 + y),
        Hypothesis::Stronge => end.v * slip * (1.0 + y),
    };
    let ends = is_far(-goal.missing(end), rate) & !at.compressing;
    zero.lt(length) & (rests | ends)
}

// ========================================================================================================
// Events that are near: the impact as power series about where it has come to
//
// The variable is x = Rθ with R the sum of the rates, so that the series converge for x of the order of 1. Where their last terms do
// not count, an event is found to rounding; else the series say how far to go for it to be near.
// ========================================================================================================

/// Last of them at which it is found, relative to the way: the next one would be its square; and at which it is a guess.
const FOUND: f64 = 1e-8;
const GUESSED: f64 = 0.1;
/// Largest share of the terms left out, of the impact, and of the way to an event that is a guess.
const EXACT: f64 = 1.0 / 9_007_199_254_740_992.0; // 2⁻⁵³
const ROUGH: f64 = 1.0 / 128.0;

/// The series.
struct Near<S: Simd> {
    /// 1/R.
    unit: Pack<S>,
    /// ∫A dθ, ∫Ay dθ, ∫Ay² dθ, ∫y dθ.
    first: Polynomial<S>,
    second: Polynomial<S>,
    third: Polynomial<S>,
    turn: Polynomial<S>,
    /// Impulse along **n**, v_c^n, work of the normal force, as they change.
    impulse: Polynomial<S>,
    velocity: Polynomial<S>,
    work: Polynomial<S>,
}

impl<S: Simd> Near<S> {
    #[inline(always)]
    pub fn new(rates: &Rates<S>, at: &Course<S>) -> Self {
        let zero = Pack::splat(at.y.simd(), 0.0);
        let unit = 1.0 / rates.pace(at.y);
        let (plus, minus) = (-2.0 * rates.plus * unit, -2.0 * rates.minus * unit);
        let (decay, kappa) = (-rates.decay * unit, -rates.kappa * unit);
        let empty = Polynomial([zero; ORDER]);
        let mut near = Self {
            unit,
            first: empty,
            second: empty,
            third: empty,
            turn: empty,
            impulse: empty,
            velocity: empty,
            work: empty,
        };
        // y and A/R, Ay/R; dp/dx and v_c^n.
        let (mut y, mut a, mut b) = ([zero; ORDER], [zero; ORDER], [zero; ORDER]);
        let (mut p, mut v) = ([zero; ORDER], [zero; ORDER]);
        (y[0], a[0], v[0]) = (at.y, at.a * unit, at.v);
        for k in 0..ORDER {
            let (mut square, mut third, mut power) = (zero, zero, zero);
            for i in 0..=k {
                b[k] = y[k - i].mul_add(a[i], b[k]);
            }
            for i in 0..=k {
                square = y[i].mul_add(y[k - i], square);
                third = b[i].mul_add(y[k - i], third);
            }
            p[k] = a[k] + third + 2.0 * b[k];
            for i in 0..=k {
                power = v[i].mul_add(p[k - i], power);
            }
            let change = rates.velocity([a[k], b[k], third]);
            let share = 1.0 / (k + 1) as f64;
            near.first.0[k] = a[k] * share;
            near.second.0[k] = b[k] * share;
            near.third.0[k] = third * share;
            near.turn.0[k] = y[k] * unit * share;
            near.impulse.0[k] = p[k] * share;
            near.velocity.0[k] = change * share;
            near.work.0[k] = power * share;
            if k + 1 < ORDER {
                y[k + 1] = (plus * y[k] + minus * square) * share;
                a[k + 1] = (decay * a[k] + kappa * b[k]) * share;
                v[k + 1] = change * share;
            }
        }
        near
    }

    /// The terms left out, as a velocity.
    #[inline(always)]
    fn error(&self, rates: &Rates<S>, x: Pack<S>) -> Pack<S> {
        let rest = self.impulse.rest().mul_add(rates.nn, self.velocity.rest());
        power(x) * rest
    }

    /// Returns whether an event beyond `from` is found to rounding, of which the velocity `allowed` is left.
    #[inline(always)]
    fn exact(&self, rates: &Rates<S>, root: &Root<S>, from: Pack<S>, allowed: Pack<S>) -> Mask<S> {
        let small = root.step.abs().le((root.x - from).abs() * FOUND);
        small & self.error(rates, root.x).le(allowed)
    }

    /// Returns whether what is `due` is a work that the series from here resolve.
    #[inline(always)]
    fn keeps(&self, x: Pack<S>, from: Pack<S>, due: Pack<S>) -> Mask<S> {
        (self.work.rest() * power(x)).le(due * EXACT) & self.work.at(from).abs().le(16.0 * due)
    }

    /// Returns whether it is found roughly.
    #[inline(always)]
    fn rough(&self, rates: &Rates<S>, root: &Root<S>, from: Pack<S>) -> Mask<S> {
        let small = root.step.abs().le((root.x - from).abs() * GUESSED);
        let pace = self.impulse.0[0].mul_add(rates.nn, self.velocity.0[0].abs());
        let way = pace * root.x.abs();
        small & self.error(rates, root.x).le(way * ROUGH)
    }

    /// Goes through the events that are near, and says how far the next one is, in θ: infinitely far if nobody knows.
    #[inline(always)]
    pub fn pass(
        &self,
        rates: &Rates<S>,
        goal: &Goal<S>,
        near: Mask<S>,
        crest: Pack<S>,
        at: &mut Course<S>,
    ) -> Pack<S> {
        let zero = Pack::splat(at.v.simd(), 0.0);
        let allowed = rates.nn.mul_add(at.normal, goal.approach) * EXACT;
        let crest = crest / self.unit;
        let rest = self.velocity.reaches(-at.v, zero, self.velocity.0[0]);
        let met = (rest.x * at.v).le(0.0) & rest.x.le(crest);
        let rests = near & at.compressing & zero.lt(rest.slope) & met;
        let ends = rests & self.exact(rates, &rest, zero, allowed);
        let from = ends.select(rest.x, 0.0);
        let mut now = *at;
        now.normal = at.normal + self.impulse.at(from);
        now.work = at.work + self.work.at(from);
        now.turn_back(ends, goal);

        let restoring = near & !now.compressing;
        let (path, value) = match goal.hypothesis {
            Hypothesis::Newton => (&self.velocity, goal.rebound - at.v),
            Hypothesis::Poisson => (
                &self.impulse,
                goal.restitution.mul_add(now.compression, now.compression) - at.normal,
            ),
            Hypothesis::Stronge => (&self.work, now.due - now.work + self.work.at(from)),
        };
        let slope = match goal.hypothesis {
            Hypothesis::Stronge => ends.select(0.0, path.0[0]),
            _ => path.0[0],
        };
        let last = path.reaches(value, from, slope.max(0.0));
        let ahead = zero.le((last.x - from) * (value - path.at(from)));
        let goes = restoring & zero.lt(last.slope) & last.x.le(crest) & ahead;
        let mut over = goes & self.exact(rates, &last, from, allowed);
        let mut end = last.x;
        if goal.hypothesis == Hypothesis::Stronge {
            let none = ends & (now.due - now.work).le(0.0); // is given back
            over = over & self.keeps(last.x, from, now.due) | none;
            end = none.select(from, end);
        }
        // In a jam the restitution may turn into another compression first.
        let falls = restoring & !ends & rest.slope.lt(0.0) & zero.le(rest.x * at.v);
        let falls = falls & rest.x.le(crest) & !(goes & last.x.lt(rest.x));
        let fallen = falls & self.exact(rates, &rest, zero, allowed);
        over = over & !falls;

        let to = over.select(end, fallen.select(rest.x, from));
        let theta = to * self.unit;
        let moments = [self.first.at(to), self.second.at(to), self.third.at(to)];
        now.normal = at.normal;
        arrive(rates, &mut now, moments, theta, self.turn.at(to));
        now.v = (ends & !over | fallen).select(0.0, at.v + self.velocity.at(to));
        now.work = (ends & !over).select(now.work, at.work + self.work.at(to));
        now.compressing = now.compressing | fallen;
        now.over = now.over | over;
        let moved = over | ends | fallen;
        *at = Course::choose(moved, &now, at);

        let rests = rests & !ends & self.rough(rates, &rest, zero);
        let falls = falls & !fallen & self.rough(rates, &rest, zero);
        let goes = goes & !over & !falls & self.rough(rates, &last, from);
        let x = (rests | falls).select(rest.x, last.x - from);
        let known = rests | falls | goes;
        known.select(x * self.unit, guess(rates, goal, at))
    }
}

// ========================================================================================================
// Where the slip vanishes: the impulse until then as a continued fraction
//
// With **u** taken the right way the direction tends to a fixed one, y → y*: to y* = 0 where ρ₊ ≥ 0, else to y* = −ρ₊/ρ₋. With D and λ* as
// for the hodograph, whose equations hold with σ = |ρ₊|, the integrals ∫A Dʲ dθ over the rest of the way are hypergeometric functions of −ρ₋D/σ; ∫A dθ, for one, is
// (A/λ*) ₂F₁(κ/2ρ₋, 1; λ*/2σ + 1; −ρ₋D/σ). C. F. Gauss's continued fraction of it, multiplied by its denominators so that none
// can vanish, consists of
//
// G_k = λ* + 2σk, N_k = G_k N_{k+1} + n_{k+1} N_{k+2}, n_{2m} = 2mD(λ*ρ₋ − κσ + 2mσρ₋), n_{2m+1} = D(κ + 2mρ₋)(λ* + 2mσ).
//
// With M = N₁ + κDN₂ and by d(ADʲ)/dθ, which relates these integrals to one another,
//
// ∫A dθ = A N₁/(λ*M), ∫AD dθ = A D N₂/M, ∫AD² dθ = A D²G₁(N₃ + κDN₄)/M,
// ∫AD³ dθ = A D³G₁G₂(N₄ + D(κ + 2ρ₋)(N₅ + κDN₆))/M.
//
// The impulse is ∫A(1 + y)² dθ. With A², 2λ* and 2κ for A, λ* and κ they give ∫u dp, and with it the work.
// ========================================================================================================

/// Pairs of levels of the fraction.
const PAIRS: usize = 12;
/// Most that the impulse may change, as a share of it, if the fraction is cut off instead of closed: it is then five to fifty times as
/// far off.
const SETTLED: f64 = 1.0 / 281_474_976_710_656.0; // 2⁻⁴⁸
/// Share by which a direction may turn until the slip vanishes and yet count as constant.
const STRAIGHT: f64 = 2.0 * f64::EPSILON;

/// The way of a slip that vanishes.
struct VanishingSlip<S: Simd> {
    /// True if the slip vanishes, unless the impact is over before.
    pub reached: Mask<S>,
    /// True if **u** is taken the other way.
    back: Mask<S>,
    /// A, y*, D.
    a: Pack<S>,
    limit: Pack<S>,
    distance: Pack<S>,
    /// 1/G₁, and times that ρ₋, σ, λ*, κ.
    unit: Pack<S>,
    minus: Pack<S>,
    sigma: Pack<S>,
    decay: Pack<S>,
    kappa: Pack<S>,
}

impl<S: Simd> VanishingSlip<S> {
    #[inline(always)]
    pub fn new(rates: &Rates<S>, at: &Course<S>) -> Self {
        let y = at.y;
        let zero = Pack::splat(y.simd(), 0.0);
        let gamma = rates.minus.mul_add(y, rates.plus);
        // A direction that is left must be the right one from the start.
        let weight = zero.lt(gamma).select(y, 1.0);
        let straight = (gamma.abs() * weight).le(rates.kappa.mul_add(y, rates.decay) * STRAIGHT);
        let aside = rates.plus.lt(0.0) & zero.le(rates.nu);
        let forward = zero.le(rates.plus) & zero.lt(gamma);
        let back = !(straight | aside | forward);
        let plus = back.select(-rates.minus, rates.plus);
        let minus = back.select(-rates.plus, rates.minus);
        let kappa = rates.brake - minus;
        let decay = back.select(rates.nu.mul_add(2.0, rates.decay), rates.decay);
        let y = back.select(1.0 / y, y);
        let limit = plus.lt(0.0).select(-plus / minus, 0.0);
        let limit = straight.select(y, limit);
        let sigma = plus.abs();
        let decay = kappa.mul_add(limit, decay);
        let unit = 1.0 / sigma.mul_add(2.0, decay);
        Self {
            reached: zero.lt(decay),
            back,
            a: back.select(at.a * at.y, at.a),
            limit,
            distance: y - limit,
            unit,
            minus: minus * unit,
            sigma: sigma * unit,
            decay: decay * unit,
            kappa: kappa * unit,
        }
    }

    /// The fraction for A to the power of `order`, closed as if it went on without change, and cut off: N₁ to N₆ with a common factor.
    #[inline(always)]
    fn levels(&self, order: f64) -> [[Pack<S>; 6]; 2] {
        let (decay, kappa, d) = (self.decay * order, self.kappa * order, self.distance);
        let (twice, bend) = (2.0 * self.sigma, 2.0 * self.minus);
        let mixed = (decay * self.minus - kappa * self.sigma) * d;
        let curl = twice * self.minus * d;
        // G_k, n_{2m}, n_{2m+1}.
        let ground = |k: f64| twice.mul_add(k, decay);
        let even = |m: f64| curl.mul_add(m, mixed) * (2.0 * m);
        let odd = |m: f64| bend.mul_add(m, kappa) * d * ground(m);
        let top = (PAIRS + 1) as f64;
        let (g, n, o) = (ground(2.0 * top - 1.0), even(top), odd(top));
        // t = g + n/(g + o/t).
        let square = g * g;
        let half = square + (n - o);
        let root = half.mul_add(half, 4.0 * square * o).max(0.0).sqrt();
        let one = Pack::splat(g.simd(), 1.0);
        let mut found = [[one; 6]; 2];
        let mut pairs = [(half + root, 2.0 * g), (g, one)];
        for m in (1..=PAIRS).rev() {
            let (n, o) = (even(m as f64), odd(m as f64));
            let (low, high) = (ground((2 * m - 1) as f64), ground((2 * m) as f64));
            for i in 0..2 {
                let second = high.mul_add(pairs[i].0, o * pairs[i].1);
                let first = low.mul_add(second, n * pairs[i].0);
                pairs[i] = (first, second);
                if m <= 3 {
                    found[i][2 * m - 1] = second;
                    found[i][2 * m - 2] = first;
                }
            }
        }
        found
    }

    /// ∫(1 + y)² A dθ from the levels for A, over A/G₁, as a fraction.
    #[inline(always)]
    fn impulse(&self, n: &[Pack<S>; 6]) -> (Pack<S>, Pack<S>) {
        let (d, q) = (self.distance, 1.0 + self.limit);
        let pull = self.kappa * d;
        let whole = pull.mul_add(n[1], n[0]) * self.decay;
        let outer = (2.0 * q).mul_add(n[1], d * pull.mul_add(n[3], n[2]));
        ((q * q).mul_add(n[0], outer * (d * self.decay)), whole)
    }

    /// ∫(1 − y)(1 + y)² A² dθ from the levels for A², over A²/G₁, as a fraction.
    #[inline(always)]
    fn moment(&self, n: &[Pack<S>; 6]) -> (Pack<S>, Pack<S>) {
        let (d, q) = (self.distance, 1.0 + self.limit);
        let (decay, pull) = (2.0 * self.decay, 2.0 * self.kappa * d);
        let whole = pull.mul_add(n[1], n[0]) * decay;
        let first = self.sigma.mul_add(2.0, decay);
        let second = self.sigma.mul_add(4.0, decay);
        let tilt = (2.0 * d).mul_add(self.minus, pull);
        let square = pull.mul_add(n[3], n[2]) * first;
        let cube = pull.mul_add(n[5], n[4]).mul_add(tilt, n[3]) * (first * second);
        // (1 − y)(1 + y)² = (s − D)(q + D)².
        let s = 1.0 - self.limit;
        let inner = (s - 2.0 * q).mul_add(square, -(d * cube));
        let outer = (q * (2.0 * s - q)).mul_add(n[1], d * inner);
        ((s * (q * q)).mul_add(n[0], outer * (d * decay)), whole)
    }

    /// Goes to where the slip vanishes, if nothing happens before: of which lanes that is true.
    #[inline(always)]
    pub fn pass(&self, rates: &Rates<S>, goal: &Goal<S>, at: &mut Course<S>) -> Mask<S> {
        let zero = Pack::splat(at.y.simd(), 0.0);
        if !(self.reached & !at.over).any() {
            return self.reached & zero.lt(zero);
        }
        let scale = self.a * self.unit;
        let [closed, open] = self.levels(1.0);
        let ((impulse, whole), (crude, cut)) = (self.impulse(&closed), self.impulse(&open));
        let off = (impulse * cut - crude * whole).abs() * scale;
        let impulse = scale * impulse / whole;
        let mut settled = off.le((impulse + at.normal) * (whole * cut).abs() * SETTLED);
        let along = -impulse.mul_add(rates.nu, at.u) / rates.uu;
        let v = rates.nn.mul_add(impulse, rates.nu.mul_add(along, at.v));
        if goal.hypothesis == Hypothesis::Stronge {
            let scale = self.a * scale;
            let [closed, open] = self.levels(2.0);
            let ((moment, whole), (crude, cut)) = (self.moment(&closed), self.moment(&open));
            let off = (moment * cut - crude * whole).abs() * scale;
            settled = settled & off.le(at.slip * impulse * (whole * cut).abs() * SETTLED);
            let moment = scale * moment / whole;
            let moment = self.back.select(-moment, moment);
            let mean = (0.5 * rates.sticking).mul_add(impulse, at.v);
            let share = (-at.u).mul_add(impulse, moment) * rates.nu / rates.uu;
            at.work = at.work + mean.mul_add(impulse, share);
        }
        let jam = rates.nu * rates.friction;
        let jam = self.back.select(-jam, jam);
        let now = rates.slope(at.y);
        let then = (rates.nn + jam).mul_add(self.limit, rates.nn - jam);
        let crest = zero.lt(now) & then.lt(0.0);
        at.normal = at.normal + impulse;
        at.along = at.along + along;
        at.across = at.across - at.w / rates.ww;
        at.v = v;
        let compressing = at.compressing & v.lt(0.0);
        let restoring = !at.compressing & zero.le(v) & zero.lt(goal.missing(at));
        self.reached & settled & (compressing | restoring) & !crest
    }
}

// ========================================================================================================
// The whole impact
// ========================================================================================================

/// Panels after which the slip is taken to have vanished.
const MOST_PANELS: f64 = 1000.0;

/// Impacts under way, one in each lane.
#[derive(Clone, Copy)]
struct OngoingImpacts<S: Simd> {
    rates: Rates<S>,
    goal: Goal<S>,
    course: Course<S>,
    /// Panels so far.
    panels: Pack<S>,
}

impl<S: Simd> OngoingImpacts<S> {
    #[inline(always)]
    fn new(contact: &Contact<Pack<S>>, restitution: Pack<S>, rule: &Coulomb) -> Self {
        let simd = restitution.simd();
        let zero = Pack::splat(simd, 0.0);
        let k = &contact.compliance;
        let response = [k.nn(), k.nu(), k.uu(), k.ww];
        let [nn, nu, uu, ww] = response;
        let speed = contact.approach_speed();
        let [along, across, _] = contact.velocity.parts();
        let size = speed + (along.abs() + across.abs());
        let scale = size.eq(0.0).select(1.0, size);
        let unit = 1.0 / scale;

        // Lanes without a particle may hold anything, and no end.
        let finite = (size + (nn + (uu + ww))).lt(f64::INFINITY);
        let strikes = zero.le(speed) & finite & !across.eq(0.0);
        let course = Course {
            u: along * unit,
            w: across.abs() * unit,
            slip: zero,
            a: zero,
            y: zero,
            mirror: zero + 1.0,
            v: -speed * unit,
            normal: zero,
            along: zero,
            across: zero,
            work: zero,
            compressing: Mask::splat(simd, true),
            compression: zero,
            balance: zero,
            taken: zero,
            due: zero,
            over: !strikes,
            limit: zero + f64::INFINITY,
        };
        Self {
            rates: Rates::new(response, rule.friction),
            goal: Goal {
                hypothesis: rule.hypothesis,
                restitution,
                approach: speed * unit,
                rebound: restitution * speed * unit,
                scale,
                aside: along.eq(0.0) & nu.eq(0.0),
                left: across.lt(0.0),
            },
            course,
            panels: zero,
        }
    }

    /// Ends the impacts whose slip vanishes before anything else happens.
    #[inline(always)]
    fn stop(&mut self) {
        let Self {
            rates,
            goal,
            course,
            panels,
        } = self;
        // **u** along the slip, or the way that K_nu drives it.
        let back = course.u.lt(0.0) | course.u.eq(0.0) & rates.nu.lt(0.0);
        course.turn_round(back, rates);
        course.direction();

        // What is left is a straight line in p where the slip has vanished, or goes on along **u** for ever.
        let straight = course.w.le(VANISHED) & rates.decay.le(0.0) & course.y.lt(1.0);
        let straight = straight & !course.is_late(goal);
        let vanished = course.slip.le(VANISHED) | straight | !panels.lt(MOST_PANELS);
        let stop = VanishingSlip::new(rates, course);
        let candidates = (stop.reached | vanished) & !course.over;
        if candidates.any() {
            let mut stopped = *course;
            let stops = stop.pass(rates, goal, &mut stopped) | vanished;
            let last = stops & candidates;
            let mut end = Course::choose(vanished, course, &stopped);
            end.finish(rates, goal);
            end.over = Mask::splat(panels.simd(), true);
            *course = Course::choose(last, &end, course);
        }
    }

    /// Goes through the events that are near, and on by a panel.
    #[inline(always)]
    fn advance(&mut self) {
        let Self {
            rates,
            goal,
            course,
            ..
        } = self;
        let wanted = events(rates, goal, course);
        if course.over.all() {
            return;
        }
        course.direction();
        let path = Hodograph::new(rates, course.y);
        let length = wanted.min(course.limit).min(path.longest(rates, course));
        let mut next = integrate_panel((rates, &path), goal, course, length);
        let back = beyond(rates, goal, course, &next, length);
        next.limit = Pack::splat(length.simd(), f64::INFINITY);
        let mut again = *course;
        again.limit = 0.5 * length;
        let next = Course::choose(back, &again, &next);
        *course = Course::choose(course.over, course, &next);
        self.panels = self.panels + 1.0;
    }

    /// The answers to those that are over.
    #[inline(always)]
    fn answer(&self) -> Response<Pack<S>> {
        let (course, goal) = (&self.course, &self.goal);
        let scale = goal.scale;
        // A plastic contact is not left: rounding must not end its stay.
        let plastic = goal.restitution.eq(0.0);
        Response {
            impulse: Vector {
                x: goal.aside.select(0.0, course.along * course.mirror * scale),
                y: goal.left.select(-course.across, course.across) * scale,
                z: course.normal * scale,
            },
            separation_speed: plastic.select(0.0, course.v.max(0.0)) * scale,
        }
    }

    /// Takes others in the lanes of the mask.
    #[inline(always)]
    fn take(&mut self, mask: Mask<S>, others: &Self) {
        *self = Self {
            rates: Rates::choose(mask, &others.rates, &self.rates),
            goal: Goal::choose(mask, &others.goal, &self.goal),
            course: Course::choose(mask, &others.course, &self.course),
            panels: mask.select(others.panels, self.panels),
        };
    }

    /// Answers the contacts that are over, and frees their lanes.
    #[inline(always)]
    fn end(&self, places: &mut Places, responses: &mut [Response<Pack<S>>]) {
        if !self.course.over.any() {
            return;
        }
        let answer = self.answer();
        self.course.over.each(|lane| {
            if let Some((i, k)) = places[lane].take() {
                responses[i].put(k, &answer.lane(lane));
            }
        });
    }
}

// ========================================================================================================
// All contacts: those that take more than one step wait in a queue for a lane, so that no lane is idle while others are under way
// ========================================================================================================

/// Vector and lane from which the contact in each lane has come; none where there is no contact.
type Places = [Option<(usize, usize)>; LANES];

/// Contacts that may slip in any direction, μ > 0, to be answered in a function of its own: it is long.
pub(in crate::law) struct Turning<'a, S: Simd> {
    pub rule: &'a Coulomb,
    pub contacts: &'a [Contact<Pack<S>>],
    pub restitution: &'a [Pack<S>],
    pub responses: &'a mut [Response<Pack<S>>],
}

impl<S: Simd> WithSimd for Turning<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) {
        // The lanes whose answer is not known yet.
        let mut open = [Mask::splat(self.restitution[0].simd(), false); MOST_CONTACTS];
        let mut waits = false;
        for (i, (contact, &restitution)) in self.contacts.iter().zip(self.restitution).enumerate() {
            let turns = !contact.velocity.y.eq(0.0);
            let mut impacts = OngoingImpacts::new(contact, restitution, self.rule);
            impacts.stop();
            self.responses[i] = impacts.answer();
            if !turns.all() {
                let straight = self.rule.respond::<S, false>(contact, restitution);
                self.responses[i] = self.responses[i].or(!turns, straight);
            }
            open[i] = !impacts.course.over & turns;
            waits |= open[i].any();
        }
        if waits {
            self.finish(&open);
        }
    }
}

impl<S: Simd> Turning<'_, S> {
    /// Finds the responses that are open.
    #[inline(always)]
    fn finish(self, open: &[Mask<S>]) {
        let width = Pack::<S>::WIDTH;
        let mut waiting = (0..self.contacts.len() * width)
            .map(|j| (j / width, j % width))
            .filter(|&(i, k)| open[i].get(k));
        let none = Pack::splat(open[0].simd(), 0.0);
        let nothing = Contact::none(none.simd());
        let mut impacts = OngoingImpacts::new(&nothing, none, self.rule);
        let mut places: Places = [None; LANES];
        loop {
            let (mut contact, mut restitution) = (nothing, none);
            let mut taken = Mask::splat(none.simd(), false);
            for (lane, place) in places[..width].iter_mut().enumerate() {
                if place.is_some() {
                    continue;
                }
                *place = waiting.next();
                let Some((i, k)) = *place else { break };
                contact.put(lane, &self.contacts[i].lane(k));
                restitution.as_mut_slice()[lane] = self.restitution[i].as_slice()[k];
                taken.set(lane, true);
            }
            if taken.any() {
                let new = OngoingImpacts::new(&contact, restitution, self.rule);
                impacts.take(taken, &new);
            }
            if impacts.course.over.all() {
                break;
            }
            impacts.stop();
            impacts.end(&mut places, self.responses);
            if !impacts.course.over.all() {
                impacts.advance();
                impacts.end(&mut places, self.responses);
            }
        }
    }
}
