//! The choice of a law.

use super::{
    ChatterjeeRuina, Components, Contact, Contacts, Coulomb, Frictionless, Normal, Response,
    Responses, TangentialRestitution, tangential::Steady,
};
use crate::Error;
use pulp::{Simd, WithSimd};

/// A collision law: what an impact does. Its normal coefficient may borrow a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Law<'a> {
    /// ε_n.
    pub normal: Normal<'a>,
    /// All else.
    pub rule: Rule,
}

/// What a law makes of a contact and a normal coefficient.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Rule {
    /// The paper's.
    TangentialRestitution(TangentialRestitution),
    /// Impulse along the plane normal alone.
    Frictionless(Frictionless),
    /// Dry friction.
    Coulomb(Coulomb),
    /// A bilinear law within the friction cone.
    ChatterjeeRuina(ChatterjeeRuina),
}

impl<'a> Law<'a> {
    /// Of ε_n in [0, 1], or a function of the normal contact speed, and a rule.
    pub fn new(normal: impl Into<Normal<'a>>, rule: impl Into<Rule>) -> Result<Self, Error> {
        Ok(Self {
            normal: normal.into().checked()?,
            rule: rule.into(),
        })
    }

    /// The law for speeds in this `unit`, in m/s, instead of m/s.
    pub fn scaled(&self, unit: f64) -> Self {
        Self {
            normal: self.normal.scaled(unit),
            rule: self.rule,
        }
    }

    /// The response to a contact.
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

    /// The paper's law with a constant ε_n, if it is that.
    pub(crate) fn steady(&self) -> Option<Steady> {
        match (self.rule, self.normal) {
            (Rule::TangentialRestitution(rule), Normal::Constant(normal)) => {
                Some(Steady { normal, rule })
            }
            _ => None,
        }
    }
}

/// A law as the bounce loop takes it.
pub(crate) trait Respond {
    /// The responses to contacts. Unless in `SPACE`, nothing slips across the plane of the axis.
    fn respond<S: Simd, const K: usize, const SPACE: bool>(
        &self,
        contact: &Contacts<S, K>,
    ) -> Responses<S, K>;
}

impl Respond for Law<'_> {
    /// A call that chooses the law: written out in the bounce loop, all of them would crowd it.
    #[inline(always)]
    fn respond<S: Simd, const K: usize, const SPACE: bool>(
        &self,
        contact: &Contacts<S, K>,
    ) -> Responses<S, K> {
        let simd = contact.slip_normal.simd();
        simd.vectorize(Choice::<S, K, SPACE> { law: self, contact })
    }
}

/// A law and the contacts that it is to answer, to be compiled for each SIMD level.
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
