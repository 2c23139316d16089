//! MOTION: the free flight, (3)–(5), in a vertical plane.

use super::Pack;
use crate::elementary::sincos_in_lanes;
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

/// Sine and cosine of the phase φ = ωt.
#[derive(Clone, Copy)]
pub(super) struct Phase<S: Simd, const K: usize> {
    pub sin: Pack<S, K>,
    pub cos: Pack<S, K>,
}

impl<S: Simd, const K: usize> Phase<S, K> {
    #[inline(always)]
    pub fn of(angle: Pack<S, K>) -> Self {
        let (sin, cos) = sincos_in_lanes(angle);
        Self { sin, cos }
    }

    /// The phase a small `angle` later: exact in double precision for angles up to 2⁻¹¹.
    #[inline(always)]
    pub fn advanced(self, angle: Pack<S, K>) -> Self {
        let square = angle * angle;
        let sin = angle * square.mul_add(-1.0 / 6.0, 1.0);
        let cos = square.mul_add(square.mul_add(1.0 / 24.0, -0.5), 1.0);
        Self {
            sin: self.sin.mul_add(cos, self.cos * sin),
            cos: self.cos.mul_add(cos, -(self.sin * sin)),
        }
    }
}

impl<S: Simd, const K: usize> State<S, K> {
    /// Height of the centre of mass above R after `time` (5).
    #[inline(always)]
    pub(super) fn lift_at(&self, time: Pack<S, K>) -> Pack<S, K> {
        time.mul_add(time.mul_add(-0.5, self.climb), self.lift) // (5)
    }

    /// e_z at a phase (3).
    #[inline(always)]
    pub(super) fn tilt(&self, phase: Phase<S, K>) -> Pack<S, K> {
        self.cosine.mul_add(phase.cos, -(self.sine * phase.sin)) // (3)
    }

    /// de_z/dt.
    #[inline(always)]
    pub(super) fn tilt_rate(&self, phase: Phase<S, K>) -> Pack<S, K> {
        -self.spin * self.sine.mul_add(phase.cos, self.cosine * phase.sin)
    }

    /// The state after `time`, when the sphere on the side `side` = ±L/2 of the centre of mass touches the plane.
    #[inline(always)]
    pub(super) fn landing(&self, time: Pack<S, K>, phase: Phase<S, K>, side: Pack<S, K>) -> Self {
        let sine = self.sine.mul_add(phase.cos, self.cosine * phase.sin); // (3)
        let cosine = self.tilt(phase);
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
