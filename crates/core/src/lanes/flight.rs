//! MOTION: the free flight, (3)–(5), in a vertical plane.

use super::Pack;
use crate::elementary::moderate_sincos_in_lanes;
use pulp::Simd;

/// Position and motion, as [`crate::State`] in the plane.
#[derive(Clone, Copy)]
pub(crate) struct State<S: Simd, const K: usize> {
    /// Height of the centre of mass above R.
    pub lift: Pack<S, K>,
    /// v_x and v_z.
    pub glide: Pack<S, K>,
    pub climb: Pack<S, K>,
    /// The axis (s, 0, c).
    pub sine: Pack<S, K>,
    pub cosine: Pack<S, K>,
    /// ω.
    pub spin: Pack<S, K>,
}

/// Where the axis points.
#[derive(Clone, Copy)]
pub(super) struct Attitude<S: Simd, const K: usize> {
    pub sine: Pack<S, K>,
    pub cosine: Pack<S, K>,
}

impl<S: Simd, const K: usize> Attitude<S, K> {
    /// The attitude after another turn through an angle with this sine and cosine (3).
    #[inline(always)]
    fn after(self, sin: Pack<S, K>, cos: Pack<S, K>) -> Self {
        Self {
            sine: self.sine.mul_add(cos, self.cosine * sin), // (3)
            cosine: self.cosine.mul_add(cos, -(self.sine * sin)), // (3)
        }
    }

    /// The attitude a moderate `angle` later: exact in double precision for angles up to 0.15.
    #[inline(always)]
    pub fn turned(self, angle: Pack<S, K>) -> Self {
        let (sin, cos) = moderate_sincos_in_lanes(angle);
        self.after(sin, cos)
    }

    /// The attitude a small `angle` later: exact in double precision for angles up to 2⁻¹⁸.
    #[inline(always)]
    pub fn advanced(self, angle: Pack<S, K>) -> Self {
        self.after(angle, (angle * angle).mul_add(-0.5, 1.0))
    }
}

impl<S: Simd, const K: usize> State<S, K> {
    /// Height of the centre of mass above R after `time` (5).
    #[inline(always)]
    pub(super) fn lift_at(&self, time: Pack<S, K>) -> Pack<S, K> {
        time.mul_add(time.mul_add(-0.5, self.climb), self.lift) // (5)
    }

    /// Where the axis points when the body has turned through φ, of which sine and cosine are given.
    #[inline(always)]
    pub fn attitude(&self, (sin, cos): (Pack<S, K>, Pack<S, K>)) -> Attitude<S, K> {
        let Self { sine, cosine, .. } = *self;
        Attitude { sine, cosine }.after(sin, cos)
    }

    /// de_z/dt.
    #[inline(always)]
    pub fn tilt_rate(&self, attitude: Attitude<S, K>) -> Pack<S, K> {
        -self.spin * attitude.sine
    }

    /// The state after `time`, when the sphere on the side `side` = ±L/2 of the centre of mass touches the plane.
    #[inline(always)]
    pub(super) fn landing(
        &self,
        time: Pack<S, K>,
        attitude: Attitude<S, K>,
        side: Pack<S, K>,
    ) -> Self {
        let Attitude { sine, cosine } = attitude;
        // One Newton step to unit length.
        let length = sine.mul_add(sine, cosine * cosine).mul_add(-0.5, 1.5);
        let (sine, cosine) = (sine * length, cosine * length);
        Self {
            lift: -(side * cosine), // (2)
            climb: self.climb - time,
            sine,
            cosine,
            ..*self
        }
    }

    /// Kinetic energy of the rotation; `inertia` is J_xx.
    #[inline(always)]
    pub fn rotational_energy(&self, inertia: f64) -> Pack<S, K> {
        0.5 * inertia * (self.spin * self.spin)
    }

    /// Kinetic energy.
    #[inline(always)]
    pub fn kinetic_energy(&self, inertia: f64) -> Pack<S, K> {
        let square = self.glide.mul_add(self.glide, self.climb * self.climb);
        0.5 * square + self.rotational_energy(inertia)
    }
}
