//! Hulls that consist of one or two spheres on the axis.

use super::{Hull, Part, Swing};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// The parameters of a hull of spheres, whose gaps are linear in e_z.
pub(super) trait Balls: Copy {
    /// Whether the hull has two spheres.
    const TWO: bool;
    /// The levers s of spheres 1 and 2.
    fn levers(&self) -> [f64; 2];
    /// e_z minus its value where both spheres touch: negative where sphere 1 is the lower one.
    fn lean<S: Simd, const K: usize>(&self, tilt: Pack<S, K>) -> Pack<S, K>;
    /// Height of the centre of mass at which the lift is 0.
    fn level(&self) -> f64;
    /// Lift above which no part can touch while |e_z| ≤ `reach`.
    fn ceiling<S: Simd, const K: usize>(&self, reach: Pack<S, K>) -> Pack<S, K>;
    /// The radius of sphere 1 where `one`, else of sphere 2.
    fn radius<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K>;
    /// +1 or −1 for a contact of sphere 1 or 2.
    fn name<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Pack<S, K>;
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
    fn ceiling<S: Simd, const K: usize>(&self, reach: Pack<S, K>) -> Pack<S, K> {
        Balls::ceiling(self, reach)
    }

    #[inline(always)]
    fn sway<S: Simd, const K: usize>(&self, amplitude: Pack<S, K>, _: Pack<S, K>) -> Pack<S, K> {
        let [one, two] = self.levers();
        one.abs().max(two.abs()) * amplitude
    }

    #[inline(always)]
    fn part<S: Simd, const K: usize>(&self, one: Mask<S, K>) -> Part<S, K> {
        let [first, second] = self.levers();
        Part {
            one,
            own: one.select(first, second),
        }
    }

    /// The lower bounds of both gaps have the same curvature. They cross only when the axis, turning at its present rate, reaches
    /// the e_z at which both spheres touch: until then the lower sphere's bound is the smaller one, afterwards the other's.
    #[inline(always)]
    fn nearer<S: Simd, const K: usize>(
        &self,
        lift: Pack<S, K>,
        climb: Pack<S, K>,
        swing: &Swing<S, K>,
        bound: Pack<S, K>,
    ) -> Part<S, K> {
        if !B::TWO {
            return self.part(Mask::splat(lift.simd(), true));
        }
        let (lean, rate) = (self.lean(swing.tilt), swing.rate);
        // Both lower bounds at that time, lift + climb t − Mt²/2 with t = −lean/rate, times rate².
        let level = rate.mul_add(
            lift.mul_add(rate, -(climb * lean)),
            -(0.5 * bound * (lean * lean)),
        );
        // If both bounds are positive there, the sphere that the rotation moves down is the one whose bound reaches 0 first.
        let swings = Pack::splat(lift.simd(), 0.0).le(level);
        self.part(swings.select(rate, lean).lt(0.0))
    }

    #[inline(always)]
    fn gap<S: Simd, const K: usize>(
        &self,
        part: &Part<S, K>,
        tilt: Pack<S, K>,
        lift: Pack<S, K>,
    ) -> Pack<S, K> {
        part.own.mul_add(self.lean(tilt), lift) // (2)
    }

    #[inline(always)]
    fn lift<S: Simd, const K: usize>(&self, part: &Part<S, K>, tilt: Pack<S, K>) -> Pack<S, K> {
        -(part.own * self.lean(tilt)) // (2)
    }

    #[inline(always)]
    fn lever<S: Simd, const K: usize>(&self, part: &Part<S, K>, _: Pack<S, K>) -> Pack<S, K> {
        part.own
    }

    #[inline(always)]
    fn radius<S: Simd, const K: usize>(&self, part: &Part<S, K>, _: Pack<S, K>) -> Pack<S, K> {
        Balls::radius(self, part.one)
    }

    #[inline(always)]
    fn bend<S: Simd, const K: usize>(
        &self,
        part: &Part<S, K>,
        swing: &Swing<S, K>,
        addend: f64,
    ) -> Pack<S, K> {
        part.own.mul_add(swing.acceleration, addend)
    }

    #[inline(always)]
    fn bends<S: Simd, const K: usize>(
        &self,
        part: &Part<S, K>,
        swing: &Swing<S, K>,
    ) -> [Pack<S, K>; 3] {
        linear_bends(part.own, swing)
    }

    #[inline(always)]
    fn name<S: Simd, const K: usize>(&self, part: &Part<S, K>, _: Pack<S, K>) -> Pack<S, K> {
        Balls::name(self, part.one)
    }
}

/// The second to fourth time derivatives of −h for a gap that is linear in e_z.
#[inline(always)]
fn linear_bends<S: Simd, const K: usize>(
    lever: Pack<S, K>,
    swing: &Swing<S, K>,
) -> [Pack<S, K>; 3] {
    let second = lever * swing.acceleration;
    let third = -(lever * swing.square) * swing.rate;
    [second, third, -swing.square * second]
}
