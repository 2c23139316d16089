//! The hull of two spheres on the axis.

use super::Ball;
use super::balls::Balls;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Spheres 1 and 2, whose centres are on the axis. Both touch the plane at once when e_z is `tilt` and the height of the centre of
/// mass is `level`. The lift is the height above that level, and the gaps are lift + s(e_z − tilt), (2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pair {
    balls: [Ball; 2],
    /// ℓ = (ϱ₁ − ϱ₂)/(s₁ − s₂), in (−1, 1).
    tilt: f64,
    level: f64,
}

impl Pair {
    /// Two spheres, neither of which contains the other, with centres `separation` apart.
    pub(in crate::shape) fn new(balls: [Ball; 2], separation: f64) -> Self {
        let [one, two] = balls;
        let tilt = (one.radius - two.radius) / separation;
        Self {
            balls,
            tilt,
            level: one.offset.mul_add(-tilt, one.radius),
        }
    }
}

/// Spheres of radius 1 at ±`lever`: the [`Pair`] with ℓ = 0, kept apart because half of the arithmetic then drops out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EqualPair {
    lever: f64,
}

impl EqualPair {
    pub(in crate::shape) fn new(half_separation: f64) -> Self {
        Self {
            lever: half_separation,
        }
    }
}

impl Balls for EqualPair {
    const TWO: bool = true;

    #[inline(always)]
    fn levers(&self) -> [f64; 2] {
        [self.lever, -self.lever]
    }

    #[inline(always)]
    fn lean<S: Simd, const K: usize>(&self, tilt: Pack<S, K>) -> Pack<S, K> {
        tilt
    }

    fn level(&self) -> f64 {
        1.0
    }

    #[inline(always)]
    fn ceiling<S: Simd, const K: usize>(&self, reach: Pack<S, K>) -> Pack<S, K> {
        self.lever * reach
    }

    #[inline(always)]
    fn radius<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K> {
        Pack::splat(one.simd(), 1.0)
    }

    #[inline(always)]
    fn name<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K> {
        one.select(1.0, -1.0_f64)
    }
}

impl Balls for Pair {
    const TWO: bool = true;

    #[inline(always)]
    fn levers(&self) -> [f64; 2] {
        [self.balls[0].offset, self.balls[1].offset]
    }

    #[inline(always)]
    fn lean<S: Simd, const K: usize>(&self, tilt: Pack<S, K>) -> Pack<S, K> {
        tilt - self.tilt
    }

    fn level(&self) -> f64 {
        self.level
    }

    #[inline(always)]
    fn ceiling<S: Simd, const K: usize>(&self, reach: Pack<S, K>) -> Pack<S, K> {
        let [one, two] = self.levers();
        let first = reach.mul_add(one.abs(), one * self.tilt);
        first.max(reach.mul_add(two.abs(), two * self.tilt))
    }

    #[inline(always)]
    fn radius<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K> {
        one.select(self.balls[0].radius, self.balls[1].radius)
    }

    #[inline(always)]
    fn name<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K> {
        one.select(1.0, -1.0_f64)
    }
}
