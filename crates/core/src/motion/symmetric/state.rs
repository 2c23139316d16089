//! The states of bodies in three dimensions, in the core's units: of one particle, and of one in each lane.

use super::SymmetricState;
use crate::math::{Vector, Vectors};
use crate::shape::{Body, Sphere};
use crate::simd::{Pack, elementary};
use pulp::{Scalar, Simd};

/// Position and motion of one particle at its release, or just before or after an impact, in the core's units. The horizontal
/// position is omitted, because the motion does not depend on it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Height of the centre of mass minus the hull's level, which is the height at which both spheres of a dumbbell lie on the
    /// plane: R for equal spheres. At a contact it is ∓(L/2)e_z, so that the gap of the touching sphere is exactly 0.
    pub height: f64,
    /// Velocity of the centre of mass, v_G.
    pub velocity: Vector,
    /// Unit vector of the symmetry axis, from sphere 2 to sphere 1.
    pub axis: Vector,
    /// **Λ**/J_xx with **Λ** the angular momentum: the axis turns about it at the rate |**Λ**|/J_xx. It equals **ω** if **ω** is
    /// perpendicular to the axis.
    pub precession: Vector,
}

impl State {
    /// The state with this height of the centre of mass above the plane, velocity, axis and angular velocity **ω**, in the core's
    /// units.
    #[inline(always)]
    pub fn with_spin(
        body: &Body,
        height: f64,
        velocity: Vector,
        axis: Vector,
        spin: Vector,
    ) -> Self {
        let axial = body.axial / body.transverse - 1.0;
        Self {
            height: height - body.hull.level(),
            velocity,
            axis,
            precession: axis.mul_add(axial * spin.dot(axis), spin), // Λ/J_xx = Ĵω/J_xx
        }
    }

    /// Angular velocity **ω** = Ĵ⁻¹**Λ**.
    pub fn spin(&self, body: &Body) -> Vector {
        self.in_lane().spin(body).lane(0)
    }

    /// Kinetic energy of the rotation, in m g R.
    pub fn rotational_energy(&self, body: &Body) -> f64 {
        self.in_lane().rotational_energy(body).as_slice()[0]
    }

    /// Kinetic energy, in m g R.
    pub fn kinetic_energy(&self, body: &Body) -> f64 {
        self.in_lane().kinetic_energy(body).as_slice()[0]
    }

    /// Angle θ between the symmetry axis and the plane normal, in [0, π] rad.
    pub fn angle(&self) -> f64 {
        elementary::angle(self.in_lane().sine().as_slice()[0], self.axis.z)
    }

    /// Gaps between the plane and spheres 1 and 2, in R; two equal values if only one part of the body can touch.
    pub fn gaps(&self, body: &Body) -> [f64; 2] {
        Sphere::BOTH.map(|sphere| body.hull.gap(sphere, self.axis.z, self.height)) // (2)
    }

    /// The state in a single lane.
    pub(crate) fn in_lane(&self) -> SpatialState<Scalar> {
        let mut state = SpatialState::resting(Scalar::new(), 0.0);
        state.put(0, self);
        state
    }
}

/// Position and motion of a body in each lane, as [`State`].
#[derive(Clone, Copy)]
pub(crate) struct SpatialState<S: Simd> {
    pub height: Pack<S>,
    /// Unit vector of the symmetry axis, from sphere 2 to sphere 1.
    pub axis: Vectors<S>,
    pub motion: SpatialMotion<S>,
}

/// v_G and **p** = **Λ**/J_xx.
#[derive(Clone, Copy)]
pub(crate) struct SpatialMotion<S: Simd> {
    pub velocity: Vectors<S>,
    pub precession: Vectors<S>,
}

impl<S: Simd> SpatialState<S> {
    /// Angular velocity **ω** = Ĵ⁻¹**Λ**.
    #[inline(always)]
    pub fn spin(&self, body: &Body) -> Vectors<S> {
        let axial = body.transverse / body.axial - 1.0;
        let precession = self.motion.precession;
        self.axis
            .mul_add(axial * precession.dot(self.axis), precession)
    }
}
