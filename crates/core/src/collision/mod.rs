//! WHAT: the instantaneous change of motion at an impact, (6)–(8), (11). One file a law.
//!
//! In the frame of **n**, of **u**, the horizontal direction of the axis, and of **w** = **n** × **u**, the matrix
//! K = I/m + [**r**_c]ᵀĴ⁻¹[**r**_c], which turns an impulse into the change of contact velocity (10), falls apart into a
//! 2×2 block {**n**, **u**} and a single entry for **w**. Every law below is closed form.

mod tangential;

pub use tangential::TangentialRestitution;

use crate::body::Body;
use crate::state::{Sphere, State};
use crate::vector::Vector;

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

/// What a law needs to know of a contact.
#[derive(Debug, Clone, Copy)]
pub struct Contact {
    /// Velocity **v**_c of the point of contact (7), (8); `normal` ≤ 0.
    pub slip: Components,
    /// J_xx.
    inertia: f64,
    /// **r**_c along **n** and **u**.
    arm_normal: f64,
    arm_along: f64,
    /// The entry of K for **w**.
    across: f64,
}

impl Contact {
    /// The impulse that changes the contact velocity by `change`: K P = Δ**v**_c (10), solved as in (14).
    pub fn impulse(&self, change: Components) -> Components {
        let (n, u, j) = (self.arm_normal, self.arm_along, self.inertia);
        let inverse = 1.0 / u.mul_add(u, n.mul_add(n, j)); // 1/(J_xx/m + r_c²)
        let cross = n * u;
        Components {
            normal: n.mul_add(n, j).mul_add(change.normal, cross * change.along) * inverse, // (14)
            along: u.mul_add(u, j).mul_add(change.along, cross * change.normal) * inverse,  // (14)
            across: change.across / self.across,
        }
    }
}

/// What a law answers.
#[derive(Debug, Clone, Copy)]
pub struct Response {
    /// Impulse P on the particle.
    pub impulse: Components,
    /// Normal velocity of the point of contact after the impact, ≥ 0.
    pub separation_speed: f64,
}

/// A collision law.
pub trait Law: Sync {
    /// The response to a contact.
    fn respond(&self, contact: &Contact) -> Response;
}

/// The state after the impact of `sphere`, and the speed at which the point of contact leaves the plane.
pub fn collide(body: &Body, law: &impl Law, before: &State, sphere: Sphere) -> (State, f64) {
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
