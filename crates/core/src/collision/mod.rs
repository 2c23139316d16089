//! WHAT: the instantaneous change of motion at an impact, (6)–(8), (11). One file a law.
//!
//! In the frame of **n**, of **u**, the horizontal direction of the axis, and of **w** = **n** × **u**, the matrix
//! K = I/m + [**r**_c]ᵀĴ⁻¹[**r**_c], which turns an impulse into the change of contact velocity (10), falls apart into a
//! 2×2 block {**n**, **u**} and a single entry for **w**. Where nothing slips along **w** every law is closed form, and its
//! formula is written once, in a function `in_plane` over any number of particles side by side ([`Plane`]).

mod chatterjee_ruina;
mod coulomb;
mod frictionless;
mod law;
mod normal;
mod plane;
mod series;
mod tangential;
mod turning;

pub use chatterjee_ruina::ChatterjeeRuina;
pub use coulomb::{Coulomb, Hypothesis};
pub use frictionless::Frictionless;
pub(crate) use law::InPlane;
pub use law::Law;
pub use normal::{Normal, Plastic, Tabulated, Viscoelastic};
pub(crate) use plane::{Plane, Rebound};
pub use tangential::TangentialRestitution;

use crate::body::Body;
use crate::lanes::Pack;
use crate::state::{Sphere, State};
use crate::vector::Vector;
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

/// What a law needs to know of a contact, in the core's units.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Velocity **v**_c of the point of contact (7), (8); `normal` ≤ 0.
    pub slip: Components,
    /// J_xx.
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
        let lane = |x| Pack::splat(Scalar::new(), x);
        let (normal, along) = self
            .plane()
            .impulse(lane(change.normal), lane(change.along));
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

    /// What of the contact lies in the vertical plane of the axis.
    fn plane(&self) -> Plane<Scalar, 1> {
        let lane = |x| Pack::splat(Scalar::new(), x);
        Plane {
            slip_normal: lane(self.slip.normal),
            slip_along: lane(self.slip.along),
            inertia: self.inertia,
            arm_normal: lane(self.arm_normal),
            arm_along: lane(self.arm_along),
        }
    }
}

/// What a law answers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Response {
    /// Impulse P on the particle.
    pub impulse: Components,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: f64,
}

/// √(a² + b²), also where the squares would underflow.
fn length(a: f64, b: f64) -> f64 {
    let (a, b) = (a.abs(), b.abs());
    let (most, least) = (a.max(b), a.min(b));
    if least == 0.0 {
        return most;
    }
    let ratio = least / most;
    most * ratio.mul_add(ratio, 1.0).sqrt()
}

/// The state after the impact of `sphere`, and the speed at which the point of contact leaves the plane.
pub fn collide(body: &Body, law: &Law<'_>, before: &State, sphere: Sphere) -> (State, f64) {
    let axis = before.axis;
    let ball = body.hull.ball(sphere, axis.z);
    let arm = axis.mul_add(ball.offset, Vector::new(0.0, 0.0, -ball.radius)); // r_c (6)
    let velocity = before.velocity + before.spin(body).cross(arm); // v_c (7)

    let sine = axis.horizontal();
    let along = if sine > UPRIGHT {
        Vector::new(axis.x / sine, axis.y / sine, 0.0)
    } else {
        Vector::new(1.0, 0.0, 0.0) // an upright axis has no horizontal direction, and none is needed
    };
    let across = Vector::new(-along.y, along.x, 0.0);

    let inverse = 1.0 / body.transverse;
    // What of r_c × w lies across the axis, and along it.
    let (twist, roll) = (ball.radius * axis.z - ball.offset, ball.radius * sine);
    let contact = Contact {
        slip: Components {
            normal: velocity.z.min(0.0), // a grazing contact may have turned around within the last step
            along: velocity.dot(along),
            across: velocity.dot(across),
        },
        inertia: body.transverse,
        arm_normal: arm.z,
        arm_along: ball.offset * sine,
        across: (twist * twist).mul_add(inverse, (roll * roll).mul_add(1.0 / body.axial, 1.0)),
    };
    let Response {
        impulse,
        separation_speed,
    } = law.respond(&contact);
    let impulse = along.mul_add(
        impulse.along,
        across.mul_add(impulse.across, Vector::new(0.0, 0.0, impulse.normal)),
    );
    let after = State {
        velocity: before.velocity + impulse, // (11)
        precession: arm.cross(impulse).mul_add(inverse, before.precession), // (11)
        ..*before
    };
    (after, separation_speed)
}

/// Below this sine of the tilt its square underflows.
const UPRIGHT: f64 = 1e-150;
