//! The hull of a sphere whose centre need not be the centre of mass.

use super::Ball;
use super::balls::Balls;
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// One sphere, recorded as sphere 1 or 2 of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct OneBall {
    ball: Ball,
    /// +1 for sphere 1, −1 for sphere 2.
    name: f64,
}

impl OneBall {
    /// The hull `ball`, recorded as sphere 1 if `first`, else as sphere 2.
    pub(in crate::shape) fn new(ball: Ball, first: bool) -> Self {
        Self {
            ball,
            name: if first { 1.0 } else { -1.0 },
        }
    }
}

impl Balls for OneBall {
    const TWO: bool = false;

    #[inline(always)]
    fn levers(&self) -> [f64; 2] {
        [self.ball.offset; 2]
    }

    #[inline(always)]
    fn lean<S: Simd, const K: usize>(&self, cos_tilt: Pack<S, K>) -> Pack<S, K> {
        cos_tilt
    }

    fn level(&self) -> f64 {
        self.ball.radius
    }

    #[inline(always)]
    fn ceiling<S: Simd, const K: usize>(&self, max_cos_tilt: Pack<S, K>) -> Pack<S, K> {
        self.ball.offset.abs() * max_cos_tilt
    }

    #[inline(always)]
    fn radius<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K> {
        Pack::splat(one.simd(), self.ball.radius)
    }

    #[inline(always)]
    fn name<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K> {
        Pack::splat(one.simd(), self.name)
    }
}
