//! The hull of a spheroid: semi-axes a across and c along the symmetry axis, with the centre of mass at its centre.
//!
//! The support function is h² = a² + De_z² with D = c² − a². While e_z = k + A cos φ, φ = Ωt, is the vertical component of a unit
//! vector,
//!
//! d²h/dt² = De_z e_z″/h + Da²e_z′²/h³,
//!
//! and this is at most |D|AEΩ²/h_min, where E = |k| + A ≤ 1 and h_min is the smallest h for |e_z| ≤ E:
//!
//! * D > 0, h_min = a: e_z e_z″ = −AΩ²(k cos φ + A cos²φ) ≤ A|k|Ω² and e_z′² ≤ A²Ω², with h ≥ a.
//! * D < 0, h_min = h(E): the second term is negative, |e_z″| ≤ AΩ², and |e_z|/h grows with |e_z|.
//!
//! A test checks that |d²h/dt²| has the same bound. The derivatives follow from hh′ = De_z e_z′ by Leibniz's rule: with (n) for the
//! n-th time derivative, h h⁽ⁿ⁾ = D(e_z²/2)⁽ⁿ⁾ minus products of lower derivatives of h.

use super::{AxisMotion, Hull, HullPart};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// An ellipsoid of revolution.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipsoid {
    /// Semi-axis a across the symmetry axis.
    equatorial: f64,
    /// D = c² − a².
    excess: f64,
    /// max(a/c, c/a), [`Hull::sharpness`]: the larger it is, the smaller the radius of convergence of h in Ωt.
    sharpness: f64,
}

impl Ellipsoid {
    /// The hull with these semi-axes across and along the axis of revolution, in the core's unit of length.
    pub(in crate::shape) fn new(equatorial: f64, polar: f64) -> Self {
        Self {
            equatorial,
            excess: (polar - equatorial) * (polar + equatorial),
            sharpness: (equatorial / polar).max(polar / equatorial),
        }
    }

    /// a and c.
    pub(in crate::shape) fn semi_axes(&self) -> [f64; 2] {
        let a = self.equatorial;
        [a, a.mul_add(a, self.excess).sqrt()]
    }

    /// h, from h² = a²(1 − e_z²) + c²e_z²: a sum of positive terms, in which no digits cancel.
    #[inline(always)]
    fn support<S: Simd>(&self, cos_tilt: Pack<S>) -> Pack<S> {
        let a2 = self.equatorial * self.equatorial;
        let across = a2 * ((1.0 - cos_tilt) * (1.0 + cos_tilt)).max(0.0);
        let along = self.excess + a2; // c²
        (cos_tilt * cos_tilt).mul_add(along, across).sqrt()
    }

    /// 1/h and h − a, the latter as De_z²/(h + a), which does not subtract nearly equal numbers; with one quotient for both.
    #[inline(always)]
    fn profile<S: Simd>(&self, cos_tilt: Pack<S>) -> [Pack<S>; 2] {
        let support = self.support(cos_tilt);
        let sum = self.equatorial + support;
        let quotient = 1.0 / (support * sum);
        [
            quotient * sum,
            self.excess * (cos_tilt * cos_tilt) * (quotient * support),
        ]
    }

    /// 1/h.
    #[inline(always)]
    fn inverse<S: Simd>(&self, cos_tilt: Pack<S>) -> Pack<S> {
        self.profile(cos_tilt)[0]
    }

    /// h − a.
    #[inline(always)]
    fn rise<S: Simd>(&self, cos_tilt: Pack<S>) -> Pack<S> {
        self.profile(cos_tilt)[1]
    }
}

impl Hull for Ellipsoid {
    const TWO: bool = false;

    fn level(&self) -> f64 {
        self.equatorial
    }

    fn sharpness(&self) -> f64 {
        self.sharpness
    }

    #[inline(always)]
    fn ceiling<S: Simd>(&self, max_cos_tilt: Pack<S>) -> Pack<S> {
        if self.excess > 0.0 {
            self.rise(max_cos_tilt.min(1.0))
        } else {
            0.0 * max_cos_tilt
        }
    }

    #[inline(always)]
    fn curvature_bound<S: Simd>(&self, amplitude: Pack<S>, max_cos_tilt: Pack<S>) -> Pack<S> {
        let max_cos_tilt = (max_cos_tilt * (1.0 + 4.0 * f64::EPSILON)).min(1.0);
        if self.excess > 0.0 {
            self.excess / self.equatorial * (amplitude * max_cos_tilt)
        } else {
            -self.excess * (amplitude * max_cos_tilt) / self.support(max_cos_tilt)
        }
    }

    #[inline(always)]
    fn part<S: Simd>(&self, one: Mask<S>) -> HullPart<S> {
        HullPart {
            one,
            own: Pack::splat(one.simd(), 0.0),
        }
    }

    #[inline(always)]
    fn nearer<S: Simd>(
        &self,
        _: Pack<S>,
        _: Pack<S>,
        axis_motion: &AxisMotion<S>,
        _: Pack<S>,
    ) -> HullPart<S> {
        HullPart {
            one: Mask::splat(axis_motion.cos_tilt.simd(), true),
            own: self.inverse(axis_motion.cos_tilt),
        }
    }

    #[inline(always)]
    fn gap<S: Simd>(&self, _: &HullPart<S>, cos_tilt: Pack<S>, height: Pack<S>) -> Pack<S> {
        height - self.rise(cos_tilt)
    }

    #[inline(always)]
    fn touching_height<S: Simd>(&self, _: &HullPart<S>, cos_tilt: Pack<S>) -> Pack<S> {
        self.rise(cos_tilt)
    }

    #[inline(always)]
    fn lever<S: Simd>(&self, _: &HullPart<S>, cos_tilt: Pack<S>) -> Pack<S> {
        (-self.excess * cos_tilt) * self.inverse(cos_tilt)
    }

    #[inline(always)]
    fn radius<S: Simd>(&self, _: &HullPart<S>, cos_tilt: Pack<S>) -> Pack<S> {
        self.equatorial * self.equatorial * self.inverse(cos_tilt)
    }

    #[inline(always)]
    fn curvature<S: Simd>(&self, _: &HullPart<S>, axis_motion: &AxisMotion<S>) -> Pack<S> {
        let inverse = self.inverse(axis_motion.cos_tilt);
        let (e, v) = (axis_motion.cos_tilt, axis_motion.rate);
        let first = self.excess * (e * v) * inverse; // h′
        let second = self.excess * e.mul_add(axis_motion.acceleration, v * v); // D(e²/2)″
        (first.mul_add(first, -second)).mul_add(inverse, -1.0)
    }

    #[inline(always)]
    fn derivatives<S: Simd>(
        &self,
        part: &HullPart<S>,
        axis_motion: &AxisMotion<S>,
    ) -> [Pack<S>; 3] {
        let inverse = part.own;
        let (e, v, a) = (
            axis_motion.cos_tilt,
            axis_motion.rate,
            axis_motion.acceleration,
        );
        let (j, s) = (-axis_motion.square * v, -axis_motion.square * a); // e_z‴ and e_z⁗
        let first = self.excess * (e * v) * inverse; // h′
        let second = self.excess * e.mul_add(a, v * v);
        let second = first.mul_add(-first, second) * inverse; // h″
        let third = self.excess * e.mul_add(j, 3.0 * (v * a));
        let third = (3.0 * first).mul_add(-second, third) * inverse; // h‴
        let fourth = self.excess * e.mul_add(s, v.mul_add(4.0 * j, 3.0 * (a * a)));
        let lower = (4.0 * first).mul_add(third, 3.0 * (second * second));
        let fourth = (fourth - lower) * inverse; // h⁗
        [-second, -third, -fourth]
    }

    #[inline(always)]
    fn name<S: Simd>(&self, _: &HullPart<S>, cos_tilt: Pack<S>) -> Pack<S> {
        cos_tilt.lt(0.0).select(1.0, -1.0_f64)
    }
}
