//! The choice of a law.

use super::{
    ChatterjeeRuina, Components, Contact, Contacts, Coulomb, Frictionless, Normal, Response,
    Responses, TangentialRestitution, tangential::Steady,
};
use pulp::{Simd, WithSimd};

/// A collision law: what an impact does. Its normal coefficient may borrow a table.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Law<'a> {
    /// The paper's.
    TangentialRestitution(TangentialRestitution<'a>),
    /// Impulse along the plane normal alone.
    Frictionless(Frictionless<'a>),
    /// Dry friction.
    Coulomb(Coulomb<'a>),
    /// A bilinear law within the friction cone.
    ChatterjeeRuina(ChatterjeeRuina<'a>),
}

impl<'a> Law<'a> {
    /// The normal coefficient.
    pub fn normal(&self) -> Normal<'a> {
        match self {
            Self::TangentialRestitution(law) => law.normal,
            Self::Frictionless(law) => law.normal,
            Self::Coulomb(law) => law.normal,
            Self::ChatterjeeRuina(law) => law.normal,
        }
    }

    /// The law for speeds in this `unit`, in m/s, instead of m/s.
    pub fn scaled(&self, unit: f64) -> Self {
        self.with_normal(self.normal().scaled(unit))
    }

    /// The law with another normal coefficient, which has been checked.
    pub fn with_normal<'b>(&self, normal: Normal<'b>) -> Law<'b> {
        match *self {
            Self::TangentialRestitution(TangentialRestitution { tangential, .. }) => {
                Law::TangentialRestitution(TangentialRestitution { normal, tangential })
            }
            Self::Frictionless(_) => Law::Frictionless(Frictionless { normal }),
            Self::Coulomb(Coulomb {
                friction,
                hypothesis,
                ..
            }) => Law::Coulomb(Coulomb {
                normal,
                friction,
                hypothesis,
            }),
            Self::ChatterjeeRuina(ChatterjeeRuina {
                tangential,
                friction,
                ..
            }) => Law::ChatterjeeRuina(ChatterjeeRuina {
                normal,
                tangential,
                friction,
            }),
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
    pub(crate) fn steady(&self) -> Option<Steady<'a>> {
        match self {
            Self::TangentialRestitution(law) => law.steady(),
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
        match self.law {
            Law::TangentialRestitution(law) => law.respond::<S, K, SPACE>(self.contact),
            Law::Frictionless(law) => law.respond::<S, K, SPACE>(self.contact),
            Law::Coulomb(law) => law.respond::<S, K, SPACE>(self.contact),
            Law::ChatterjeeRuina(law) => law.respond::<S, K, SPACE>(self.contact),
        }
    }
}

impl<'a> From<TangentialRestitution<'a>> for Law<'a> {
    fn from(law: TangentialRestitution<'a>) -> Self {
        Self::TangentialRestitution(law)
    }
}

impl<'a> From<Frictionless<'a>> for Law<'a> {
    fn from(law: Frictionless<'a>) -> Self {
        Self::Frictionless(law)
    }
}

impl<'a> From<Coulomb<'a>> for Law<'a> {
    fn from(law: Coulomb<'a>) -> Self {
        Self::Coulomb(law)
    }
}

impl<'a> From<ChatterjeeRuina<'a>> for Law<'a> {
    fn from(law: ChatterjeeRuina<'a>) -> Self {
        Self::ChatterjeeRuina(law)
    }
}
