//! The paper's law, (9): both components of the contact velocity change by a fixed factor.

use super::{
    Compliant, Components, Contact, Creation, ImpulseRule, LawKind, Respond, Response, Sliding,
    Slip,
};
use crate::Error;
use crate::describe::{Argument, Arguments, Interval, Kind, Parameter};
use crate::simd::{Operand, Pack};
use pulp::Simd;

/// Normal and tangential restitution of the contact velocity, (9).
///
/// With ε_t = 1 it conserves the tangential contact velocity, which is not the absence of friction: for a non-spherical body it
/// requires a tangential impulse. That impulse can do positive work, so that the kinetic energy can grow, and it may lie outside
/// the friction cone of any coefficient of friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TangentialRestitution {
    tangential: f64,
}

impl TangentialRestitution {
    /// Its entry in the table of laws.
    pub(crate) const KIND: LawKind = LawKind {
        kind: Kind {
            name: "TangentialRestitution",
            text: "both components of the contact velocity change by a fixed factor",
            parameters: &[Parameter::number(
                "tangential",
                "tangential coefficient of restitution",
                "1",
                Interval::from(-1.0, 1.0),
                1.0,
            )
            .or(Argument::Number(1.0))],
            make: |given| Ok(Self::new(given.number(0))?.into()),
        },
        creates_energy: Creation::Possible,
        from_rest: Some([Slip::Stuck, Slip::Stuck]),
    };

    /// The law with ε_t in [−1, 1].
    ///
    /// # Errors
    /// [`Error::Parameter`] for ε_t outside [−1, 1].
    pub fn new(tangential: f64) -> Result<Self, Error> {
        Error::unless(
            (-1.0..=1.0).contains(&tangential),
            "tangential",
            tangential,
            "in [-1, 1]",
        )?;
        Ok(Self { tangential })
    }

    /// The response for `rebound` = −ε_n and `change` = −(1 + ε_n).
    #[inline(always)]
    fn with<S: Simd, const SPACE: bool>(
        &self,
        rebound: impl Operand<S, 1>,
        change: impl Operand<S, 1>,
        contact: &Contact<Pack<S, 1>, impl Compliant<S>>,
    ) -> Response<Pack<S, 1>> {
        let velocity = contact.velocity;
        Response {
            impulse: contact.compliance.impulse::<SPACE>(Components {
                normal: velocity.normal * change,                  // (9), (10)
                along: (self.tangential - 1.0) * velocity.along,   // (9), (10)
                across: (self.tangential - 1.0) * velocity.across, // (9), (10)
            }),
            separation_speed: velocity.normal * rebound, // (9)
        }
    }
}

impl ImpulseRule for TangentialRestitution {
    #[inline(always)]
    fn respond<S: Simd, const SPACE: bool>(
        &self,
        contact: &Contact<Pack<S, 1>, impl Compliant<S> + Sliding<S>>,
        normal: Pack<S, 1>,
    ) -> Response<Pack<S, 1>> {
        self.with::<S, SPACE>(-normal, -(normal + 1.0), contact)
    }
}

/// The law with a constant ε_n, inlined in the bounce loop, because the paper's runs use it.
pub(crate) struct Steady {
    pub(super) normal: f64,
    pub(super) rule: TangentialRestitution,
}

impl Respond for Steady {
    #[inline(always)]
    fn scatters(&self) -> bool {
        false
    }

    #[inline(always)]
    fn respond_all<S: Simd, const SPACE: bool>(
        &self,
        contacts: &[Contact<Pack<S, 1>>],
        _: &[Pack<S, 1>],
        responses: &mut [Response<Pack<S, 1>>],
    ) {
        for (contact, response) in contacts.iter().zip(responses) {
            *response = self
                .rule
                .with::<S, SPACE>(-self.normal, -(1.0 + self.normal), contact);
        }
    }
}
