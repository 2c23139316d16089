//! The paper's law, (9): both components of the contact velocity change by a fixed factor.

use super::{Compliant, Contact, Creation, ImpulseRule, LawKind, Respond, Response, Sliding, Slip};
use crate::Error;
use crate::describe::{Argument, Arguments, Interval, Kind, Parameter};
use crate::math::Vector;
use crate::simd::Pack;
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
            parameters: &[parameter(1.0).or(Argument::Number(1.0))],
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
        check(tangential)?;
        Ok(Self { tangential })
    }
}

/// A tangential coefficient among the parameters of a law.
pub(super) const fn parameter(example: f64) -> Parameter {
    Parameter::number(
        "tangential",
        "tangential coefficient of restitution",
        "1",
        Interval::from(-1.0, 1.0),
        example,
    )
}

pub(super) fn check(tangential: f64) -> Result<(), Error> {
    let holds = (-1.0..=1.0).contains(&tangential);
    Error::unless(holds, "tangential", tangential, "in [-1, 1]")
}

impl ImpulseRule for TangentialRestitution {
    #[inline(always)]
    fn respond<S: Simd, const SPACE: bool>(
        &self,
        contact: &Contact<Pack<S>, impl Compliant<S> + Sliding<S>>,
        normal: Pack<S>,
    ) -> Response<Pack<S>> {
        let velocity = contact.velocity;
        Response {
            impulse: contact.compliance.impulse::<SPACE>(Vector {
                x: (self.tangential - 1.0) * velocity.x, // (9), (10)
                y: (self.tangential - 1.0) * velocity.y, // (9), (10)
                z: velocity.z * -(normal + 1.0),         // (9), (10)
            }),
            separation_speed: velocity.z * -normal, // (9)
        }
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
        contacts: &[Contact<Pack<S>>],
        _: &[Pack<S>],
        responses: &mut [Response<Pack<S>>],
    ) {
        for (contact, response) in contacts.iter().zip(responses) {
            let normal = Pack::splat(contact.velocity.z.simd(), self.normal);
            *response = self.rule.respond::<S, SPACE>(contact, normal);
        }
    }
}
