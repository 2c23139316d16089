//! The paper's law, (9): both components of the contact velocity change by a fixed factor.

use super::{Components, Contact, Law, Response};
use crate::Error;

/// Normal and tangential restitution of the contact velocity, (9).
///
/// With ε^t = 1 the tangential contact velocity is kept. For a body that is not a sphere this takes a tangential impulse,
/// which can do positive work: kinetic energy can grow. The law is not a frictionless one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentialRestitution {
    normal: f64,
    tangential: f64,
}

impl TangentialRestitution {
    /// ε^n in [0, 1], ε^t in [−1, 1].
    pub fn new(normal: f64, tangential: f64) -> Result<Self, Error> {
        Error::unless((0.0..=1.0).contains(&normal), "normal", normal, "in [0, 1]")?;
        Error::unless(
            (-1.0..=1.0).contains(&tangential),
            "tangential",
            tangential,
            "in [-1, 1]",
        )?;
        Ok(Self { normal, tangential })
    }

    /// ε^n.
    pub fn normal(&self) -> f64 {
        self.normal
    }

    /// ε^t.
    pub fn tangential(&self) -> f64 {
        self.tangential
    }
}

impl Law for TangentialRestitution {
    fn respond(&self, contact: &Contact) -> Response {
        let slip = contact.slip;
        let impulse = contact.impulse(Components {
            normal: -(1.0 + self.normal) * slip.normal,    // (9), (10)
            along: (self.tangential - 1.0) * slip.along,   // (9), (10)
            across: (self.tangential - 1.0) * slip.across, // (9), (10)
        });
        Response {
            impulse,
            separation_speed: -self.normal * slip.normal, // (9)
        }
    }
}
