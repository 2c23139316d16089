//! The choice of a law.

use super::{
    Compliance, Contact, CustomLaw, Frictionless, ImpulseFunction, MOST_CONTACTS, Material, Normal,
    Respond, Response, Rule, coulomb::Turning, tangential::Steady,
};
use crate::Error;
use crate::Fault;
use crate::math::Vector;
use crate::simd::{Lanewise, Pack, one};
use pulp::{Scalar, Simd, WithSimd};

/// A collision law: a normal coefficient, which may borrow a table and may scatter, and a rule for the impulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<'a> {
    /// The normal coefficient ε_n.
    pub normal: Normal<'a>,
    /// The standard deviation with which ε_n scatters before truncation to [0, 1]; 0 if it does not.
    pub deviation: f64,
    /// The impulse that follows from a contact and ε_n.
    pub rule: Rule,
    /// A law of one's own, which takes the place of coefficient and rule.
    pub custom: Option<CustomLaw<'a>>,
}

/// Makes the rule that is one of these laws, and the table of them.
macro_rules! laws {
    ($($(#[$text:meta])* $law:ident),* $(,)?) => {
        /// The rule by which the impulse follows from a contact and a normal coefficient.
        #[derive(Debug, Clone, Copy, PartialEq)]
        pub enum Rule {
            $($(#[$text])* $law($law)),*
        }

        /// Every law.
        pub const LAWS: &[LawKind] = &[$($law::KIND),*];

        impl Rule {
            /// The response to a contact in each lane.
            #[inline(always)]
            fn respond<S: Simd, const SPACE: bool>(
                &self,
                contact: &Contact<Pack<S>, impl Compliant<S> + Sliding<S>>,
                normal: Pack<S>,
            ) -> Response<Pack<S>> {
                match self {
                    $(Self::$law(law) => law.respond::<S, SPACE>(contact, normal)),*
                }
            }

            /// The responses to vectors of contacts of bodies of revolution.
            #[inline(always)]
            fn respond_all<S: Simd, const SPACE: bool>(
                &self,
                contacts: &[Contact<Pack<S>>],
                normal: &[Pack<S>],
                responses: &mut [Response<Pack<S>>],
            ) {
                match self {
                    $(Self::$law(law) => {
                        for (i, (contact, response)) in contacts.iter().zip(responses).enumerate() {
                            *response = law.respond::<S, SPACE>(contact, normal[i]);
                        }
                    }),*
                }
            }
        }

        $(impl From<$law> for Rule {
            fn from(law: $law) -> Self {
                Self::$law(law)
            }
        })*
    };
}
pub(super) use laws;

impl<'a> Law<'a> {
    /// The law with ε_n, a constant in [0, 1] or a function of the normal contact speed, and a rule.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a constant ε_n outside [0, 1].
    pub fn new(normal: impl Into<Normal<'a>>, rule: impl Into<Rule>) -> Result<Self, Error> {
        Ok(Self {
            normal: normal.into().checked()?,
            deviation: 0.0,
            rule: rule.into(),
            custom: None,
        })
    }

    /// The law that asks a function.
    pub fn custom(function: &'a dyn ImpulseFunction) -> Self {
        Self {
            normal: Normal::Constant(1.0),
            deviation: 0.0,
            rule: Frictionless.into(),
            custom: Some(CustomLaw::new(function)),
        }
    }

    /// The same law for contacts in multiples of these units, in m/s and kg, instead of SI units.
    pub fn scaled(&self, speed: f64, mass: f64) -> Self {
        Self {
            normal: self.normal.scaled(speed),
            custom: self.custom.map(|law| law.scaled(speed, mass)),
            ..*self
        }
    }

    /// The law of a material with this rule.
    pub fn of(material: &'a Material, rule: Rule) -> Self {
        Self {
            normal: material.normal(),
            deviation: material.deviation(),
            rule,
            custom: None,
        }
    }

    /// The impulse of a contact, and its normal velocity after the impact, with ε_n as it is where it does not scatter. A law of one's
    /// own is not asked, but [`Law::answer`].
    pub fn respond(&self, contact: &Contact) -> Response {
        let mut found = [Response::none(Scalar::new())];
        let steady = Self {
            deviation: 0.0,
            ..*self
        };
        steady.respond_all::<_, true>(&[contact.map(one)], &[], &mut found);
        found[0].lane(0)
    }

    /// The impulse for any compliance, of a contact that arrives with this velocity in the frame whose z axis is the normal, z ≤ 0;
    /// ε_n as in [`Self::respond`].
    ///
    /// # Errors
    /// [`Fault`] if a law of one's own gives no impulse that is possible.
    pub fn answer(&self, compliance: &Compliance, velocity: Vector) -> Result<Response, Fault> {
        self.answer_drawn(compliance, velocity, None)
    }

    /// The same, and where ε_n scatters with a uniform number in (0, 1).
    #[inline(always)]
    pub(crate) fn answer_drawn(
        &self,
        compliance: &Compliance,
        velocity: Vector,
        chance: Option<f64>,
    ) -> Result<Response, Fault> {
        // One that leaves only touches.
        let velocity = Vector::new(velocity.x, velocity.y, velocity.z.min(0.0));
        if let Some(law) = &self.custom {
            return law.answer(compliance, velocity);
        }
        let contact = Contact {
            velocity: velocity.in_lane(),
            compliance: *compliance,
        };
        let normal = self.coefficient(one(velocity.z.abs()), chance.map(one));
        Ok(self.rule.respond::<_, true>(&contact, normal).lane(0))
    }

    /// ε_n at a speed, where it scatters with uniform numbers in (0, 1).
    #[inline(always)]
    pub(crate) fn coefficient<S: Simd>(&self, speed: Pack<S>, chances: Option<Pack<S>>) -> Pack<S> {
        match chances {
            Some(chances) => self.normal.apart(speed, Some((self.deviation, chances))),
            None => self.normal.in_lanes(speed),
        }
    }

    /// The law as [`Steady`], if it is the paper's with the same ε_n for all impacts.
    pub(crate) fn steady(&self) -> Option<Steady> {
        match (self.rule, self.normal) {
            (Rule::TangentialRestitution(rule), Normal::Constant(normal)) if !self.scatters() => {
                Some(Steady { normal, rule })
            }
            _ => None,
        }
    }
}

impl Respond for Law<'_> {
    #[inline(always)]
    fn scatters(&self) -> bool {
        self.deviation > 0.0
    }

    /// Chooses the law in a function of its own: inlined, all laws together would use up the registers of the bounce loop.
    #[inline(always)]
    fn respond_all<S: Simd, const SPACE: bool>(
        &self,
        contacts: &[Contact<Pack<S>>],
        chances: &[Pack<S>],
        responses: &mut [Response<Pack<S>>],
    ) {
        let Some(first) = contacts.first() else {
            return;
        };
        first.velocity.z.simd().vectorize(Choice::<S, SPACE> {
            law: self,
            contacts,
            chances,
            responses,
        });
    }

    #[inline(always)]
    fn custom(&self) -> Option<CustomLaw<'_>> {
        self.custom
    }
}

/// A law and the contacts that it is applied to, compiled for each SIMD level.
struct Choice<'a, 'b, S: Simd, const SPACE: bool> {
    law: &'a Law<'b>,
    contacts: &'a [Contact<Pack<S>>],
    chances: &'a [Pack<S>],
    responses: &'a mut [Response<Pack<S>>],
}

impl<S: Simd, const SPACE: bool> WithSimd for Choice<'_, '_, S, SPACE> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) {
        let (law, contacts) = (self.law, self.contacts);
        let simd = contacts[0].velocity.z.simd();
        let mut normal = [Pack::splat(simd, 0.0); MOST_CONTACTS];
        for (i, contact) in contacts.iter().enumerate() {
            let chances = law.scatters().then(|| self.chances[i]);
            normal[i] = law.coefficient(contact.approach_speed(), chances);
        }
        match &law.rule {
            Rule::Coulomb(rule) if SPACE && rule.turns() => simd.vectorize(Turning {
                rule,
                contacts,
                restitution: &normal,
                responses: self.responses,
            }),
            rule => rule.respond_all::<S, SPACE>(contacts, &normal, self.responses),
        }
    }
}
