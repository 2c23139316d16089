//! A part of the way of a slip that turns, by quadrature over its nodes.
//!
//! With ∫A dθ, ∫Ay dθ and ∫Ay² dθ everything is known: dp = A(1 + y)² dθ, |**s**|-weighted friction −μA(1 − y²) dθ along
//! **u**, dA = −A(λ + κy) dθ and dw = −μK_ww w(1 + y) dθ. With v_c^n as it follows from p and u, the work of the normal force is
//!
//! ∫v_c^n dp = v p + (K_nn − K_nu²/K_uu) p²/2 + (K_nu/K_uu) ∫(u − u₀) dp.

use super::hodograph::Hodograph;
use super::nodes::NODES;
use super::{Course, Goal, Rates};
use crate::law::Hypothesis;
use crate::simd::Pack;
use crate::simd::elementary::{exp_in_lanes, exp_m1_in_lanes};
use pulp::Simd;

/// Most by which ln w changes on a panel.
pub(super) const BRAKE: f64 = 32.0;

/// Nodes side by side, for the chain of operations at one of them is long.
const WIDE: usize = 10;

/// Sum over the vectors.
#[inline(always)]
fn sum<S: Simd>(terms: &Pack<S, WIDE>) -> Pack<S, 1> {
    let mut sum = terms.part(0);
    for k in 1..WIDE {
        sum = sum + terms.part(k);
    }
    sum
}

/// Goes on by θ = `length`.
#[inline(always)]
pub(super) fn pass<S: Simd>(
    (rates, path): (&Rates<S, 1>, &Hodograph<S, 1>),
    goal: &Goal<S, 1>,
    at: &Course<S, 1>,
    length: Pack<S, 1>,
) -> Course<S, 1> {
    let end_turn = path.limit.mul_add(length, path.at(length).turn);
    let path = path.repeat::<WIDE>();
    let start = at.y.repeat::<WIDE>();
    let zero = Pack::<S, WIDE>::splat(at.y.simd(), 0.0);
    let [mut x, mut y, mut z, mut moment] = [zero; 4];
    for chunk in NODES.chunks_exact(WIDE) {
        let (mut theta, mut weight) = (zero, zero);
        for (k, &(node, share)) in chunk.iter().enumerate() {
            theta.set_part(k, &(length * node));
            weight.set_part(k, &Pack::<S, 1>::splat(length.simd(), share));
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
pub(super) fn arrive<S: Simd, const K: usize>(
    rates: &Rates<S, K>,
    at: &mut Course<S, K>,
    [x, y, z]: [Pack<S, K>; 3],
    theta: Pack<S, K>,
    turn: Pack<S, K>,
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
