//! Hulls that consist of one or two spheres on the axis.

use super::{AxisMotion, Ball, Hull, HullPart};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Spheres whose centres are on the axis: `TWO`, or one. Both touch the plane at once when e_z is `cos_tilt` and the centre of mass is at the
/// level; the gaps are height + s(e_z − `cos_tilt`), (2). Two `EQUAL` ones are kept apart because half of the arithmetic then drops out.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Balls<const TWO: bool, const EQUAL: bool> {
    /// Spheres 1 and 2; one alone is in both places.
    balls: [Ball; 2],
    /// ℓ = (ϱ₁ − ϱ₂)/(s₁ − s₂), in (−1, 1); of one sphere +1 if it is recorded as sphere 1, −1 if as sphere 2, and so always the lower one.
    cos_tilt: f64,
    level: f64,
}

/// One sphere, whose centre need not be the centre of mass.
pub type OneBall = Balls<false, false>;
/// Two spheres, neither of which contains the other.
pub type TwoBalls = Balls<true, false>;
/// Two spheres of radius 1 with the centre of mass in the middle.
pub type EqualBalls = Balls<true, true>;

impl OneBall {
    /// The hull `ball`, recorded as sphere 1 if `first`, else as sphere 2.
    pub(in crate::shape) fn new(ball: Ball, first: bool) -> Self {
        Self {
            balls: [ball; 2],
            cos_tilt: if first { 1.0 } else { -1.0 },
            level: ball.radius,
        }
    }
}

impl TwoBalls {
    /// Two spheres with centres `separation` apart.
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

impl EqualBalls {
    /// Spheres at ±`half_separation`.
    pub(in crate::shape) fn new(half_separation: f64) -> Self {
        let ball = |offset| Ball {
            offset,
            radius: 1.0,
        };
        Self {
            balls: [half_separation, -half_separation].map(ball),
            cos_tilt: 0.0,
            level: 1.0,
        }
    }
}

impl<const TWO: bool, const EQUAL: bool> Balls<TWO, EQUAL> {
    /// The balls themselves.
    pub(in crate::shape) fn balls(&self) -> &[Ball] {
        &self.balls[..1 + usize::from(TWO)]
    }

    /// The levers s of spheres 1 and 2.
    #[inline(always)]
    fn levers(&self) -> [f64; 2] {
        let [one, two] = [self.balls[0].offset, self.balls[1].offset];
        [one, if EQUAL { -one } else { two }]
    }

    /// e_z minus its value where both spheres touch: negative where sphere 1 is the lower one.
    #[inline(always)]
    fn lean<S: Simd>(&self, cos_tilt: Pack<S>) -> Pack<S> {
        if TWO && !EQUAL {
            cos_tilt - self.cos_tilt
        } else {
            cos_tilt
        }
    }
}

impl<const TWO: bool, const EQUAL: bool> Hull for Balls<TWO, EQUAL> {
    const TWO: bool = TWO;

    fn level(&self) -> f64 {
        self.level
    }

    fn sharpness(&self) -> f64 {
        1.0
    }

    #[inline(always)]
    fn ceiling<S: Simd>(&self, max_cos_tilt: Pack<S>) -> Pack<S> {
        let [one, two] = self.levers();
        if EQUAL || !TWO {
            return one.abs() * max_cos_tilt;
        }
        let first = max_cos_tilt.mul_add(one.abs(), one * self.cos_tilt);
        first.max(max_cos_tilt.mul_add(two.abs(), two * self.cos_tilt))
    }

    #[inline(always)]
    fn curvature_bound<S: Simd>(&self, amplitude: Pack<S>, _: Pack<S>) -> Pack<S> {
        let [one, two] = self.levers();
        one.abs().max(two.abs()) * amplitude
    }

    #[inline(always)]
    fn part<S: Simd>(&self, one: Mask<S>) -> HullPart<S> {
        let [first, second] = self.levers();
        HullPart {
            one,
            own: one.select(first, second),
        }
    }

    /// The lower bounds of both gaps have the same curvature. They cross only when the axis, turning at its present rate, reaches
    /// the e_z at which both spheres touch: until then the lower sphere's bound is the smaller one, afterwards the other's.
    #[inline(always)]
    fn nearer<S: Simd>(
        &self,
        height: Pack<S>,
        vz: Pack<S>,
        axis_motion: &AxisMotion<S>,
        bound: Pack<S>,
    ) -> HullPart<S> {
        if !TWO {
            return self.part(Mask::splat(height.simd(), true));
        }
        let (lean, rate) = (self.lean(axis_motion.cos_tilt), axis_motion.rate);
        // Both lower bounds at that time, height + v_z t − Mt²/2 with t = −lean/rate, times rate².
        let level = rate.mul_add(
            height.mul_add(rate, -(vz * lean)),
            -(0.5 * bound * (lean * lean)),
        );
        // If both bounds are positive there, the sphere that the rotation moves down is the one whose bound reaches 0 first.
        let swings = Pack::splat(height.simd(), 0.0).le(level);
        self.part(swings.select(rate, lean).lt(0.0))
    }

    #[inline(always)]
    fn gap<S: Simd>(&self, part: &HullPart<S>, cos_tilt: Pack<S>, height: Pack<S>) -> Pack<S> {
        part.own.mul_add(self.lean(cos_tilt), height) // (2)
    }

    #[inline(always)]
    fn touching_height<S: Simd>(&self, part: &HullPart<S>, cos_tilt: Pack<S>) -> Pack<S> {
        -(part.own * self.lean(cos_tilt)) // (2)
    }

    #[inline(always)]
    fn lever<S: Simd>(&self, part: &HullPart<S>, _: Pack<S>) -> Pack<S> {
        part.own
    }

    #[inline(always)]
    fn radius<S: Simd>(&self, part: &HullPart<S>, _: Pack<S>) -> Pack<S> {
        let [one, two] = [self.balls[0].radius, self.balls[1].radius];
        if EQUAL {
            Pack::splat(part.own.simd(), 1.0)
        } else if TWO {
            part.one.select(one, two)
        } else {
            Pack::splat(part.own.simd(), one)
        }
    }

    #[inline(always)]
    fn curvature<S: Simd>(&self, part: &HullPart<S>, axis_motion: &AxisMotion<S>) -> Pack<S> {
        part.own.mul_add(axis_motion.acceleration, -1.0)
    }

    #[inline(always)]
    fn derivatives<S: Simd>(
        &self,
        part: &HullPart<S>,
        axis_motion: &AxisMotion<S>,
    ) -> [Pack<S>; 3] {
        let second = part.own * axis_motion.acceleration;
        let third = -(part.own * axis_motion.square) * axis_motion.rate;
        [second, third, -axis_motion.square * second]
    }

    #[inline(always)]
    fn name<S: Simd>(&self, part: &HullPart<S>, _: Pack<S>) -> Pack<S> {
        if TWO {
            part.one.select(1.0, -1.0_f64)
        } else {
            Pack::splat(part.own.simd(), self.cos_tilt)
        }
    }
}
