//! The choice of a law.

use super::{
    ChatterjeeRuina, Components, Contact, Coulomb, Frictionless, Normal, Plane, Rebound, Response,
    TangentialRestitution, tangential::Steady,
};
use crate::scales::Scales;
use pulp::{Scalar, Simd, WithSimd};

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

    /// The law for speeds in the unit of `scales` instead of m/s.
    pub fn scaled(&self, scales: &Scales) -> Self {
        let mut law = *self;
        let normal = match &mut law {
            Self::TangentialRestitution(law) => &mut law.normal,
            Self::Frictionless(law) => &mut law.normal,
            Self::Coulomb(law) => &mut law.normal,
            Self::ChatterjeeRuina(law) => &mut law.normal,
        };
        *normal = normal.scaled(scales);
        law
    }

    /// The response to a contact.
    pub fn respond(&self, contact: &Contact) -> Response {
        if contact.slip.across == 0.0 {
            return planar(self.in_plane(&contact.plane()));
        }
        match self {
            Self::TangentialRestitution(law) => {
                let mut response = planar(self.in_plane(&contact.plane()));
                response.impulse.across = law.across(contact);
                response
            }
            Self::Frictionless(_) => planar(self.in_plane(&contact.plane())),
            Self::Coulomb(law) => law.in_space(contact),
            Self::ChatterjeeRuina(law) => law.in_space(contact),
        }
    }

    /// The paper's law with a constant ε^n, if it is that.
    pub(crate) fn steady(&self) -> Option<Steady<'a>> {
        match self {
            Self::TangentialRestitution(law) => law.steady(),
            _ => None,
        }
    }
}

/// A law as the bounce loop of the lanes takes it.
pub(crate) trait InPlane {
    /// The response where nothing slips across the plane of the axis.
    fn in_plane<S: Simd, const K: usize>(&self, contact: &Plane<S, K>) -> Rebound<S, K>;
}

impl InPlane for Law<'_> {
    /// A call that chooses the law: written out in the bounce loop, all of them would crowd it.
    #[inline(always)]
    fn in_plane<S: Simd, const K: usize>(&self, contact: &Plane<S, K>) -> Rebound<S, K> {
        let simd = contact.slip_normal.simd();
        simd.vectorize(Choice { law: self, contact })
    }
}

/// One lane, as a response in space.
fn planar(rebound: Rebound<Scalar, 1>) -> Response {
    Response {
        impulse: Components {
            normal: rebound.normal.as_slice()[0],
            along: rebound.along.as_slice()[0],
            across: 0.0,
        },
        separation_speed: rebound.separation_speed.as_slice()[0],
    }
}

/// A law and the contacts that it is to answer, to be compiled for each SIMD level.
struct Choice<'a, 'b, S: Simd, const K: usize> {
    law: &'a Law<'b>,
    contact: &'a Plane<S, K>,
}

impl<S: Simd, const K: usize> WithSimd for Choice<'_, '_, S, K> {
    type Output = Rebound<S, K>;

    #[inline(always)]
    fn with_simd<T: Simd>(self, _: T) -> Self::Output {
        match self.law {
            Law::TangentialRestitution(law) => law.in_plane(self.contact),
            Law::Frictionless(law) => law.in_plane(self.contact),
            Law::Coulomb(law) => law.in_plane(self.contact),
            Law::ChatterjeeRuina(law) => law.in_plane(self.contact),
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
