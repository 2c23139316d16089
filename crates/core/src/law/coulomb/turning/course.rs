//! Where an impact with turning slip has come to, what ends it, and its end once the slip has come to rest.

use super::{Hypothesis, Rates};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Slip at which it counts as vanished, relative to the contact velocity; the impulse is of the order of that.
pub(super) const VANISHED: f64 = 1.0 / 18_014_398_509_481_984.0; // 2⁻⁵⁴

/// Where the impacts have come to.
#[derive(Clone, Copy)]
pub(super) struct Course<S: Simd, const K: usize> {
    /// Slip u and w ≥ 0, |**s**|, A, y.
    pub u: Pack<S, K>,
    pub w: Pack<S, K>,
    pub slip: Pack<S, K>,
    pub a: Pack<S, K>,
    pub y: Pack<S, K>,
    /// ±1: whether **u** is that of the contact.
    pub mirror: Pack<S, K>,
    /// v_c^n.
    pub v: Pack<S, K>,
    /// Impulse so far.
    pub normal: Pack<S, K>,
    pub along: Pack<S, K>,
    pub across: Pack<S, K>,
    /// Work of the normal force since the beginning or the last end of a compression.
    pub work: Pack<S, K>,
    /// Before the end of the compression, which in a jam may come more than once.
    pub compressing: Mask<S, K>,
    /// Impulse at its last end, and work of the normal force until then.
    pub compression: Pack<S, K>,
    pub balance: Pack<S, K>,
    /// The most work that was taken so far, and the work that the restitution is to give back.
    pub taken: Pack<S, K>,
    pub due: Pack<S, K>,
    pub over: Mask<S, K>,
    /// Most by which to go on: a longer step was too long.
    pub limit: Pack<S, K>,
}

/// What ends the restitution.
#[derive(Clone, Copy)]
pub(super) struct Goal<S: Simd, const K: usize> {
    pub hypothesis: Hypothesis,
    pub restitution: Pack<S, K>,
    /// |v_c^n| before the impact.
    pub approach: Pack<S, K>,
    /// ε_n|v_c^n|, Newton's goal.
    pub rebound: Pack<S, K>,
}

impl<S: Simd, const K: usize> Goal<S, K> {
    /// What is missing of the restitution: < 0 once it is over.
    #[inline(always)]
    pub fn missing(&self, at: &Course<S, K>) -> Pack<S, K> {
        match self.hypothesis {
            Hypothesis::Newton => self.rebound - at.v,
            Hypothesis::Poisson => {
                self.restitution.mul_add(at.compression, at.compression) - at.normal
            }
            Hypothesis::Stronge => at.due - at.work,
        }
    }
}

impl<S: Simd, const K: usize> Course<S, K> {
    /// Lane by lane one or the other.
    #[inline(always)]
    pub fn choose(mask: Mask<S, K>, a: &Self, b: &Self) -> Self {
        Self {
            u: mask.select(a.u, b.u),
            w: mask.select(a.w, b.w),
            slip: mask.select(a.slip, b.slip),
            a: mask.select(a.a, b.a),
            y: mask.select(a.y, b.y),
            mirror: mask.select(a.mirror, b.mirror),
            v: mask.select(a.v, b.v),
            normal: mask.select(a.normal, b.normal),
            along: mask.select(a.along, b.along),
            across: mask.select(a.across, b.across),
            work: mask.select(a.work, b.work),
            compressing: mask & a.compressing | !mask & b.compressing,
            compression: mask.select(a.compression, b.compression),
            balance: mask.select(a.balance, b.balance),
            taken: mask.select(a.taken, b.taken),
            due: mask.select(a.due, b.due),
            over: mask & a.over | !mask & b.over,
            limit: mask.select(a.limit, b.limit),
        }
    }

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
    pub fn turn_round(&mut self, mask: Mask<S, K>, rates: &mut Rates<S, K>) {
        self.u = mask.select(-self.u, self.u);
        self.along = mask.select(-self.along, self.along);
        self.mirror = mask.select(-self.mirror, self.mirror);
        rates.turn(mask.select(-rates.nu, rates.nu));
    }

    /// Whether it has gone beyond the next event.
    #[inline(always)]
    pub fn is_late(&self, goal: &Goal<S, K>) -> Mask<S, K> {
        let zero = Pack::splat(self.v.simd(), 0.0);
        let done = self.v.lt(0.0) | goal.missing(self).le(0.0);
        self.compressing & zero.le(self.v) | !self.compressing & done
    }

    /// Ends the compression, of the lanes in the mask, where v_c^n = 0.
    #[inline(always)]
    pub fn turn_back(&mut self, mask: Mask<S, K>, goal: &Goal<S, K>) {
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
    pub fn finish(&mut self, rates: &Rates<S, K>, goal: &Goal<S, K>) {
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
