//! PlanarMotion in one vertical plane: the axis is (s, 0, c), the velocity (v_x, 0, v_z) and the angular velocity (0, ω, 0).

use super::{Attitude, Flight, SpatialMotion, SpatialState, State, SymmetricState};
use crate::math::Vectors;
use crate::shape::{AxisMotion, Body};
use crate::simd::{Lanewise, Pack};
use pulp::Simd;

/// Position and motion, and the flight from there.
#[derive(Clone, Copy)]
pub(crate) struct PlanarState<S: Simd> {
    pub height: Pack<S>,
    pub sine: Pack<S>,
    pub cosine: Pack<S>,
    pub motion: PlanarMotion<S>,
}

/// v_x, v_z and ω.
#[derive(Clone, Copy)]
pub(crate) struct PlanarMotion<S: Simd> {
    pub vx: Pack<S>,
    pub vz: Pack<S>,
    pub spin: Pack<S>,
}

impl<S: Simd> SymmetricState<S> for PlanarState<S> {
    type Motion = PlanarMotion<S>;

    #[inline(always)]
    fn resting(simd: S, height: f64) -> Self {
        Self {
            height: Pack::splat(simd, height),
            cosine: Pack::splat(simd, 1.0),
            ..Self::none(simd)
        }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, start: &State) {
        self.height.as_mut_slice()[lane] = start.height;
        self.sine.as_mut_slice()[lane] = start.axis.x;
        self.cosine.as_mut_slice()[lane] = start.axis.z;
        self.motion.vx.as_mut_slice()[lane] = start.velocity.x;
        self.motion.vz.as_mut_slice()[lane] = start.velocity.z;
        self.motion.spin.as_mut_slice()[lane] = start.precession.y;
    }

    #[inline(always)]
    fn height(&self) -> Pack<S> {
        self.height
    }

    #[inline(always)]
    fn vz(&self) -> Pack<S> {
        self.motion.vz
    }

    #[inline(always)]
    fn sine(&self) -> Pack<S> {
        self.sine
    }

    #[inline(always)]
    fn cos_tilt(&self) -> Pack<S> {
        self.cosine
    }

    #[inline(always)]
    fn motion(&self) -> PlanarMotion<S> {
        self.motion
    }

    #[inline(always)]
    fn with_motion(self, motion: PlanarMotion<S>) -> Self {
        Self { motion, ..self }
    }

    #[inline(always)]
    fn in_space(&self) -> SpatialState<S> {
        let PlanarMotion { vx, vz, spin } = self.motion;
        let zero = Pack::splat(self.height.simd(), 0.0);
        SpatialState {
            height: self.height,
            axis: Vectors::new(self.sine, zero, self.cosine),
            motion: SpatialMotion {
                velocity: Vectors::new(vx, zero, vz),
                precession: Vectors::new(zero, spin, zero),
            },
        }
    }

    #[inline(always)]
    fn rotational_energy(&self, body: &Body) -> Pack<S> {
        let spin = self.motion.spin;
        0.5 * body.transverse * (spin * spin)
    }

    #[inline(always)]
    fn kinetic_energy(&self, body: &Body) -> Pack<S> {
        let PlanarMotion { vx, vz, .. } = self.motion;
        0.5 * vx.mul_add(vx, vz * vz) + self.rotational_energy(body)
    }
}

/// A flight is the state at its start.
impl<S: Simd> Flight<S> for PlanarState<S> {
    type State = Self;

    /// The slope is 0: over an incline the motion is spatial, because gravity has a component outside the plane of the axis.
    #[inline(always)]
    fn new(start: Self, _: f64) -> Self {
        start
    }

    #[inline(always)]
    fn start(&self) -> &Self {
        self
    }

    #[inline(always)]
    fn rate(&self) -> Pack<S> {
        self.motion.spin
    }

    #[inline(always)]
    fn bounds(&self) -> [Pack<S>; 3] {
        let (rate, one) = (self.rate(), Pack::splat(self.height.simd(), 1.0));
        [rate * rate, one, one]
    }

    #[inline(always)]
    fn attitude(&self, (sin, cos): (Pack<S>, Pack<S>)) -> Attitude<S> {
        self.now().after(sin, cos)
    }

    #[inline(always)]
    fn axis_motion(&self, attitude: Attitude<S>) -> AxisMotion<S> {
        let square = self.rate() * self.rate();
        AxisMotion {
            cos_tilt: attitude.cosine,
            rate: -self.rate() * attitude.sine,
            acceleration: -square * attitude.cosine,
            square,
        }
    }

    #[inline(always)]
    fn axis_motion_at_start(&self) -> AxisMotion<S> {
        self.axis_motion(self.now())
    }

    #[inline(always)]
    fn state(&self, time: Pack<S>, attitude: Attitude<S>) -> Self {
        let Attitude { sine, cosine } = attitude;
        // One Newton step to unit length; rounding would otherwise accumulate over the impacts.
        let length = sine.mul_add(sine, cosine * cosine).mul_add(-0.5, 1.5);
        Self {
            height: self.height,
            sine: sine * length,
            cosine: cosine * length,
            motion: PlanarMotion {
                vz: self.vz_at(time),
                ..self.motion
            },
        }
    }

    #[inline(always)]
    fn end(&mut self, state: Self, height: Pack<S>) {
        *self = Self { height, ..state };
    }
}

impl<S: Simd> PlanarState<S> {
    #[inline(always)]
    fn now(&self) -> Attitude<S> {
        Attitude {
            sine: self.sine,
            cosine: self.cosine,
        }
    }
}
