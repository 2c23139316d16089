//! The paper's law, (9): both components of the contact velocity change by a fixed factor.

use super::{Contact, Normal, Plane, Rebound};
use crate::Error;
use crate::lanes::Pack;
use pulp::Simd;

/// Normal and tangential restitution of the contact velocity, (9).
///
/// It conserves what the plane cannot touch: nothing of the motion but the tangential contact velocity, for ε^t = 1. For a body
/// that is not a sphere this takes a tangential impulse, which can do positive work, so that kinetic energy can grow, and which
/// may lie outside every friction cone. The law is not a frictionless one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentialRestitution<'a> {
    pub(super) normal: Normal<'a>,
    tangential: f64,
}

impl<'a> TangentialRestitution<'a> {
    /// ε^n in [0, 1] or a function of the normal contact speed, ε^t in [−1, 1].
    pub fn new(normal: impl Into<Normal<'a>>, tangential: f64) -> Result<Self, Error> {
        let normal = normal.into().checked()?;
        Error::unless(
            (-1.0..=1.0).contains(&tangential),
            "tangential",
            tangential,
            "in [-1, 1]",
        )?;
        Ok(Self { normal, tangential })
    }

    /// ε^t.
    pub fn tangential(&self) -> f64 {
        self.tangential
    }

    #[inline(always)]
    pub(super) fn in_plane<S: Simd, const K: usize>(&self, contact: &Plane<S, K>) -> Rebound<S, K> {
        self.with(self.normal.in_lanes(contact.approach_speed()), contact)
    }

    /// The response with this ε^n.
    #[inline(always)]
    pub(super) fn with<S: Simd, const K: usize>(
        &self,
        restitution: Pack<S, K>,
        contact: &Plane<S, K>,
    ) -> Rebound<S, K> {
        let (normal, along) = contact.impulse(
            -(restitution + 1.0) * contact.slip_normal,   // (9), (10)
            (self.tangential - 1.0) * contact.slip_along, // (9), (10)
        );
        Rebound {
            normal,
            along,
            separation_speed: -restitution * contact.slip_normal, // (9)
        }
    }

    /// Impulse along **w**.
    pub(super) fn across(&self, contact: &Contact) -> f64 {
        (self.tangential - 1.0) * contact.slip.across / contact.across // (9), (10)
    }
}
