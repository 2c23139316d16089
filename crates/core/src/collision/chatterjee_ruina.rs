//! The law of A. Chatterjee and A. Ruina, *A new algebraic rigid-body collision law based on impulse space considerations*,
//! J. Appl. Mech. **65**, 939 (1998).

use super::{Components, Contact, Normal, Plane, Rebound, Response, length};
use crate::Error;
use crate::lanes::Pack;
use pulp::Simd;

/// P = (1 + e) P_I + κ (P_II − P_I), with P_I the impulse of a frictionless and P_II that of a sticking plastic impact, and
/// κ = 1 + e_t or, where that lies outside the friction cone |P_t| ≤ μ P_n, the κ at which P lies on it.
///
/// P_I and P_II − P_I are orthogonal with respect to the kinetic energy, so that it falls by
/// (1 − e²)|P_I|² + κ(2 − κ)|P_II − P_I|², halved, with |P|² = PᵀKP: as 0 ≤ κ ≤ 1 + e_t ≤ 2 it cannot grow. Without friction
/// (μ = 0) or for e_t = −1 this is [`super::Frictionless`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChatterjeeRuina<'a> {
    pub(super) normal: Normal<'a>,
    tangential: f64,
    friction: f64,
}

impl<'a> ChatterjeeRuina<'a> {
    /// e in [0, 1] or a function of the normal contact speed, e_t in [−1, 1], μ ≥ 0.
    pub fn new(
        normal: impl Into<Normal<'a>>,
        tangential: f64,
        friction: f64,
    ) -> Result<Self, Error> {
        let normal = normal.into().checked()?;
        Error::unless(
            (-1.0..=1.0).contains(&tangential),
            "tangential",
            tangential,
            "in [-1, 1]",
        )?;
        super::coulomb::check_friction(friction)?;
        Ok(Self {
            normal,
            tangential,
            friction,
        })
    }

    #[inline(always)]
    pub(super) fn in_plane<S: Simd, const K: usize>(&self, contact: &Plane<S, K>) -> Rebound<S, K> {
        let speed = contact.approach_speed();
        let restitution = self.normal.in_lanes(speed);
        let zero = Pack::splat(speed.simd(), 0.0);

        let frictionless = speed / contact.normal_response(); // P_I
        let left = contact.coupling().mul_add(frictionless, contact.slip_along); // slip after P_I
        let (normal, along) = contact.impulse(zero, -left); // P_II − P_I
        let most = restitution.mul_add(frictionless, frictionless);
        let excess = normal.mul_add(-self.friction, along.abs());
        let wanted = 1.0 + self.tangential;
        let outside = (most * self.friction).lt(excess * wanted);
        let share = outside.select(most * self.friction / excess, wanted); // κ
        Rebound {
            normal: share.mul_add(normal, most),
            along: share * along,
            separation_speed: restitution * speed, // P_II − P_I leaves the normal velocity alone
        }
    }

    pub(super) fn in_space(&self, contact: &Contact) -> Response {
        let plane = contact.plane();
        let speed = contact.slip.normal.abs();
        let restitution = self.normal.at(speed);

        let frictionless = speed / plane.normal_response().as_slice()[0]; // P_I
        let coupling = plane.coupling().as_slice()[0];
        let further = contact.impulse(Components {
            normal: 0.0,
            along: -coupling.mul_add(frictionless, contact.slip.along),
            across: -contact.slip.across,
        }); // P_II − P_I
        let most = restitution.mul_add(frictionless, frictionless);
        let tangential = length(further.along, further.across);
        let excess = further.normal.mul_add(-self.friction, tangential);
        let wanted = 1.0 + self.tangential;
        let share = if most * self.friction < excess * wanted {
            most * self.friction / excess
        } else {
            wanted
        }; // κ
        Response {
            impulse: Components {
                normal: share.mul_add(further.normal, most),
                along: share * further.along,
                across: share * further.across,
            },
            separation_speed: restitution * speed,
        }
    }
}
