//! Motion in three dimensions.
//!
//! With **p** = **Λ**/J_xx and Ω = |**p**| the axis is **e**(t) = **k** + (**e** − **k**) cos Ωt + (**p** × **e**)/Ω sin Ωt,
//! where **k** = **p**(**p**·**e**)/Ω² and **e** is the axis at the start (3).

use super::{Attitude, Flight, SpatialMotion, SpatialState, State, SymmetricState};
use crate::math::{UNITS, Vectors};
use crate::shape::{AxisMotion, Body};
use crate::simd::{Lanewise, Pack};
use pulp::Simd;

impl<S: Simd> SymmetricState<S> for SpatialState<S> {
    type Motion = SpatialMotion<S>;

    #[inline(always)]
    fn resting(simd: S, height: f64) -> Self {
        Self {
            height: Pack::splat(simd, height),
            axis: Vectors::splat(simd, UNITS[2]),
            ..Self::none(simd)
        }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, start: &State) {
        self.height.as_mut_slice()[lane] = start.height;
        self.axis.put(lane, start.axis);
        self.motion.velocity.put(lane, start.velocity);
        self.motion.precession.put(lane, start.precession);
    }

    #[inline(always)]
    fn height(&self) -> Pack<S> {
        self.height
    }

    #[inline(always)]
    fn vz(&self) -> Pack<S> {
        self.motion.velocity.z
    }

    #[inline(always)]
    fn sine(&self) -> Pack<S> {
        self.axis.horizontal()
    }

    #[inline(always)]
    fn cos_tilt(&self) -> Pack<S> {
        self.axis.z
    }

    #[inline(always)]
    fn motion(&self) -> SpatialMotion<S> {
        self.motion
    }

    #[inline(always)]
    fn with_motion(self, motion: SpatialMotion<S>) -> Self {
        Self { motion, ..self }
    }

    #[inline(always)]
    fn in_space(&self) -> Self {
        *self
    }

    /// **ω**·**Λ**/2, the rotational part of (12).
    #[inline(always)]
    fn rotational_energy(&self, body: &Body) -> Pack<S> {
        let precession = self.motion.precession;
        0.5 * body.transverse * self.spin(body).dot(precession)
    }

    #[inline(always)]
    fn kinetic_energy(&self, body: &Body) -> Pack<S> {
        let velocity = self.motion.velocity;
        0.5 * velocity.dot(velocity) + self.rotational_energy(body)
    }
}

/// A flight: the state at its start, and the constants of its rotation.
#[derive(Clone, Copy)]
pub(crate) struct SpatialFlight<S: Simd> {
    start: SpatialState<S>,
    slope: f64,
    /// Ω and Ω².
    rate: Pack<S>,
    square: Pack<S>,
    /// **p**·**e**/Ω² and 1/Ω; 0 for a body that does not rotate.
    share: Pack<S>,
    inverse: Pack<S>,
    /// e_z is `centre + cosine cos φ + sine sin φ`, φ = Ωt (3).
    centre: Pack<S>,
    cosine: Pack<S>,
    sine: Pack<S>,
    amplitude: Pack<S>,
}

/// Ω² below which a body is treated as not rotating.
const SLOWEST: f64 = 1e-300;

impl<S: Simd> Flight<S> for SpatialFlight<S> {
    type State = SpatialState<S>;

    #[inline(always)]
    fn new(start: SpatialState<S>, slope: f64) -> Self {
        let (axis, precession) = (start.axis, start.motion.precession);
        let square = precession.dot(precession);
        let rate = square.sqrt();
        let inverse = square.lt(SLOWEST).select(0.0, 1.0 / rate.max(SLOWEST));
        let share = precession.dot(axis) * (inverse * inverse);
        let centre = precession.z * share;
        let cosine = axis.z - centre;
        let horizontal = precession.x.mul_add(axis.y, -(precession.y * axis.x));
        let sine = horizontal * inverse;
        let amplitude = cosine.mul_add(cosine, sine * sine).sqrt();
        Self {
            start,
            slope,
            rate,
            square,
            share,
            inverse,
            centre,
            cosine,
            sine,
            amplitude: (amplitude * (1.0 + 4.0 * f64::EPSILON)).min(1.0), // an upper bound in spite of rounding
        }
    }

    #[inline(always)]
    fn start(&self) -> &SpatialState<S> {
        &self.start
    }

    #[inline(always)]
    fn rate(&self) -> Pack<S> {
        self.rate
    }

    #[inline(always)]
    fn bounds(&self) -> [Pack<S>; 3] {
        let highest = self.centre.abs() + self.amplitude;
        [self.square, self.amplitude, highest]
    }

    #[inline(always)]
    fn attitude(&self, (sine, cosine): (Pack<S>, Pack<S>)) -> Attitude<S> {
        Attitude { sine, cosine }
    }

    #[inline(always)]
    fn axis_motion(&self, Attitude { sine, cosine }: Attitude<S>) -> AxisMotion<S> {
        let turning = self.cosine.mul_add(cosine, self.sine * sine); // (3)
        let leading = self.sine.mul_add(cosine, -(self.cosine * sine)); // a quarter of a turn later
        AxisMotion {
            cos_tilt: turning + self.centre,
            rate: self.rate * leading,
            acceleration: -self.square * turning,
            square: self.square,
        }
    }

    #[inline(always)]
    fn axis_motion_at_start(&self) -> AxisMotion<S> {
        AxisMotion {
            cos_tilt: self.start.axis.z,
            rate: self.rate * self.sine,
            acceleration: -self.square * self.cosine,
            square: self.square,
        }
    }

    #[inline(always)]
    fn state(&self, time: Pack<S>, attitude: Attitude<S>) -> SpatialState<S> {
        let SpatialState {
            axis,
            motion,
            height,
        } = self.start;
        let constant = motion.precession * self.share;
        let leading = motion.precession.cross(axis) * self.inverse;
        let axis = leading.mul_add(
            attitude.sine,
            (axis - constant).mul_add(attitude.cosine, constant),
        ); // (3)
        // One Newton step to unit length; rounding would otherwise accumulate over the impacts.
        let axis = axis * axis.dot(axis).mul_add(-0.5, 1.5);
        let Vectors { x, y, .. } = motion.velocity;
        SpatialState {
            height,
            axis,
            motion: SpatialMotion {
                velocity: Vectors::new(time.mul_add(self.slope, x), y, self.vz_at(time)), // (5)
                ..motion
            },
        }
    }

    #[inline(always)]
    fn end(&mut self, state: SpatialState<S>, height: Pack<S>) {
        self.start = SpatialState { height, ..state };
    }
}
