//! The law without friction: **P** ∥ **n**.

use super::{Compliant, Contact, Creation, ImpulseRule, LawKind, Response, Sliding, Slip};
use crate::describe::Kind;
use crate::math::Vector;
use crate::simd::Pack;
use pulp::Simd;

/// An impulse along the plane normal only: P_n = (1 + ε_n)|v_c^n|/K_nn, so that v_c^n′ = −ε_n v_c^n.
///
/// It conserves the horizontal velocity of the centre of mass and the angular momentum about **n**. The kinetic energy decreases
/// by (1 − ε_n²)(v_c^n)²/(2 K_nn) ≥ 0. The hypotheses of Newton, Poisson and Stronge agree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Frictionless;

impl Frictionless {
    /// Its entry in the table of laws.
    pub(crate) const KIND: LawKind = LawKind {
        kind: Kind {
            name: "Frictionless",
            text: "an impulse along the plane normal only",
            parameters: &[],
            make: |_| Ok(Self.into()),
        },
        creates_energy: Creation::Never,
        from_rest: Some([Slip::Free, Slip::Free]),
    };

    /// P_n, where the coefficient is ε_n, from the speed of approach and K_nn.
    #[inline(always)]
    pub(crate) fn impulse<S: Simd>(
        coefficient: Pack<S>,
        speed: Pack<S>,
        compliance: Pack<S>,
    ) -> Pack<S> {
        coefficient.mul_add(speed, speed) / compliance
    }
}

impl ImpulseRule for Frictionless {
    #[inline(always)]
    fn respond<S: Simd, const SPACE: bool>(
        &self,
        contact: &Contact<Pack<S>, impl Compliant<S> + Sliding<S>>,
        normal: Pack<S>,
    ) -> Response<Pack<S>> {
        let speed = contact.approach_speed();
        Response {
            impulse: Vector {
                x: speed * 0.0,
                y: speed * 0.0,
                z: Self::impulse(normal, speed, contact.compliance.nn()),
            },
            separation_speed: normal * speed,
        }
    }
}
