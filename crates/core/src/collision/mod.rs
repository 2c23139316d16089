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
    normal_normal: f64,
    normal_along: f64,
    along_along: f64,
    across_across: f64,
}

impl Contact {
    /// The impulse that changes the contact velocity by `change`: K P = Δ**v**_c (10), solved.
    pub fn impulse(&self, change: Components) -> Components {
        let (nn, nu, uu) = (self.normal_normal, self.normal_along, self.along_along);
        let determinant = nn.mul_add(uu, -(nu * nu));
        Components {
            normal: uu.mul_add(change.normal, -(nu * change.along)) / determinant,
            along: nn.mul_add(change.along, -(nu * change.normal)) / determinant,
            across: change.across / self.across_across,
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
    let side = sphere.sign() * body.half_separation;
    let arm = axis.mul_add(side, Vector::new(0.0, 0.0, -1.0)); // r_c (6)
    let velocity = before.velocity + before.spin(body).cross(arm); // v_c (7)

    let sine = axis.horizontal();
    let along = if sine > UPRIGHT {
        Vector::new(axis.x / sine, axis.y / sine, 0.0)
    } else {
        Vector::new(1.0, 0.0, 0.0) // an upright axis has no horizontal direction, and none is needed
    };
    let across = Vector::new(-along.y, along.x, 0.0);

    let inverse = 1.0 / body.transverse;
    let reach = side * sine; // r_c · u
    let drop = arm.z; // r_c · n
    let twist = axis.z - side; // (r_c × w) across the axis
    let contact = Contact {
        slip: Components {
            normal: velocity.z.min(0.0), // a grazing contact may have turned around within the last step
            along: velocity.dot(along),
            across: velocity.dot(across),
        },
        normal_normal: (reach * reach).mul_add(inverse, 1.0),
        normal_along: -(reach * drop * inverse),
        along_along: (drop * drop).mul_add(inverse, 1.0),
        across_across: (twist * twist)
            .mul_add(inverse, (sine * sine).mul_add(1.0 / body.axial, 1.0)),
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
