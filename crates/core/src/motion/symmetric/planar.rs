//! Motion in one vertical plane: the axis is (s, 0, c), the velocity (v_x, 0, v_z) and the angular velocity (0, ω, 0).

use super::{Attitude, Flight, SpatialMotion, SpatialStates, State};
use crate::math::Vectors;
use crate::shape::{Body, Swing};
use crate::simd::{Mask, Pack};
use pulp::Simd;

/// Position and motion. They also represent the flight that starts from them, since nothing needs to be computed in advance.
#[derive(Clone, Copy)]
pub(crate) struct States<S: Simd, const K: usize> {
    pub lift: Pack<S, K>,
    pub sine: Pack<S, K>,
    pub cosine: Pack<S, K>,
    pub motion: Motion<S, K>,
}

/// v_x, v_z and ω.
#[derive(Clone, Copy)]
pub(crate) struct Motion<S: Simd, const K: usize> {
    pub glide: Pack<S, K>,
    pub climb: Pack<S, K>,
    pub spin: Pack<S, K>,
}

impl<S: Simd, const K: usize> super::States<S, K> for States<S, K> {
    type Motion = Motion<S, K>;

    #[inline(always)]
    fn resting(simd: S, lift: f64) -> Self {
        let zero = Pack::splat(simd, 0.0);
        Self {
            lift: Pack::splat(simd, lift),
            sine: zero,
            cosine: Pack::splat(simd, 1.0),
            motion: Motion {
                glide: zero,
                climb: zero,
                spin: zero,
            },
        }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, start: &State) {
        self.lift.as_mut_slice()[lane] = start.lift;
        self.sine.as_mut_slice()[lane] = start.axis.x;
        self.cosine.as_mut_slice()[lane] = start.axis.z;
        self.motion.glide.as_mut_slice()[lane] = start.velocity.x;
        self.motion.climb.as_mut_slice()[lane] = start.velocity.z;
        self.motion.spin.as_mut_slice()[lane] = start.precession.y;
    }

    #[inline(always)]
    fn lift(&self) -> Pack<S, K> {
        self.lift
    }

    #[inline(always)]
    fn climb(&self) -> Pack<S, K> {
        self.motion.climb
    }

    #[inline(always)]
    fn sine(&self) -> Pack<S, K> {
        self.sine
    }

    #[inline(always)]
    fn tilt(&self) -> Pack<S, K> {
        self.cosine
    }

    #[inline(always)]
    fn motion(&self) -> Motion<S, K> {
        self.motion
    }

    #[inline(always)]
    fn or(self, mask: Mask<S, K>, other: &Self) -> Self {
        Self {
            lift: mask.select(other.lift, self.lift),
            sine: mask.select(other.sine, self.sine),
            cosine: mask.select(other.cosine, self.cosine),
            motion: Motion {
                glide: mask.select(other.motion.glide, self.motion.glide),
                climb: mask.select(other.motion.climb, self.motion.climb),
                spin: mask.select(other.motion.spin, self.motion.spin),
            },
        }
    }

    #[inline(always)]
    fn moving(self, motion: Motion<S, K>) -> Self {
        Self { motion, ..self }
    }

    #[inline(always)]
    fn in_space(&self) -> SpatialStates<S, K> {
        let Motion { glide, climb, spin } = self.motion;
        let zero = Pack::splat(self.lift.simd(), 0.0);
        let vector = |x, y, z| Vectors { x, y, z };
        SpatialStates {
            lift: self.lift,
            axis: vector(self.sine, zero, self.cosine),
            motion: SpatialMotion {
                velocity: vector(glide, zero, climb),
                precession: vector(zero, spin, zero),
            },
        }
    }

    #[inline(always)]
    fn rotational_energy(&self, body: &Body) -> Pack<S, K> {
        let spin = self.motion.spin;
        0.5 * body.transverse * (spin * spin)
    }

    #[inline(always)]
    fn kinetic_energy(&self, body: &Body) -> Pack<S, K> {
        let Motion { glide, climb, .. } = self.motion;
        0.5 * glide.mul_add(glide, climb * climb) + self.rotational_energy(body)
    }
}

impl<S: Simd, const K: usize> Flight<S, K> for States<S, K> {
    type State = Self;

    /// The slope is 0: over an incline the motion is spatial, because gravity has a component outside the plane of the axis.
    #[inline(always)]
    fn new(start: Self, _: f64) -> Self {
        start
    }

    #[inline(always)]
    fn depart(&mut self, motion: Motion<S, K>, _: f64) {
        self.motion = motion;
    }

    #[inline(always)]
    fn start(&self) -> &Self {
        self
    }

    #[inline(always)]
    fn rate(&self) -> Pack<S, K> {
        self.motion.spin
    }

    #[inline(always)]
    fn square(&self) -> Pack<S, K> {
        self.motion.spin * self.motion.spin
    }

    #[inline(always)]
    fn amplitude(&self) -> Pack<S, K> {
        Pack::splat(self.lift.simd(), 1.0)
    }

    #[inline(always)]
    fn reach(&self) -> Pack<S, K> {
        Pack::splat(self.lift.simd(), 1.0)
    }

    #[inline(always)]
    fn attitude(&self, (sin, cos): (Pack<S, K>, Pack<S, K>)) -> Attitude<S, K> {
        let Self { sine, cosine, .. } = *self;
        Attitude { sine, cosine }.after(sin, cos)
    }

    #[inline(always)]
    fn swing(&self, attitude: Attitude<S, K>) -> Swing<S, K> {
        let square = self.square();
        Swing {
            tilt: attitude.cosine,
            rate: -self.motion.spin * attitude.sine,
            acceleration: -square * attitude.cosine,
            square,
        }
    }

    #[inline(always)]
    fn beginning(&self) -> Swing<S, K> {
        self.swing(Attitude {
            sine: self.sine,
            cosine: self.cosine,
        })
    }

    #[inline(always)]
    fn state(&self, time: Pack<S, K>, attitude: Attitude<S, K>) -> Self {
        let Attitude { sine, cosine } = attitude;
        // One Newton step to unit length; rounding would otherwise accumulate over the impacts.
        let length = sine.mul_add(sine, cosine * cosine).mul_add(-0.5, 1.5);
        Self {
            lift: self.lift,
            sine: sine * length,
            cosine: cosine * length,
            motion: Motion {
                climb: self.climb_at(time),
                ..self.motion
            },
        }
    }

    #[inline(always)]
    fn end(&mut self, state: Self, lift: Pack<S, K>) {
        *self = Self { lift, ..state };
    }
}
