//! The law of A. Chatterjee and A. Ruina, *A new algebraic rigid-body collision law based on impulse space considerations*,
//! J. Appl. Mech. **65**, 939 (1998).

use super::coulomb::{FRICTION, check_friction};
use super::{
    Compliant, Contact, Creation, ImpulseRule, LawKind, Response, Sliding, Slip, tangential,
};
use crate::Error;
use crate::describe::{Arguments, Kind};
use crate::math::Vector;
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
    tangential: f64,
    friction: f64,
}

impl ChatterjeeRuina {
    /// Its entry in the table of laws.
    pub(crate) const KIND: LawKind = LawKind {
        kind: Kind {
            name: "ChatterjeeRuina",
            text: "restitution along and across the normal, within the friction cone",
            parameters: &[tangential::parameter(0.0), FRICTION],
            make: |given| Ok(Self::new(given.number(0), given.number(1))?.into()),
        },
        creates_energy: Creation::Never,
        from_rest: Some([Slip::Part, Slip::Sliding]),
    };

    /// The law with the tangential coefficient e_t and the coefficient of friction μ.
    ///
    /// # Errors
    /// [`Error::Parameter`] for e_t outside [−1, 1] or μ outside [0, 10¹⁰⁰].
    pub fn new(tangential: f64, friction: f64) -> Result<Self, Error> {
        tangential::check(tangential)?;
        check_friction(friction)?;
        Ok(Self {
            tangential,
            friction,
        })
    }
}

impl ImpulseRule for ChatterjeeRuina {
    #[inline(always)]
    fn respond<S: Simd, const SPACE: bool>(
        &self,
        contact: &Contact<Pack<S>, impl Compliant<S> + Sliding<S>>,
        restitution: Pack<S>,
    ) -> Response<Pack<S>> {
        let speed = contact.approach_speed();
        let zero = Pack::splat(speed.simd(), 0.0);

        let (k, velocity) = (&contact.compliance, contact.velocity);
        let frictionless = speed / k.nn(); // P_I
        let [along, across] = k.pushed(frictionless, &velocity); // tangential contact velocity after P_I
        let stop = k.impulse::<SPACE>(Vector::new(-along, -across, zero)); // P_II − P_I
        let tangential = if SPACE {
            length(stop.x, stop.y)
        } else {
            stop.x.abs()
        };
        let most = restitution.mul_add(frictionless, frictionless);
        let excess = stop.z.mul_add(-self.friction, tangential);
        let wanted = 1.0 + self.tangential;
        let outside = (most * self.friction).lt(excess * wanted);
        let share = outside.select(most * self.friction / excess, wanted); // κ
        Response {
            impulse: Vector::new(share * stop.x, share * stop.y, share.mul_add(stop.z, most)),
            separation_speed: restitution * speed, // P_II − P_I does not change the normal contact velocity
        }
    }
}

/// √(a² + b²), also where the squares would underflow.
#[inline(always)]
fn length<S: Simd>(a: Pack<S>, b: Pack<S>) -> Pack<S> {
    let (a, b) = (a.abs(), b.abs());
    let (most, least) = (a.max(b), a.min(b));
    let ratio = least / most;
    least
        .eq(0.0)
        .select(most, most * ratio.mul_add(ratio, 1.0).sqrt())
}
