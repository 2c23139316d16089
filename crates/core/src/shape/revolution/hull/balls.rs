//! Hulls that consist of one or two spheres on the axis.

use super::{AxisMotion, Ball, Hull, HullPart};
use crate::simd::{Mask, Pack};
use pulp::{Scalar, Simd};

/// The parameters of a hull of spheres, whose gaps are linear in e_z.
pub(super) trait Balls: Copy {
    /// True if the hull has two spheres.
    const TWO: bool;
    /// The levers s of spheres 1 and 2.
    fn levers(&self) -> [f64; 2];
    /// e_z minus its value where both spheres touch: negative where sphere 1 is the lower one.
    fn lean<S: Simd, const K: usize>(&self, cos_tilt: Pack<S, K>) -> Pack<S, K>;
    /// [`Hull::level`].
    fn level(&self) -> f64;
    /// Height above which no part can touch while |e_z| ≤ `max_cos_tilt`.
    fn ceiling<S: Simd, const K: usize>(&self, max_cos_tilt: Pack<S, K>) -> Pack<S, K>;
    /// The radius of sphere 1 where `one`, else of sphere 2.
    fn radius<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K>;
    /// +1 or −1 for a contact of sphere 1 or 2.
    fn name<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K>;
}

/// The balls themselves.
pub(super) fn balls<B: Balls>(hull: &B) -> Vec<Ball> {
    let ball = |sphere: usize| Ball {
        offset: hull.levers()[sphere],
        radius: hull
            .radius(Mask::<_, 1>::splat(Scalar::new(), sphere == 0))
            .as_slice()[0],
    };
    (0..1 + usize::from(B::TWO)).map(ball).collect()
}

impl<B: Balls> Hull for B {
    const TWO: bool = B::TWO;

    fn level(&self) -> f64 {
        Balls::level(self)
    }

    fn sharpness(&self) -> f64 {
        1.0
    }

    #[inline(always)]
    fn ceiling<S: Simd, const K: usize>(&self, max_cos_tilt: Pack<S, K>) -> Pack<S, K> {
        Balls::ceiling(self, max_cos_tilt)
    }

    #[inline(always)]
    fn curvature_bound<S: Simd, const K: usize>(
        &self,
        amplitude: Pack<S, K>,
        _: Pack<S, K>,
    ) -> Pack<S, K> {
        let [one, two] = self.levers();
        one.abs().max(two.abs()) * amplitude
    }

    #[inline(always)]
    fn part<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> HullPart<S, K> {
        let [first, second] = self.levers();
        HullPart {
            one,
            own: one.select(first, second),
        }
    }

    /// The lower bounds of both gaps have the same curvature. They cross only when the axis, turning at its present rate, reaches
    /// the e_z at which both spheres touch: until then the lower sphere's bound is the smaller one, afterwards the other's.
    #[inline(always)]
    fn nearer<S: Simd, const K: usize>(
        &self,
        height: Pack<S, K>,
        vz: Pack<S, K>,
        axis_motion: &AxisMotion<S, K>,
        bound: Pack<S, K>,
    ) -> HullPart<S, K> {
        if !B::TWO {
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
    fn gap<S: Simd, const K: usize>(
        &self,
        part: &HullPart<S, K>,
        cos_tilt: Pack<S, K>,
        height: Pack<S, K>,
    ) -> Pack<S, K> {
        part.own.mul_add(self.lean(cos_tilt), height) // (2)
    }

    #[inline(always)]
    fn touching_height<S: Simd, const K: usize>(
        &self,
        part: &HullPart<S, K>,
        cos_tilt: Pack<S, K>,
    ) -> Pack<S, K> {
        -(part.own * self.lean(cos_tilt)) // (2)
    }

    #[inline(always)]
    fn lever<S: Simd, const K: usize>(&self, part: &HullPart<S, K>, _: Pack<S, K>) -> Pack<S, K> {
        part.own
    }

    #[inline(always)]
    fn radius<S: Simd, const K: usize>(&self, part: &HullPart<S, K>, _: Pack<S, K>) -> Pack<S, K> {
        Balls::radius(self, part.one)
    }

    #[inline(always)]
    fn curvature<S: Simd, const K: usize>(
        &self,
        part: &HullPart<S, K>,
        axis_motion: &AxisMotion<S, K>,
        addend: f64,
    ) -> Pack<S, K> {
        part.own.mul_add(axis_motion.acceleration, addend)
    }

    #[inline(always)]
    fn derivatives<S: Simd, const K: usize>(
        &self,
        part: &HullPart<S, K>,
        axis_motion: &AxisMotion<S, K>,
    ) -> [Pack<S, K>; 3] {
        linear_derivatives(part.own, axis_motion)
    }

    #[inline(always)]
    fn name<S: Simd, const K: usize>(&self, part: &HullPart<S, K>, _: Pack<S, K>) -> Pack<S, K> {
        Balls::name(self, part.one)
    }
}

/// The second to fourth time derivatives of −h for a gap that is linear in e_z.
#[inline(always)]
fn linear_derivatives<S: Simd, const K: usize>(
    lever: Pack<S, K>,
    axis_motion: &AxisMotion<S, K>,
) -> [Pack<S, K>; 3] {
    let second = lever * axis_motion.acceleration;
    let third = -(lever * axis_motion.square) * axis_motion.rate;
    [second, third, -axis_motion.square * second]
}
