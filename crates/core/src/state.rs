//! The state of a particle in the core's units, just before or just after an impact.

use crate::body::Body;
use crate::elementary;
use crate::vector::Vector;

/// Position and motion of one particle. Horizontal position is left out: the plane looks the same everywhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct State {
    /// Height of the centre of mass above the hull's level, at which both spheres of a dumbbell lie on the plane: above R for
    /// equal ones. Kept in this form because at a contact it is then ∓(L/2)e_z, and the gap of the touching sphere vanishes to
    /// the last bit.
    pub lift: f64,
    /// Velocity of the centre of mass, v_G.
    pub velocity: Vector,
    /// Unit vector of the symmetry axis, from sphere 2 to sphere 1.
    pub axis: Vector,
    /// **Λ**/J_xx, **Λ** the angular momentum: the axis turns about it at the rate |**Λ**|/J_xx. It equals **ω**
    /// as long as **ω** is perpendicular to the axis.
    pub precession: Vector,
}

impl State {
    /// A state from the height of the centre of mass above the plane and the angular velocity **ω**.
    pub fn with_spin(
        body: &Body,
        height: f64,
        velocity: Vector,
        axis: Vector,
        spin: Vector,
    ) -> Self {
        let axial = body.axial / body.transverse - 1.0;
        Self {
            lift: height - body.hull.level(),
            velocity,
            axis,
            precession: axis.mul_add(axial * spin.dot(axis), spin), // Λ/J_xx = Ĵω/J_xx
        }
    }

    /// Angular velocity **ω** = Ĵ⁻¹**Λ**.
    pub fn spin(&self, body: &Body) -> Vector {
        let axial = body.transverse / body.axial - 1.0;
        self.axis
            .mul_add(axial * self.precession.dot(self.axis), self.precession)
    }

    /// Kinetic energy of the translation, in m g R.
    pub fn translational_energy(&self) -> f64 {
        0.5 * self.velocity.dot(self.velocity)
    }

    /// Kinetic energy of the rotation **ω**·**Λ**/2, in m g R.
    pub fn rotational_energy(&self, body: &Body) -> f64 {
        0.5 * body.transverse * self.spin(body).dot(self.precession)
    }

    /// Kinetic energy, in m g R.
    pub fn kinetic_energy(&self, body: &Body) -> f64 {
        self.translational_energy() + self.rotational_energy(body)
    }

    /// Angle between the symmetry axis and the plane normal, in [0, π].
    pub fn angle(&self) -> f64 {
        elementary::angle(self.axis.horizontal(), self.axis.z)
    }

    /// Gaps between the plane and spheres 1 and 2; twice that of the body if only one part of it can touch.
    pub fn gaps(&self, body: &Body) -> [f64; 2] {
        Sphere::BOTH.map(|sphere| body.hull.gap(sphere, self.axis.z, self.lift)) // (2)
    }
}

/// One of the two spheres of the dumbbell; one of the two halves of an ellipsoid.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Sphere {
    /// The one to which the axis points: at +L/2 along it.
    One,
    /// The other one: at −L/2 along the axis.
    Two,
}

impl Sphere {
    /// Both, in order.
    pub const BOTH: [Self; 2] = [Self::One, Self::Two];

    /// The other one.
    pub fn other(self) -> Self {
        match self {
            Self::One => Self::Two,
            Self::Two => Self::One,
        }
    }

    /// +1 or −1: the side of the centre of mass on which the sphere sits.
    pub fn sign(self) -> f64 {
        match self {
            Self::One => 1.0,
            Self::Two => -1.0,
        }
    }
}
