//! The choice of a law.

use super::{
    Answer, ChatterjeeRuina, Compliance, Components, Contact, Contacts, Coulomb, Frictionless,
    Late, Normal, Response, Responses, TangentialRestitution, tangential::Steady,
};
use crate::Error;
use crate::math::Vector;
use pulp::{Simd, WithSimd};

/// A collision law: a normal coefficient, which may borrow a table, and a rule for the impulse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<'a> {
    /// The normal coefficient ε_n.
    pub normal: Normal<'a>,
    /// The impulse that follows from a contact and ε_n.
    pub rule: Rule,
}

/// The rule by which the impulse follows from a contact and a normal coefficient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// The paper's law (9).
    TangentialRestitution(TangentialRestitution),
    /// An impulse along the plane normal only.
    Frictionless(Frictionless),
    /// Coulomb friction.
    Coulomb(Coulomb),
    /// The law of Chatterjee and Ruina, within the friction cone.
    ChatterjeeRuina(ChatterjeeRuina),
}

impl<'a> Law<'a> {
    /// The law with ε_n, a constant in [0, 1] or a function of the normal contact speed, and a rule.
    ///
    /// # Errors
    /// [`Error::Parameter`] for a constant ε_n outside [0, 1].
    pub fn new(normal: impl Into<Normal<'a>>, rule: impl Into<Rule>) -> Result<Self, Error> {
        Ok(Self {
            normal: normal.into().checked()?,
            rule: rule.into(),
        })
    }

    /// The same law for speeds that are given in multiples of `unit` (in m/s) instead of m/s.
    pub fn scaled(&self, unit: f64) -> Self {
        Self {
            normal: self.normal.scaled(unit),
            rule: self.rule,
        }
    }

    /// The impulse of a contact, and its normal velocity after the impact.
    pub fn respond(&self, contact: &Contact) -> Response {
        let found = Respond::respond::<_, 1, true>(self, &contact.in_lane());
        Response {
            impulse: Components {
                normal: found.normal.as_slice()[0],
                along: found.along.as_slice()[0],
                across: found.across.as_slice()[0],
            },
            separation_speed: found.separation_speed.as_slice()[0],
        }
    }

    /// The impulse for any compliance, of a contact that arrives with this velocity in the frame whose z axis is the normal, z ≤ 0.
    pub fn answer(&self, compliance: &Compliance, velocity: Vector) -> Answer {
        // One that leaves only touches.
        let velocity = Vector::new(velocity.x, velocity.y, velocity.z.min(0.0));
        let normal = self.normal.at(velocity.z.abs());
        match &self.rule {
            Rule::TangentialRestitution(rule) => rule.answer(compliance, velocity, normal),
            Rule::Frictionless(rule) => rule.answer(compliance, velocity, normal),
            Rule::Coulomb(rule) => rule.answer(compliance, velocity, normal),
            Rule::ChatterjeeRuina(rule) => rule.answer(compliance, velocity, normal),
        }
    }

    /// The law as [`Steady`], if it is the paper's with a constant ε_n.
    pub(crate) fn steady(&self) -> Option<Steady> {
        match (self.rule, self.normal) {
            (Rule::TangentialRestitution(rule), Normal::Constant(normal)) => {
                Some(Steady { normal, rule })
            }
            _ => None,
        }
    }
}

/// A law in the form that the bounce loop uses.
pub(crate) trait Respond {
    /// The responses to contacts. Without `SPACE` the contact velocity has no component along **w**.
    fn respond<S: Simd, const K: usize, const SPACE: bool>(
        &self,
        contact: &Contacts<S, K>,
    ) -> Responses<S, K>;

    /// The law in two steps, if in space some responses take much longer than others.
    fn takes_long(&self) -> Option<Gradual<'_>>;
}

/// A law whose responses may take long, in two steps.
#[derive(Clone, Copy)]
pub(crate) struct Gradual<'a> {
    normal: &'a Normal<'a>,
    rule: &'a Coulomb,
}

impl Gradual<'_> {
    /// The responses that do not take long.
    #[inline(always)]
    pub fn begin<S: Simd>(&self, contact: &Contacts<S, 1>) -> Late<S> {
        let simd = contact.slip_normal.simd();
        simd.vectorize(Begin {
            law: *self,
            contact,
        })
    }

    /// The others, of as many vectors as there are.
    #[inline(always)]
    pub fn finish<S: Simd>(&self, late: &mut [Late<S>]) {
        self.rule.finish(late);
    }
}

/// [`Gradual::begin`], to be compiled once for all hulls.
struct Begin<'a, S: Simd> {
    law: Gradual<'a>,
    contact: &'a Contacts<S, 1>,
}

impl<S: Simd> WithSimd for Begin<'_, S> {
    type Output = Late<S>;

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) -> Late<S> {
        let Self { law, contact } = self;
        let normal = law.normal.in_lanes(contact.approach_speed());
        law.rule.begin(contact, normal)
    }
}

impl Respond for Law<'_> {
    /// Chooses the law in a function of its own: inlined, all laws together would use up the registers of the bounce loop.
    #[inline(always)]
    fn respond<S: Simd, const K: usize, const SPACE: bool>(
        &self,
        contact: &Contacts<S, K>,
    ) -> Responses<S, K> {
        let simd = contact.slip_normal.simd();
        simd.vectorize(Choice::<S, K, SPACE> { law: self, contact })
    }

    #[inline(always)]
    fn takes_long(&self) -> Option<Gradual<'_>> {
        match &self.rule {
            Rule::Coulomb(rule) if rule.friction() > 0.0 => Some(Gradual {
                normal: &self.normal,
                rule,
            }),
            _ => None,
        }
    }
}

/// A law and the contacts that it is applied to, compiled for each SIMD level.
struct Choice<'a, 'b, S: Simd, const K: usize, const SPACE: bool> {
    law: &'a Law<'b>,
    contact: &'a Contacts<S, K>,
}

impl<S: Simd, const K: usize, const SPACE: bool> WithSimd for Choice<'_, '_, S, K, SPACE> {
    type Output = Responses<S, K>;

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) -> Self::Output {
        let Self { law, contact } = self;
        let normal = law.normal.in_lanes(contact.approach_speed());
        match &law.rule {
            Rule::TangentialRestitution(rule) => rule.respond::<S, K, SPACE>(contact, normal),
            Rule::Frictionless(rule) => rule.respond(contact, normal),
            Rule::Coulomb(rule) => rule.respond::<S, K, SPACE>(contact, normal),
            Rule::ChatterjeeRuina(rule) => rule.respond::<S, K, SPACE>(contact, normal),
        }
    }
}

impl From<TangentialRestitution> for Rule {
    fn from(rule: TangentialRestitution) -> Self {
        Self::TangentialRestitution(rule)
    }
}

impl From<Frictionless> for Rule {
    fn from(rule: Frictionless) -> Self {
        Self::Frictionless(rule)
    }
}

impl From<Coulomb> for Rule {
    fn from(rule: Coulomb) -> Self {
        Self::Coulomb(rule)
    }
}

impl From<ChatterjeeRuina> for Rule {
    fn from(rule: ChatterjeeRuina) -> Self {
        Self::ChatterjeeRuina(rule)
    }
}
