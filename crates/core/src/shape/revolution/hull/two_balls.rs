//! The hull of two spheres on the axis.

use super::Ball;
use super::balls::Balls;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Spheres 1 and 2, whose centres are on the axis. Both touch the plane at once when e_z is `cos_tilt` and the centre of mass is at
/// the level; the gaps are height + s(e_z − `cos_tilt`), (2).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TwoBalls {
    balls: [Ball; 2],
    /// ℓ = (ϱ₁ − ϱ₂)/(s₁ − s₂), in (−1, 1).
    cos_tilt: f64,
    level: f64,
}

impl TwoBalls {
    /// Two spheres, neither of which contains the other, with centres `separation` apart.
    pub(in crate::shape) fn new(balls: [Ball; 2], separation: f64) -> Self {
        let [one, two] = balls;
        let cos_tilt = (one.radius - two.radius) / separation;
        Self {
            balls,
            cos_tilt,
            level: one.offset.mul_add(-cos_tilt, one.radius),
        }
    }
}

/// Spheres of radius 1 at ±`lever`: the [`TwoBalls`] with ℓ = 0, kept apart because half of the arithmetic then drops out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct EqualBalls {
    lever: f64,
}

impl EqualBalls {
    pub(in crate::shape) fn new(half_separation: f64) -> Self {
        Self {
            lever: half_separation,
        }
    }
}

impl Balls for EqualBalls {
    const TWO: bool = true;

    #[inline(always)]
    fn levers(&self) -> [f64; 2] {
        [self.lever, -self.lever]
    }

    #[inline(always)]
    fn lean<S: Simd, const K: usize>(&self, cos_tilt: Pack<S, K>) -> Pack<S, K> {
        cos_tilt
    }

    fn level(&self) -> f64 {
        1.0
    }

    #[inline(always)]
    fn ceiling<S: Simd, const K: usize>(&self, max_cos_tilt: Pack<S, K>) -> Pack<S, K> {
        self.lever * max_cos_tilt
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

impl Balls for TwoBalls {
    const TWO: bool = true;

    #[inline(always)]
    fn levers(&self) -> [f64; 2] {
        [self.balls[0].offset, self.balls[1].offset]
    }

    #[inline(always)]
    fn lean<S: Simd, const K: usize>(&self, cos_tilt: Pack<S, K>) -> Pack<S, K> {
        cos_tilt - self.cos_tilt
    }

    fn level(&self) -> f64 {
        self.level
    }

    #[inline(always)]
    fn ceiling<S: Simd, const K: usize>(&self, max_cos_tilt: Pack<S, K>) -> Pack<S, K> {
        let [one, two] = self.levers();
        let first = max_cos_tilt.mul_add(one.abs(), one * self.cos_tilt);
        first.max(max_cos_tilt.mul_add(two.abs(), two * self.cos_tilt))
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
