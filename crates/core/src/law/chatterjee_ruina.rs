//! The law of A. Chatterjee and A. Ruina, *A new algebraic rigid-body collision law based on impulse space considerations*,
//! J. Appl. Mech. **65**, 939 (1998).

use super::{Contacts, Responses};
use crate::Error;
use crate::simd::Pack;
use pulp::Simd;

/// **P** = (1 + e) **P**_I + κ (**P**_II − **P**_I), with e = ε_n, **P**_I the impulse of a perfectly plastic impact without
/// friction, **P**_II that of a perfectly plastic impact that sticks, and κ = 1 + e_t or, where that lies outside the friction cone
/// |P_t| ≤ μ P_n, the κ for which **P** lies on the cone.
///
/// **P**_I and **P**_II − **P**_I are orthogonal with respect to the kinetic energy, which therefore decreases by
/// [(1 − e²)|**P**_I|² + κ(2 − κ)|**P**_II − **P**_I|²]/2 with |**P**|² = **P**ᵀK**P**. Since 0 ≤ κ ≤ 1 + e_t ≤ 2, it cannot grow.
/// Without friction (μ = 0) or for e_t = −1 the law is [`super::Frictionless`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChatterjeeRuina {
    pub(super) tangential: f64,
    pub(super) friction: f64,
}

impl ChatterjeeRuina {
    /// The law with the tangential coefficient e_t and the coefficient of friction μ.
    ///
    /// # Errors
    /// [`Error::Parameter`] for e_t outside [−1, 1] or μ outside [0, 10¹⁰⁰].
    pub fn new(tangential: f64, friction: f64) -> Result<Self, Error> {
        Error::unless(
            (-1.0..=1.0).contains(&tangential),
            "tangential",
            tangential,
            "in [-1, 1]",
        )?;
        super::coulomb::check_friction(friction)?;
        Ok(Self {
            tangential,
            friction,
        })
    }

    #[inline(always)]
    pub(super) fn respond<S: Simd, const K: usize, const SPACE: bool>(
        &self,
        contact: &Contacts<S, K>,
        restitution: Pack<S, K>,
    ) -> Responses<S, K> {
        let speed = contact.approach_speed();
        let zero = Pack::splat(speed.simd(), 0.0);

        let frictionless = speed / contact.normal_response(); // P_I
        let left = contact.coupling().mul_add(frictionless, contact.slip_along); // tangential contact velocity after P_I
        let (normal, along) = contact.impulse(zero, -left); // P_II − P_I
        let (across, tangential) = if SPACE {
            let across = -contact.slip_across / contact.across_response();
            (across, length(along, across))
        } else {
            (zero, along.abs())
        };
        let most = restitution.mul_add(frictionless, frictionless);
        let excess = normal.mul_add(-self.friction, tangential);
        let wanted = 1.0 + self.tangential;
        let outside = (most * self.friction).lt(excess * wanted);
        let share = outside.select(most * self.friction / excess, wanted); // κ
        Responses {
            normal: share.mul_add(normal, most),
            along: share * along,
            across: share * across,
            separation_speed: restitution * speed, // P_II − P_I does not change the normal contact velocity
        }
    }
}

/// √(a² + b²), also where the squares would underflow.
#[inline(always)]
fn length<S: Simd, const K: usize>(a: Pack<S, K>, b: Pack<S, K>) -> Pack<S, K> {
    let (a, b) = (a.abs(), b.abs());
    let (most, least) = (a.max(b), a.min(b));
    let ratio = least / most;
    least
        .eq(0.0)
        .select(most, most * ratio.mul_add(ratio, 1.0).sqrt())
}
