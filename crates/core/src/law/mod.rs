//! The impulse of an impact, (9), (10): the contact as a law sees it, and one file per law.
//!
//! In the frame of **n**, of **u**, the horizontal direction of the axis, and of **w** = **n** × **u**, the matrix
//! K = I/m + \[**r**_c\]ᵀĴ⁻¹\[**r**_c\], which turns an impulse into the change of contact velocity (10), separates into a
//! 2×2 block {**n**, **u**} and a single entry for **w**. Each formula is written once, for any number of contacts side by side
//! (`Contacts`); terms along **w** are omitted where all motion is in the plane of **n** and **u**.

mod chatterjee_ruina;
mod compliance;
mod contact;
mod coulomb;
mod frictionless;
mod normal;
mod rule;
mod tangential;

pub use chatterjee_ruina::ChatterjeeRuina;
pub use compliance::Compliance;
pub(crate) use contact::{Contacts, Late, Responses};
pub use coulomb::{Coulomb, Hypothesis, MOST_FRICTION};
pub use frictionless::Frictionless;
pub use normal::{Normal, PADE_ABOVE, PADE_BELOW, Plastic, Points, Tabulated, Viscoelastic};
pub(crate) use rule::{Gradual, Respond};
pub use rule::{Law, Rule};
pub use tangential::TangentialRestitution;

use crate::math::Vector;
use crate::simd::one;
use pulp::Scalar;

/// Components along **n**, **u** and **w**.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Components {
    /// Along the plane normal.
    pub normal: f64,
    /// Along the horizontal direction of the symmetry axis.
    pub along: f64,
    /// Perpendicular to both.
    pub across: f64,
}

/// A contact as a law sees it, in the core's units.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Velocity **v**_c of the point of contact (7), (8); `normal` ≤ 0.
    pub slip: Components,
    /// Moment of inertia J_xx across the symmetry axis.
    pub inertia: f64,
    /// **r**_c along **n**.
    pub arm_normal: f64,
    /// **r**_c along **u**.
    pub arm_along: f64,
    /// The entry of K for **w**.
    pub across: f64,
}

impl Contact {
    /// The impulse that changes the contact velocity by `change`: K P = Δ**v**_c (10), solved as in (14).
    pub fn impulse(&self, change: Components) -> Components {
        let (normal, along) = self
            .in_lane()
            .impulse(one(change.normal), one(change.along));
        Components {
            normal: normal.as_slice()[0],
            along: along.as_slice()[0],
            across: change.across / self.across,
        }
    }

    /// The change of the contact velocity by an impulse, K P (10).
    pub fn change(&self, impulse: Components) -> Components {
        let (n, u, j) = (self.arm_normal, self.arm_along, self.inertia);
        let torque = n.mul_add(impulse.along, -(u * impulse.normal)) / j;
        Components {
            normal: u.mul_add(-torque, impulse.normal),
            along: n.mul_add(torque, impulse.along),
            across: self.across * impulse.across,
        }
    }

    /// The contact in a single lane.
    pub(super) fn in_lane(&self) -> Contacts<Scalar, 1> {
        let slip = [self.slip.normal, self.slip.along, self.slip.across];
        let arm = [self.arm_normal, self.arm_along];
        Contacts::in_space(slip.map(one), self.inertia, arm.map(one), one(self.across))
    }
}

/// The outcome of a collision law, in the core's units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Impulse **P** on the particle (10).
    pub impulse: Components,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: f64,
}

/// The outcome of a collision law for any compliance, in the units of compliance and velocity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    /// Impulse **P** on the body (10).
    pub impulse: Vector,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: f64,
}
