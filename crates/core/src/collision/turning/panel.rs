//! A part of the way of a slip that turns, by quadrature in ξ ∈ [−1, 1], θ = h(1 + ξ)/2.
//!
//! With ∫A dθ, ∫Ay dθ and ∫Ay² dθ everything is known: dp = A(1 + y)² dθ, |**s**|-weighted friction −μA(1 − y²) dθ along
//! **u**, dA = −A(λ + κy) dθ and dw = −μK_ww w(1 + y) dθ.
//!
//! Nothing happens on most panels but that the slip goes on to vanish. Such a panel may be long, and sums over its nodes are
//! all it takes; only one on which the compression or the impact ends is turned into polynomials ([`Within`]).

use super::nodes::{HALF, NODES};
use super::values::{Values, ratios};
use super::within::Within;
use super::{Course, Goal, Rates};
use crate::collision::Hypothesis;
use crate::simd::elementary::{exp_in_lanes, exp_m1_in_lanes, polynomial};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Most by which ln y changes on a panel by itself: 1/y is singular at ±iπ/2ρ₊, too.
const TURN: f64 = 2.0;
/// Most by which ln A changes where nothing happens, and on a panel that is gone through again because something does. Twenty
/// nodes integrate an exponential function that falls by e⁻²² to rounding; the work of polynomials of their degree is less exact.
const LONG_DECAY: f64 = 18.0;
const DECAY: f64 = 2.5;
/// What is left of A or w at the end of a panel on which most of the slip vanishes, at most.
const SLOWS: f64 = 0.25;
/// Below this y nothing is singular at ±iπ/2ρ₊, and below that it does not count beside 1.
const SMALL: f64 = 1.0 / 1024.0;
const NOTHING: f64 = 1.0 / 18_014_398_509_481_984.0; // 2⁻⁵⁴
/// Length of a panel over the distance of the singularity behind it, and ahead.
const AHEAD_OF: f64 = 0.9;
const SHORT_OF: f64 = 0.45;
/// The same for a panel that is gone through again.
const CAREFUL_AHEAD_OF: f64 = 0.45;
const CAREFUL_SHORT_OF: f64 = 0.25;
const CAREFUL_TURN: f64 = 4.0 / 3.0;

/// sinh(x)/x and (cosh(x) − 1)/x² as polynomials in x², |x| ≤ 2; error 10⁻¹⁹.
const SINE: [f64; 10] = [
    1.0,
    0.166_666_666_666_666_66,
    0.008_333_333_333_333_316,
    0.000_198_412_698_412_752_13,
    2.755_731_922_311_343_6e-6,
    2.505_210_846_679_812_6e-8,
    1.605_903_922_054_479_1e-10,
    7.647_325_717_351_055e-13,
    2.808_027_627_737_413e-15,
    8.621_121_152_219_096e-18,
];
const COSINE: [f64; 10] = [
    0.5,
    0.041_666_666_666_666_664,
    0.001_388_888_888_888_888,
    2.480_158_730_158_973_4e-5,
    2.755_731_922_359_058_3e-7,
    2.087_675_702_473_339_4e-9,
    1.147_074_350_572_072_6e-11,
    4.779_550_754_544_631e-14,
    1.560_365_701_419_263_3e-16,
    4.292_010_522_787_033_5e-19,
];

/// What the impact does on the panel: at its nodes, and in all.
pub(super) struct Panel<S: Simd, const K: usize> {
    /// Length h.
    pub length: Pack<S, K>,
    /// y, and A, Ay, Ay² times h/2.
    y: Values<S, K>,
    first: Values<S, K>,
    second: Values<S, K>,
    third: Values<S, K>,
    /// dv_c^n/dp (1 + y) is stiff + soft y.
    stiff: Pack<S, K>,
    soft: Pack<S, K>,
}

/// The longest panel on which the functions are resolved, and that is not much longer than the impact.
#[inline(always)]
fn length<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    at: &Course<S, K>,
    goal: &Goal<S, K>,
) -> Pack<S, K> {
    let y = at.y;
    let zero = Pack::splat(y.simd(), 0.0);
    let gamma = rates.minus.mul_add(y, rates.plus);
    let ahead = gamma.lt(0.0);
    // 1/y is singular where θ = −ln(1 + t)/2ρ₊, t = −ρ₊/γ; ln(1 + t) ≥ 8(q − 1)/(q + 1) with q⁴ = 1 + t.
    let fourth = rates.minus * y / gamma;
    let real = zero.le(fourth);
    let q = fourth.max(0.0).sqrt().sqrt();
    let near = (q + 1.0) * (q + 1.0) * q.mul_add(q, 1.0) * gamma.abs(); // 4 over the distance
    let share = ahead.select(
        at.careful.select(0.25 / CAREFUL_SHORT_OF, 0.25 / SHORT_OF),
        at.careful.select(0.25 / CAREFUL_AHEAD_OF, 0.25 / AHEAD_OF),
    );
    let singular = (real & !y.le(NOTHING)).select(near * share, 0.0);
    let turn = at.careful.select(
        2.0 / CAREFUL_TURN,
        y.lt(SMALL).select(1.0 / TURN, 2.0 / TURN),
    );
    let turning = y.le(NOTHING).select(0.0, rates.plus.abs() * turn);
    let most = ahead.select((8.0 * y).min(4.0), y); // of y; above 1 the slip is turned round
    let braked = rates.brake.mul_add(most, rates.brake);
    let growing = rates.kappa.abs().mul_add(most, rates.decay.abs());
    let growing = growing.max(at.w.eq(0.0).select(0.0, braked))
        * at.careful.select(1.0 / DECAY, 1.0 / LONG_DECAY);
    let inverse = singular.max(turning).max(growing);

    // What the impact takes, if it went on as it is.
    let slope = rates.slope(y) / (1.0 + y);
    let stiff = slope.max(0.3 * rates.sticking);
    let wanted = 2.0 * (1.0 + goal.restitution) * goal.approach / stiff;
    let pace = at.slip * (1.0 + y);
    let decay = rates.kappa.mul_add(y, rates.decay);
    let needed = pace / wanted + 0.45 * decay.abs();
    // Else it jams, or there is nothing to compress, or the slip vanishes first.
    let rises = zero.lt(slope) & zero.lt(wanted) & (at.careful | (wanted * decay).lt(1.5 * pace));
    1.0 / inverse.max(rises.select(needed, 0.0))
}

impl<S: Simd, const K: usize> Panel<S, K> {
    #[inline(always)]
    pub fn new(rates: &Rates<S, K>, at: &Course<S, K>, goal: &Goal<S, K>) -> Self {
        let zero = Pack::splat(at.y.simd(), 0.0);
        let length = length(rates, at, goal);
        let half = 0.5 * length;

        // 1/y over its first value.
        let straight = at.y.le(NOTHING);
        let y = straight.select(0.0, at.y);
        let plus = straight.select(0.0, rates.plus);
        let gamma = rates.minus.mul_add(y, plus);
        let z = plus * length;
        let squared = z * z;
        let turn = 2.0 * gamma * half;
        let rise = z.mul_add(polynomial(COSINE, squared), polynomial(SINE, squared));
        let middle = turn.mul_add(rise, 1.0);
        let pace = turn * z.mul_add(rise, 1.0);
        let mut g = Values::new(zero);
        for (j, &node) in NODES.iter().enumerate() {
            let square = squared * (node * node);
            let odd = polynomial(SINE, square) * (pace * node);
            let even = (polynomial(COSINE, square) * (pace * z)).mul_add(node * node, middle);
            g.right[j] = even + odd;
            g.left[j] = even - odd;
        }
        let y = ratios(y, &g);
        let angle = y.running(); // ∫y dξ

        let (decay, bend) = (rates.decay * half, rates.kappa * half);
        let size = at.a * half;
        let (mut first, mut second, mut third) = (y, y, y);
        for (j, &node) in NODES.iter().enumerate() {
            let right = -angle.right[j].mul_add(bend, decay * (1.0 + node));
            let left = -angle.left[j].mul_add(bend, decay * (1.0 - node));
            first.right[j] = size * (1.0 + exp_m1_in_lanes(right));
            first.left[j] = size * (1.0 + exp_m1_in_lanes(left));
            second.right[j] = first.right[j] * y.right[j];
            second.left[j] = first.left[j] * y.left[j];
            third.right[j] = second.right[j] * y.right[j];
            third.left[j] = second.left[j] * y.left[j];
        }
        let jam = rates.nu * rates.friction;
        Self {
            length,
            y,
            first,
            second,
            third,
            stiff: rates.nn - jam,
            soft: rates.nn + jam,
        }
    }

    /// v_c^n dp/dξ at the nodes.
    #[inline(always)]
    fn power(&self, rates: &Rates<S, K>, at: &Course<S, K>) -> Values<S, K> {
        let (first, second, third) = (&self.first, &self.second, &self.third);
        let (stiff, soft, twice) = (self.stiff, self.soft, 2.0 * rates.nn);
        let mut change = self.first;
        for j in 0..HALF {
            change.right[j] = first.right[j]
                .mul_add(stiff, second.right[j].mul_add(twice, third.right[j] * soft));
            change.left[j] =
                first.left[j].mul_add(stiff, second.left[j].mul_add(twice, third.left[j] * soft));
        }
        let change = change.running();
        let mut power = change;
        for j in 0..HALF {
            power.right[j] = (change.right[j] + at.v)
                * (2.0_f64 * second.right[j] + (first.right[j] + third.right[j]));
            power.left[j] = (change.left[j] + at.v)
                * (2.0_f64 * second.left[j] + (first.left[j] + third.left[j]));
        }
        power
    }

    /// Work of the normal force on a panel on which most of the slip vanishes: v_c^n as it follows from p and u, whose
    /// differences lose nothing there.
    #[inline(always)]
    fn slowing_work(&self, rates: &Rates<S, K>, at: &Course<S, K>, p: Pack<S, K>) -> Pack<S, K> {
        // ∫u dp, u = A(1 − y), dp = A(1 + y)² dθ.
        let mut moment = self.first;
        for j in 0..HALF {
            let (a, b, c) = (
                self.first.right[j],
                self.second.right[j],
                self.third.right[j],
            );
            moment.right[j] = (a - b) * (2.0_f64 * b + (a + c));
            let (a, b, c) = (self.first.left[j], self.second.left[j], self.third.left[j]);
            moment.left[j] = (a - b) * (2.0_f64 * b + (a + c));
        }
        let moment = moment.whole() * (2.0 / self.length);
        let mean = (0.5 * rates.sticking).mul_add(p, at.v);
        mean.mul_add(p, (-at.u).mul_add(p, moment) * rates.nu / rates.uu)
    }

    #[inline(always)]
    fn within(
        &self,
        hypothesis: Hypothesis,
        rates: &Rates<S, K>,
        at: &Course<S, K>,
    ) -> Within<S, K> {
        let (a, b, c) = (
            self.first.integral(),
            self.second.integral(),
            self.third.integral(),
        );
        let one = Pack::splat(self.length.simd(), 1.0);
        let velocity = a.combined(self.stiff, (&b, 2.0 * rates.nn), (&c, self.soft));
        let impulse = a.combined(one, (&b, 2.0 * one), (&c, one));
        let work = if hypothesis == Hypothesis::Stronge {
            self.power(rates, at).integral()
        } else {
            impulse
        };
        Within {
            first: a,
            second: b,
            third: c,
            angle: self.y.integral(),
            velocity,
            impulse,
            work,
        }
    }

    /// Goes to the end of the panel, or to the end of the impact on it.
    #[inline(always)]
    pub fn pass(&self, rates: &Rates<S, K>, goal: &Goal<S, K>, at: &Course<S, K>) -> Course<S, K> {
        let zero = Pack::splat(at.v.simd(), 0.0);
        let (x, y, z) = (self.first.whole(), self.second.whole(), self.third.whole());
        let mut end = *at;
        let half = 0.5 * self.length;
        let passed = [self.length, half * self.y.whole()];
        self.arrive(rates, &mut end, [x, y, z], passed);
        end.v = at.v + x.mul_add(self.stiff, y.mul_add(2.0 * rates.nn, z * self.soft));
        let slows = end.a.le(at.a * SLOWS) | end.w.le(at.w * SLOWS);
        if goal.hypothesis == Hypothesis::Stronge {
            let mut work = self.slowing_work(rates, at, x + z + 2.0 * y);
            if !(slows | at.over).all() {
                work = slows.select(work, self.power(rates, at).whole());
            }
            end.work = at.work + work;
        }
        let turned = end.w * end.w / (4.0 * end.a * end.a);
        let bends = (rates.slope(at.y) * rates.slope(turned)).le(0.0);
        let rests = at.compressing & zero.le(end.v);
        let back = !at.compressing & (end.v.lt(0.0) | goal.missing(&end).le(0.0));
        let eventful = bends | rests | back;
        if !(eventful & !at.over).any() {
            return end;
        }
        let mut now = self
            .within(goal.hypothesis, rates, at)
            .pass(self, rates, goal, at);
        now.careful = Mask::splat(zero.simd(), false);
        // Polynomials resolve less than the sums do: the way to what happens is gone through again, in shorter panels.
        let found = Course::choose(eventful, &now, &end);
        let mut again = *at;
        again.careful = Mask::splat(zero.simd(), true);
        Course::choose(eventful & !at.careful, &again, &found)
    }

    /// The slip and the impulse after ∫A dθ, ∫Ay dθ, ∫Ay² dθ, θ and ∫y dθ.
    #[inline(always)]
    pub fn arrive(
        &self,
        rates: &Rates<S, K>,
        at: &mut Course<S, K>,
        [x, y, z]: [Pack<S, K>; 3],
        [theta, turn]: [Pack<S, K>; 2],
    ) {
        let exponent = -rates.decay.mul_add(theta, rates.kappa * turn);
        let braked = (-(rates.brake * (theta + turn))).max(-32.0);
        let a = at.a * exp_in_lanes(exponent);
        let lost = at.w * exp_m1_in_lanes(braked); // Δw
        at.w = at.w * exp_in_lanes(braked);
        at.a = a;
        at.u = a - at.w * at.w / (4.0 * a);
        at.normal = at.normal + (x + z + 2.0 * y);
        at.along = at.along - (x - z) * rates.friction;
        at.across = at.across + lost / rates.ww;
    }
}
